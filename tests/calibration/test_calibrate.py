"""``imugui calibrate`` and ``imugui replay --profile``, as a user calls them."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from imugui.calibration.profile_file import load
from imugui.recording import write_samples
from imugui.samples import Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

Held = Callable[..., tuple[VirtualBoard, Rows]]


def run(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "imugui", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


@pytest.fixture
def positions_csv(held: Held, tmp_path: Path) -> Path:
    """A datasheet board in 12 positions."""
    path = tmp_path / "positions.csv"
    write_samples(path, held(12, 3)[1], {"made by": "a test"})
    return path


def test_gyr_then_acc_into_one_profile_with_its_certificate(positions_csv: Path, tmp_path: Path) -> None:
    first, second, page = (tmp_path / name for name in ("gyr.json", "both.json", "page.html"))
    done = run("calibrate", "gyr", positions_csv, "--out", first, "--name", "probe <1>")
    assert (done.returncode, done.stderr) == (0, "")
    assert "Bias (" in done.stdout
    done = run("calibrate", "acc", positions_csv, "--profile", first, "--out", second, "--certificate", page)
    assert (done.returncode, done.stderr) == (0, "")
    assert "12 positions, 9 parameters" in done.stdout
    profile = load(second)
    assert set(profile.parts) == {"gyroscope", "accelerometer"}
    assert profile.board.name == "probe <1>"
    assert profile.rate_hz == pytest.approx(100.0)
    assert profile.accelerometer is not None
    assert profile.accelerometer.residual_mg <= 0.3
    assert load(first).accelerometer is None
    assert "probe &lt;1&gt;" in page.read_text(encoding="utf-8")


def test_what_is_refused_exits_with_3_the_reason_and_no_file(
    load_real: Callable[[str], Rows], positions_csv: Path, tmp_path: Path
) -> None:
    moving, out = tmp_path / "moving.csv", tmp_path / "never.json"
    write_samples(moving, load_real("startup1"), {})
    for what, word in (("gyr", "handled"), ("acc", "positions"), ("mag", "")):
        done = run("calibrate", what, moving, "--out", out)
        assert done.returncode == 3, done.stderr
        assert done.stderr.startswith("imugui: refused: ")
        assert done.stderr.count("\n") == 1
        assert word in done.stderr
        assert not out.exists()


def test_a_refusal_leaves_the_old_profile(
    positions_csv: Path, load_real: Callable[[str], Rows], tmp_path: Path
) -> None:
    moving, out = tmp_path / "moving.csv", tmp_path / "board.json"
    write_samples(moving, load_real("startup1"), {})
    assert run("calibrate", "gyr", positions_csv, "--out", out).returncode == 0
    before = out.read_bytes()
    assert run("calibrate", "gyr", moving, "--profile", out, "--out", out).returncode == 3
    assert out.read_bytes() == before


@pytest.mark.parametrize("command", [["calibrate", "gyr"], ["replay"]])
def test_a_bad_profile_exits_with_2(command: list[str], positions_csv: Path, tmp_path: Path) -> None:
    bad, out = tmp_path / "bad.json", tmp_path / "out"
    bad.write_text('{"imugui_profile": 99}')
    done = run(*command, positions_csv, "--profile", bad, "--out", out)
    assert done.returncode == 2
    assert done.stderr.startswith("imugui: bad.json: made by a newer imugui")
    assert done.stderr.count("\n") == 1
    assert not out.exists()


def test_a_missing_file_exits_with_2(tmp_path: Path) -> None:
    done = run("calibrate", "acc", "/nowhere/x.csv", "--out", tmp_path / "p.json")
    assert done.returncode == 2
    assert "/nowhere/x.csv: No such file" in done.stderr


def test_mag_and_a_replay_with_the_profile(tmp_path: Path) -> None:
    """Turned to all sides, calibrated, and the same recording fused with and without."""
    csv, profile, plain, better = (tmp_path / name for name in ("free.csv", "p.json", "plain.csv", "better.csv"))
    write_samples(csv, VirtualBoard("free", 100.0, PRESETS["mpu9250"], 5).rows(6000), {})
    done = run("calibrate", "mag", csv, "--out", profile, "--field", "48")
    assert done.returncode == 0, done.stderr
    part = load(profile).magnetometer
    assert part is not None
    assert part.predicted_deg <= 2.0
    assert part.coverage > 0.6
    assert len(part.cells) == pytest.approx(100 * part.coverage, abs=3)  # the picture shows what the figure says
    assert run("replay", csv, "--out", plain).returncode == 0
    assert run("replay", csv, "--profile", profile, "--out", better).returncode == 0
    assert "# profile: p.json" in better.read_text()
    tables = [np.loadtxt(path, delimiter=",", comments=("#", "t,")) for path in (plain, better)]
    assert np.abs(tables[0][-1000:, 1:5] - tables[1][-1000:, 1:5]).max() > 0.01
    assert tables[0][-1000:, 9].mean() >= tables[1][-1000:, 9].mean()


def test_whole_turns_give_the_scale(load_real: Callable[[str], Rows], tmp_path: Path) -> None:
    csv, out = tmp_path / "nilspod.csv", tmp_path / "p.json"
    write_samples(csv, load_real("nilspod"), {})
    done = run("calibrate", "gyr", csv, "--whole-turns", "--out", out)
    assert done.returncode == 0, done.stderr
    assert "x 370, y 354, z 359" in done.stdout
    part = load(out).gyroscope
    assert part is not None
    assert part.matrix_method == "whole turns"
    assert part.matrix[0][0] == pytest.approx(1 / 1.028, abs=1e-3)

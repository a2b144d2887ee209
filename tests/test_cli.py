"""The commands as a user calls them: in a process, with real ports and files."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from imugui.samples import GRAVITY, SAMPLE, empty_rows
from imugui.simulation.pty_board import BOOT_S
from imugui.simulation.pty_port import PtyPort

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")


def run(*arguments: object, timeout: float = 60.0) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "imugui", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)


@pytest.fixture
def walk(tmp_path: Path) -> Path:
    """A board that turns by 90 degrees to the left in two seconds, as sample CSV."""
    from imugui.recording import write_samples

    rows = empty_rows(SAMPLE, 600)
    rows["t"] = np.arange(600) / 200.0
    rows["acc"] = [0.0, 0.0, GRAVITY]
    rows["gyr"] = 0.0
    rows["gyr"][100:500] = [0.0, 0.0, np.pi / 4]
    path = tmp_path / "walk.csv"
    write_samples(path, rows, {"made by": "a test"})
    return path


def test_replay_writes_the_attitude(walk: Path, tmp_path: Path) -> None:
    out = tmp_path / "attitude.csv"
    done = run("replay", walk, "--out", out)
    assert (done.returncode, done.stderr) == (0, "")
    assert "600 samples, 0 bad messages" in done.stdout
    lines = out.read_text().splitlines()
    header = next(line for line in lines if not line.startswith("#"))
    assert header == "t,qw,qx,qy,qz,roll_deg,pitch_deg,yaw_deg,rest,disturbed"
    table = np.loadtxt(out, delimiter=",", skiprows=lines.index(header) + 1)
    assert len(table) == 600
    yaw = table[-1, 7] - table[0, 7]
    assert yaw == pytest.approx(90.0, abs=0.5)
    assert table[-1, 5:7] == pytest.approx([0.0, 0.0], abs=0.1)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("replay", "/nowhere/x.csv", "--out", "y.csv"), "No such file"),
        (("replay", __file__, "--out", "never.csv"), "no known message"),
        (("live", "--recording", "/nowhere/x.csv", "--seconds", "5"), "cannot be read"),
        (("live", "--port", "/dev/there-is-none", "--seconds", "1"), "no port"),
        (("live", "--seconds", "1"), "required"),
        (
            ("live", "--simulate", "rest", "--filter", "imugui", "--set", "delay=1"),
            "there is no 'delay'",
        ),
        (("live", "--simulate", "rest", "--filter", "mahony", "--set", "kp=-1"), "kp: -1.0 is outside"),
        (("replay", __file__, "--out", "never.csv", "--set", "tau_acc=slow"), "'slow' is not a number"),
        (("nonsense",), "invalid choice"),
    ],
)
def test_bad_use_exits_with_2_and_one_cause(arguments: tuple[str, ...], words: str, tmp_path: Path) -> None:
    done = run(*arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_parameters_of_the_filter_can_be_set(walk: Path, tmp_path: Path) -> None:
    plain, late = tmp_path / "plain.csv", tmp_path / "late.csv"
    assert run("replay", walk, "--filter", "imugui", "--set", "bounded=on", "--out", plain).returncode == 0
    assert run("replay", walk, "--filter", "imugui", "--set", "gyr_latency_ms=20", "--out", late).returncode == 0
    yaws = [np.loadtxt(path, delimiter=",", comments=("#", "t"))[:, 7] for path in (plain, late)]
    assert np.abs(yaws[1] - yaws[0]).max() > 0.3  # 20 ms ahead, in the turn


def test_an_unwritable_result_is_said(walk: Path) -> None:
    done = run("replay", walk, "--out", "/nowhere/at/all.csv")
    assert done.returncode == 2
    assert "/nowhere/at/all.csv: No such file or directory" in done.stderr


def test_live_plays_a_recording_at_its_speed(walk: Path, tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    done = run("live", "--recording", walk, "--report", report)
    assert done.returncode == 0, done.stderr
    figures = json.loads(report.read_text())
    assert figures["samples"] == 600
    assert figures["state"] == "ended"
    assert figures["missed_rows"] == 0
    assert set(figures["age_ms"]) == {"p50", "p95", "p99"}


@POSIX
def test_simulate_and_live_meet_on_a_port(tmp_path: Path) -> None:
    link = tmp_path / "board"
    command = [sys.executable, "-m", "imugui", "simulate", "--format", "colon-line", "--port-link", str(link)]
    board = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert "colon-line at 100 Hz" in (board.stdout.readline() if board.stdout else "")
        done = run("live", "--port", link, "--seconds", "6")
    finally:
        board.send_signal(signal.SIGINT)
        board.communicate(timeout=60)
    assert done.returncode == 0, done.stderr
    figures = json.loads(done.stdout)
    assert figures["format"] == "colon-line"
    assert figures["samples"] > 200
    assert figures["bad_messages"] == 0
    assert board.returncode == 0
    assert not link.is_symlink()


@POSIX
@pytest.mark.parametrize(
    ("name", "samples", "bad"), [("triplets-car-run1.txt", 987, 1), ("triplets-car-run3.txt", 494, 0)]
)
def test_the_cars_lines_through_a_port(data_dir: Path, tmp_path: Path, name: str, samples: int, bad: int) -> None:
    """At thirty times their rate, to keep the test short; at their own rate it was done by hand."""
    port = PtyPort()
    port.open()
    report = tmp_path / "report.json"
    command = [sys.executable, "-m", "imugui", "live", "--port", port.path, "--seconds", f"{samples / 288.0 + 5.0}"]
    live = subprocess.Popen([*command, "--report", str(report)], stdout=subprocess.DEVNULL)
    while not port.has_reader():
        assert live.poll() is None
    start = time.monotonic() + BOOT_S  # the board restarts when its port is opened, then speaks
    for k, line in enumerate((data_dir / "boards" / name).read_bytes().splitlines(keepends=True)):
        time.sleep(max(0.0, start + k / 288.0 - time.monotonic()))
        port.write(line)
    assert live.wait(timeout=60) == 0
    port.close()
    figures = json.loads(report.read_text())
    assert (figures["format"], figures["samples"], figures["bad_messages"]) == ("triplets", samples, bad)
    assert (figures["gaps"], figures["missed_rows"]) == (0, 0)
    assert figures["mag_trust"] == "disturbed"


def test_demo_writes_a_report_and_a_picture_of_each_page(tmp_path: Path) -> None:
    environment = os.environ | {"QT_QPA_PLATFORM": "offscreen"}
    command = [sys.executable, "-m", "imugui", "demo", "--out", str(tmp_path / "demo"), "--seconds", "4"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=90, env=environment, check=False)
    assert done.returncode == 0, done.stderr
    figures = json.loads((tmp_path / "demo" / "report.json").read_text())
    assert figures["samples"] > 200
    assert figures["state"] == "streaming"
    for page in ("live", "settings"):
        assert (tmp_path / "demo" / f"{page}.png").read_bytes().startswith(b"\x89PNG")

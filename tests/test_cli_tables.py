"""Foreign tables on the command line: fused as guessed or as said, or refused in one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from imugui.cli import parser

SAMPLES = Path(__file__).resolve().parent / "data"


def replay(tmp_path: Path, *arguments: object) -> tuple[int, Path]:
    out = tmp_path / "attitude.csv"
    parsed = parser().parse_args(["replay", *map(str, arguments), "--out", str(out)])
    return parsed.run(parsed), out


@pytest.mark.parametrize(
    "file", ["phyphox-tab/Gyroscope.csv", "phyphox", "x-imu3/Inertial.csv", "matlab-writetable.csv"]
)
def test_a_foreign_table_is_fused(tmp_path: Path, capsys: pytest.CaptureFixture[str], file: str) -> None:
    status, out = replay(tmp_path, SAMPLES / file)
    assert (status, capsys.readouterr().err) == (0, "")
    table = np.loadtxt(out, delimiter=",", skiprows=sum(line[0] in "#t" for line in out.read_text().splitlines()))
    assert len(table) == 200
    assert np.abs(table[:20, 5:7]).max() < 2.0  # level at first: roll and pitch


def test_what_is_assumed_is_printed_and_kept_in_the_result(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _, out = replay(tmp_path, SAMPLES / "sensor-logger-iphone/Gyroscope.csv")
    assert "assumed: accelerometer in g*-1" in capsys.readouterr().out
    assert "reverses the sign" in out.read_text().partition("\nt,")[0]


def test_columns_can_be_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bare.csv"
    path.write_text("7,0,0,1,0,0,90\n" * 300)
    names = "--columns=,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps"
    status, out = replay(tmp_path, path, names, "--rate", 100, "--filter", "complementary")
    assert status == 0
    table = np.loadtxt(out, delimiter=",", skiprows=sum(line[0] in "#t" for line in out.read_text().splitlines()))
    assert np.unwrap(np.radians(table[:, 7]))[-1] == pytest.approx(np.radians(90 * 2.99), abs=0.1)


@pytest.mark.parametrize(
    ("text", "arguments", "said"),
    [
        ("time,lux\n1,2\n2,3\n3,4\n", (), "names its columns time, lux"),
        ("t_s,mx_uT,my_uT,mz_uT\n" + "0.1,20,3,-40\n0.2,20,3,-41\n" * 20, (), "no attitude without an accelerometer"),
        ("1,2,3\n2,3,4\n", ("--columns=t_s,ax",), "2 columns are named, the file has 3"),
        ("", (), "the file is empty"),
    ],
)
def test_what_cannot_be_fused_is_said_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, arguments: tuple[str, ...], said: str
) -> None:
    path = tmp_path / "odd.csv"
    path.write_text(text)
    status, out = replay(tmp_path, path, *arguments)
    errors = capsys.readouterr().err
    assert status == 2
    assert said in errors
    assert errors.count("\n") == 1
    assert not out.exists()

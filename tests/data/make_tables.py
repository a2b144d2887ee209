"""Writes the sample tables in this folder: run it again after a change, ``python tests/data/make_tables.py``.

The layouts follow public documentation; every value is of our own simulator, none is copied.

- x-IMU3: x-io's x-IMU3 GUI and x-IMU3-Software export one CSV for each kind of message, "Timestamp (us)" first.
- phyphox: the CSV export of its raw sensor experiments (phyphox.org, export sets of phyphox-experiments); five
  variants, comma, tab or semicolon with decimal point, tab or semicolon with decimal comma; numbers as 1.000000000E0.
- Sensor Logger: github.com/tszheichoi/awesome-sensor-logger, UNITS.md, COORDINATES.md and CROSSPLATFORM.md: one CSV
  for each sensor, "time" in ns since 1970, columns z, y, x; on iOS acceleration has the opposite sign, the
  accelerometer comes without gravity, and uncalibrated acceleration is in g.
- MATLAB: mathworks.com/help/matlab/ref/writetable.html and writetimetable.html (row times as "1 sec").
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from imugui.fusion.quaternion import conjugate, rotate
from imugui.samples import GRAVITY, Rows
from imugui.simulation.board import VirtualBoard
from imugui.simulation.errors import PRESETS

HERE = Path(__file__).resolve().parent
RATE_HZ = 500.0
SECONDS = 4.0
GYR, ACC, MAG = slice(0, None, 10), slice(3, None, 10), slice(7, None, 25)
"""Which rows of the simulated board each sensor of a phone gives: 50 Hz, 50 Hz and 20 Hz, at times of their own."""
EPOCH_NS = 1_760_000_000_000_000_000

Columns = Sequence[NDArray[np.float64]]
Number = Callable[[float], str]


def simulated() -> tuple[Rows, NDArray[np.float64]]:
    """Rows of a board that is turned to all sides, and gravity (n, 3) in its axes, m/s2."""
    board = VirtualBoard("free", RATE_HZ, PRESETS["mpu9250-calibrated"], seed=31)
    rows = board.rows(int(SECONDS * RATE_HZ))
    return rows, rotate(conjugate(board.truth), np.tile([0.0, 0.0, GRAVITY], (len(rows), 1)))


def write(name: str, header: str, columns: Columns, numbers: Sequence[Number], delimiter: str = ",") -> None:
    """One file; each column with its own way to write numbers."""
    path = HERE / name
    path.parent.mkdir(exist_ok=True)
    pairs = [[number(value) for value in column.tolist()] for column, number in zip(columns, numbers, strict=True)]
    lines = [header, *(delimiter.join(row) for row in zip(*pairs, strict=True))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def plain(digits: int) -> Number:
    """Numbers with a fixed count of decimals."""
    return lambda value: f"{value:.{digits}f}"


def x_imu3(rows: Rows) -> None:
    """Inertial.csv and Magnetometer.csv; the magnetometer is normalised (a.u.)."""
    us = rows["t"] * 1e6 + 5_000_000
    names = [
        f"{kind} {axis} ({unit})" for kind, unit in (("Gyroscope", "deg/s"), ("Accelerometer", "g")) for axis in "XYZ"
    ]
    columns = [us[GYR], *np.degrees(rows["gyr"][GYR]).T, *(rows["acc"][GYR] / GRAVITY).T]
    write("x-imu3/Inertial.csv", ",".join(["Timestamp (us)", *names]), columns, [plain(0), *[plain(4)] * 6])
    columns = [us[MAG], *(rows["mag"][MAG] / 48.0).T]
    write("x-imu3/Magnetometer.csv", "Timestamp (us),X (a.u.),Y (a.u.),Z (a.u.)", columns, [plain(0), *[plain(4)] * 3])
    columns = [us[::500], rows["temp_c"][::500]]
    write("x-imu3/Temperature.csv", "Timestamp (us),Temperature (degC)", columns, [plain(0), plain(4)])


def phyphox(rows: Rows, folder: str, delimiter: str, decimal: str) -> None:
    """The three raw sensors, each with its own times."""

    def number(value: float) -> str:
        mantissa, _, exponent = f"{value:.9E}".partition("E")
        return f"{mantissa.replace('.', decimal)}E{int(exponent)}"

    sensors = (
        ("Accelerometer", "Acceleration {} (m/s^2)", "acc", ACC),
        ("Gyroscope", "Gyroscope {} (rad/s)", "gyr", GYR),
        ("Magnetometer", "Magnetic field {} (µT)", "mag", MAG),
    )
    for file, name, key, chosen in sensors:
        header = delimiter.join(f'"{text}"' for text in ("Time (s)", *(name.format(axis) for axis in "xyz")))
        columns = [rows["t"][chosen] + 0.01, *rows[key][chosen].T]
        write(f"{folder}/{file}.csv", header, columns, [number] * 4, delimiter)


def sensor_logger(rows: Rows, gravity: NDArray[np.float64], folder: str, iphone: bool) -> None:
    """One CSV for each sensor; an iPhone has no TotalAcceleration, and its acceleration has the other sign."""
    sign = -1.0 if iphone else 1.0
    sensors = {
        "Accelerometer": (sign * (rows["acc"] - gravity), ACC),
        "Gravity": (sign * gravity, ACC),
        "Gyroscope": (rows["gyr"], GYR),
        "Magnetometer": (rows["mag"], MAG),
    }
    if iphone:
        sensors["AccelerometerUncalibrated"] = (-rows["acc"] / GRAVITY, ACC)
    else:
        sensors["TotalAcceleration"] = (rows["acc"], ACC)
    for file, (values, chosen) in sensors.items():
        t = rows["t"][chosen] + 0.031
        columns = [t, t, *values[chosen].T[::-1]]
        numbers = [lambda value: str(EPOCH_NS + round(value * 1e9)), plain(9), *[plain(9)] * 3]
        write(f"{folder}/{file}.csv", "time,seconds_elapsed,z,y,x", columns, numbers)


def sensor_logger_combined(rows: Rows, gravity: NDArray[np.float64]) -> None:
    """All sensors in one file, with empty cells where a sensor has nothing at a time."""
    prefixes = {"accelerometer": rows["acc"] - gravity, "gyroscope": rows["gyr"], "magnetometer": rows["mag"]}
    prefixes |= {"totalAcceleration": rows["acc"], "gravity": gravity}
    when = {"gyroscope": GYR, "magnetometer": MAG}
    chosen = np.zeros((len(rows), len(prefixes)), bool)
    for place, name in enumerate(prefixes):
        chosen[when.get(name, ACC), place] = True
    header = ["seconds_elapsed", *(f"{name}_{axis}" for name in prefixes for axis in "zyx")]
    lines = [",".join(header)]
    for k in np.flatnonzero(chosen.any(axis=1)):
        cells = [f"{value:.9f}" if chosen[k, place] else "" for place, values in enumerate(prefixes.values())
                 for value in values[k][::-1]]  # fmt: skip
        lines.append(",".join([f"{rows['t'][k]:.6f}", *cells]))
    (HERE / "sensor-logger-combined.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def matlab(rows: Rows) -> None:
    """writetable of a table with units in its variable names, and writetimetable."""
    chosen = rows[GYR]
    values = [*(chosen["acc"] / GRAVITY).T, *np.degrees(chosen["gyr"]).T, *chosen["mag"].T]
    short: Number = lambda value: f"{value:.15g}"  # noqa: E731
    names = [
        *(f"Acc{axis}_g" for axis in "XYZ"),
        *(f"Gyro{axis}_deg_s" for axis in "XYZ"),
        *(f"Mag{axis}_uT" for axis in "XYZ"),
    ]
    write("matlab-writetable.csv", ",".join(["Time_s", *names]), [chosen["t"], *values], [short] * 10)
    bare = ["Time", "Acceleration_X", "Acceleration_Y", "Acceleration_Z",
            "AngularVelocity_X", "AngularVelocity_Y", "AngularVelocity_Z"]  # fmt: skip
    numbers = [lambda value: f"{value:.5g} sec", *[short] * 6]
    write("matlab-writetimetable.csv", ",".join(bare), [chosen["t"], *values[:6]], numbers)


def main() -> None:
    """Write every table."""
    rows, gravity = simulated()
    x_imu3(rows)
    phyphox(rows, "phyphox", ",", ".")
    phyphox(rows, "phyphox-semicolon", ";", ",")
    phyphox(rows, "phyphox-tab", "\t", ",")
    sensor_logger(rows, gravity, "sensor-logger-android", iphone=False)
    sensor_logger(rows, gravity, "sensor-logger-iphone", iphone=True)
    sensor_logger_combined(rows, gravity)
    matlab(rows)


if __name__ == "__main__":
    main()

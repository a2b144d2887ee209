"""Names of columns in the spellings of other programs."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.formats.spelling import UNKNOWN, read_spelling


@pytest.mark.parametrize(
    ("name", "kind", "axis", "unit"),
    [
        ("Timestamp (us)", "t", "", "us"),
        ("Gyroscope X (deg/s)", "g", "x", "deg/s"),
        ("Accelerometer Z (g)", "a", "z", "g"),
        ("Acceleration x (m/s^2)", "a", "x", "m/s^2"),
        ("Linear Acceleration x (m/s^2)", "lin", "x", "m/s^2"),
        ("Magnetic field y (µT)", "m", "y", "µT"),
        ("seconds_elapsed", "t", "", "s"),
        ("Time since start in ms ", "t", "", "ms"),
        ("t_nominal_s", "t", "", "s"),
        ("totalAcceleration_z", "a", "z", ""),
        ("userAccelerationY", "lin", "y", ""),
        ("gravity_x", "grav", "x", ""),
        ("rotationRateX", "g", "x", ""),
        ("AngularVelocity_Y", "g", "y", ""),
        ("Accel_X_m_s2", "a", "x", "m/s2"),
        ("GyroY_deg_s", "g", "y", "deg/s"),
        ("rollrate", "g", "x", ""),
        ("yaw rate (deg/s)", "g", "z", "deg/s"),
        ("gyroscope pitch (rad/s)", "g", "y", "rad/s"),
        ("location_latitude", "lat", "", ""),
        ("Velocity (m/s)", "speed", "", "m/s"),
        ("bearing", "course_deg", "", ""),
        ("Temperature (°C)", "temp_c", "", "°C"),
    ],
)
def test_spellings(name: str, kind: str, axis: str, unit: str) -> None:
    meaning = read_spelling(name)
    assert (meaning.kind, meaning.axis, meaning.unit) == (kind, axis, unit)


@pytest.mark.parametrize(
    "name",
    ["", "qw", "quaternionX", "roll", "pitch_deg", "n_samples", "px", "bearingAccuracy", "relativeAltitude", "date",
     "Absolute acceleration (m/s^2)", "line_repeats", "annotation", "gyro_bias_x", "x"],
)  # fmt: skip
def test_other_names_mean_nothing(name: str) -> None:
    assert read_spelling(name).kind == ""


@pytest.mark.parametrize(
    ("file", "kind"),
    [
        ("Gyroscope", "g"),
        ("TotalAcceleration", "a"),
        ("Gravity", "grav"),
        ("Linear Accelerometer", "lin"),
        ("Magnetometer", "m"),
        ("Orientation", ""),
    ],
)
def test_a_bare_axis_takes_its_kind_from_the_file(file: str, kind: str) -> None:
    assert read_spelling("x", file).kind == kind


def test_the_three_axes_of_a_sensor_are_one_group() -> None:
    for names in (("AngularVelocity_X", "AngularVelocity_Y"), ("gyroX", "gyroY"), ("ax_g", "ay_g"), ("x_acc", "y_acc")):
        assert len({read_spelling(name).group for name in names}) == 1, names
    assert read_spelling("accelerometer_x").group != read_spelling("totalAcceleration_x").group


def test_uncalibrated_sensors_are_second_choice() -> None:
    assert read_spelling("gyroscopeUncalibrated_x").lesser > read_spelling("gyroscope_x").lesser


@given(st.text(max_size=60), st.text(max_size=20))
def test_no_name_raises(name: str, file: str) -> None:
    meaning = read_spelling(name, file)
    assert meaning == UNKNOWN or meaning.kind

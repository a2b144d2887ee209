"""The true motions: unit, smooth, starting at rest, equal for equal seeds, and true to their names."""

from __future__ import annotations

import numpy as np
import pytest

from imugui.fusion import quaternion
from imugui.simulation.motions import MOTIONS
from imugui.simulation.path import Floats, Path, place

OF_TIME = [name for name in MOTIONS if name != "hand"]
DEGREE = np.pi / 180


def times(seconds: float, rate_hz: float = 200.0) -> Floats:
    return np.arange(int(seconds * rate_hz)) / rate_hz


def rates(path: Path, seconds: float, rate_hz: float = 200.0) -> Floats:
    """Body rates (n-1, 3) in rad/s."""
    quats = path.quats(times(seconds, rate_hz))
    steps = quaternion.multiply(quaternion.conjugate(quats[:-1]), quats[1:])
    return quaternion.to_rotation_vector(steps) * rate_hz


@pytest.mark.parametrize("name", MOTIONS)
def test_every_motion_has_words_and_unit_quaternions(name: str) -> None:
    motion = MOTIONS[name]
    assert motion.title
    assert motion.sentence.endswith(".")
    quats = motion.start(3).quats(times(90.0, 50.0))
    assert np.abs(np.linalg.norm(quats, axis=1) - 1).max() < 1e-12


@pytest.mark.parametrize("name", MOTIONS)
def test_every_motion_begins_at_rest_and_turns_smoothly(name: str) -> None:
    path = MOTIONS[name].start(5)
    turning = rates(path, 60.0, 500.0)
    assert np.abs(turning[:499]).max() < 1e-9
    assert np.linalg.norm(turning, axis=1).max() < 250 * DEGREE
    # no jump of the rate: 12 Hz tremor of 0.4 deg has 40 rad/s2, a stepped rate would show thousands
    assert np.abs(np.diff(turning, axis=0)).max() * 500.0 < 60.0


@pytest.mark.parametrize("name", OF_TIME)
def test_a_motion_of_time_is_the_same_for_the_same_seed_at_any_time(name: str) -> None:
    t = times(4000.0, 1.0) + 0.37
    path, again = MOTIONS[name].start(11), MOTIONS[name].start(11)
    late = again.quats(t[2000:])
    assert np.abs(path.quats(t)[2000:] - late).max() < 1e-9


@pytest.mark.parametrize("name", ["rest", "aiming", "driving", "free"])
def test_another_seed_is_another_course(name: str) -> None:
    t = times(30.0, 20.0)
    one, two = (MOTIONS[name].start(seed).quats(t) for seed in (1, 2))
    assert quaternion.angle_between(one, two).max() > 0.1 * DEGREE


def test_rest_does_not_move() -> None:
    assert np.abs(rates(MOTIONS["rest"].start(4), 10.0)).max() < 1e-12


def test_turns_read_90_degrees_about_each_own_axis_in_turn() -> None:
    path = MOTIONS["turns"].start(0)
    middle_of_holds = np.arange(13) * 4.5 + 0.75
    turned = quaternion.to_rotation_vector(path.quats(middle_of_holds)) / DEGREE
    expected = np.zeros((13, 3))
    for axis in range(3):
        expected[4 * axis + 1, axis], expected[4 * axis + 3, axis] = 90, -90
    assert np.abs(turned - expected).max() < 1e-9
    speed = np.abs(rates(path, 54.0)) / DEGREE
    assert 50 < speed.max() < 60
    assert (np.count_nonzero(speed > 1e-9, axis=1) <= 1).all()


def test_aiming_is_slow_and_trembles_like_a_hand() -> None:
    path = MOTIONS["aiming"].start(8)
    speed = np.linalg.norm(rates(path, 180.0), axis=1) / DEGREE
    assert np.quantile(speed, 0.95) < 60
    held = times(2.0, 200.0) + 1.5 + 4.5 + 2.3
    wobble = quaternion.to_rotation_vector(
        quaternion.multiply(quaternion.conjugate(path.quats(held[:1])), path.quats(held))
    )
    power = np.abs(np.fft.rfft((wobble - wobble.mean(axis=0)) * np.hanning(400)[:, None], axis=0)) ** 2
    hertz = np.fft.rfftfreq(400, 1 / 200)
    tremor = power[(hertz >= 7) & (hertz <= 13)].sum()
    assert power[hertz > 14].sum() < 0.01 * tremor
    rms_deg = np.sqrt(2 * tremor / 400**2 / (3 / 8) / 3) / DEGREE  # three axes; the Hann window keeps 3/8
    assert 0.08 < rms_deg < 0.16


@pytest.mark.parametrize("seed", [0, 1, 2, 7])
@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (0.0, 0.4226, -0.9063), (1.0, 0.0, 0.0)])
def test_free_shows_every_side_to_up_north_and_east_within_a_minute(seed: int, direction: tuple[float, ...]) -> None:
    quats = MOTIONS["free"].start(seed).quats(times(60.0, 50.0))
    seen = quaternion.rotate(quaternion.conjugate(quats), np.broadcast_to(direction, (len(quats), 3)))
    # 10 bands of equal height by 10 sectors: 100 cells of equal area
    band = np.clip((seen[:, 2] + 1) * 5, 0, 9.999).astype(int)
    sector = ((np.arctan2(seen[:, 1], seen[:, 0]) / (2 * np.pi)) % 1.0 * 10).astype(int) % 10
    assert len(set(zip(band.tolist(), sector.tolist(), strict=True))) > 90


def test_driving_goes_where_it_points_and_stays_on_its_track() -> None:
    path = MOTIONS["driving"].start(2)
    t = times(40.0, 50.0)[200:]
    velocity = path.velocity(t)
    forward = quaternion.rotate(path.quats(t), np.broadcast_to([1.0, 0.0, 0.0], (len(t), 3)))
    speed = np.linalg.norm(velocity, axis=1)
    assert 1.1 < speed.min() < speed.max() < 1.9
    assert ((velocity * forward).sum(axis=1) / speed).min() > np.cos(2 * DEGREE)
    east, north, _ = path.position(t).T
    assert np.abs((east / 1.2) ** 2 + (north / 0.8) ** 2 - 1).max() < 1e-9


def test_acceleration_is_the_second_derivative_of_the_position() -> None:
    path = MOTIONS["driving"].start(2)
    t = times(6.0, 100.0) + 10.0
    # on the ellipse at a steady parameter rate of 1.5 rad/s the acceleration is -1.5^2 times the position
    assert np.abs(path.acceleration(t) + 2.25 * path.position(t)).max() < 1e-5
    aiming = MOTIONS["aiming"].start(2)
    assert 0.1 < np.abs(aiming.acceleration(t)).max() < 5.0
    assert not MOTIONS["free"].start(2).acceleration(t).any()


def test_the_place_on_the_globe_moves_as_the_car_does() -> None:
    path = MOTIONS["driving"].start(2)
    t = times(20.0, 10.0)
    at, position = place(path, t), path.position(t)
    assert (at.lat - at.lat[0]) * 111_320 == pytest.approx(position[:, 1] - position[0, 1], abs=1e-6)
    east = (at.lon - at.lon[0]) * 111_320 * np.cos(50.8162 * DEGREE)
    assert east == pytest.approx(position[:, 0] - position[0, 0], abs=1e-6)
    assert at.speed[0] == 0.0
    assert at.speed[-1] == pytest.approx(np.linalg.norm(path.velocity(t)[-1]))

"""Rest and field detectors of the light filters."""

from __future__ import annotations

import json

import numpy as np
import pytest

from imugui.fusion.detectors import FieldDetector, RestDetector

UP = (0.0, 0.0, 9.81)
DIP = np.radians(65.0)


def test_rest_comes_after_a_second_and_a_half() -> None:
    detector = RestDetector()
    flags = [detector.update((0.01, 0.0, 0.0), UP, 0.01) for _ in range(200)]
    assert flags.index(True) == pytest.approx(149, abs=1)


@pytest.mark.parametrize(
    ("gyr", "acc"), [((0.2, 0.0, 0.0), UP), ((0.0, 0.0, 0.0), (0.8, 0.0, 9.81)), ((0.0, 0.0, -0.1), UP)]
)
def test_any_movement_ends_it(gyr: tuple[float, ...], acc: tuple[float, ...]) -> None:
    detector = RestDetector()
    for _ in range(200):
        detector.update((0.0, 0.0, 0.0), UP, 0.01)
    assert detector.rest
    assert not detector.update(gyr, acc, 0.01)
    assert not detector.update((0.0, 0.0, 0.0), UP, 0.01)


def fed(detector: FieldDetector, norm: float, dip: float, seconds: float, rate: float) -> list[bool]:
    return [detector.update(norm, dip, 0.05, rate) for _ in range(round(seconds / 0.05))]


def test_the_first_steady_field_is_the_reference_and_never_called_disturbed() -> None:
    detector = FieldDetector()
    assert not any(fed(detector, 48.0, DIP, 5.0, 0.0))
    assert all(fed(detector, 60.0, DIP, 2.0, 0.0)[4:])
    assert not any(fed(detector, 48.0, DIP, 3.0, 0.0)[20:])


@pytest.mark.parametrize(("norm", "dip_deg"), [(54.0, 65.0), (42.0, 65.0), (48.0, 77.0), (48.0, 53.0)])
def test_norm_and_dip_count(norm: float, dip_deg: float) -> None:
    detector = FieldDetector()
    fed(detector, 48.0, DIP, 5.0, 0.0)
    assert fed(detector, norm, np.radians(dip_deg), 1.0, 1.0)[-1]


@pytest.mark.parametrize(("norm", "dip_deg"), [(51.0, 65.0), (48.0, 72.0)])
def test_a_little_more_or_less_is_the_same_field(norm: float, dip_deg: float) -> None:
    detector = FieldDetector()
    fed(detector, 48.0, DIP, 5.0, 0.0)
    assert not any(fed(detector, norm, np.radians(dip_deg), 5.0, 1.0))


@pytest.mark.parametrize(("rate", "accepted"), [(0.0, False), (1.0, True)])
def test_another_field_is_accepted_after_20_s_of_turning_only(rate: float, accepted: bool) -> None:
    detector = FieldDetector()
    fed(detector, 48.0, DIP, 5.0, 1.0)
    assert all(fed(detector, 30.0, DIP, 19.0, rate)[4:])
    assert fed(detector, 30.0, DIP, 3.0, rate)[-1] is not accepted


def test_states_continue() -> None:
    for detector, sample in ((RestDetector(), ((0.01, 0.0, 0.0), UP, 0.01)), (FieldDetector(), (48.0, DIP, 0.05, 1.0))):
        for _ in range(100):
            detector.update(*sample)  # type: ignore[arg-type]
        again = type(detector)()
        again.restore(json.loads(json.dumps(detector.state())))
        assert [again.update(*sample) for _ in range(100)] == [detector.update(*sample) for _ in range(100)]  # type: ignore[arg-type]
        assert again.state() == detector.state()

"""GUIDES: every guided calibration that the page offers, by key; the first of a part is the one recommended."""

from __future__ import annotations

import dataclasses

from imugui.calibration.accelerometer_flows import FLOWS
from imugui.calibration.axes_flow import AxesFlow, MappedMagnetometerFlow
from imugui.calibration.mounting import MountingFlow
from imugui.calibration.profile import Profile
from imugui.calibration.rest import RestFlow
from imugui.calibration.temperature import TemperatureFlow
from imugui.views import calibrate_apply as apply
from imugui.views import guides_inertial as inertial
from imugui.views import guides_mag as mag
from imugui.views import guides_still as still
from imugui.views.calibrate_apply import AXES_METHOD
from imugui.views.calibrate_look import Guide

_POSITION_WORDS = {
    "many": "Put the board down in 9 to 12 different ways; any will do, in any order. About 2 minutes.",
    "six": "Put the board down on each of its six sides, in any order. About 1 minute.",
    "flat": "Lay the board flat on a level table. A few seconds; the way of two older programs.",
}


def _positions(method: str) -> Guide:
    flow = FLOWS[method]()
    return Guide(
        f"acc {method}", "acc", f"Accelerometer: {flow.title.lower()}", _POSITION_WORDS[method], flow.accuracy,
        "cube", "g", lambda profile: FLOWS[method](), inertial.positions_look, inertial.judge_acc, apply.apply_acc,
    )  # fmt: skip


def _magnetometer(profile: Profile | None) -> MappedMagnetometerFlow:
    part = profile.magnetometer if profile else None
    if profile is None or part is None:
        return MappedMagnetometerFlow(before=profile.correction() if profile else None)
    rough = part.method == AXES_METHOD  # nothing to be compared with
    before = dataclasses.replace(profile, magnetometer=None) if rough else profile
    return MappedMagnetometerFlow(part.axes, before.correction())


_ALL = (
    Guide(
        "gyr", "gyr", "Gyroscope: at rest", "Lay the board on something solid and let go of it. 2 to 10 seconds.",
        "The bias, to 0.02 deg/s.", "board", "deg/s",
        lambda profile: RestFlow(), inertial.rest_look, inertial.judge_rest, apply.apply_rest,
    ),
    *(_positions(method) for method in ("many", "six", "flat")),
    Guide(
        "acc fall", "acc", "Accelerometer: free fall", "Let the board drop three times onto something soft.",
        FLOWS["free fall"]().accuracy, "board", "g",
        lambda profile: FLOWS["free fall"](), inertial.fall_look, inertial.judge_acc, apply.apply_acc,
    ),
    Guide(
        "mag", "mag", "Magnetometer", "Turn the board slowly to all sides, away from metal; then once around to check. "
        "About 1 minute.", "Heading to 1 to 2 deg.", "sphere", "µT",
        _magnetometer,
        mag.mag_look, mag.judge_mag, apply.apply_mag, first=("gyr", "acc"), finish="finish_turning", ends=True,
    ),
    Guide(
        "axes", "axes", "Axes", "Turn the board slowly to all sides, with stops. Half a minute.",
        "One of 24 maps, with its lead over the second.", "board", "",
        lambda profile: AxesFlow(profile.correction() if profile else None),
        mag.axes_look, mag.judge_axes, apply.apply_axes, first=("acc",), ends=True,
    ),
    Guide(
        "mounting", "mounting", "Mounting", "Put the box level as it is used, then raise its nose. 20 seconds.",
        "The direction ahead, to about 1 deg.", "board", "",
        lambda profile: MountingFlow(profile.correction() if profile else None),
        still.mounting_look, still.judge_mounting, apply.apply_mounting, ends=True,
    ),
    Guide(
        "temperature", "temperature", "Temperature", "Leave the board lying while it warms up or cools down. 5 to 20 "
        "minutes.", "The bias over 5 K and more, where it follows the temperature at all.", "board", "deg/s",
        lambda profile: TemperatureFlow(), still.temperature_look, still.judge_temperature, apply.apply_temperature,
        pace_s=32.0,  # each verdict closes the still spans that run
    ),
)  # fmt: skip

GUIDES: dict[str, Guide] = {guide.key: guide for guide in _ALL}

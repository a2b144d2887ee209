"""Control: everything a person may set about how the hand steers the view."""

from __future__ import annotations

from dataclasses import dataclass

from imugui.fields import field as editable

POSITION = "position"
SPEED = "speed"
HOLD = "hold"
TOGGLE = "toggle"

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
"""A turn about a body axis, right-handed or the other way."""


@dataclass(frozen=True)
class Control:
    """How a turn of the board becomes a movement of the view; ``PRESETS`` has the usual sets.

    The default axes are those of a pointer: the board lies flat in the hand, x to the right, y forward, z up.
    Turning it to the right moves the view right, raising its front moves it up or, while zooming, makes it larger.
    """

    mapping: str = editable(
        POSITION, "Mapping", choices=(POSITION, SPEED), tip="Whether an angle means a place or a speed."
    )
    gain: float = editable(
        8.0, "Gain", unit="px/deg", low=0.1, high=100.0, step=0.5,
        tip="Pixels of the 600 px field per degree of the hand; with the speed mapping, pixels per second per degree.",
    )  # fmt: skip
    zoom_gain: float = editable(
        8.0, "Gain while zooming", unit="px/deg", low=0.1, high=100.0, step=0.5,
        tip="The same for the side of the view.",
    )  # fmt: skip
    dead_zone_deg: float = editable(
        0.0, "Dead zone", unit="°", low=0.0, high=20.0, step=0.1,
        tip="Smaller turns do nothing. It is taken off larger ones, so that nothing jumps at its edge.",
    )  # fmt: skip
    exponent: float = editable(
        1.0, "Curve", low=1.0, high=3.0, step=0.1,
        tip="1 is straight; more is finer near the middle, with the same reach at saturation.",
    )  # fmt: skip
    saturation_deg: float = editable(
        45.0, "Saturation", unit="°", low=1.0, high=90.0, step=1.0, tip="Larger turns count as this one."
    )  # fmt: skip
    v_max: float = editable(
        5000.0, "Largest speed", unit="px/s", low=1.0, high=1e5, step=100.0,
        tip="Of the command, for place and size alike.",
    )  # fmt: skip
    a_max: float = editable(
        5e5, "Largest acceleration", unit="px/s²", low=1.0, high=1e8, step=1000.0,
        tip="Of the command, for place and size alike.",
    )  # fmt: skip
    lag_s: float = editable(
        0.0, "Lag", unit="s", low=0.0, high=10.0, step=0.05, tip="Time constant τ of a slow robot (first order)."
    )  # fmt: skip
    dead_time_s: float = editable(
        0.0, "Dead time", unit="s", low=0.0, high=0.5, step=0.01, tip="The hand is seen this much later."
    )  # fmt: skip
    smoothing: bool = editable(True, "Smooth the hand", tip="The 1 € filter: steady when still, quick when moving.")
    min_cutoff_hz: float = editable(
        1.0, "Cut-off at rest", unit="Hz", low=0.05, high=50.0, step=0.1, tip="Lower is steadier when still."
    )  # fmt: skip
    beta: float = editable(
        0.02, "Cut-off slope", unit="Hz per deg/s", low=0.0, high=10.0, step=0.005, tip="Higher lags less when moving."
    )  # fmt: skip
    derivative_cutoff_hz: float = editable(
        1.0, "Cut-off of the hand's speed", unit="Hz", low=0.05, high=50.0, step=0.1,
        tip="How smooth the speed is that opens the filter.",
    )  # fmt: skip
    gain_ramp_s: float = editable(
        0.15, "Gain ramp", unit="s", low=0.0, high=2.0, step=0.01, tip="The gain grows from 0 to full after engaging."
    )  # fmt: skip
    mask_s: float = editable(
        0.020, "Button mask", unit="s", low=0.0, high=0.5, step=0.005,
        tip="A pressed button jolts the board: for so long the gyroscope alone carries the attitude.",
    )  # fmt: skip
    latch: str = editable(
        HOLD, "Buttons", choices=(HOLD, TOGGLE),
        tip="hold: steers while a button is held. toggle: one press starts, the next one stops.",
    )  # fmt: skip
    latch_timeout_s: float = editable(
        60.0, "Latched at most", unit="s", low=1.0, high=600.0, step=5.0,
        tip="A latched activation ends by itself, as the heading drifts meanwhile.",
    )  # fmt: skip
    disengage_deg: float = editable(
        90.0, "Lets go beyond", unit="°", low=10.0, high=170.0, step=5.0, tip="A hand turned further steers no more."
    )  # fmt: skip
    half_width: float = editable(
        300.0, "Workspace", unit="px", low=10.0, high=3000.0, step=10.0,
        tip="How far the centre of the view may go from the middle of the field, to each side.",
    )  # fmt: skip
    size_min: float = editable(20.0, "Smallest view", unit="px", low=1.0, high=600.0, step=5.0)
    size_max: float = editable(600.0, "Largest view", unit="px", low=1.0, high=3000.0, step=5.0)
    stale_s: float = editable(
        0.1, "Input is stale after", unit="s", low=0.02, high=1.0, step=0.01,
        tip="Without a sample for so long, and for five periods, the view holds.",
    )  # fmt: skip
    gyro_range_dps: float = editable(
        2000.0, "Gyroscope range", unit="deg/s", low=50.0, high=4000.0, step=50.0,
        tip="A rate at the end of the range is no measurement.",
    )  # fmt: skip
    x_axis: str = editable("-z", "Right is a turn about", choices=AXES, tip="An axis of the board, right-handed.")
    y_axis: str = editable("+x", "Up is a turn about", choices=AXES, tip="An axis of the board, right-handed.")
    zoom_axis: str = editable("+x", "Larger is a turn about", choices=AXES, tip="An axis of the board, right-handed.")
    roll_corrected: bool = editable(
        True, "Correct the roll", tip="Right stays right when the board is held rolled. For pointing, not for tilting."
    )


def _thesis(mapping: str) -> Control:
    """The motion card: both tilts of a flat card steer, x also zooms, a click latches; no smoothing but the lag."""
    return Control(
        mapping=mapping, lag_s=0.25, smoothing=False, gain_ramp_s=0.0, latch=TOGGLE, saturation_deg=90.0,
        v_max=1e5, a_max=1e8, x_axis="+x", y_axis="+y", zoom_axis="+x", roll_corrected=False,
    )  # fmt: skip


PRESETS: dict[str, Control] = {
    "position": Control(),
    "speed": Control(mapping=SPEED, dead_zone_deg=1.5),
    "thesis position": _thesis(POSITION),
    "thesis speed": _thesis(SPEED),
}

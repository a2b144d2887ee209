"""The parameters of VQF, with units; here, apart, so that they can be read where the library is missing."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

from imugui.fields import field as editable


@dataclass(frozen=True)
class VqfParams:
    """The library's parameters under its own names, with units."""

    tau_acc: float = editable(
        3.0, "Time constant, tilt", unit="s", low=0.05, high=100.0, step=0.1,
        tip="How slowly the vertical of the accelerometer is followed; short trusts it more.",
    )  # fmt: skip
    tau_mag: float = editable(
        9.0, "Time constant, heading", unit="s", low=0.05, high=1000.0, step=0.5,
        tip="How slowly the magnetic north is followed; short trusts it more.",
    )  # fmt: skip
    motion_bias_est_enabled: bool = editable(
        True, "Learn the gyroscope bias in motion", tip="From the tilt corrections; the magnetometer is not used."
    )
    rest_bias_est_enabled: bool = editable(
        True, "Learn the gyroscope bias at rest", tip="Needed for the rest flag, too."
    )
    mag_dist_rejection_enabled: bool = editable(
        True, "Reject a disturbed field", tip="The heading is left to the gyroscope while the field is not the earth's."
    )
    bias_sigma_init_dps: float = editable(
        0.5, "Bias: first uncertainty", unit="deg/s", low=0.01, high=20.0, step=0.1, tip="One standard deviation."
    )
    bias_forgetting_time: float = editable(
        100.0, "Bias: forgetting time", unit="s", low=1.0, high=10000.0, step=10.0,
        tip="In this time the uncertainty of a known bias grows from 0 to 0.1 deg/s.",
    )  # fmt: skip
    bias_clip_dps: float = editable(
        2.0, "Bias: largest believed", unit="deg/s", low=0.1, high=50.0, step=0.5,
        tip="A constant rate above this is motion, not bias and not rest.",
    )  # fmt: skip
    bias_sigma_motion_dps: float = editable(
        0.1, "Bias: uncertainty reached in motion", unit="deg/s", low=0.001, high=10.0, step=0.01,
        tip="Small values trust the estimate in motion more.",
    )  # fmt: skip
    bias_vertical_forgetting_factor: float = editable(
        0.0001, "Bias: forgetting about the vertical", low=0.0, high=1.0, step=0.0001,
        tip="How strongly the bias about the vertical, not observable in motion, is drawn to zero.",
    )  # fmt: skip
    bias_sigma_rest_dps: float = editable(
        0.03, "Bias: uncertainty reached at rest", unit="deg/s", low=0.001, high=10.0, step=0.01,
        tip="Small values trust the estimate at rest more.",
    )  # fmt: skip
    rest_min_t: float = editable(
        1.5, "Rest: after", unit="s", low=0.1, high=60.0, step=0.1, tip="So long nothing may move before it is rest."
    )
    rest_filter_tau: float = editable(
        0.5, "Rest: low-pass", unit="s", low=0.05, high=10.0, step=0.1, tip="Rest is staying near this low-pass."
    )
    rest_th_gyr_dps: float = editable(
        2.0, "Rest: largest rate departure", unit="deg/s", low=0.01, high=50.0, step=0.1,
        tip="Of the angular rate from its low-pass.",
    )  # fmt: skip
    rest_th_acc: float = editable(
        0.5, "Rest: largest acceleration departure", unit="m/s2", low=0.01, high=20.0, step=0.1,
        tip="Of the specific force from its low-pass.",
    )  # fmt: skip
    mag_current_tau: float = editable(
        0.05, "Field: low-pass", unit="s", low=0.001, high=10.0, step=0.01, tip="On norm and dip.",
    )  # fmt: skip
    mag_ref_tau: float = editable(
        20.0, "Field: reference time constant", unit="s", low=0.1, high=1000.0, step=1.0,
        tip="How slowly the reference follows an undisturbed field.",
    )  # fmt: skip
    mag_norm_th: float = editable(
        0.1, "Field: largest departure of the norm", low=0.001, high=10.0, step=0.01, tip="Relative to the reference."
    )
    mag_dip_th_deg: float = editable(
        10.0, "Field: largest departure of the dip", unit="deg", low=0.1, high=180.0, step=0.5,
        tip="From the reference.",
    )  # fmt: skip
    mag_new_time: float = editable(
        20.0, "Field: accept another after", unit="s", low=0.1, high=1000.0, step=1.0,
        tip="So long another field must stay the same while the board turns before it becomes the reference.",
    )  # fmt: skip
    mag_new_first_time: float = editable(
        5.0, "Field: accept the first after", unit="s", low=0.1, high=1000.0, step=0.5,
        tip="The same for the first reference.",
    )  # fmt: skip
    mag_new_min_gyr_dps: float = editable(
        20.0, "Field: turning means at least", unit="deg/s", low=0.0, high=1000.0, step=1.0,
        tip="Only time spent turning so fast counts for accepting a field.",
    )  # fmt: skip
    mag_min_undisturbed_time: float = editable(
        0.5, "Field: undisturbed after", unit="s", low=0.0, high=60.0, step=0.1, tip="So long near the reference."
    )
    mag_max_rejection_time: float = editable(
        60.0, "Field: reject at most", unit="s", low=0.0, high=3600.0, step=5.0,
        tip="After that a disturbed field is followed again, but slowly.",
    )  # fmt: skip
    mag_rejection_factor: float = editable(
        2.0, "Field: then slower by", low=1.0, high=1000.0, step=0.5, tip="Factor on the time constant of the heading."
    )


def library_arguments(params: VqfParams) -> dict[str, Any]:
    """The parameters under the library's spelling: ``rest_th_gyr_dps`` is its ``restThGyr``."""
    arguments = {}
    for name, value in dataclasses.asdict(params).items():
        first, *others = name.removesuffix("_dps").removesuffix("_deg").split("_")
        arguments[first + "".join(word.capitalize() for word in others)] = value
    return arguments

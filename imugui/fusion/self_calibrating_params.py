"""The parameters of imugui's own filter, with units."""

from __future__ import annotations

from dataclasses import dataclass

from imugui.fields import field as editable


@dataclass(frozen=True)
class ImuguiParams:
    """What a person may change; noises are densities, so that they hold at any rate."""

    gyr_latency_ms: float = editable(
        0.0, "Delay of the gyroscope", unit="ms", low=0.0, high=50.0, step=0.1,
        tip="Group delay of its low-pass. The attitude is predicted ahead by it.",
    )  # fmt: skip
    mag_latency_ms: float = editable(
        0.0, "Delay of the magnetometer", unit="ms", low=0.0, high=200.0, step=1.0,
        tip="How much later than the gyroscope's the field's values arrive.",
    )  # fmt: skip
    mag_latency_sigma_ms: float = editable(
        10.0, "Delay of the magnetometer: uncertainty", unit="ms", low=0.0, high=100.0, step=1.0,
        tip="One standard deviation; the rest of the delay is learnt. 0 learns none.",
    )  # fmt: skip
    bounded: bool = editable(
        True, "Stays within arm's reach",
        tip="Position stays bounded, as in a hand or on a body. Off in a vehicle: only its speed is.",
    )  # fmt: skip
    position_noise: float = editable(
        0.37, "Reach", unit="m√s", low=0.01, high=10.0, step=0.05,
        tip="How loosely the position is held: 0.37 is 1.7 m in each 50 ms. Small trusts the accelerometer more.",
    )  # fmt: skip
    velocity_noise: float = editable(
        10.0, "Speed of a vehicle", unit="m/s √s", low=0.1, high=100.0, step=1.0,
        tip="How loosely the speed is held when the position is not.",
    )  # fmt: skip
    heading_noise_deg: float = editable(
        3.7, "Noise of the magnetic heading", unit="deg √s", low=0.1, high=100.0, step=0.5,
        tip="How loosely magnetic north is followed: 3.7 is 17 degrees in each 50 ms.",
    )  # fmt: skip
    field_norm: float = editable(
        0.1, "Field: departure of the norm", low=0.001, high=1.0, step=0.01, tip="Relative; disturbed above it."
    )
    field_dip_deg: float = editable(
        6.0, "Field: departure of the dip", unit="deg", low=0.1, high=90.0, step=0.5, tip="Disturbed above it."
    )
    field_tau: float = editable(
        150.0, "Field: time constant of the reference", unit="s", low=1.0, high=10000.0, step=10.0,
        tip="How slowly norm and dip of the undisturbed field are followed.",
    )  # fmt: skip
    gyr_noise_dps: float = editable(
        0.003, "Gyroscope: noise", unit="deg/s/√Hz", low=0.0001, high=1.0, step=0.001, tip="White noise of the rate."
    )
    gyr_rate_noise: float = editable(
        0.0005, "Gyroscope: noise that grows with the rate", unit="√s", low=0.0, high=0.1, step=0.0001,
        tip="What a matrix cannot describe, as a share of the rate.",
    )  # fmt: skip
    gyr_full_scale_dps: float = editable(
        0.0, "Gyroscope: full scale", unit="deg/s", low=0.0, high=10000.0, step=250.0,
        tip="A reading beyond 99 % of it is clipped; 0 finds clipping by repeated extremes.",
    )  # fmt: skip
    bias_sigma_dps: float = editable(
        0.3, "Bias: first uncertainty", unit="deg/s", low=0.001, high=20.0, step=0.1, tip="One standard deviation."
    )
    bias_walk_dps: float = editable(
        0.003, "Bias: drift", unit="deg/s/√s", low=0.0, high=1.0, step=0.001, tip="Spread of the bias after 1 s."
    )
    matrix_sigma: float = editable(
        0.004, "Scale and misalignment: first uncertainty", low=0.0, high=0.2, step=0.001,
        tip="One standard deviation of each element; 0 learns none.",
    )  # fmt: skip
    matrix_worst: float = editable(
        0.02, "Scale and misalignment: at worst", low=0.0, high=0.2, step=0.001,
        tip="As one standard deviation. Without a magnetometer the uncertainty of the heading allows for it, "
        "until the elements have been learnt. Lower it for a calibrated gyroscope.",
    )  # fmt: skip
    acc_noise: float = editable(
        0.02, "Accelerometer: noise", unit="m/s2/√Hz", low=0.0001, high=10.0, step=0.01, tip="White noise of the force."
    )
    acc_bias_sigma: float = editable(
        0.05, "Accelerometer: uncertainty of the bias", unit="m/s2", low=0.0001, high=2.0, step=0.01,
        tip="One standard deviation.",
    )  # fmt: skip

"""The check after a magnetometer calibration: one full turn, watched against the gyroscope.

While the board turns, gyroscope and accelerometer alone carry its attitude. In the earth frame the field must then
stand still: its direction (heading), its dip and its strength. What moves is the error one would have in use.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from imugui.calibration.ellipsoid import Floats
from imugui.fusion.attitude import dip_and_norm
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import rotate
from imugui.samples import Rows

STILL_S = 1.0
STILL_GYR = np.radians(1.0)  # rad/s, standard deviation
STILL_ACC = 0.3  # m/s2, standard deviation
FULL_TURN = 2.0 * np.pi
LARGEST_CLOSING_DEG = 12.0  # the scale of an uncalibrated gyroscope alone may be 3 % of 360 degrees
LARGEST_DEVIATION_DEG = 4.0
LARGEST_DIP_SPREAD_DEG = 3.0
LARGEST_NORM_SPREAD = 0.04


@dataclass(frozen=True)
class CheckResult:
    """What a full turn showed: ``closing_deg`` is by how much the heading misses 360 degrees of the gyroscope,

    ``deviation_deg`` how far it strays on the way (rms); dip with its standard deviation; field, spread as a share.
    """

    closing_deg: float
    deviation_deg: float
    dip_deg: float
    dip_spread_deg: float
    field_ut: float
    field_spread: float

    @property
    def problems(self) -> tuple[str, ...]:
        """What is wrong, in words; empty when the calibration holds."""
        checks = (
            (
                abs(self.closing_deg) > LARGEST_CLOSING_DEG,
                f"the heading misses the full turn by {self.closing_deg:.0f}°",
            ),
            (self.deviation_deg > LARGEST_DEVIATION_DEG, f"the heading strays by {self.deviation_deg:.1f}° on the way"),
            (self.dip_spread_deg > LARGEST_DIP_SPREAD_DEG, f"the dip angle changes by {self.dip_spread_deg:.1f}°"),
            (self.field_spread > LARGEST_NORM_SPREAD, f"the field changes by {100 * self.field_spread:.1f} %"),
        )
        return tuple(said for wrong, said in checks if wrong)

    @property
    def sentence(self) -> str:
        """The outcome in one line."""
        if self.problems:
            return f"The check turn found a fault: {', '.join(self.problems)}."
        return (
            f"Checked by a full turn: the heading closes to {abs(self.closing_deg):.1f}° and strays by "
            f"{self.deviation_deg:.1f}°, the dip holds to {self.dip_spread_deg:.1f}°."
        )


class CheckTurn:
    """Waits for a second at rest, which gives the gyroscope's bias, and then watches one turn about the vertical."""

    def __init__(self, correction: Correction) -> None:
        self.correction = correction
        self.turned = 0.0  # rad, net
        self._waiting: list[Rows] = []
        self._pipeline: Pipeline | None = None
        self._last_mag: Floats = np.full(3, np.nan)
        self._last_t = np.nan
        self._seen: list[Floats] = []  # rows of turned (rad), field east, north, up (uT)

    @property
    def started(self) -> bool:
        """Whether the board has rested and may be turned."""
        return self._pipeline is not None

    @property
    def progress(self) -> float:
        """Share of the full turn, 0 to 1."""
        return min(abs(self.turned) / FULL_TURN, 1.0)

    @property
    def done(self) -> bool:
        """Whether a full turn has been seen."""
        return abs(self.turned) >= FULL_TURN and bool(self._seen)

    @property
    def sentence(self) -> str:
        """What to do now."""
        if not self.started:
            return "Now the check: lay the board flat and let go of it for a second."
        return "Turn the board slowly once around, lying flat, until it is back where it began."

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows (n,)."""
        if self.done or not len(rows):
            return
        if self._pipeline is None:
            self._wait(rows)
        else:
            self._watch(self._pipeline, rows)

    def _wait(self, rows: Rows) -> None:
        """Look for a still second; its mean rate is the bias."""
        self._waiting.append(rows)
        held = np.concatenate(self._waiting)
        held = held[held["t"] >= held["t"][-1] - STILL_S]
        self._waiting = [held]
        if held["t"][-1] - held["t"][0] < 0.8 * STILL_S or len(held) < 5:
            return
        if (held["gyr"].std(axis=0) < STILL_GYR).all() and (held["acc"].std(axis=0) < STILL_ACC).all():
            bias = tuple(held["gyr"].mean(axis=0).tolist())
            self._pipeline = Pipeline(correction=replace(self.correction, gyr_bias=bias), use_mag=False)
            self._watch(self._pipeline, held)

    def _watch(self, pipeline: Pipeline, rows: Rows) -> None:
        attitude = pipeline.step(rows)
        rates = rotate(attitude["quat"], attitude["gyr"])[:, 2]
        steps = np.diff(rows["t"], prepend=self._last_t if np.isfinite(self._last_t) else rows["t"][0])
        turned = self.turned + np.cumsum(np.nan_to_num(rates * np.clip(steps, 0.0, 1.0)))
        until = int(np.argmax(np.abs(turned) >= FULL_TURN)) + 1 if (np.abs(turned) >= FULL_TURN).any() else len(rows)
        raw = np.concatenate((self._last_mag[None], rows["mag"]))
        fresh = (raw[1:] != raw[:-1]).any(axis=1) & np.isfinite(raw[1:]).all(axis=1)
        fresh[until:] = False
        earth = rotate(attitude["quat"], attitude["mag"])
        self._seen.append(np.column_stack((turned, earth))[fresh])
        self.turned, self._last_t, self._last_mag = float(turned[until - 1]), float(rows["t"][-1]), raw[-1]

    def result(self) -> CheckResult | None:
        """The figures of the turn; None before it is complete or without a field."""
        seen = np.concatenate(self._seen) if self._seen else np.zeros((0, 4))
        if not self.done or len(seen) < 10:
            return None
        turned, field = seen[:, 0], seen[:, 1:]
        heading = np.degrees(np.unwrap(np.arctan2(field[:, 0], field[:, 1])))
        # the harmonics of a turn go along, or one period of them would tilt the slope
        waves = [wave(k * turned) for k in (1, 2) for wave in (np.sin, np.cos)]
        design = np.column_stack((turned, np.ones(len(turned)), *waves))
        slope, offset = np.linalg.lstsq(design, heading, rcond=None)[0][:2]
        dip, norm = dip_and_norm((1.0, 0.0, 0.0, 0.0), field)
        return CheckResult(
            closing_deg=float(slope * FULL_TURN),
            deviation_deg=float(np.std(heading - slope * turned - offset)),
            dip_deg=float(np.degrees(dip.mean())),
            dip_spread_deg=float(np.degrees(dip.std())),
            field_ut=float(norm.mean()),
            field_spread=float(norm.std() / norm.mean()),
        )

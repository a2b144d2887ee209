"""The guided search for the axes, and the magnetometer's calibration in the axes that were found."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from imugui.calibration.accelerometer import vector
from imugui.calibration.axes import MAPS, QUIET_FEWEST, TILT_SPREAD, AxesResult, mag_map, quiet_pairs
from imugui.calibration.ellipsoid import Ellipsoid, Floats
from imugui.calibration.gate import Verdict, judge
from imugui.calibration.magnetometer import MagnetometerFlow
from imugui.fusion.correction import Correction
from imugui.samples import Rows

ENOUGH = 3 * QUIET_FEWEST
"""Quiet measurements before a verdict."""
MOST = 6000
"""Newest measurements kept."""
FITTED, REFIT = 600, 40
"""Measurements in a fit, and new ones between two fits."""
LARGEST_ERROR_DEG = 5.0
"""A rough fit tells maps apart that are 90 degrees from each other."""


@dataclass(frozen=True, eq=False)
class FoundAxes:
    """The map, and the fit of the field under which it was found."""

    axes: AxesResult
    verdict: Verdict

    @property
    def accepted(self) -> bool:
        """Whether one map stands out."""
        return self.axes.accepted

    @property
    def reason(self) -> str:
        """The map, or why there is none, in words."""
        return self.axes.reason


class AxesFlow:
    """Axes: slow turns to all sides; the right map is the one under which the dip stays the same."""

    title = "Axes"

    def __init__(self, before: Correction | None = None) -> None:
        """``before``: the correction in force, of which the accelerometer's part is used."""
        self._before = before or Correction()
        self._last: Floats = np.full(3, np.nan)
        self._seen: Floats = np.zeros((0, 6))  # acceleration (m/s2) calibrated, field (uT) raw
        self._new = 0
        self._quiet = 0
        self._tilt = 0.0
        self._verdict = judge(self._seen[:, 3:])
        self._axes = mag_map(self._seen[:, :3], self._seen[:, 3:])

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        raw = np.concatenate((self._last[None], rows["mag"]))
        fresh = (raw[1:] != raw[:-1]).any(axis=1) & np.isfinite(raw[1:]).all(axis=1)
        fresh &= np.isfinite(rows["acc"]).all(axis=1)
        self._last = raw[-1]
        acc = (rows["acc"][fresh] - self._before.acc_bias) @ np.transpose(self._before.acc_matrix)
        self._seen = np.concatenate((self._seen, np.column_stack((acc, rows["mag"][fresh]))))[-MOST:]
        self._new += int(fresh.sum())
        if self._new >= REFIT:
            self._new = 0
            self._refit()

    def _refit(self) -> None:
        acc, mag = self._seen[:, :3], self._seen[:, 3:]
        self._verdict = judge(mag[:: max(1, len(mag) // FITTED)])
        if self._fit is None:
            return
        up, _ = quiet_pairs(acc, self._fit.apply(mag))
        self._quiet = len(up)
        self._tilt = float(np.linalg.eigvalsh(up.T @ up / len(up))[0]) if len(up) else 0.0
        self._axes = mag_map(acc, self._fit.apply(mag))

    @property
    def _fit(self) -> Ellipsoid | None:
        return self._verdict.fit if self._verdict.error_deg <= LARGEST_ERROR_DEG else None

    def result(self) -> FoundAxes:
        """The map with its margin, or why there is none."""
        return FoundAxes(self._axes, self._verdict)

    @property
    def progress(self) -> float:
        """Share of the directions, the quiet measurements and the tilting that are needed."""
        if self._fit is None:
            return 0.5 * self._verdict.coverage
        return min(1.0, 0.5 + 0.5 * min(self._quiet / ENOUGH, self._tilt / TILT_SPREAD))

    @property
    def missing(self) -> tuple[str, ...]:
        """What is still missing, in words."""
        if self._fit is None:
            return self._verdict.reasons
        tilt = "tilts to other sides" if self._tilt < TILT_SPREAD else ""
        quiet = f"{self._quiet} of {ENOUGH} quiet measurements" if self._quiet < ENOUGH else ""
        doubt = "" if tilt or quiet or self._axes.accepted else self._axes.reason
        return tuple(words for words in (tilt, quiet, doubt) if words)

    @property
    def sentence(self) -> str:
        """What to do now."""
        return (
            "Done: the axes are known." if self.done else "Turn the board slowly to all sides, and stop now and then."
        )

    @property
    def done(self) -> bool:
        """Whether one map stands out."""
        return self._fit is not None and not self.missing


class MappedMagnetometerFlow(MagnetometerFlow):
    """The magnetometer's flow on a field that is brought into the accelerometer's axes first."""

    def __init__(self, axes: str = "", before: Correction | None = None) -> None:
        """``axes``: a key of MAPS, or empty; ``before``: the correction in force, for the field as it comes."""
        self._map = MAPS.get(axes, np.eye(3))
        before = before or Correction()
        bias, matrix = self._map @ before.mag_bias, np.array(before.mag_matrix) @ self._map.T
        first, second, third = (vector(row) for row in matrix)
        super().__init__(before=replace(before, mag_bias=vector(bias), mag_matrix=(first, second, third)))

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,)."""
        mapped = rows.copy()
        mapped["mag"] = rows["mag"] @ self._map.T
        super().feed(mapped)

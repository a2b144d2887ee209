"""The running alarm: does the field still have the strength and the dip that the calibration found?

A mean over one second is judged, so that a knock passes and a magnet does not: yellow above 4 % of the field's
strength, red above 6 %. A departure of ten times that turns red within a tenth of a second.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from imugui.calibration.ellipsoid import Floats
from imugui.fusion.attitude import dip_and_norm
from imugui.samples import Rows

WINDOW_S = 1.0
YELLOW_NORM, RED_NORM = 0.04, 0.06  # share of the calibrated field
YELLOW_DIP_DEG, RED_DIP_DEG = 5.0, 10.0
CERTAIN_COUNT = 3  # measurements in the window before it is judged
WORDS = {
    "off": "no field yet",
    "green": "the field is as calibrated",
    "yellow": "the field is a little off: headings may be wrong by a few degrees",
    "red": "the field is not the one of the calibration: go away from iron and magnets, or calibrate again",
}


class FieldAlarm:
    """Follows a corrected field; ``light`` is a key of WORDS. Red lasts until the mean is below the yellow limit."""

    def __init__(self, field_ut: float, dip_deg: float | None = None) -> None:
        """The field's strength after correction, and its dip when it is known; ValueError for no strength."""
        if not field_ut > 0.0:
            raise ValueError(f"the calibrated field must be above 0 µT, not {field_ut}")
        self.field_ut, self.dip_deg = field_ut, dip_deg
        self.light = "off"
        self.norm_off = np.nan  # mean departure of the strength over the window, share
        self.dip_off_deg = np.nan  # mean departure of the dip over the window
        self._window: deque[tuple[float, float, float]] = deque()
        self._last: Floats = np.full(3, np.nan)

    @property
    def sentence(self) -> str:
        """The state in words, with figures."""
        if self.light == "off":
            return WORDS[self.light]
        dip = f", dip {self.dip_off_deg:.0f}° off" if np.isfinite(self.dip_off_deg) else ""
        return f"{WORDS[self.light]} (strength {100 * self.norm_off:.0f} % off{dip})"

    def feed(self, rows: Rows) -> str:
        """Take ATTITUDE rows, whose ``mag`` is corrected; returns the light."""
        return self.update(rows["t"], rows["mag"], rows["quat"])

    def update(self, t: Floats, mag: Floats, quat: Floats | None = None) -> str:
        """Take times (n,) in s, corrected fields (n, 3) in uT and, for the dip, attitudes (n, 4); returns the light."""
        seen = np.concatenate((self._last[None], mag))
        fresh = (seen[1:] != seen[:-1]).any(axis=1) & np.isfinite(mag).all(axis=1) & np.isfinite(t)
        self._last = seen[-1]
        norm_off = np.abs(np.linalg.norm(mag[fresh], axis=1) / self.field_ut - 1.0)
        dip_off = self._dip_off(mag[fresh], None if quat is None else quat[fresh])
        for now, norm, dip in zip(t[fresh].tolist(), norm_off.tolist(), dip_off.tolist(), strict=True):
            self._take(now, norm, dip)
        return self.light

    def _dip_off(self, mag: Floats, quat: Floats | None) -> Floats:
        if quat is None or self.dip_deg is None:
            return np.full(len(mag), np.nan)
        return np.asarray(np.abs(np.degrees(dip_and_norm(quat, mag)[0]) - self.dip_deg))

    def _take(self, now: float, norm_off: float, dip_off_deg: float) -> None:
        if self._window and now < self._window[-1][0]:
            self._window.clear()  # the stream began again
        self._window.append((now, norm_off, dip_off_deg))
        while self._window[0][0] < now - WINDOW_S:
            self._window.popleft()
        if len(self._window) < CERTAIN_COUNT:
            return
        _, self.norm_off, self.dip_off_deg = np.mean(self._window, axis=0).tolist()
        norm_high = self.norm_off > YELLOW_NORM
        dip_high = self.dip_off_deg > YELLOW_DIP_DEG  # False for NaN
        if self.norm_off > RED_NORM or self.dip_off_deg > RED_DIP_DEG:
            self.light = "red"
        elif not (norm_high or dip_high):
            self.light = "green"
        elif self.light != "red":
            self.light = "yellow"

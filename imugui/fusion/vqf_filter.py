"""VQF, the most accurate of the filters: the ``vqf`` library's C++ code behind our ``update``."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot
from typing import Any, ClassVar

import numpy as np
from vqf import VQF

from imugui.fusion.attitude import from_acc_mag
from imugui.fusion.quaternion import normalise
from imugui.fusion.scalar import (
    FREE_FALL,
    HELD,
    LARGEST,
    NO_FIELD,
    NOTHING,
    Quat,
    Vector,
    bounded,
    direction,
    sane,
    turned_in_sensor,
)
from imugui.fusion.stretches import Said
from imugui.fusion.vqf_block import EVEN, MOST, Flags, Floats, follow, plain
from imugui.fusion.vqf_params import VqfParams, library_arguments
from imugui.fusion.vqf_spacing import Spacing, carried_over

SHORTEST_TS = 1e-6  # s


class Vqf:
    """D. Laidig and T. Seel, VQF, Information Fusion 91, 2023, doi:10.1016/j.inffus.2022.10.014.

    The library fixes its sampling time when it is built; our samples bring their own dt. Two things bridge that:

    - Small variations. The one place where dt itself matters is the integral of the rate, so each sample is fed with
      the rate ``bias + (gyr - bias) * dt/Ts``, which the library turns into exactly ``(gyr - bias) * dt``. At rest,
      where gyr is about the bias, the fed rate hardly differs, so rest detection does not see the jitter. The
      low-passes and gains count samples and are right in the mean.
    - Lasting departures. The mean spacing is measured over windows that grow to a second; when it departs from Ts by
      more than 6 % the library is built anew for the new spacing, with its state carried over. The same is done for
      the spacing of new magnetometer values, which many boards send far less often.

    The first sample is held until the second tells the spacing; the attitude is out at once. The library is placed at
    the tilt of that sample, with yaw 0, and the first field sets the heading. Left at the identity, as it begins by
    itself, it would take the first tilt for a rotation and put a part of it into the bias. From this start on, with a
    constant dt and a field in every sample, the results are the library's own (within 1e-9).

    ``disturbed`` is the library's word once it has a reference, which takes 5 s of turning; before, it cannot know.
    """

    title: ClassVar[str] = "VQF"
    Params: ClassVar[type[VqfParams]] = VqfParams
    PRESETS: ClassVar[dict[str, VqfParams]] = {
        "Default": VqfParams(),
        "Uncalibrated gyroscope": VqfParams(bias_clip_dps=10.0, bias_sigma_init_dps=5.0),
        "Trust the magnetometer": VqfParams(tau_mag=3.0, mag_dist_rejection_enabled=False),
    }

    def __init__(self, params: VqfParams | None = None) -> None:
        self.params = params if params is not None else VqfParams()
        self.quat: Quat = (1.0, 0.0, 0.0, 0.0)
        self.bias: Vector = NOTHING
        self.rest = False
        self.disturbed = False
        self._library: Any = None  # built when the spacing of the samples is known
        self._ts = self._mag_ts = 0.0
        self._spacing, self._mag_spacing = Spacing(), Spacing()
        self._mag_age = 0.0  # s since the last field
        self._fields = 0  # seen since the start
        # until the library is built: where to begin and whether that heading is known, or the first sample
        self._start: tuple[Quat, bool] | None = None
        self._first: list[Any] | None = None
        self._gyr, self._acc, self._mag = np.zeros(3), np.zeros(3), np.zeros(3)

    def update(self, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, dt: float) -> None:
        """Take one sample: see ``Filter.update``."""
        dt = bounded(dt)
        gyr, acc = sane(gyr), sane(acc)
        if mag is not None and not NO_FIELD < hypot(*mag) < LARGEST:
            mag = None
        if self._library is None and not self._begin(gyr, acc, mag, dt):
            return
        self._follow_spacing(dt, mag is not None)
        self._feed(gyr, acc, mag, dt / self._ts)

    def _feed(self, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, scale: float) -> None:
        library, g, a = self._library, self._gyr, self._acc
        bx, by, bz = self.bias
        if abs(scale - 1.0) < EVEN:
            g[0], g[1], g[2] = gyr
        else:
            g[0], g[1], g[2] = bx + (gyr[0] - bx) * scale, by + (gyr[1] - by) * scale, bz + (gyr[2] - bz) * scale
        a[0], a[1], a[2] = acc
        if mag is None:
            library.update(g, a)
        else:
            m = self._mag
            m[0], m[1], m[2] = mag
            library.update(g, a, m)
            self.disturbed = library.getMagDistDetected() and library.getMagRefNorm() > 0.0
        w, x, y, z = library.getQuat9D().tolist()
        self.quat = (w, x, y, z)
        bx, by, bz = library.getBiasEstimate()[0].tolist()
        self.bias = (bx, by, bz)
        self.rest = library.getRestDetected()

    def update_block(self, gyr: Floats, acc: Floats, mag: Floats, new: Flags, dts: Floats) -> Said | tuple[()]:
        """Take as many of the first samples, arrays (n, 3) and (n,), as the library can at once: () for none.

        What ``update`` would say after each comes back, the same to the last digit.
        """
        if self._library is None or self._fields == 1:
            return ()
        n = plain(gyr, acc, mag, new, dts[:MOST] / self._ts)
        dts, new = dts[:n], new[:n]
        spacings = self._spacing, self._mag_spacing
        first_field = self._fields == 0 and bool(new.any())
        after = follow(*spacings, self._ts, self._mag_ts, self._mag_age, dts, new) if n and not first_field else None
        if after is None:
            return ()
        self._spacing.restore(after[0])
        self._mag_spacing.restore(after[1])
        self._mag_age, self._fields = after[2], self._fields + int(new.sum())
        return self._feed_block(np.ascontiguousarray(gyr[:n]), np.ascontiguousarray(acc[:n]), mag[:n], new)

    def _feed_block(self, gyr: Floats, acc: Floats, mag: Floats, new: Flags) -> Said:
        library, before = self._library, self.disturbed
        known = library.getMagRefNorm() > 0.0
        out = library.updateBatch(gyr, acc, np.where(new[:, None], mag, 0.0))  # it passes over fields of zeros
        found = out["magDistDetected"]
        # as long as it has no reference it says disturbed, and is not believed
        disturbed = found & (known | np.logical_or.accumulate(~found))
        if not new.all():
            disturbed = np.where(np.logical_or.accumulate(new), disturbed, before)
        rest = out["restDetected"]
        self.quat, (bx, by, bz) = _quat(out["quat9D"][-1]), out["bias"][-1].tolist()
        self.bias, self.rest, self.disturbed = (bx, by, bz), bool(rest[-1]), bool(disturbed[-1])
        unknown = np.full(len(rest), np.nan)
        return out["quat9D"], out["bias"], rest, disturbed, unknown, unknown

    def _follow_spacing(self, dt: float, new_field: bool) -> None:
        """Build the library anew when samples or fields have come at another spacing for a while."""
        ts, mag_ts = self._spacing.departed(dt, self._ts), None
        self._mag_age += dt
        if new_field:
            if self._fields > 0:
                mag_ts = self._mag_spacing.departed(bounded(self._mag_age), self._mag_ts)
            if self._fields == 1 and self._mag_age > HELD * dt:
                self._forget_first_field()
            self._mag_age, self._fields = 0.0, self._fields + 1
        if ts is not None or mag_ts is not None:
            state, coefficients = self._library.state, self._library.coeffs
            self._build(ts or self._ts, mag_ts or self._mag_ts)
            self._library.state = carried_over(state, coefficients, self._library.coeffs)

    def _forget_first_field(self) -> None:
        """The board holds its field and may have taken the first a while ago, turned otherwise: the second counts."""
        state = self._library.state
        if state["kMagInit"] > 0.0:
            self._library.state = {**state, "kMagInit": 1.0}

    def _build(self, ts: float, mag_ts: float) -> None:
        self._ts, self._mag_ts = max(ts, SHORTEST_TS), max(mag_ts, SHORTEST_TS)
        self._library = VQF(self._ts, self._ts, self._mag_ts, **library_arguments(self.params))

    def _begin(self, gyr: Sequence[float], acc: Sequence[float], mag: Sequence[float] | None, dt: float) -> bool:
        """Hold the first sample, build at the next; False while there is nothing to feed."""
        if self._first is None and self._start is None:
            if direction(acc, FREE_FALL) is not None:
                self._first = [list(gyr), list(acc), None if mag is None else list(mag)]
                self.quat = _quat(from_acc_mag(acc, mag))
            return False
        if dt == 0.0:
            return False
        self._build(dt, dt)
        if self._start is not None:
            self._place(*self._start)
        elif self._first is not None:
            first_gyr, first_acc, first_mag = self._first
            # the library integrates the first rate before it looks at gravity: begin that much earlier
            x, y, z = (-self._ts * rate for rate in first_gyr)
            self._place(turned_in_sensor(_quat(from_acc_mag(first_acc)), x, y, z), False)
            self._feed(first_gyr, first_acc, first_mag, 1.0)
            self._fields = 0 if first_mag is None else 1
        self._first = self._start = None
        return True

    def _place(self, quat: Quat, heading_known: bool) -> None:
        """Put the library at an attitude, keeping what it knows of bias and field."""
        kept = {name: value for name, value in self._library.state.items() if name.startswith(("bias", "mag"))}
        self._library.resetState()
        begin = {"gyrQuat": list(quat), "kMagInit": 0.0 if heading_known else 1.0}
        self._library.state = {**self._library.state, **kept, **begin}

    def start(self, quat: Sequence[float], heading_known: bool = True) -> None:
        """Begin again at an attitude: see ``Filter.start``."""
        self.quat = _quat(normalise(quat))
        self.rest = False
        self._first, self._fields = None, 0
        if self._library is None:
            self._start = (self.quat, heading_known)
        else:
            self._place(self.quat, heading_known)

    def state(self) -> dict[str, Any]:
        """Everything that the next update depends on."""
        library = self._library
        return {
            "quat": list(self.quat),
            "bias": list(self.bias),
            "rest": self.rest,
            "disturbed": self.disturbed,
            "ts": self._ts,
            "mag_ts": self._mag_ts,
            "spacing": self._spacing.state(),
            "mag_spacing": self._mag_spacing.state(),
            "mag_age": self._mag_age,
            "fields": self._fields,
            "start": None if self._start is None else [list(self._start[0]), self._start[1]],
            "first": self._first,
            "library": None if library is None else {"state": library.state, "coeffs": library.coeffs},
        }

    def restore(self, state: dict[str, Any]) -> None:
        """Continue from a state of the same class; other parameters take over without a jump."""
        bx, by, bz = state["bias"]
        self.quat, self.bias, self.rest, self.disturbed = (
            _quat(np.array(state["quat"])), (bx, by, bz), state["rest"], state["disturbed"],
        )  # fmt: skip
        self._spacing.restore(state["spacing"])
        self._mag_spacing.restore(state["mag_spacing"])
        self._mag_age, self._fields, self._first = state["mag_age"], state["fields"], state["first"]
        self._start = None if state["start"] is None else (_quat(np.array(state["start"][0])), state["start"][1])
        self._library = None
        if state["library"] is not None:
            self._build(state["ts"], state["mag_ts"])
            self._library.state = carried_over(
                state["library"]["state"], state["library"]["coeffs"], self._library.coeffs
            )


def _quat(array: np.ndarray[Any, np.dtype[np.float64]]) -> Quat:
    w, x, y, z = array.tolist()
    return w, x, y, z

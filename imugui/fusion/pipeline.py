"""Pipeline: SAMPLE rows in, ATTITUDE rows out. One object with correction, filter and origin, swapped whole."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.fusion.attitude import from_acc_mag, from_euler, heading_deg
from imugui.fusion.correction import Correction
from imugui.fusion.filter import Filter
from imugui.fusion.quaternion import conjugate, length, multiply, normalise
from imugui.fusion.scalar import FREE_FALL, Quat, direction
from imugui.fusion.spike_mask import SpikeMask
from imugui.fusion.stretches import SAID, run
from imugui.samples import ATTITUDE, Rows, empty_rows

PIECE = 4000  # rows
LARGEST_RATE = 1e3  # rad/s; no gyroscope reads more
LARGEST_FORCE = 1e4  # m/s2
LARGEST_FIELD = 1e6  # uT, to square without overflow
EARTH_FIELD = (20.0, 70.0)  # uT; the earth's is between 22 and 67, any other field is not the earth's alone
FED_FIELD = (5.0, 200.0)  # uT; outside this a field says nothing about north

Flags = NDArray[np.bool_]


class Pipeline:
    """Feeds every sample to the filter once, in order, with its own dt. The result does not depend on the blocks.

    - ``dt`` comes from ``rows["t"]``. A time that stands still or goes back a little integrates nothing: the sample
      still corrects the attitude, and integration goes on from the new time. A step of more than a second either way
      is a gap: the filter restarts from the accelerometer, keeping its bias and, until the next field, its heading.
    - A magnetometer triple that repeats the one before it is held by the board and not a new measurement.
    - A row without a usable time, rate or force is not fed; the attitude is held and the next dt bridges it.
    - With ``spike_mask`` force and field are not fed while the board's button moves, and the force shown is held; the
      gyroscope goes on turning the attitude.
    """

    def __init__(
        self,
        filter_name: str = DEFAULT_FILTER,
        params: Any = None,
        correction: Correction | None = None,
        use_mag: bool = True,
        origin: Sequence[float] | None = None,
        spike_mask: bool = False,
    ) -> None:
        self.filter_name = filter_name
        self.filter: Filter = FILTERS[filter_name](params)
        self.correction = correction if correction is not None else Correction()
        self.use_mag = use_mag
        self.spike_mask = spike_mask
        self.origin: Quat | None = None
        self.set_origin(origin)
        self.mag_updates = 0  # new field measurements fed to the filter
        self.mag_refused = 0  # new field measurements not fed, because no field on earth is that weak or strong
        self.skipped = 0  # rows not fed, because they lack a usable time, rate or force
        self.restarts = 0  # restarts of the filter after gaps
        self._t = np.nan  # of the last row fed
        self._raw_mag: NDArray[np.float64] = np.full(3, np.nan)  # of the last row fed
        self._strange = False  # the last field seen was not the earth's
        self._mask = SpikeMask()

    @property
    def params(self) -> Any:
        """The filter's parameters, an instance of its ``Params``."""
        return self.filter.params

    def set_origin(self, quat: Sequence[float] | None) -> None:
        """Make ``quat`` (sensor -> earth) the zero of the shown attitude, or clear it; safe from another thread."""
        if quat is None:
            self.origin = None
        else:
            w, x, y, z = normalise(quat).tolist()
            self.origin = (w, x, y, z)

    def refer_heading(self) -> None:
        """Call the heading right by definition from now on, where the filter runs without field and can count from it.

        See ``Imugui.refer_heading``; the other filters state no uncertainty that could begin anew.
        """
        refer = getattr(self.filter, "refer_heading", None)
        if refer is not None:
            refer(not self.use_mag)

    def continue_from(self, other: Pipeline) -> None:
        """Go on where ``other`` is: its attitude, its origin, its place in the stream and its counts.

        With the same filter and correction all that the filter has learnt goes along, whatever the parameters.
        """
        self.origin = other.origin
        self.mag_updates, self.mag_refused = other.mag_updates, other.mag_refused
        self.skipped, self.restarts = other.skipped, other.restarts
        self._t, self._raw_mag, self._strange = other._t, other._raw_mag, other._strange
        self._mask.restore(other._mask.state())
        if self.filter_name == other.filter_name and self.correction == other.correction:
            self.filter.restore(other.filter.state())
        elif not np.isnan(other._t):
            self.filter.start(other.filter.quat, heading_known=other.use_mag and other.mag_updates > 0)

    @np.errstate(over="ignore", invalid="ignore")  # what a wild number gives is refused below
    def restart(self) -> None:
        """Begin again from the next sample's accelerometer and field: what comes does not follow what was."""
        self.filter = FILTERS[self.filter_name](self.params)
        self._t, self._raw_mag, self._strange = np.nan, np.full(3, np.nan), False
        self._mask = SpikeMask()
        self.restarts += 1

    def settings(self) -> dict[str, Any]:
        """All that was chosen, as plain values: filter, parameters, correction, magnetometer, origin, spike mask."""
        return {
            "filter": self.filter_name,
            "params": asdict(self.params),
            "correction": asdict(self.correction),
            "use_mag": self.use_mag,
            "origin": self.origin,
            "spike_mask": self.spike_mask,
        }

    def state(self) -> dict[str, Any]:
        """All that the next step depends on, as plain values; ``from_state`` continues from it bit for bit."""
        kept = {"t": float(self._t), "raw_mag": self._raw_mag.tolist(), "strange": self._strange}
        kept["mask"] = self._mask.state()
        return {"settings": self.settings(), "state": self.filter.state(), **kept}

    @classmethod
    def from_settings(cls, settings: dict[str, Any]) -> Pipeline:
        """A fresh pipeline with these settings; KeyError, TypeError or ValueError when they are none."""
        params = FILTERS[settings["filter"]].Params(**settings["params"])
        correction = Correction(**settings["correction"])
        pipeline = cls(settings["filter"], params, correction, bool(settings["use_mag"]))
        pipeline.spike_mask = bool(settings.get("spike_mask", False))  # older recordings know of none
        if settings["origin"] is not None:
            w, x, y, z = map(float, settings["origin"])  # not normalised again, which would change the last digit
            pipeline.origin = (w, x, y, z)
        return pipeline

    @classmethod
    def from_state(cls, state: dict[str, Any]) -> Pipeline:
        """A pipeline that continues from a ``state``; KeyError, TypeError or ValueError when it is none."""
        pipeline = cls.from_settings(state["settings"])
        pipeline.filter.restore(state["state"])
        pipeline._t = np.float64(state["t"])
        pipeline._raw_mag = np.array(state["raw_mag"], float).reshape(3)
        pipeline._strange = bool(state["strange"])
        if "mask" in state:
            pipeline._mask.restore(state["mask"])
        return pipeline

    def step(self, rows: Rows) -> Rows:
        """Feed a block of SAMPLE rows, shape (n,); returns n ATTITUDE rows, ``t_publish`` left open (NaN)."""
        corrected = self.correction.apply(rows)
        out = empty_rows(ATTITUDE, len(rows))
        for name in ("t", "t_arrival", "acc", "mag", "status"):
            out[name] = corrected[name]
        if len(rows) == 0:
            return out
        good = _usable(corrected)
        self.skipped += len(rows) - int(good.sum())
        norm = length(np.clip(corrected["mag"], -LARGEST_FIELD, LARGEST_FIELD))
        fresh, fed = self._fields(rows["mag"], norm, good)
        self.mag_refused += int((fresh & ~fed).sum()) if self.use_mag else 0
        self._mask_spikes(rows, good, out)
        out["mag_used"] = fed & ~out["masked"] & self.use_mag
        self.mag_updates += int(out["mag_used"].sum())
        self._fuse(corrected, good, out)
        out["disturbed"] |= self._not_earths(norm)
        out["gyr"] = corrected["gyr"] - out["bias"]
        origin = self.origin
        out["local"] = out["quat"] if origin is None else multiply(conjugate(origin), out["quat"])
        return out

    def steps(self, rows: Rows) -> Iterator[Rows]:
        """The same for many SAMPLE rows, piece by piece: what fits in the processor's cache is worked on sooner."""
        for start in range(0, len(rows), PIECE):
            yield self.step(rows[start : start + PIECE])

    def _fields(self, raw: NDArray[np.float64], norm: NDArray[np.float64], good: Flags) -> tuple[Flags, Flags]:
        """Which rows carry a new field measurement, and which of these (norms in uT) are fed."""
        seen = np.concatenate((self._raw_mag[None], raw[good]))
        fresh = good.copy()
        # compared with the last row fed: what came new in a skipped row is still new in the next
        fresh[good] = (seen[1:] != seen[:-1]).any(axis=1) & np.isfinite(seen[1:]).all(axis=1)
        self._raw_mag = seen[-1]
        return fresh, fresh & (norm >= FED_FIELD[0]) & (norm <= FED_FIELD[1])

    def _not_earths(self, norm: NDArray[np.float64]) -> Flags:
        """Where the newest field seen so far, norms in uT of shape (n,), is outside what the earth's can be."""
        known = np.isfinite(norm)
        strange = np.concatenate(([self._strange], known & ~((norm >= EARTH_FIELD[0]) & (norm <= EARTH_FIELD[1]))))
        newest = np.maximum.accumulate(np.concatenate(([0], np.where(known, np.arange(1, len(norm) + 1), 0))))
        held = strange[newest]
        self._strange = bool(held[-1])
        return np.asarray(held[1:])

    def _mask_spikes(self, rows: Rows, good: Flags, out: Rows) -> None:
        """Say where the button moves, and show the force before it there."""
        if self.spike_mask:
            chosen = rows[good]
            out["masked"][good], out["acc"][good] = self._mask.step(chosen["t"], chosen["status"], out["acc"][good])

    def _fuse(self, rows: Rows, good: Flags, out: Rows) -> None:
        """Run the filter over the good rows and write what it says; the other rows hold what was said before."""
        chosen = rows[good]
        dts = np.diff(chosen["t"], prepend=self._t)
        acc = np.where(out["masked"][good, None], 0.0, chosen["acc"]) if self.spike_mask else chosen["acc"]
        samples = chosen["gyr"], acc, chosen["mag"], out["mag_used"][good], dts
        said = run(self.filter, *samples, self._restart)
        shown = np.cumsum(good)
        for name, values in zip(SAID, said, strict=True):
            out[name] = values[shown]
        if len(chosen):
            self._t = chosen["t"][-1]

    def _restart(self, acc: list[float], dt: float) -> float:
        """Begin again from the accelerometer with the heading there was; returns the dt to feed, 0."""
        if dt == dt and direction(acc, FREE_FALL) is not None:
            self.restarts += 1
            yaw = np.radians(90.0 - heading_deg(self.filter.quat))
            quat = multiply(from_euler(yaw, 0.0, 0.0), from_acc_mag(acc))
            self.filter.start(quat.tolist(), heading_known=False)
        return 0.0


def _usable(rows: Rows) -> Flags:
    """Rows with a finite time and with a rate and a force that a sensor can give; comparisons with NaN are False."""
    within = (np.abs(rows["gyr"]) < LARGEST_RATE) & (np.abs(rows["acc"]) < LARGEST_FORCE)
    return np.asarray(within.all(axis=1) & np.isfinite(rows["t"]))

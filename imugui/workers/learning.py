"""What the own filter learns of the connected board's gyroscope, looked at once a second."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from imugui.calibration.learnt import Clipping, Learnt, refusal
from imugui.calibration.profile import Profile
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.samples import Rows
from imugui.workers.fusion_worker import FusionWorker

LOOK_EVERY_S = 1.0


def learns(pipeline: Pipeline) -> bool:
    """Does this pipeline's filter learn anything of the gyroscope?"""
    return hasattr(type(pipeline.filter), "matrix_sigma")


class Learning:
    """Told of rows and time by the session, in the main thread.

    The filter's numbers are taken by the fusion thread, between two samples, and handed over as one object that nobody
    changes: they belong together, and to the correction that is in it.
    """

    def __init__(self, fusion: FusionWorker) -> None:
        self._fusion = fusion
        self._seen: Learnt | None = None
        self._asked = False
        self._raw = fusion.samples.count
        self._clipping = Clipping()
        self._key: tuple[Correction, int] | None = None
        self._looked = -math.inf
        self._begin(None)

    def watch(self, rows: Rows, now: float) -> None:
        """Take new ATTITUDE rows, shape (n,), at host time ``now``, s."""
        pipeline = self._fusion.pipeline
        key = (pipeline.correction, self._fusion.epoch) if learns(pipeline) else None
        raw, self._raw, _ = self._fusion.samples.since(self._raw)
        if key != self._key:
            self._begin(key)
        if key is None:
            return
        self._clipping.feed(raw)
        self._count(rows)
        if not self._asked and now - self._looked >= LOOK_EVERY_S:
            self._asked, self._looked = True, now
            self._fusion.look(self._see)

    def learnt(self, profile: Profile, factory: bool) -> Learnt | None:
        """What is known now, and whether it can be kept in that profile; None when nothing is learnt."""
        seen = self._seen
        if seen is None or self._key is None or seen.correction != self._key[0]:
            return None
        learnt = replace(
            seen,
            seconds=self._seconds,
            rest_s=self._rest_s,
            samples=self._samples,
            clipped=self._clipping.seen,
            temp_c=self._temp_c,
        )
        return replace(learnt, refusal=refusal(learnt, profile, factory))

    def _begin(self, key: tuple[Correction, int] | None) -> None:
        """Another correction, or the attitude began anew: learning begins."""
        self._key, self._clipping = key, Clipping()
        self._raw = self._fusion.samples.count
        self._seen, self._looked = None, -math.inf
        self._seconds = self._rest_s = 0.0
        self._samples, self._t, self._temp_c = 0, math.nan, math.nan

    def _count(self, rows: Rows) -> None:
        """Add up the time that was learnt from."""
        if len(rows) == 0:
            return
        if self._seen is not None and self._seen.note:
            self._seconds, self._rest_s, self._samples = 0.0, 0.0, 0
        dt = np.diff(rows["t"], prepend=self._t)
        dt[~((dt > 0.0) & (dt < 1.0))] = 0.0
        self._t = float(rows["t"][-1])
        self._seconds += float(dt.sum())
        self._rest_s += float(dt[rows["rest"]].sum())
        self._samples += len(rows)
        newest = self._fusion.samples.last(1)
        if len(newest) and math.isfinite(newest["temp_c"][0]):
            self._temp_c = float(newest["temp_c"][0])

    def _see(self, pipeline: Pipeline) -> None:
        """In the fusion thread: what the filter knows."""
        if learns(pipeline):
            known: Any = pipeline.filter
            first, second, third = (tuple(row) for row in known.matrix.tolist())
            self._seen = Learnt(
                pipeline.correction,
                (first, second, third),
                known.bias,
                known.matrix_sigma,
                known.first_sigma,
                known.bias_sigma,
                known.note,
            )
        self._asked = False

"""The relative thread: at a fixed cadence, every attitude of the tool into the reference board's frame."""

from __future__ import annotations

import math
import time

import numpy as np

from imugui.fusion.quaternion import Floats, conjugate, multiply
from imugui.fusion.relative import UNALIGNED, Alignment, Relative, align
from imugui.guidance.hold import HOLD_S
from imugui.guidance.stream import pushed
from imugui.guidance.turning import Turning
from imugui.ring import Ring
from imugui.samples import ATTITUDE, Rows
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.status import RelativeStatus
from imugui.workers.worker import Worker

TICK_S = 1.0 / 200.0
LOOK_ROWS = 512
FRESH_S = 0.5
"""Boards can be aligned while the newest relative attitude is younger than this."""

Epochs = tuple[int, int]


class RelativeWorker(Worker):
    """Pulls from the attitude rings of two boards, pushes to one of its own. Alignment is set by the main thread."""

    def __init__(self, tool: FusionWorker, reference: FusionWorker, rows: int) -> None:
        """``rows``: capacity of the ring."""
        super().__init__()
        self.attitude = Ring(ATTITUDE, rows)
        self.attitude.reserve()
        self._tool, self._reference = tool, reference
        self._relative = Relative()
        self._counts = tool.attitude.count, reference.attitude.count
        self._alignment = UNALIGNED
        self._aligned_at = math.nan
        self._aligned_in: Epochs | None = None  # epochs of both boards when they were aligned
        self._changes = 0
        self._turnings = Turning(), Turning()
        self._turnings_of: int | None = None  # number of the alignment that they count from

    @property
    def same_north(self) -> bool:
        """Both headings follow the magnetic field."""
        pipelines = self._tool.pipeline, self._reference.pipeline
        return all(pipeline.use_mag and pipeline.mag_updates > 0 for pipeline in pipelines)

    @property
    def aligned(self) -> bool:
        """The two headings can be compared."""
        return self.same_north or self._aligned_in == self._epochs

    @property
    def has_origin(self) -> bool:
        """Whether the shown attitude is relative to an origin."""
        return self._aligned_in is not None

    @property
    def aligned_at(self) -> float:
        """Host time in s from which the headings drift apart: infinite where they do not, NaN before an alignment."""
        return math.inf if self.same_north else self._aligned_at if self.aligned else math.nan

    @property
    def epoch(self) -> tuple[int, ...]:
        """Changes whenever the relative heading begins to mean something else."""
        return (*self._epochs, self._changes, self.same_north)

    @property
    def to_earth(self) -> Floats:
        """The rotation (4,) from the reference's frame to the tool's earth frame: h^-1 q_ref."""
        if self._relative.newest is None:
            return np.array((1.0, 0.0, 0.0, 0.0))
        return multiply(conjugate(self._heading().heading), self._relative.newest[0])

    @property
    def turnings(self) -> tuple[float, float]:
        """By how much tool and reference were turned since they were aligned: see guidance.turning, rad."""
        return self._turnings[0].size, self._turnings[1].size

    @property
    def shaken(self) -> bool:
        """One of the two is pushed or shaken, which pulls at its tilt."""
        return any(pushed(_recent(worker.attitude)) for worker in (self._tool, self._reference))

    def align(self) -> bool:
        """Make the newest attitude zero, and the headings equal; False when one of the boards is silent."""
        newest, rows = self._relative.newest, self.attitude.last(1)
        if newest is None or len(rows) == 0 or time.perf_counter() - float(rows["t_arrival"][0]) > FRESH_S:
            return False
        reference, tool = newest
        self._alignment = align(tool, reference, self.same_north)
        self._aligned_at, self._aligned_in = time.perf_counter(), self._epochs
        for worker in (self._tool, self._reference):
            worker.refer_heading()
        self._changes += 1
        return True

    def clear(self) -> None:
        """Forget the alignment."""
        self._alignment, self._aligned_at, self._aligned_in = UNALIGNED, math.nan, None
        self._changes += 1

    def status(self) -> RelativeStatus:
        """A snapshot."""
        now = time.perf_counter()
        return RelativeStatus(
            _age_ms(self._tool.attitude, now),
            _age_ms(self._reference.attitude, now),
            self.aligned,
            self.same_north,
            now - self._aligned_at,
            math.degrees(self._alignment.residual) if self.has_origin else math.nan,
        )

    def step(self) -> None:
        self.stopping.wait(TICK_S)
        self.drain()

    def drain(self) -> None:
        """Everything that is new, now."""
        tool, tool_count, _ = self._tool.attitude.since(self._counts[0])
        reference, reference_count, _ = self._reference.attitude.since(self._counts[1])
        self._counts = tool_count, reference_count
        self._turn(tool["quat"], reference["quat"])
        self._relative.alignment = self._heading()
        rows = self._relative.step(tool, reference)
        if len(rows):
            rows["t_publish"] = time.perf_counter()
            self.attitude.push(rows)

    def _turn(self, *quats: Floats) -> None:
        """Follow the turning of both boards, from an alignment anew."""
        anew, self._turnings_of = self._turnings_of != self._changes, self._changes
        for turning, block in zip(self._turnings, quats, strict=True):
            if anew:
                turning.reset()
            turning.step(block)

    @property
    def _epochs(self) -> Epochs:
        return self._tool.epoch, self._reference.epoch

    def _heading(self) -> Alignment:
        """The alignment as far as it holds: a heading that began anew since is another one."""
        kept = self._alignment
        return kept if self._aligned_in in (None, self._epochs) else Alignment(zero=kept.zero, residual=kept.residual)


def _recent(attitude: Ring) -> Rows:
    """The rows of the last HOLD_S, as far as LOOK_ROWS reach."""
    rows = attitude.last(LOOK_ROWS)
    return rows[rows["t"] >= rows["t"][-1] - HOLD_S] if len(rows) else rows


def _age_ms(attitude: Ring, now: float) -> float:
    """Of the newest attitude of a ring."""
    rows = attitude.last(1)
    return (now - float(rows["t_arrival"][0])) * 1e3 if len(rows) else math.nan

"""The fusion thread: as soon as samples arrive, at a bounded cadence, every one once through the pipeline."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np
from PySide6.QtCore import Signal

from imugui.fusion.pipeline import Pipeline
from imugui.recording.events import Event
from imugui.ring import Ring
from imugui.samples import ATTITUDE, Rows, empty_rows
from imugui.workers.changes import CHANGES, rehearse, start_of
from imugui.workers.recorder import Tap
from imugui.workers.worker import Worker

TICK_S = 1.0 / 200.0  # the slowest cadence, when nothing arrives
SHORTEST_TICK_S = 1.0 / 500.0  # the quickest: a block costs more than its rows
BIN_MS = 0.1
BINS = 20_000  # ages up to 2 s
NOW = -1
BACK = "The chosen filter is back."

Action = Callable[[int], None]


class AgeCounts:
    """A histogram of ages (arrival of the bytes to attitude published); quantiles in ms."""

    def __init__(self) -> None:
        self._counts = np.zeros(BINS, np.int64)

    def add(self, ages_s: np.ndarray) -> None:
        """Count ages in s, shape (n,); NaN is left out."""
        bins = np.clip(ages_s[np.isfinite(ages_s)] * (1e3 / BIN_MS), 0, BINS - 1).astype(np.int64)
        np.add.at(self._counts, bins, 1)

    def quantiles(self) -> dict[str, float]:
        """{"p50", "p95", "p99"} in ms, each the upper edge of its bin; empty when nothing was counted."""
        total = np.cumsum(self._counts)
        if total[-1] == 0:
            return {}
        edges = {key: int(np.searchsorted(total, share * total[-1])) for key, share in _SHARES.items()}
        return {key: round((edge + 1) * BIN_MS, 1) for key, edge in edges.items()}


_SHARES = {"p50": 0.50, "p95": 0.95, "p99": 0.99}


class FusionWorker(Worker):
    """Pulls from the samples ring, pushes to the attitude ring, one row for each sample.

    Whatever changes the fusion is done by its own thread between two samples, and is noted with the sample's number:
    so a recording can be computed again exactly.
    """

    noted = Signal(str)  # why another filter has taken over, a sentence; "": the chosen one is back

    def __init__(self, samples: Ring, attitude: Ring, pipeline: Pipeline) -> None:
        super().__init__()
        self.filter_note = ""
        """Why another filter has taken over; empty while the chosen one runs."""
        self.pipeline = pipeline  # the newest one asked for
        self.ages = AgeCounts()
        self.missed_rows = 0
        self.tap: Tap | None = None
        self._running = pipeline
        self._actions: deque[tuple[int, Action]] = deque()
        self._followed: deque[tuple[int, Action]] = deque()  # what a recording did, while it is replayed
        self.samples = samples
        self.attitude = attitude
        self._count = samples.count
        self._breaks = 0
        self._referred = False  # a heading was referred since a recording is followed
        self._fresh = threading.Event()
        self._drained = 0.0  # host time of the last tick, s

    def at(self, sample: int, action: Action) -> None:
        """Call ``action`` just before the sample of this number (NOW: the next) is fused; numbers must not fall."""
        self._actions.append((sample, action))

    def replace(self, pipeline: Pipeline, carry_on: bool, sample: int = NOW) -> None:
        """Use this pipeline from that sample on; ``carry_on``: from the old one's last attitude, with its origin."""
        self.pipeline = pipeline
        self._followed.clear()

        def exchange(number: int) -> None:
            if carry_on:
                pipeline.continue_from(self._running)
            self._swap(pipeline, anew=not carry_on)
            self._note("filter", number, pipeline.filter_name, {"carry_on": carry_on, "pipeline": pipeline.settings()})

        self.at(sample, exchange)

    def set_origin(self, quat: tuple[float, ...] | None, sample: int = NOW) -> None:
        """Make ``quat`` the zero of the shown attitude, or clear it."""

        def move(number: int) -> None:
            self._running.set_origin(quat)
            self._note("origin", number, "set" if quat else "cleared", {"quat": quat})

        self.at(sample, move)

    def look(self, see: Callable[[Pipeline], None]) -> None:
        """Have the fusion thread call ``see`` with the pipeline that runs, once and between two samples."""
        self.at(NOW, lambda _: see(self._running))

    def refer_heading(self, sample: int = NOW) -> None:
        """Call the heading right by definition from that sample on: see ``Pipeline.refer_heading``."""

        def refer(number: int) -> None:
            self._referred = True
            self._running.refer_heading()
            self._note("heading", number, "", {})

        self.at(sample, refer)

    def restart(self, sample: int) -> None:
        """Begin again from the accelerometer at that sample: what comes does not follow what was."""

        def begin(number: int) -> None:
            self._followed.clear()
            self._running.restart()
            self.filter_note = ""
            self._note("restart", number, "", {})

        self.at(sample, begin)

    def follow(self, events: list[Event], sample: int) -> None:
        """Do from that sample on what was done when these events were recorded, until the user does otherwise.

        KeyError, TypeError or ValueError when the recorded filter cannot be set up here.
        """
        start = start_of(events)
        if start is None:
            return
        rehearse(start, events)
        pipeline = Pipeline.from_state(start.data["pipeline"])

        def begin(_: int) -> None:
            self.pipeline, self._referred = pipeline, False
            self._swap(pipeline, anew=True)

        self.at(sample, begin)
        for event in events:
            if event.kind in CHANGES:
                self._followed.append((sample + event.sample, self._as_before(event)))

    def _as_before(self, event: Event) -> Action:
        def change(_: int) -> None:
            if event.kind == "heading" and self._referred:
                return  # a registration that was made by now counts from itself
            self.pipeline = CHANGES[event.kind](self._running, event.data)
            self._swap(self.pipeline, anew=not event.data.get("carry_on", True))

        return change

    def _swap(self, pipeline: Pipeline, anew: bool) -> None:
        """Run this pipeline; with or without the magnetometer, the heading means something else."""
        old, self._running = self._running, pipeline
        if anew or old.filter_name != pipeline.filter_name:
            self.filter_note = ""  # nothing has come back: there is another one
        self._breaks += old.restarts - pipeline.restarts + (anew or old.use_mag != pipeline.use_mag)

    @property
    def has_origin(self) -> bool:
        """Whether the shown attitude is relative to an origin."""
        return self._running.origin is not None

    @property
    def epoch(self) -> int:
        """Grows whenever the attitude began anew: what was said of an attitude before holds no longer."""
        return self._breaks + self._running.restarts

    def begin_tap(self, tap: Tap, sample: int, found: dict[str, Any]) -> None:
        """Start a recording at that sample, noting what the filter knows and what the reader ``found``."""

        def begin(number: int) -> None:
            tap.first_sample, tap.first_attitude = number, self.attitude.count
            self.tap = tap
            self._note("start", number, "", {"pipeline": self._running.state(), **found})
            tap.ready.set()

        self.at(sample, begin)

    def mark(self, text: str) -> None:
        """Note a marker at the next sample."""
        self.at(NOW, lambda number: self._note("marker", number, text, {}))

    def note(self, kind: str, text: str, data: dict[str, Any], attitude_number: int | None) -> None:
        """Note something else, at once, from any thread; ``attitude_number`` says at which attitude (None: the next).

        What it says can be computed again without it: it need not stand among the changes in its order.
        """
        tap = self.tap
        if tap is None:
            return
        into = 0 if attitude_number is None else max(0, attitude_number - tap.first_attitude)
        number = self._count if attitude_number is None else tap.first_sample + into
        self._note(kind, number, text, {**data, "first_attitude": tap.first_attitude})

    def end_tap(self) -> None:
        """The recording ends: nothing is noted any more."""
        self.tap = None

    @property
    def done(self) -> int:
        """How many samples of all time were taken in."""
        return self._count

    def step(self) -> None:
        self._fresh.wait(TICK_S)
        rest_s = self._drained + SHORTEST_TICK_S - time.perf_counter()
        if rest_s > 0.0:
            time.sleep(rest_s)
        self._fresh.clear()
        self._drained = time.perf_counter()
        self.drain()

    def wake(self) -> None:
        """Rows were pushed: take them now, not only at the next tick; from any thread."""
        self._fresh.set()

    def drain(self) -> None:
        """Everything that is new, now."""
        rows, count, missed = self.samples.since(self._count)
        self.missed_rows += missed
        first, at = count - len(rows), 0
        while (queue := self._due_first(count)) is not None:
            number, action = queue.popleft()
            cut = max(number - first, at)
            self._fuse(rows[at:cut], first + cut)
            at = cut
            action(first + at)
        self._fuse(rows[at:], count)

    def _due_first(self, count: int) -> deque[tuple[int, Action]] | None:
        """The queue whose first action comes first, if it is due before sample ``count``."""
        queues = [queue for queue in (self._actions, self._followed) if queue and queue[0][0] <= count]
        return min(queues, key=lambda queue: queue[0][0], default=None)

    def _fuse(self, rows: Rows, count: int) -> None:
        """Fuse these rows, which end at sample number ``count``; even a defect of the filter has no row fused twice."""
        self._count = count
        if len(rows) == 0:
            return
        try:
            fused = self._running.step(rows)
        except Exception:
            self._running.restart()
            self.attitude.push(empty_rows(ATTITUDE, len(rows)))
            raise
        now = time.perf_counter()
        fused["t_publish"] = now
        self.attitude.push(fused)
        self.ages.add(now - rows["t_arrival"])
        note = getattr(self._running.filter, "note", "")
        if note != self.filter_note:
            self._tell(note)

    def _tell(self, note: str) -> None:
        """Say so when another filter takes over, and when the chosen one is back; not when only the reason changes."""
        changed = bool(note) != bool(self.filter_note)
        self.filter_note = note
        if changed:
            self._note("note", self._count, note or BACK, {})
            self.noted.emit(note)

    def _note(self, kind: str, number: int, text: str, data: dict[str, Any]) -> None:
        tap = self.tap
        if tap is not None:
            newest = self.attitude.last(1)
            t = float(newest["t"][0]) if len(newest) else float("nan")
            tap.events.append(Event(kind, t, number - tap.first_sample, text, data))

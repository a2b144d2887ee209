"""The fusion thread: at a fixed cadence, every new sample once through the pipeline."""

from __future__ import annotations

import time

import numpy as np

from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.workers.worker import Worker

TICK_S = 1.0 / 200.0
BIN_MS = 0.1
BINS = 20_000  # ages up to 2 s


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
    """Pulls from the samples ring, pushes to the attitude ring."""

    def __init__(self, samples: Ring, attitude: Ring, pipeline: Pipeline) -> None:
        super().__init__()
        self.pipeline = pipeline  # the newest one asked for; ``replace`` assigns it
        self._running = pipeline
        self._carry_on = False
        self.ages = AgeCounts()
        self.missed_rows = 0
        self._samples = samples
        self._attitude = attitude
        self._count = samples.count
        self._due = time.perf_counter()

    def replace(self, pipeline: Pipeline, carry_on: bool) -> None:
        """Use this pipeline from the next tick on; ``carry_on``: from the old one's last attitude, with its origin."""
        self._carry_on = carry_on
        self.pipeline = pipeline

    def step(self) -> None:
        self._due = max(self._due + TICK_S, time.perf_counter() - TICK_S)
        self.stopping.wait(max(0.0, self._due - time.perf_counter()))
        self.drain()

    def drain(self) -> None:
        """Everything that is new, now."""
        rows, self._count, missed = self._samples.since(self._count)
        self.missed_rows += missed
        if self.pipeline is not self._running:
            self._exchange()
        if len(rows) == 0:
            return
        fused = self._running.step(rows)
        now = time.perf_counter()
        fused["t_publish"] = now
        self._attitude.push(fused)
        self.ages.add(now - rows["t_arrival"])

    def _exchange(self) -> None:
        pipeline = self.pipeline
        if self._carry_on:
            pipeline.continue_from(self._running)
        self._running = pipeline

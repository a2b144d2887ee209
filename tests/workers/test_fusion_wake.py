"""Rows that are pushed are fused when the reader says so, without waiting for the next tick."""

from __future__ import annotations

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE, empty_rows
from imugui.workers import fusion_worker
from imugui.workers.fusion_worker import FusionWorker


def test_a_worker_that_is_woken_takes_everything_new(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fusion_worker, "TICK_S", 3600.0)
    worker = FusionWorker(Ring(SAMPLE, 100), Ring(ATTITUDE, 100), Pipeline("madgwick"))
    worker.start()
    rows = empty_rows(SAMPLE, 3)
    rows["gyr"], rows["acc"] = 0.0, (0.0, 0.0, 9.8)
    try:
        for first in (0, 3):
            rows["t"] = rows["t_arrival"] = 0.01 * (first + np.arange(3))
            worker.samples.push(rows)
            worker.wake()
            qtbot.waitUntil(lambda first=first: worker.attitude.count == first + 3)
    finally:
        worker.stopping.set()
        worker.wake()
        worker.wait()
    assert worker.missed_rows == 0

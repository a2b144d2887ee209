"""FlowRunner and Feed: rows reach the flow, once and in order; what stops them is said."""

from __future__ import annotations

from typing import Any

import numpy as np
from pytestqt.qtbot import QtBot

from imugui.calibration.flow import Result
from imugui.samples import SAMPLE, Rows, empty_rows
from imugui.views.calibrate_feed import Feed
from imugui.views.flow_runner import FlowRunner
from imugui.workers.session import Session


class Counting:
    """A flow that counts rows and is done after ten."""

    title = "Counting"
    progress, sentence, missing = 0.0, "", ()

    def __init__(self) -> None:
        self.times: list[float] = []
        self.results = 0

    def feed(self, rows: Rows) -> None:
        if np.isnan(rows["t"]).any():
            raise ValueError("no time")
        self.times += rows["t"].tolist()

    @property
    def done(self) -> bool:
        return len(self.times) >= 10

    def result(self) -> Result:
        self.results += 1
        return Result(True, f"{len(self.times)} rows")

    def finish(self) -> None:
        self.times += [0.0] * 10


def block(first: float, n: int) -> Rows:
    rows = empty_rows(SAMPLE, n)
    rows["t"] = first + 0.01 * np.arange(n)
    return rows


def steps_of(runner: FlowRunner) -> list[Any]:
    steps: list[Any] = []
    runner.stepped.connect(steps.append)
    return steps


def test_every_row_once_and_a_result_when_done(qtbot: QtBot) -> None:
    runner = FlowRunner(Counting(), lambda flow, recent: (len(flow.times), len(recent)))
    steps = steps_of(runner)
    runner.start()
    for start in range(4):
        runner.feed(block(start, 3))
    qtbot.waitUntil(lambda: bool(steps) and steps[-1].picture == (12, 12))
    runner.stop()
    assert steps[0].result is None
    assert steps[-1].result.reason == "12 rows"


def test_a_flow_that_ends_is_left_alone(qtbot: QtBot) -> None:
    flow = Counting()
    runner = FlowRunner(flow, lambda flow, recent: None, ends=True)
    steps = steps_of(runner)
    runner.start()
    runner.feed(block(0, 10))
    qtbot.waitUntil(lambda: bool(steps) and steps[-1].done)
    runner.feed(block(1, 10))
    runner.stop()
    assert (len(flow.times), flow.results) == (10, 1)


def test_a_method_is_called_in_the_thread(qtbot: QtBot) -> None:
    runner = FlowRunner(Counting(), lambda flow, recent: None)
    steps = steps_of(runner)
    runner.start()
    runner.ask("finish")
    qtbot.waitUntil(lambda: bool(steps) and steps[-1].done)
    runner.stop()


def test_a_defect_is_told_and_ends_the_run(qtbot: QtBot) -> None:
    runner = FlowRunner(Counting(), lambda flow, recent: None)
    with qtbot.waitSignal(runner.failed) as told:
        runner.start()
        runner.feed(empty_rows(SAMPLE, 1))
    assert "no time" in told.args[0]
    runner.stop()
    assert runner.isFinished()


def test_feed_gives_every_new_row_once(session: Session) -> None:
    session.samples.push(block(0, 5))
    feed = Feed(session)
    assert len(feed.pull()) == 0
    session.samples.push(block(1, 5))
    assert len(feed.pull()) == 5
    assert len(feed.pull()) == 0


def test_feed_says_that_nothing_comes(session: Session) -> None:
    feed = Feed(session)
    feed.pull()
    assert "waits" in feed.trouble


def test_feed_counts_gaps(session: Session) -> None:
    feed = Feed(session)
    session.samples.push(block(0, 5))
    feed.pull()
    session.samples.push(block(0.05, 5))
    feed.pull()
    assert feed.gaps == 0
    session.samples.push(block(9, 5))
    feed.pull()
    assert feed.gaps == 1


def test_paused_feed_lets_rows_pass(session: Session) -> None:
    feed = Feed(session)
    feed.pause()
    session.samples.push(block(0, 5))
    assert len(feed.pull()) == 0
    feed.resume()
    assert len(feed.pull()) == 0
    session.samples.push(block(5, 2))
    assert (len(feed.pull()), feed.gaps) == (2, 0)

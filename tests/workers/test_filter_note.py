"""A filter that gives up and comes back, and a heading that is called right: what the fusion thread tells and notes."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from imugui.fusion.imugui_filter import Imugui
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.self_calibrating_guard import BROKEN, OUT_OF_BOUNDS, RETURN_AFTER, TOO_FAR, WRONG_NORTH
from imugui.recording import write_samples
from imugui.recording.events import Event, from_lines, to_line
from imugui.ring import Ring
from imugui.samples import ATTITUDE, GRAVITY, SAMPLE, Rows, empty_rows
from imugui.workers.filter_words import takeover_words
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.headless import report
from imugui.workers.recorder import Tap
from imugui.workers.session import Session, Source, State
from imugui.workers.verify import fuse_again

RATE_HZ = 25.0


def trembling(seconds: float, rate_hz: float = RATE_HZ, parted_after: float = math.inf) -> Rows:
    """A level board in a trembling hand; after so many seconds the field comes from elsewhere, as strong and as steep.

    That is what makes imugui's own filter give up: its heading has parted from the field.
    """
    rows = empty_rows(SAMPLE, round(rate_hz * seconds))
    rng = np.random.default_rng(1)
    rows["t"] = rows["t_arrival"] = np.arange(len(rows)) / rate_hz
    rows["gyr"] = rng.normal(0.0, 0.05, (len(rows), 3))
    rows["acc"] = np.array((0.0, 0.0, GRAVITY)) + rng.normal(0.0, 0.02, (len(rows), 3))
    north = np.where(rows["t"] < parted_after, 0.0, math.radians(120.0))
    field = np.stack((20.0 * np.sin(north), 20.0 * np.cos(north), np.full(len(rows), -43.0)), axis=1)
    rows["mag"] = field + rng.normal(0.0, 0.2, (len(rows), 3))
    return rows


class Thread:
    """The fusion worker without its thread, and what it told."""

    def __init__(self, filter_name: str = "imugui", use_mag: bool = True) -> None:
        self.samples, self.attitude = Ring(SAMPLE, 4096), Ring(ATTITUDE, 4096)
        self.worker = FusionWorker(self.samples, self.attitude, Pipeline(filter_name, use_mag=use_mag))
        self.told: list[str] = []
        self.worker.noted.connect(self.told.append)
        self.tap = Tap()

    def record(self) -> None:
        self.worker.begin_tap(self.tap, 0, {})
        self.worker.drain()

    def feed(self, rows: Rows, block: int = 10) -> None:
        for start in range(0, len(rows), block):
            self.samples.push(rows[start : start + block])
            self.worker.drain()

    def events(self, kind: str) -> list[Event]:
        return [event for event in self.tap.events if event.kind == kind]


def test_the_takeover_and_the_return_are_told_once_each_and_noted() -> None:
    thread = Thread()
    thread.record()
    thread.feed(trembling(2.0 * RETURN_AFTER, parted_after=6.0))
    assert [WRONG_NORTH in told for told in thread.told] == [True, False]
    assert thread.told[1] == ""
    assert thread.worker.filter_note == ""
    fell, came = thread.events("note")
    assert fell.text == thread.told[0]
    assert "is back" in came.text
    assert came.sample - fell.sample >= RETURN_AFTER * RATE_HZ - 10
    assert from_lines([to_line(fell)]) == ([fell], 0)
    sigmas = thread.attitude.last(4096)["sigma_heading"]
    silent = np.flatnonzero(np.isnan(sigmas))
    assert fell.sample - 10 <= silent[0] <= fell.sample
    assert came.sample - 10 <= silent[-1] + 1 <= came.sample


def test_while_it_lasts_it_is_known_and_another_filter_is_no_return() -> None:
    thread = Thread()
    thread.feed(trembling(RETURN_AFTER, parted_after=6.0))
    assert WRONG_NORTH in thread.worker.filter_note
    thread.worker.replace(Pipeline("imugui", Imugui.PRESETS["Vehicle"]), carry_on=True)
    thread.feed(trembling(1.0))
    assert thread.worker.filter_note != ""  # its own state went along
    thread.worker.replace(Pipeline("vqf"), carry_on=True)
    thread.feed(trembling(1.0))
    assert thread.worker.filter_note == ""
    assert len(thread.told) == 1


def test_a_filter_that_begins_anew_has_not_come_back() -> None:
    thread = Thread()
    thread.feed(trembling(RETURN_AFTER, parted_after=6.0))
    thread.worker.restart(thread.samples.count)
    thread.feed(trembling(1.0))
    assert thread.worker.filter_note == ""
    assert len(thread.told) == 1


@pytest.mark.parametrize("reason", [BROKEN, OUT_OF_BOUNDS, TOO_FAR, WRONG_NORTH])
def test_the_words_say_what_happened_why_and_what_comes(reason: str) -> None:
    words = takeover_words("imugui", f"VQF has taken over for now: {reason}.")
    assert words.startswith("VQF has taken over")
    assert reason in words
    assert words.endswith("comes back by itself after 10 s without trouble.")
    assert (words.count(". ") == 1) is (reason == BROKEN)  # for all others there is something to do


@pytest.fixture
def played(tmp_path: Path, qtbot: Any) -> Iterator[Callable[[Rows], Session]]:
    """Plays rows as fast as it goes into a session with imugui's own filter."""
    sessions: list[Session] = []

    def play(rows: Rows) -> Session:
        path = tmp_path / "samples.csv"
        write_samples(path, rows, {})
        session = Session("imugui")
        sessions.append(session)
        session.connect_to(Source("replay", str(path), speed=math.inf))
        return session

    yield play
    for session in sessions:
        session.close()


def test_the_window_is_told_what_to_do(played: Callable[[Rows], Session], qtbot: Any) -> None:
    session = played(trembling(2.6 * RETURN_AFTER, 50.0, 6.0))  # longer than the blocks it is played in
    said: list[tuple[str, str]] = []
    session.message.connect(lambda *message: said.append(message))
    qtbot.waitUntil(lambda: len(said) == 2)
    assert [tone for tone, _ in said] == ["warn", "info"]
    assert "Take iron and magnets away" in said[0][1]
    assert "imugui is back" in said[1][1]
    assert "register again" in said[1][1]
    assert session.filter_note == ""


def test_status_and_report_say_it_while_it_lasts(played: Callable[[Rows], Session], qtbot: Any) -> None:
    session = played(trembling(RETURN_AFTER, parted_after=6.0))
    qtbot.waitUntil(lambda: session.status().state is State.ENDED)
    qtbot.waitUntil(lambda: session.filter_note != "")
    status = session.status()
    assert WRONG_NORTH in status.filter_note == session.filter_note
    assert report(session, status)["filter_note"] == status.filter_note


# the heading


def turned(seconds: float) -> Rows:
    rows = trembling(seconds)
    rows["gyr"][:, 2] += np.sin(rows["t"])
    return rows


def test_a_referred_heading_counts_from_there_and_is_computed_again_exactly() -> None:
    thread = Thread(use_mag=False)
    thread.record()
    rows = turned(8.0)
    thread.feed(rows[:100])
    before = thread.attitude.last(1)["sigma_heading"][0]
    thread.worker.refer_heading(105)
    thread.feed(rows[100:])
    (event,) = thread.events("heading")
    assert event.sample == 105
    fused = thread.attitude.last(len(rows))
    assert fused["sigma_heading"][110] < 0.5 * before
    (start,) = thread.events("start")
    events = [Event(**json.loads(to_line(one))) for one in thread.tap.events]
    again = fuse_again(rows, start, events)
    for name in ("quat", "sigma_heading", "sigma_tilt"):
        assert np.array_equal(again[name], fused[name])
    without = fuse_again(rows, start, [one for one in events if one.kind != "heading"])
    assert without["sigma_heading"][110] > 2.0 * fused["sigma_heading"][110]


@pytest.mark.parametrize("by_hand", [True, False])
def test_a_replayed_reference_does_not_shorten_that_of_a_registration_made_now(by_hand: bool) -> None:
    recorded = Thread(use_mag=False)
    recorded.record()
    rows = turned(8.0)
    recorded.worker.refer_heading(150)
    recorded.feed(rows)
    again = Thread(use_mag=False)
    again.worker.follow(recorded.tap.events, 0)
    if by_hand:
        again.worker.refer_heading(50)
    again.feed(rows)
    first, second = (thread.attitude.last(len(rows))["sigma_heading"] for thread in (recorded, again))
    dropped = second[152] < 0.5 * second[148]
    assert dropped is not by_hand
    assert np.array_equal(first, second) is not by_hand


def test_filters_that_state_nothing_go_on_as_they_did() -> None:
    rows, quats = turned(4.0), []
    for refers in (True, False):
        thread = Thread("mahony", use_mag=False)
        if refers:
            thread.worker.refer_heading(50)
        thread.feed(rows)
        quats.append(thread.attitude.last(len(rows))["quat"])
    assert np.array_equal(*quats)

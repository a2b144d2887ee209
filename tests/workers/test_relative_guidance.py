"""Readings against a reference board: trusted only while both boards are, and never claimed to be computed again."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading, reading_from
from imugui.guidance.registration import from_origin
from imugui.workers.session import Session, Source, State
from imugui.workers.verify import verify

TILTED = Source("simulator", "rest", rate_hz=200.0, seed=5)


@pytest.fixture
def pair(qtbot) -> Iterator[tuple[Session, Session]]:
    """Two boards at rest, tilted and turned in different ways."""
    tool = Session(use_mag=False)
    reference = tool.beside()
    tool.connect_to(Source("simulator", "rest", rate_hz=400.0))
    reference.connect_to(TILTED)
    for session in (tool, reference):
        qtbot.waitUntil(lambda s=session: s.status().state is State.STREAMING)
    tool.measure_against(reference)
    qtbot.waitUntil(lambda: tool.shown.count > 20)
    yield tool, reference
    tool.close()
    assert not reference.radio.started


class Page:
    """What the Guide page does at every frame."""

    def __init__(self, session: Session) -> None:
        self.session, self.guide, self.ring = session, Guide(), session.shown
        self.count, self.epoch = self.ring.count, session.guide_facts()["epoch"]
        self.guide.set_plans([Plan(name="L4", side="left")])
        self.guide.confirm_side("left")

    def refresh(self) -> None:
        rows, self.count, _ = self.ring.since(self.count)
        facts = self.session.guide_facts()
        same = facts.pop("epoch") == self.epoch
        self.guide.step(rows, self.count - len(rows), Facts(**facts, epoch_same=same))

    def register(self) -> None:
        self.epoch = self.session.guide_facts()["epoch"]
        rows, numbers = self.guide.recent(0.5), self.guide.recent_numbers(0.5)
        self.guide.register(from_origin(rows["quat"], t=float(rows["t"][-1]), rows=(numbers,)))


@pytest.fixture
def page(pair: tuple[Session, Session], qtbot) -> Page:
    """Aligned and registered."""
    assert pair[0].set_origin()
    one = Page(pair[0])
    qtbot.waitUntil(lambda: one.refresh() or len(one.guide.recent(0.5)) > 150)
    one.register()
    return one


def test_a_reading_says_that_it_is_relative_and_verify_does_not_claim_it(page: Page, qtbot, tmp_path: Path) -> None:
    folder = tmp_path / "tool.imugui"
    assert page.session.record(folder)
    qtbot.waitUntil(lambda: page.session.recording.rows > 0)
    qtbot.waitUntil(lambda: page.refresh() or page.guide.look.armed)
    reading = page.guide.capture(page.session.guide_facts()["now"])
    assert isinstance(reading, Reading), reading
    assert reading.relative
    assert reading_from(reading.to_dict()).relative
    assert page.session.note("guidance", "reading", {"reading": reading.to_dict()}, None)
    page.session.stop_recording()
    found = verify(folder)
    assert (found.guidance.readings, found.guidance.recomputed, found.guidance.relative) == (1, 0, 1)
    assert "0 of 1 readings computed again. Not checked: 1 measured against a reference board" in found.sentence
    assert "largest difference 0 deg" in found.sentence  # the tool's own attitudes


def test_before_the_alignment_nothing_is_trusted(pair: tuple[Session, Session], qtbot) -> None:
    one = Page(pair[0])
    qtbot.waitUntil(lambda: one.refresh() or len(one.guide.recent(0.5)) > 150)
    one.register()
    qtbot.waitUntil(lambda: one.refresh() or any("not aligned" in reason for reason in one.guide.look.reasons))
    assert not one.guide.look.trusted


def test_aligning_anew_or_a_reference_that_begins_anew_ends_the_registration(page: Page, qtbot) -> None:
    qtbot.waitUntil(lambda: page.refresh() or page.guide.look.trusted)
    page.session.set_origin()
    qtbot.waitUntil(lambda: page.refresh() or any("begun anew" in reason for reason in page.guide.look.reasons))
    page.register()
    qtbot.waitUntil(lambda: page.refresh() or page.guide.look.trusted)
    page.session.reference.connect_to(TILTED)
    qtbot.waitUntil(lambda: not page.session.relative.aligned)
    page.refresh()
    assert not page.guide.look.trusted


def test_the_headings_sigma_of_two_boards_is_of_both_and_counts_from_the_alignment(
    pair: tuple[Session, Session], qtbot
) -> None:
    """Both run imugui's own filter; with another one on the reference nothing is stated, and the drift counts."""

    def stated() -> float:
        rows = tool.shown.last(1)
        return float(rows["sigma_heading"][0]) if len(rows) else math.nan

    tool, reference = pair
    for session in pair:
        session.set_filter("imugui", use_mag=False)
    qtbot.waitUntil(lambda: stated() > 0.0)
    count = tool.shown.count
    qtbot.waitUntil(lambda: tool.shown.count > count + 400)
    before = stated()
    assert tool.set_origin()
    qtbot.waitUntil(lambda: stated() < 0.5 * before)
    one = Page(tool)
    qtbot.waitUntil(lambda: one.refresh() or len(one.guide.recent(0.5)) > 150)
    one.register()
    tool.refer_heading()  # as the Guide page does: it counts from the alignment all the same
    qtbot.waitUntil(lambda: one.refresh() or one.guide.look.heading_age_s > 0.2)

    def own() -> list[float]:
        return [float(session.attitude.last(1)["sigma_heading"][0]) for session in pair]

    qtbot.waitUntil(lambda: math.hypot(*own()) == pytest.approx(stated(), rel=0.2))
    one.refresh()
    assert math.radians(one.guide.look.heading_sigma_deg) >= 0.9 * min(own())
    reference.set_filter("vqf", use_mag=False)
    qtbot.waitUntil(lambda: math.isnan(stated()))
    assert "vqf" in tool.guide_facts()["filter"]


def test_a_tilted_reference_is_no_shaken_tool(page: Page, qtbot) -> None:
    qtbot.waitUntil(lambda: page.refresh() or len(page.guide.recent(0.5)) > 150)
    tilt = page.session.reference.attitude.last(1)["quat"][0]
    assert np.degrees(2.0 * np.arccos(np.hypot(tilt[0], tilt[3]))) > 1.0
    assert not page.session.relative.shaken
    assert not any("shaken" in reason for reason in page.guide.look.reasons)


def test_a_silent_reference_blanks_the_target(page: Page, qtbot) -> None:
    page.refresh()
    page.session.reference.disconnect_source()
    qtbot.waitUntil(lambda: page.refresh() or page.guide.look.colour == "blank")
    assert not page.guide.look.trusted

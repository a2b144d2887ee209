"""Guidance on a live session: what it is told of the stream, what it leaves in a recording, and the proof."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from imugui.fusion.self_calibrating_params import ImuguiParams
from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading
from imugui.guidance.registration import from_origin
from imugui.recording.folder import ABOUT, EVENTS
from imugui.workers.session import Session, Source
from imugui.workers.verify import verify

AT_REST = Source("simulator", "rest", rate_hz=400.0)


@pytest.fixture
def session(qtbot) -> Iterator[Session]:
    one = Session(use_mag=False)
    one.connect_to(AT_REST)
    qtbot.waitUntil(lambda: one.samples.count > 50)
    yield one
    one.close()


class Page:
    """What a page does at every frame."""

    def __init__(self, session: Session) -> None:
        self.session, self.guide, self.count = session, Guide(), session.attitude.count

    def refresh(self) -> None:
        rows, self.count, _ = self.session.attitude.since(self.count)
        facts = self.session.guide_facts()
        facts.pop("epoch")
        self.guide.step(rows, self.count - len(rows), Facts(**facts))

    def register(self) -> None:
        rows, numbers = self.guide.recent(0.5), self.guide.recent_numbers(0.5)
        self.guide.register(from_origin(rows["quat"], t=float(rows["t"][-1]), rows=(numbers,)))
        self.session.refer_heading()


def captured(session: Session, qtbot) -> Reading:
    page = Page(session)
    page.guide.set_plans([Plan(name="L4", side="left")])
    page.guide.confirm_side("left")
    qtbot.waitUntil(lambda: page.refresh() or len(page.guide.recent(0.5)) > 150)
    page.register()
    taken: list[Reading] = []

    def take() -> bool:
        page.refresh()
        if page.guide.look.armed:
            reading = page.guide.capture(session.guide_facts()["now"])
            taken.extend([reading] if isinstance(reading, Reading) else [])
        return bool(taken)

    qtbot.waitUntil(take)
    return taken[0]


@pytest.fixture
def recorded(session: Session, tmp_path: Path, qtbot) -> Path:
    folder = tmp_path / "guided.imugui"
    assert session.record(folder)
    qtbot.waitUntil(lambda: session.recording.rows > 0)
    reading = captured(session, qtbot)
    assert session.note("guidance", "reading", {"reading": reading.to_dict()}, reading.rows[1])
    session.stop_recording()
    return folder


def test_a_reading_is_computed_again_from_the_recording_to_the_last_digit(recorded: Path) -> None:
    found = verify(recorded).guidance
    assert (found.readings, found.recomputed, found.registrations) == (1, 1, 1)
    assert found.reading_difference_deg == 0.0
    assert found.registration_difference_deg < 1e-6
    assert "1 of 1 readings computed again: largest difference 0 deg" in verify(recorded).sentence


def test_a_reading_with_imuguis_own_filter_is_computed_again_with_its_sigma(
    session: Session, tmp_path: Path, qtbot
) -> None:
    """Registered, the filter is told, and what it states from there on is in the reading, and in the proof."""
    session.set_filter("imugui", use_mag=False)
    count = session.attitude.count
    qtbot.waitUntil(lambda: session.attitude.count > count + 400)
    before = float(session.attitude.last(1)["sigma_heading"][0])
    folder = tmp_path / "own.imugui"
    assert session.record(folder)
    qtbot.waitUntil(lambda: session.recording.rows > 0)
    reading = captured(session, qtbot)
    assert reading.heading_from == "filter"
    assert 0.0 < math.radians(reading.heading_sigma_deg) < before
    assert session.note("guidance", "reading", {"reading": reading.to_dict()}, reading.rows[1])
    session.stop_recording()
    again = verify(folder)
    assert again.attitude_difference_deg == 0.0
    assert (again.guidance.reading_difference_deg, again.guidance.sigma_difference_deg) == (0.0, 0.0)
    assert (again.guidance.recomputed, again.guidance.sigmas) == (1, 1)
    assert "1 of their heading's sigmas: 0 deg" in again.sentence
    lines = (folder / EVENTS).read_text().splitlines()
    (folder / EVENTS).write_text("\n".join(line for line in lines if '"kind": "heading"' not in line) + "\n")
    assert verify(folder).guidance.sigma_difference_deg > 0.0


def test_a_reading_that_claims_other_samples_is_found_out(recorded: Path) -> None:
    lines = (recorded / EVENTS).read_text().splitlines()
    number = next(number for number, line in enumerate(lines) if '"guidance"' in line)
    event = json.loads(lines[number])
    first, last = event["data"]["reading"]["rows"]
    event["data"]["reading"]["rows"] = [first - 20, last - 20]
    lines[number] = json.dumps(event)
    (recorded / EVENTS).write_text("\n".join(lines) + "\n")
    assert 0.0 < verify(recorded).guidance.reading_difference_deg < 1.0


def test_a_damaged_reading_is_said_and_one_from_before_the_recording_is_not_claimed(recorded: Path) -> None:
    lines = (recorded / EVENTS).read_text().splitlines()
    event = json.loads(next(line for line in lines if '"guidance"' in line))
    earlier = {**event, "data": {**event["data"], "first_attitude": 10**9}}
    broken = {**event, "data": {"reading": {"number": "one"}, "first_attitude": 0}}
    (recorded / EVENTS).write_text("\n".join([*lines, json.dumps(earlier), json.dumps(broken)]) + "\n")
    found = verify(recorded).guidance
    assert (found.readings, found.recomputed) == (3, 1)
    assert "1 of 3 readings" in found.sentence
    assert "before the recording began" in found.sentence
    assert "A reading is damaged" in found.sentence


def test_without_a_recording_nothing_is_noted(session: Session) -> None:
    assert not session.note("guidance", "reading", {}, None)


def test_the_epoch_grows_when_the_heading_begins_to_mean_something_else(session: Session, qtbot) -> None:
    def epoch() -> int:
        return int(session.guide_facts()["epoch"])

    start = epoch()
    session.set_filter("mahony", use_mag=False)
    qtbot.waitUntil(lambda: session.guide_facts()["filter"] == "mahony")
    count = session.attitude.count
    qtbot.waitUntil(lambda: session.attitude.count > count + 10)
    assert epoch() == start, "the new filter goes on from the old one's attitude"
    session.set_filter("mahony", use_mag=True)
    qtbot.waitUntil(lambda: epoch() == start + 1)
    session.connect_to(AT_REST)
    qtbot.waitUntil(lambda: epoch() > start + 1)


def test_a_virtual_board_counts_as_calibrated_only_when_its_errors_are_small(session: Session) -> None:
    assert session.guide_facts()["calibrated"]
    session.connect_to(dataclasses.replace(AT_REST, errors="mpu9250"))
    facts = session.guide_facts()
    assert not facts["calibrated"]
    assert facts["base_tilt"] > 0.03
    assert facts["prior_holds"]
    session.set_filter("imugui", ImuguiParams(matrix_worst=0.0), use_mag=False)
    assert not session.guide_facts()["prior_holds"], "it takes the gyroscope for better than a datasheet's"
    session.connect_to(AT_REST)
    assert session.guide_facts()["prior_holds"]


def test_a_replay_is_as_trusted_as_the_board_was(recorded: Path, session: Session) -> None:
    session.connect_to(Source("replay", str(recorded)))
    facts = session.guide_facts()
    assert facts["calibrated"]
    assert facts["profile_words"] == "calibrated at the factory"
    about = json.loads((recorded / ABOUT).read_text())
    (recorded / ABOUT).write_text(json.dumps({**about, "calibration": "lost"}))
    session.connect_to(Source("replay", str(recorded)))
    assert not session.guide_facts()["calibrated"]

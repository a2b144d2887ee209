"""Two boards in one window: a second desk, one board in front, the tool in the reference's frame."""

from __future__ import annotations

import gc
import math
import weakref
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from imugui.fusion.quaternion import angle_between
from imugui.guidance.registration import from_origin
from imugui.views.board_strip import BOARDS
from imugui.views.main_window import MainWindow
from imugui.views.relative_words import age_words, aligned_words, relative_words, stale_relative
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import RelativeStatus, Session, Source, State

GOOD = RelativeStatus(5.0, 8.0, aligned=True, same_north=False, aligned_s=12.0, residual_deg=0.4)


@pytest.fixture
def session(qapp: object) -> Iterator[Session]:
    one = Session(use_mag=False)
    yield one
    one.close()


@pytest.fixture
def window(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> MainWindow:
    return shown(MainWindow(session, settings_store))


@pytest.fixture
def pair(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """Two boards that lie still, each its own way round."""
    window.add_board()
    for number, desk in enumerate(window.desks):
        desk.session.connect_to(Source("simulator", "rest", seed=0, rate_hz=200.0 - 60.0 * number))
        qtbot.waitUntil(lambda desk=desk: desk.session.status().state is State.STREAMING)
    window.choose_board(0)
    return window


def test_one_board_shows_nothing_of_a_second_but_a_small_button(window: MainWindow) -> None:
    assert not window.strip.isVisible()
    assert window.bar.add_button.isVisible()


def test_a_second_board_has_its_own_source_status_pages_and_recording(pair: MainWindow, qtbot: QtBot, tmp_path) -> None:
    first, second = pair.desks
    assert second.session.radio is first.session.radio
    assert second.session.profiles is first.session.profiles
    assert pair.strip.isVisible()
    assert not first.bar.add_button.isVisible()
    qtbot.waitUntil(lambda: 130.0 < second.session.status().rate_hz < 150.0)
    qtbot.waitUntil(lambda: first.session.status().rate_hz > 190.0)
    pair.strip.tabs[1].click()
    assert pair.desk is second
    assert [desk.bar.isVisible() for desk in pair.desks] == [False, True]
    assert [desk.status_line.isVisible() for desk in pair.desks] == [False, True]
    assert pair.page() is second.pages["live"]
    assert pair.page() is not first.pages["live"]
    assert pair.session.record(tmp_path / "second.imugui")
    assert first.session.recording is None
    pair.remove_board()
    assert "recorded" in pair.banner.text()
    assert len(pair.desks) == 2
    pair.session.stop_recording()


def test_pages_that_are_there_once_come_with_the_first_board(pair: MainWindow) -> None:
    pair.choose_board(1)
    pair.show_page("guide")
    assert pair.desk is pair.desks[0]
    pair.choose_board(1)
    assert pair.page() is pair.desks[1].pages["live"]
    assert list(pair.desks[1].pages) == ["live"]


def test_what_the_second_board_says_has_its_name(pair: MainWindow) -> None:
    pair.desks[1].session.message.emit("warn", "Something happened.")
    assert pair.banner.text() == "Board 2: Something happened."


def test_the_second_source_is_not_remembered_as_the_first(pair: MainWindow, settings_store: SettingsStore) -> None:
    before = settings_store.settings.address
    pair.choose_board(1)
    pair.bar.connect_to("simulator", "free")
    assert settings_store.settings.address == before


def test_a_removed_board_is_gone_and_its_session_ended(pair: MainWindow, qtbot: QtBot) -> None:
    gone = pair.desks[1].session
    pair.set_relative(True)
    pair.choose_board(1)
    pair.strip.remove_button.click()
    assert pair.desk is pair.desks[0]
    assert len(pair.desks) == 1
    assert gone.source is None
    assert pair.session.relative is None
    assert not pair.strip.isVisible()
    assert pair.bar.add_button.isVisible()
    pair.add_board()
    assert pair.desk.session is not gone


def test_a_removed_board_gives_its_memory_back(pair: MainWindow, qtbot: QtBot) -> None:
    ring = weakref.ref(pair.desks[1].session.samples)
    pair.remove_board()
    qtbot.waitUntil(lambda: gc.collect() >= 0 and ring() is None)


def test_relative_is_offered_where_it_acts(pair: MainWindow) -> None:
    offered = {}
    for name in ("live", "calibrate", "guide", "signals"):
        pair.show_page(name)
        offered[name] = pair.strip.relative.isVisible()
    assert offered == {"live": True, "calibrate": False, "guide": True, "signals": False}
    pair.choose_board(1)
    pair.show_page("live")
    assert not pair.strip.relative.isVisible()


def test_the_live_page_shows_the_tool_in_the_frame_of_the_reference(pair: MainWindow, qtbot: QtBot) -> None:
    tool, reference = (desk.session for desk in pair.desks)
    pair.strip.relative.click()
    assert tool.reference is reference
    assert tool.shown is not tool.attitude
    assert not pair.pages["live"].heading.isVisible()
    assert pair.strip.state.text() == "▲ Not aligned"
    assert pair.strip.hint.isVisible()
    qtbot.waitUntil(lambda: tool.shown.count > 20)
    pair.set_origin()
    assert pair.strip.state.text().startswith("✓ Aligned")
    assert not pair.strip.hint.isVisible()
    count = tool.shown.count
    qtbot.waitUntil(lambda: tool.shown.count > count + 20)
    pair.slow_refresh()
    assert "tool" in pair.strip.ages.whole
    assert "reference" in pair.strip.ages.whole
    assert np.degrees(angle_between(tool.shown.last(5)["local"], (1.0, 0.0, 0.0, 0.0))).max() < 0.5
    assert pair.pages["live"].origin.text() == "Relative to the reference board"
    pair.clear_origin()
    assert not tool.relative.aligned
    pair.strip.relative.click()
    assert tool.shown is tool.attitude
    assert pair.pages["live"].heading.isVisible()


def test_without_the_reference_nothing_looks_alive(pair: MainWindow, qtbot: QtBot) -> None:
    pair.set_relative(True)
    qtbot.waitUntil(lambda: pair.session.shown.count > 20)
    pair.desks[1].session.disconnect_source()
    view = pair.pages["live"]
    qtbot.waitUntil(lambda: "Reference silent" in view._stale_word(pair.session.shown.last(1)))
    view.refresh()
    assert all("-" in readout.text() for readout in view.angles.readouts.values())
    assert not pair.session.guide_facts()["streaming"]
    pair.set_origin()
    assert "both boards" in pair.banner.text()


def test_guidance_in_the_frame_of_the_reference(pair: MainWindow, qtbot: QtBot) -> None:
    pair.show_page("guide")
    desk, panel = pair.page().desk, pair.page().register_panel
    desk.register(from_origin([1.0, 0.0, 0.0, 0.0], t=0.0, rows=((0, 1),)))
    pair.set_relative(True)
    pair.refresh()
    assert desk.guide.registration is None
    assert "another frame" in pair.banner.text()
    assert panel.method.findData("mark") < 0
    assert not panel.mag.isEnabled()
    facts = pair.session.guide_facts()
    assert facts["relative"]
    assert "not aligned" in facts["epoch_words"]
    assert math.isnan(facts["aligned_at"])
    qtbot.waitUntil(lambda: pair.session.shown.count > 20)
    pair.set_origin()
    assert pair.session.guide_facts()["epoch_words"] == ""
    desk.register(from_origin([1.0, 0.0, 0.0, 0.0], t=0.0, rows=((0, 1),)))
    pair.set_origin()
    assert desk.guide.registration is None
    pair.set_relative(False)
    pair.slow_refresh()
    assert panel.method.findData("mark") == 1


def test_two_boards_are_trusted_less_than_one(pair: MainWindow) -> None:
    own = pair.session.guide_facts()
    pair.set_relative(True)
    both = pair.session.guide_facts()
    for name in ("base_tilt", "drift"):
        assert both[name] == pytest.approx(math.sqrt(2.0) * own[name])
    assert both["epoch"] != own["epoch"]
    assert not both["use_mag"]


def test_tabs_name_the_boards(window: MainWindow) -> None:
    assert tuple(tab.text() for tab in window.strip.tabs) == BOARDS


@pytest.mark.parametrize(
    ("changes", "tone", "words"),
    [
        ({}, "good", "Aligned 12 s ago"),
        ({"same_north": True}, "good", "Common north"),
        ({"aligned": False}, "warn", "Not aligned"),
        ({"reference_age_ms": 2100.0}, "bad", "Reference silent for 2.1 s"),
        ({"tool_age_ms": math.nan}, "bad", "Tool sends nothing"),
    ],
)
def test_words_of_the_relative_attitude(changes: dict[str, Any], tone: str, words: str) -> None:
    status = RelativeStatus(**{**GOOD.__dict__, **changes})
    assert relative_words(status) == (tone, words)


def test_ages_and_what_an_alignment_leaves() -> None:
    assert age_words(4.6, math.nan) == "tool 5 ms, reference –"
    assert aligned_words(GOOD)[1] == ""
    tone, words = aligned_words(RelativeStatus(5.0, 8.0, True, False, 0.0, 24.0))
    assert tone == "warn"
    assert "24°" in words
    assert stale_relative(GOOD, 0) == "Waiting for both boards"
    assert stale_relative(GOOD, 1) == ""

"""The link log window: everything that was not data, in order, by kind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtGui import QGuiApplication
from pytestqt.qtbot import QtBot

from imugui.views.link_log import KINDS, LinkLogWindow, line_of
from imugui.workers.session import Session, Source, State

CAPTURE = b"RESET\r\nconfiguring device.\r\n" + b"0.1,0.2,1.0;1,2,3;10,20,30;\r\n" * 30 + b"0.1,0.2;zz;;\r\n"


@pytest.fixture
def log(session: Session, shown: Callable[[Any], Any], qtbot: QtBot, tmp_path: Path) -> LinkLogWindow:
    path = tmp_path / "capture.txt"
    path.write_bytes(CAPTURE)
    window = shown(LinkLogWindow(session))
    session.connect_to(Source("replay", str(path), "triplets", speed=50.0))
    qtbot.waitUntil(lambda: session.status().state is State.ENDED)
    window.refresh(session.status())
    return window


def test_line_of() -> None:
    assert line_of((12.5, "bad", "malformed: x"), 10.0) == "     2.500 s  bad      malformed: x"


def test_shows_what_was_not_data(log: LinkLogWindow, session: Session) -> None:
    text = log.text.toPlainText()
    assert "RESET" in text
    assert "configuring device." in text
    assert len(text.splitlines()) == len(session.link_log())
    assert "30 messages" in log.counts.text()


@pytest.mark.parametrize("kind", KINDS)
def test_one_kind_only(log: LinkLogWindow, session: Session, kind: str) -> None:
    log.kind.choose(kind)
    wanted = [entry for entry in session.link_log() if kind in ("all", entry[1])]
    assert log.text.toPlainText().splitlines() == [line_of(entry, session.link_log()[0][0]) for entry in wanted]


def test_what_was_seen_stays_after_disconnecting(log: LinkLogWindow, session: Session) -> None:
    before = log.text.toPlainText()
    session.disconnect_source()
    log.refresh(session.status())
    assert log.text.toPlainText() == before


def test_copy(log: LinkLogWindow) -> None:
    log.copy()
    assert QGuiApplication.clipboard().text() == log.text.toPlainText()


def test_a_hidden_window_does_no_work(session: Session, log: LinkLogWindow) -> None:
    log.hide()
    session.connect_to(Source("simulator", "rest", "accel-lines"))
    before = log.counts.text()
    log.refresh(session.status())
    assert log.counts.text() == before

"""A session with no source, settings that are not written, and rows to put into the rings."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from PySide6.QtCore import QCoreApplication, QEvent
from pytestqt.qtbot import QtBot

from imugui.samples import ATTITUDE, Rows, empty_rows
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session

PushAttitude = Callable[..., Rows]


@pytest.fixture
def session(qapp: object) -> Iterator[Session]:
    one = Session()
    yield one
    one.close()


@pytest.fixture
def settings_store(qapp: object) -> SettingsStore:
    return SettingsStore()


@pytest.fixture
def push_attitude(session: Session) -> PushAttitude:
    """Put one fused row into the session: ``quat`` and ``local`` (w, x, y, z), ``age_s``, and any other field."""

    def push(quat: Any = (1.0, 0.0, 0.0, 0.0), age_s: float = 0.0, **values: Any) -> Rows:
        rows = empty_rows(ATTITUDE, 1)
        rows["quat"] = rows["local"] = quat
        rows["t_arrival"] = time.perf_counter() - age_s
        for name, value in values.items():
            rows[name] = value
        session.attitude.push(rows)
        return rows

    return push


@pytest.fixture
def owned(qapp: object) -> Iterator[Callable[[Any], Any]]:
    """Close and delete a widget after the test: those that live on make every change of the scheme slower."""
    widgets: list[Any] = []

    def own(widget: Any) -> Any:
        widgets.append(widget)
        return widget

    yield own
    for widget in widgets:
        widget.close()
        widget.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete.value)


@pytest.fixture
def shown(qtbot: QtBot, owned: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Show a widget, close it after the test."""

    def show(widget: Any) -> Any:
        owned(widget).show()
        qtbot.waitExposed(widget)
        return widget

    return show

"""The spike mask on screen: chosen on the Signals and Live pages, its stretches shaded."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pytestqt.qtbot import QtBot

from imugui.samples import ATTITUDE, SAMPLE, empty_rows
from imugui.views import theme
from imugui.views.filter_panel import FilterPanel
from imugui.views.settings_store import SettingsStore
from imugui.views.signals_view import SignalsView
from imugui.workers.session import Session

N = 200


@pytest.fixture
def view(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> SignalsView:
    one = SignalsView(session, settings_store)
    one.resize(1180, 680)
    return shown(one)


def push(session: Session, status: Any, masked: Any = False) -> None:
    for dtype, ring in ((SAMPLE, session.samples), (ATTITUDE, session.attitude)):
        rows = empty_rows(dtype, N)
        rows["t"] = 0.01 * np.arange(N)
        rows["acc"], rows["gyr"], rows["status"] = (0.0, 0.0, 9.8), 0.0, status
        if dtype is ATTITUDE:
            rows["quat"] = rows["local"] = (1.0, 0.0, 0.0, 0.0)
            rows["masked"] = masked
        ring.push(rows)


def test_masked_stretches_are_shaded(session: Session, view: SignalsView) -> None:
    at = np.arange(N)
    push(session, at >= 50, (at >= 50) & (at < 53))
    view.scope.set_window(1.99)
    view.refresh()
    view.slow_refresh()
    columns = view.plots.frame.count
    ((start, end),) = view.plots.frame.bands
    assert (start, end) == pytest.approx((columns * 0.5 / 1.99, columns * 0.53 / 1.99), abs=2.0)
    picture, body = view.plots.grab().toImage(), view.plots.bodies()[0]
    cap = picture.pixelColor(round(body.x(0.5 * (start + end))), round(body.rect.top()) + 1)
    beside = picture.pixelColor(round(body.x(start)) - 8, round(body.rect.top()) + 1)
    assert cap == theme.tone_colour("warn")
    assert beside != cap


def test_the_mask_is_a_channel(session: Session, view: SignalsView) -> None:
    at = np.arange(N)
    push(session, 2 * (at >= 50), (at >= 50) & (at < 53))
    view.scope.choice.plots = {"button"}
    view.refresh()
    view.slow_refresh()
    curves = {one.label: one.strokes.extremes() for one in view.plots.frame.plots[0].curves}
    assert curves == {"status": (0.0, 2.0), "mask": (0.0, 1.0)}


def test_it_is_offered_where_there_is_a_button(session: Session, view: SignalsView) -> None:
    push(session, -1)
    view.refresh()
    view.slow_refresh()
    assert view.card.spikes.isHidden()
    assert view.plots.frame.bands == ()


def test_it_is_switched_and_kept(
    session: Session, settings_store: SettingsStore, view: SignalsView, owned: Any, qtbot: QtBot
) -> None:
    push(session, 0)
    view.refresh()
    view.slow_refresh()
    view.card.spikes.click()
    assert session.spike_mask
    assert session.fusion_settings["spike_mask"]
    assert settings_store.settings.spike_mask
    session.set_filter("mahony", None, False)
    assert session.spike_mask
    panel = owned(FilterPanel(session, settings_store))
    assert panel.spikes.isChecked()
    panel.spikes.click()
    view.slow_refresh()
    assert not session.spike_mask
    assert not view.card.spikes.isChecked()

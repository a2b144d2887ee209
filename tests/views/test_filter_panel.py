"""The filter's parameters on the Live page: live, remembered, following the session."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import pytest

from imugui.fusion import FILTERS
from imugui.views.filter_panel import FilterPanel
from imugui.views.filters import kept_params, use_filter
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session


@pytest.fixture
def panel(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> FilterPanel:
    one = shown(FilterPanel(session, settings_store))
    one.head.setChecked(True)
    return one


@pytest.mark.parametrize("name", FILTERS)
def test_every_filter_has_its_form(panel: FilterPanel, session: Session, name: str) -> None:
    session.set_filter(name)
    panel.refresh()
    assert FILTERS[name].title in panel.head.text()
    assert panel.form.value() == session.filter_params


def test_a_change_acts_at_once_and_is_kept(panel: FilterPanel, session: Session, settings_store: SettingsStore) -> None:
    session.set_filter("mahony")
    panel.refresh()
    panel.form.editor("kp").setValue(2.5)
    assert session.filter_params.kp == 2.5
    assert kept_params(settings_store, "mahony").kp == 2.5
    use_filter(session, settings_store, "complementary")
    use_filter(session, settings_store, "mahony")
    assert session.filter_params.kp == 2.5


def test_a_change_from_elsewhere_is_shown(panel: FilterPanel, session: Session) -> None:
    session.set_filter("mahony")
    panel.refresh()
    session.set_filter("mahony", dataclasses.replace(session.filter_params, kp=7.0))
    panel.refresh()
    assert panel.form.value().kp == 7.0


def test_magnetometer_on_and_off(panel: FilterPanel, session: Session, settings_store: SettingsStore) -> None:
    name = session.filter_name
    panel.mag.setChecked(False)
    assert session.use_mag is False
    assert settings_store.settings.use_mag is False
    assert session.filter_name == name
    panel.mag.setChecked(True)
    assert session.use_mag is True


def test_folds_away(panel: FilterPanel) -> None:
    assert panel.form.isVisible()
    panel.head.setChecked(False)
    assert not panel.form.isVisible()

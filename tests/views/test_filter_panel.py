"""The filter's parameters on the Live page: live, remembered, following the session."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtWidgets import QComboBox

from imugui.calibration.learnt import Learnt
from imugui.formats.families import Delays
from imugui.fusion import FILTERS
from imugui.views.filter_board_words import delays_words, learnt_words
from imugui.views.filter_panel import FilterPanel
from imugui.views.filters import kept_params, use_filter
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import BoardDelays, Session, Source


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


def connect(session: Session, source: Source) -> None:
    """As if this board were connected and had spoken."""
    session._know(source)
    session._follow_board(source.format)


def test_delays_are_the_boards_and_the_panel_says_so(panel: FilterPanel, session: Session, settings_store) -> None:
    session.set_filter("imugui")
    panel.refresh()
    assert not panel.board.delays.isVisible()
    connect(session, Source("serial", "/dev/no-such-port", "accel-lines"))
    panel.refresh()
    assert panel.board.delays.text() == (
        "Delays from the table: 5.9 and 1\u00a0ms (MPU-9250, low-pass of 41 Hz). "
        "A change holds for this board, and is kept with its profile."
    )
    assert panel.form.preset() == "Default"
    panel.form.editor("gyr_latency_ms").setValue(4.0)
    panel.refresh()
    assert session.filter_params.gyr_latency_ms == session.profile.delays_ms[0] == 4.0
    assert kept_params(settings_store, "imugui").gyr_latency_ms == 0.0
    assert panel.board.delays.text() == (
        "Delays as set for this board, kept with its profile. "
        "From the table: 5.9 and 1\u00a0ms (MPU-9250, low-pass of 41 Hz)."
    )
    assert panel.form.preset() == "Default"  # the others keep the board's delays too
    panel.board.reset.click()
    panel.refresh()
    assert panel.form.editor("gyr_latency_ms").value() == 5.9
    assert not panel.board.reset.isVisible()


def test_a_preset_leaves_the_boards_delays(panel: FilterPanel, session: Session) -> None:
    session.set_filter("imugui")
    connect(session, Source("serial", "/dev/no-such-port", "accel-lines"))
    panel.refresh()
    box = panel.form.findChild(QComboBox)
    box.setCurrentText("Vehicle")
    box.activated.emit(box.currentIndex())
    assert session.filter_params.bounded is False
    assert session.filter_params.gyr_latency_ms == 5.9
    assert session.delays.own is None


def test_what_is_learnt_is_shown_and_only_kept_when_it_may(panel: FilterPanel, session: Session, qtbot) -> None:
    assert not panel.board.learnt.isVisible()
    session.set_filter("imugui")
    session.connect_to(Source("simulator", "rest"))
    qtbot.waitUntil(lambda: session.status().samples > 100 and session.learnt() is not None)
    panel.refresh()
    assert "of 20 s so far" in panel.board.why_not.text()
    assert not panel.board.keep.isEnabled()
    assert session.profile is None


@pytest.mark.parametrize(
    ("scale", "across", "sigma", "words"),
    [
        (1.0288, 0.0112, 0.00373, "scale +2.9 %, misalignment 1.1 %, each ±0.4 %"),
        (0.9712, 0.0112, 0.016, "scale −3 %, misalignment 1 %, each ±2 %"),
        (1.0003, 0.0011, 0.004, "scale 0.0 %, misalignment 0.1 %, each ±0.4 %"),
        (0.99951, 0.00042, 0.00089, "scale −0.05 %, misalignment 0.04 %, each ±0.09 %"),
    ],
)
def test_only_digits_that_are_supported(scale: float, across: float, sigma: float, words: str) -> None:
    learnt = Learnt(matrix=((1.0, across, 0.0), (0.0, scale, 0.0), (0.0, 0.0, 1.0)), matrix_sigma=sigma)
    assert words in learnt_words(learnt).replace("\u00a0", " ")


def test_a_board_that_no_table_knows() -> None:
    assert delays_words(BoardDelays(), connected=False) == ""
    assert delays_words(BoardDelays(), connected=True).startswith("The table knows no delays of this board.")
    assert delays_words(BoardDelays(own=Delays(1.0, 2.0)), connected=True).endswith("The table does not know it.")

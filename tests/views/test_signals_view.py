"""The Signals page: rows in the rings, curves, numbers and words on screen."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from imugui.fusion.attitude import from_euler
from imugui.recording import read_samples
from imugui.samples import ATTITUDE, GRAVITY, SAMPLE, empty_rows
from imugui.views.settings_store import SettingsStore
from imugui.views.signal_frame import Curve, Plot
from imugui.views.signal_words import NO_CHANNEL, NO_PLOT, NO_ROWS, NOT_SENT, TOO_SHORT
from imugui.views.signals_view import SignalsView
from imugui.workers.session import Session, Source, State

Push = Callable[..., None]
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def push(session: Session) -> Push:
    """Put rows at the times ``t`` into both rings: level, at rest, other fields by name, raw ones as ``raw_...``."""

    def put(t: Any, **values: Any) -> None:
        for dtype, ring, mine in ((SAMPLE, session.samples, "raw_"), (ATTITUDE, session.attitude, "")):
            rows = empty_rows(dtype, len(t))
            rows["t"], rows["gyr"], rows["acc"] = t, 0.0, (0.0, 0.0, GRAVITY)
            for name, value in values.items():
                field = name.removeprefix(mine) if mine and name.startswith(mine) else name
                if field in (rows.dtype.names or ()) and (field == name or mine):
                    rows[field] = value
            if dtype is ATTITUDE:
                for name in ("quat", "local"):
                    rows[name] = values.get(name, (1.0, 0.0, 0.0, 0.0))
            ring.push(rows)

    return put


@pytest.fixture
def view(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> SignalsView:
    page = SignalsView(session, settings_store)
    page.resize(940, 566)
    return shown(page)


def show(view: SignalsView) -> None:
    view.slow_refresh()
    view.refresh()
    view.slow_refresh()


def plot(view: SignalsView, key: str) -> Plot:
    return next(one for one in view.plots.frame.plots if one.key == key)


def curve(view: SignalsView, key: str, label: str) -> Curve:
    return next(one for one in plot(view, key).curves if one.label == label)


def cells(view: SignalsView, key: str) -> tuple[str, ...]:
    return view.card.quantities[key.split(".")[0]].rows[key].cells.texts()


def test_without_a_source_the_page_says_what_it_will_show(view: SignalsView) -> None:
    show(view)
    assert view.empty.isVisible()
    assert not view.plots.isVisible()


def test_the_keys_go_to_what_is_in_front(view: SignalsView, push: Push) -> None:
    assert view.focusWidget() is view.empty.buttons()[0]
    push(np.arange(10) * 0.01)
    show(view)
    assert view.focusWidget() is view.plots


def test_curves_of_the_three_sensors(view: SignalsView, push: Push) -> None:
    t = np.arange(3000) * 0.005
    push(t, acc=np.column_stack((np.sin(t), np.cos(t), 0.0 * t)), gyr=(math.radians(90.0), 0.0, 0.0), mag=(20.0, 0, 0))
    show(view)
    assert not view.empty.isVisible()
    assert [one.key for one in view.plots.frame.plots] == ["acc", "gyr", "mag"]
    assert [one.label for one in plot(view, "acc").curves] == ["x", "y", "z"]
    assert curve(view, "acc", "x").strokes.extremes() == pytest.approx((-1.0, 1.0), abs=0.01)
    assert curve(view, "gyr", "x").strokes.extremes() == pytest.approx((90.0, 90.0))
    assert (plot(view, "acc").unit, plot(view, "gyr").unit, plot(view, "mag").unit) == ("m/s²", "°/s", "µT")
    assert plot(view, "gyr").range[1] > 90.0


def test_rows_that_come_are_drawn_and_nothing_is_drawn_without(view: SignalsView, push: Push) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    first = view.plots.frame
    view.refresh()
    assert view.plots.frame is first
    push(1.0 + np.arange(5) * 0.01)
    view.refresh()
    assert view.plots.frame is not first


def test_a_hidden_page_does_nothing_and_catches_up_when_shown(view: SignalsView, push: Push) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    view.hide()
    for block in range(1, 30):
        push(block + np.arange(100) * 0.01)
    assert len(view.scope.feed.raw) == 100
    view.show()
    show(view)
    assert len(view.scope.feed.raw) == len(view.scope.feed.corrected) == 3000
    assert curve(view, "acc", "z").strokes.marks[0, 0] < 1.0


def test_a_spike_is_seen_in_the_longest_window(view: SignalsView, push: Push) -> None:
    t = np.arange(16_000) * 0.0075
    acc = np.zeros((16_000, 3))
    acc[7777, 1] = 50.0
    push(t, acc=acc)
    view.scope.viewport.window_s = 120.0
    show(view)
    strokes = curve(view, "acc", "y").strokes
    assert strokes.dense
    assert strokes.extremes()[1] == 50.0
    image = view.plots.grab().toImage()
    body = view.plots.bodies()[0]
    x = int(body.x(strokes.marks[np.argmax(strokes.marks[:, 2]), 0]))
    green = [image.pixelColor(x, y).green() - image.pixelColor(x, y).red() for y in range(image.height())]
    assert sum(one > 80 for one in green) > 0.5 * body.rect.height()


def test_gaps_are_gaps(view: SignalsView, push: Push) -> None:
    push(np.concatenate((np.arange(400) * 0.005, 6.0 + np.arange(400) * 0.005)))
    show(view)
    xs = curve(view, "acc", "z").strokes.marks[:, 0] / view.plots.frame.count * 10.0
    assert not ((xs > 4.1) & (xs < 7.9)).any()  # the window is -2 to 8 s
    assert "1 gap" in view.card.foot.whole


def test_what_is_not_sent_is_said(view: SignalsView, push: Push) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    assert plot(view, "mag").note.lower() == NOT_SENT
    assert view.card.quantities["mag"].note.isVisible()
    assert not view.card.quantities["mag"].rows["mag.x"].isVisible()
    assert not view.card.quantities["acc"].note.isVisible()


def test_a_source_without_rows_is_waited_for(view: SignalsView) -> None:
    view._draw()
    assert {one.note for one in view.plots.frame.plots} == {NO_ROWS}


def test_choosing_plots_and_channels(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    push(np.arange(100) * 0.01, acc=(3.0, 0.0, 4.0))
    show(view)
    view.card.quantities["gyr"].box.click()
    view.card.quantities["euler"].box.click()
    view.card.quantities["acc"].rows["acc.norm"].box.click()
    assert [one.key for one in view.plots.frame.plots] == ["acc", "mag", "euler"]
    assert curve(view, "acc", "norm").strokes.extremes() == (5.0, 5.0)
    for key in ("acc.x", "acc.y", "acc.z", "acc.norm"):
        view.card.quantities["acc"].rows[key].box.click()
    assert plot(view, "acc").note == NO_CHANNEL
    for key in ("acc", "mag", "euler"):
        view.card.quantities[key].box.click()
    assert view.plots.frame.plots == ()
    assert view.plots.frame.note == NO_PLOT


def test_every_quantity_can_be_drawn(view: SignalsView, push: Push) -> None:
    t = np.arange(200) * 0.01
    quat = from_euler(3.0 * t, 0.2 * np.sin(t), 0.0 * t)
    push(t, mag=(20.0, 0.0, -40.0), temp_c=21.5, quat=quat, local=quat, status=1)
    show(view)
    for key, rows in view.card.quantities.items():
        if not rows.box.isChecked():
            rows.box.click()
        assert plot(view, key).note == ""
        assert all(len(one.strokes.marks) for one in plot(view, key).curves)
    assert curve(view, "interval", "interval").strokes.extremes() == pytest.approx((10.0, 10.0))
    assert plot(view, "temp").unit == "°C"
    assert plot(view, "euler").range == (-180.0, 180.0)
    assert not view.plots.grab().isNull()


def test_a_turning_board_draws_no_line_across_the_fold(view: SignalsView, push: Push) -> None:
    for rate in (20.0, 500.0):
        t = (1e4 if rate > 100 else 0.0) + np.arange(int(10 * rate)) / rate
        quat = from_euler(2.0 * t, 0.0 * t, 0.0 * t)
        push(t, quat=quat, local=quat)
        view.scope.choice.plots = {"euler"}
        show(view)
        strokes = curve(view, "euler", "yaw").strokes
        ends = strokes.marks[:, 1:3] if strokes.dense else strokes.marks[:, 1::2]
        assert strokes.dense is (rate > 100)
        assert np.abs(np.diff(ends, axis=1)).max() < 20.0
        assert strokes.extremes() == pytest.approx((-180.0, 180.0), abs=3.0)


def test_raw_and_corrected(view: SignalsView, push: Push) -> None:
    push(np.arange(100) * 0.01, acc=(1.0, 0.0, 0.0), raw_acc=(2.0, 0.0, 0.0))
    show(view)
    assert (plot(view, "acc").title, cells(view, "acc.x")) == ("Accelerometer, corrected", ("1.000",))
    view.card.data.setCurrentIndex(1)
    view.card.data.activated.emit(1)
    assert (plot(view, "acc").title, cells(view, "acc.x")) == ("Accelerometer, raw", ("2.000",))
    assert curve(view, "acc", "x").strokes.extremes() == (2.0, 2.0)


def test_units(view: SignalsView, push: Push) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    view.card.quantities["acc"].unit.click()
    assert plot(view, "acc").unit == "g"
    assert curve(view, "acc", "z").strokes.extremes() == pytest.approx((1.0, 1.0))
    assert cells(view, "acc.z") == ("1.0000",)
    assert not view.card.quantities["mag"].unit.isEnabled()


def test_the_display_convention(view: SignalsView, push: Push, settings_store: SettingsStore) -> None:
    push(np.arange(100) * 0.01)
    view.scope.choice.plots = {"euler"}
    show(view)
    assert cells(view, "euler.yaw") == ("0.00",)
    settings_store.update(convention="NED")
    show(view)
    assert cells(view, "euler.yaw") == ("90.00",)


def test_statistics_of_the_window(view: SignalsView, push: Push) -> None:
    t = np.arange(5000) * 0.004
    push(t, acc=np.column_stack((np.where(t < 9.9, 100.0, np.where(np.arange(5000) % 2, 1.0, 3.0)), 0 * t, 0 * t)))
    show(view)
    view.card.modes["statistics"].click()
    mean, sd, peak_to_peak, rms = (float(cell) for cell in cells(view, "acc.x"))
    assert (mean, sd, peak_to_peak, rms) == pytest.approx((2.0, 1.0, 2.0, math.sqrt(5.0)), rel=1e-3)
    assert view.card.foot.whole == "10.0 s, 2,501 samples, 250.0 Hz, no gaps"
    assert view.card.heads.texts() == ("mean", "SD", "p-p", "RMS")


def test_pausing_with_cursors(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    t = np.arange(2001) * 0.01
    push(t, acc=np.column_stack((2.0 * t, 0 * t, 0 * t)))
    show(view)
    qtbot.keyClick(view.plots, Qt.Key.Key_Space)
    assert view.card.state.text() == "Paused"
    assert view.controls.pause.text().strip() == "Resume"
    assert [one.name for one in view.plots.frame.cursors] == ["A", "B"]
    assert cells(view, "acc.x") == ("26.000", "34.000", "8.000", "2.000")
    assert view.card.foot.whole == "B − A is 4.000 s (0.250 Hz)"
    push(np.array([20.01]))
    view.refresh()
    assert view.scope.last_t == 20.0
    qtbot.keyClick(view.plots, Qt.Key.Key_B)
    qtbot.keyClick(view.plots, Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert cells(view, "acc.x")[1] == "34.200"
    qtbot.keyClick(view.plots, Qt.Key.Key_Space)
    view.refresh()
    assert view.plots.frame.cursors == ()
    assert view.scope.last_t == 20.01
    assert view.card.heads.texts() == ("newest",)


def test_cursors_by_mouse(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    push(np.arange(2001) * 0.01)
    show(view)
    view.toggle_pause()
    rect = view.plots.bodies()[1].rect
    qtbot.mouseClick(view.plots, LEFT, pos=(rect.topLeft() + 0.5 * (rect.bottomRight() - rect.topLeft())).toPoint())
    assert view.scope.cursors.times[0] == pytest.approx(15.0, abs=0.05)


def test_panning_pauses_and_shows_what_was(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    t = np.arange(4001) * 0.01
    push(t, acc=np.column_stack((t, 0 * t, 0 * t)))
    show(view)
    qtbot.keyClick(view.plots, Qt.Key.Key_PageUp)
    assert view.scope.held
    low, high = curve(view, "acc", "x").strokes.extremes()
    assert (low, high) == pytest.approx((25.0, 35.0), abs=0.1)
    assert view.plots.frame.ticks.words[0].startswith("−1")


def test_zooming_by_keys_buttons_and_list(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    seen = []
    for press in (
        lambda: qtbot.keyClick(view.plots, Qt.Key.Key_Plus),
        view.controls.longer.click,
        view.controls.shorter.click,
        lambda: qtbot.keyClick(view.plots, Qt.Key.Key_Minus),
        lambda: view.controls.window_chosen.emit(120.0),
    ):
        press()
        seen.append(view.scope.viewport.window_s)
        assert view.controls.window_box.currentData() == seen[-1]
    assert seen == [20.0, 30.0, 20.0, 10.0, 120.0]


def test_a_fixed_scale(view: SignalsView, push: Push) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    before = plot(view, "acc").range
    view.controls.scale.setCurrentIndex(1)
    view.controls.scale.activated.emit(1)
    push(1.0 + np.arange(10) * 0.01, acc=(90.0, 0.0, 0.0))
    show(view)
    assert plot(view, "acc").range == before
    fields = view.card.quantities["acc"].range
    assert fields.isVisible()
    fields.high.setValue(200.0)
    assert plot(view, "acc").range == (before[0], 200.0)
    fields.low.setValue(300.0)  # above the upper end: not taken
    assert plot(view, "acc").range == (before[0], 200.0)
    view.fit_scales()
    assert plot(view, "acc").range != (before[0], 200.0)
    view.controls.fixed_chosen.emit(False)
    assert not fields.isVisible()


def test_the_spectrum_shows_a_known_sine(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    t = np.arange(4000) / 200.0
    push(t, gyr=np.column_stack((np.radians(30.0 * np.sin(2 * np.pi * 35.0 * t)), 0 * t, 0 * t)))
    show(view)
    view.toggle_spectrum()
    assert plot(view, "gyr").unit == "°/s/√Hz"
    for _ in range(10):
        view.refresh()
    view.slow_refresh()
    frequency, rms, _ = cells(view, "gyr.x")
    assert float(frequency) == pytest.approx(35.0, abs=0.05)
    assert float(rms) == pytest.approx(30.0 / math.sqrt(2.0), rel=0.01)
    strokes = curve(view, "gyr", "x").strokes
    x = strokes.marks[np.argmax(strokes.marks[:, 1]), 0] / view.plots.frame.count * 100.0
    assert x == pytest.approx(35.0, abs=0.5)
    assert plot(view, "mag").note.lower() == NOT_SENT
    assert view.plots.frame.ticks.words[-1] == "100 Hz"
    view.toggle_spectrum()
    assert plot(view, "gyr").unit == "°/s"
    assert view.card.heads.texts() == ("newest",)


def test_a_spectrum_needs_enough_samples(view: SignalsView, push: Push) -> None:
    push(np.arange(20) * 0.01)
    show(view)
    view.toggle_spectrum()
    for _ in range(10):
        view.refresh()
    assert plot(view, "acc").note == TOO_SHORT
    assert view.card.foot.whole == TOO_SHORT


def test_a_held_spectrum_is_computed_once(view: SignalsView, push: Push) -> None:
    push(np.arange(1000) * 0.01)
    show(view)
    view.toggle_spectrum()
    view.toggle_pause()
    for _ in range(12):
        view.refresh()
    frame = view.plots.frame
    view.refresh()
    assert view.plots.frame is frame


def test_the_picture_goes_to_the_clipboard(view: SignalsView, push: Push, qtbot: QtBot) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    with qtbot.waitSignal(view.session.message):
        view.card.copy.click()
    assert QGuiApplication.clipboard().pixmap().size() == view.plots.grab().size()


def test_the_data_on_screen_are_exported(
    view: SignalsView, push: Push, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    push(np.arange(2000) * 0.01, gyr=(math.radians(30.0), 0.0, 0.0), mag=(20.0, 0.0, 0.0))
    show(view)
    path = tmp_path / "some.csv"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
    with qtbot.waitSignal(view.export.ended), qtbot.waitSignal(view.session.message) as said:
        view.card.export.click()
    assert said.args[0] == "info"
    lines = path.read_text(encoding="utf-8").splitlines()
    header = [line for line in lines if line.startswith("#")]
    assert any(line == "# sensor data: corrected" for line in header)
    assert lines[len(header)].split(",")[:5] == ["t_s", "acc_x_m/s2", "acc_y_m/s2", "acc_z_m/s2", "gyr_x_deg/s"]
    assert len(lines) - len(header) - 1 in (1000, 1001)
    assert list(tmp_path.iterdir()) == [path]
    rows = read_samples(path).rows
    assert rows["gyr"][0] == pytest.approx((math.radians(30.0), 0.0, 0.0))


def test_an_export_that_fails_says_why(view: SignalsView, push: Push, qtbot: QtBot, tmp_path: Path) -> None:
    push(np.arange(100) * 0.01)
    show(view)
    missing = tmp_path / "nowhere" / "some.csv"
    with qtbot.waitSignal(view.session.message) as said:
        view.export.write(missing, view.export_table(), {})
    assert said.args[0] == "error"
    assert "could not be written" in said.args[1]


def test_an_export_can_be_cancelled(view: SignalsView, push: Push, qtbot: QtBot, tmp_path: Path) -> None:
    push(np.arange(10_000) * 0.001)
    show(view)
    with qtbot.waitSignal(view.export.ended):
        view.export.write(tmp_path / "some.csv", view.export_table(), {})
        assert view.export.busy
        view.export_data()
    assert not view.export.busy
    view.export.stop()
    assert list(tmp_path.iterdir()) == []


def test_live_data_and_a_stalled_source(view: SignalsView, session: Session, qtbot: QtBot) -> None:
    session.connect_to(Source("simulator", "free"))
    qtbot.waitUntil(lambda: session.status().state is State.STREAMING and session.attitude.count > 50)
    show(view)
    assert (view.card.state.tone, view.card.state.text()) == ("good", "Live")
    assert len(curve(view, "acc", "z").strokes.marks) > 0
    session.disconnect_source()
    show(view)
    assert (view.card.state.tone, view.card.state.text()) == ("neutral", State.IDLE.word)
    assert view.plots.isVisible()  # what was received can still be looked at


def test_a_new_connection_from_an_earlier_time_starts_anew(view: SignalsView, push: Push) -> None:
    push(100.0 + np.arange(100) * 0.01)
    show(view)
    push(1.0 + np.arange(50) * 0.01)
    show(view)
    assert view.scope.feed.raw.first_t == 1.0
    assert len(view.scope.feed.corrected) == 50

"""A recording fused again with another filter, beside the first."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from imugui.formats.csv_line import CsvLineEncoder
from imugui.samples import SAMPLE, empty_rows
from imugui.views.compare_plots import ANGLES, DIFFERENCE
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source


@pytest.fixture
def window(
    session: Session, settings_store: SettingsStore, tmp_path: Path, shown: Callable[[Any], Any], qtbot: QtBot
) -> Iterator[MainWindow]:
    rows = empty_rows(SAMPLE, 6000)
    rows["t"] = np.arange(len(rows)) / 100.0
    rows["acc"], rows["mag"] = (0.0, 0.0, 9.81), (0.0, 20.0, -43.0)
    rows["mag"][::2, 0] += 0.1  # a field that only repeats itself is no measurement
    rows["gyr"] = (0.0, 0.0, 0.05)
    encoder = CsvLineEncoder()
    (tmp_path / "run.csv").write_bytes(encoder.preamble() + encoder.encode(rows))
    session.set_filter("madgwick")
    one = shown(MainWindow(session, settings_store))
    session.connect_to(Source("replay", str(tmp_path / "run.csv")))
    qtbot.waitUntil(lambda: session.player is not None and session.attitude.count > 5)
    one.slow_refresh()
    yield one
    one.close()


def compute(window: MainWindow, qtbot: QtBot, name: str, use_mag: bool = True) -> None:
    compare = window.compare
    window.show_compare()
    row = compare.filter.findData(name)
    compare.filter.setCurrentIndex(row)
    compare.filter.activated.emit(row)
    compare.mag.setChecked(use_mag)
    qtbot.mouseClick(compare.button, Qt.MouseButton.LeftButton)
    assert compare.button.text().strip() == "Cancel"
    qtbot.waitUntil(lambda: compare.comparison is not None)


def test_nothing_to_compare_without_a_replay(window: MainWindow) -> None:
    window.session.disconnect_source()
    window.show_compare()
    assert not window.compare.button.isEnabled()
    assert "Open a recording" in window.compare.button.toolTip()


def test_the_same_filter_differs_by_nothing(window: MainWindow, qtbot: QtBot) -> None:
    compute(window, qtbot, "madgwick")
    assert not window.compare.comparison.difference_deg.any()
    assert "mean 0.00°" in window.compare.words.text()


def test_another_filter_is_overlaid_with_the_angle_between(window: MainWindow, qtbot: QtBot) -> None:
    compute(window, qtbot, "complementary", use_mag=False)
    found = window.compare.comparison
    # with a magnetometer the board does not turn, without it turns by 0.05 rad/s
    assert found.difference_deg[-1] > 30.0
    assert found.tilt_deg.max() < 1.0
    plots = window.compare.plots
    for name in (*ANGLES, DIFFERENCE):
        assert all(len(curve.getData()[0]) > 100 for curve in plots.curves[name])
    assert plots.curves[DIFFERENCE][0].getData()[1].max() == pytest.approx(found.difference_deg.max())
    whole, _ = found.figures()
    assert f"largest {whole.largest:.2f}°" in window.compare.words.text()


def test_cursor_and_ghost_follow_the_replay(window: MainWindow, qtbot: QtBot) -> None:
    window.session.player.pause()
    compute(window, qtbot, "complementary", use_mag=False)
    window.replay.seek(30.0)
    qtbot.waitUntil(lambda: not window.session.player.playing)
    window.refresh()
    position = window.session.player.position_s
    assert window.compare.plots._cursors[0].value() == pytest.approx(position)
    scene = window.pages["live"].scene
    assert scene._ghost is not None
    window.refresh()
    window.compare.close()
    window.refresh()
    assert scene._ghost is None


def test_cancel(window: MainWindow, qtbot: QtBot) -> None:
    window.show_compare()
    window.compare.compute()
    window.compare.compute()
    assert window.compare.words.text() == "Cancelled."
    assert window.compare.button.text().strip() == "Compute"
    assert window.compare.comparison is None


def test_another_source_forgets_the_comparison(window: MainWindow, qtbot: QtBot) -> None:
    compute(window, qtbot, "mahony")
    window.session.connect_to(Source("simulator", "rest"))
    window.slow_refresh()
    assert window.compare.comparison is None

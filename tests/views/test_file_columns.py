"""Opening files: at once, after a question, or as it was said before of the file or of its like."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtWidgets import QFileDialog
from pytestqt.qtbot import QtBot

from imugui.views.boards import bare_lines, keep_options, kept_options
from imugui.views.column_map_dialog import ColumnMapDialog
from imugui.views.file_columns import NOTHING_SAID, FileColumns
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Options, Session, State

SAMPLES = Path(__file__).resolve().parent.parent / "data"
UNSURE = "ax,ay,az,gx,gy,gz\n" + "0,0,1,0,0,0.1\n" * 200


@pytest.fixture
def files(settings_store: SettingsStore) -> FileColumns:
    return FileColumns(settings_store)


@pytest.fixture
def window(session: Session, settings_store: SettingsStore, shown: Callable[[Any], Any]) -> MainWindow:
    return shown(MainWindow(session, settings_store))


def unsure(path: Path, text: str = UNSURE) -> Path:
    path.write_text(text)
    return path


def streaming(window: MainWindow) -> Callable[[], bool]:
    return lambda: window.session.status().state in (State.STREAMING, State.ENDED)


def test_what_is_sure_is_opened_and_what_is_assumed_is_said(files: FileColumns) -> None:
    assert files.opening(str(SAMPLES / "phyphox/Gyroscope.csv"), NOTHING_SAID).words == ""
    opening = files.opening(str(SAMPLES / "x-imu3/Inertial.csv"), NOTHING_SAID)
    assert not opening.asks
    assert "arbitrary units" in opening.words


def test_what_is_unsure_is_asked_unless_it_was_said(files: FileColumns, tmp_path: Path) -> None:
    path = unsure(tmp_path / "a.csv")
    assert files.opening(str(path), NOTHING_SAID).asks
    said = Options(columns=("ax", "ay", "az", "gx", "gy", "gz"))
    opening = files.opening(str(path), said)
    assert (opening.asks, opening.options) == (False, said)


def test_a_file_without_an_attitude_is_opened_with_a_warning(files: FileColumns, data_dir: Path) -> None:
    opening = files.opening(str(data_dir / "boards/lines-magnetometer-unique.csv"), NOTHING_SAID)
    assert (opening.asks, opening.tone) == (False, "warn")
    assert "no accelerometer and no gyroscope" in opening.words
    assert files.opening(str(SAMPLES / "phyphox"), NOTHING_SAID).tone == "info"


@pytest.mark.parametrize("name", ["missing.csv", "fifo", "noise.bin"])
def test_what_cannot_be_read_is_left_to_the_session(files: FileColumns, tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    if name == "fifo":
        os.mkfifo(path)  # reading it would wait for ever
    elif name == "noise.bin":
        path.write_bytes(bytes(range(256)) * 100)
    assert not files.opening(str(path), NOTHING_SAID).asks


def test_files_picked_together_are_read_together(files: FileColumns, tmp_path: Path) -> None:
    for name, new in (("Gyroscope", "first"), ("Accelerometer", "second")):
        shutil.copy(SAMPLES / f"phyphox/{name}.csv", tmp_path / f"{new}.csv")
    paths = [str(tmp_path / "first.csv"), str(tmp_path / "second.csv")]
    assert len(files.guess(paths[0]).used) == 1
    files.pick(paths)
    assert {table.file for table in files.opening(paths[0], NOTHING_SAID).options.tables} == {"first.csv", "second.csv"}


def test_a_header_seen_before_is_not_asked_about_again(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    window.bar.connect_to("replay", str(unsure(tmp_path / "one.csv")))
    dialog = window.findChild(ColumnMapDialog)
    assert window.session.source is None
    dialog.rate.setValue(200.0)
    dialog.accept()
    qtbot.waitUntil(streaming(window))
    qtbot.waitUntil(lambda: window.session.samples.count > 1)
    assert np.diff(window.session.samples.last(2)["t"]) == pytest.approx(1 / 200.0)
    window.bar.connect_to("replay", str(unsure(tmp_path / "two.csv")))
    assert window.session.source is not None
    assert window.session.source.address == str(tmp_path / "two.csv")
    assert window.session.source.options.tables[0].rate_hz == 200.0
    assert "as you named them" in window.banner.text()


def test_a_header_seen_before_with_other_units_is_asked_about(files: FileColumns, tmp_path: Path) -> None:
    one = unsure(tmp_path / "one.csv")
    files.keep(str(one), Options(tables=files.guess(str(one)).maps))
    assert not files.opening(str(unsure(tmp_path / "two.csv")), NOTHING_SAID).asks
    raw = unsure(tmp_path / "raw.csv", UNSURE.replace("0,0,1,", "0,0,16384,"))
    assert files.opening(str(raw), NOTHING_SAID).asks


def test_a_question_while_another_file_is_played_is_about_the_new_one(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    window.bar.connect_to("replay", str(SAMPLES / "matlab-writetable.csv"))
    qtbot.waitUntil(streaming(window))
    window.bar.connect_to("replay", str(unsure(tmp_path / "a.csv")))
    window.slow_refresh()
    window.findChild(ColumnMapDialog).accept()
    assert window.session.source.address == str(tmp_path / "a.csv")
    qtbot.waitUntil(streaming(window))


def test_a_question_that_is_cancelled_opens_nothing(window: MainWindow, tmp_path: Path) -> None:
    window.bar.connect_to("replay", str(unsure(tmp_path / "a.csv")))
    window.findChild(ColumnMapDialog).reject()
    assert window.session.source is None


def test_several_files_are_picked_in_one_go(window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = [str(SAMPLES / f"phyphox/{name}.csv") for name in ("Accelerometer", "Gyroscope")]
    monkeypatch.setattr(QFileDialog, "getOpenFileNames", lambda *_: (paths, ""))
    window.open_recording()
    qtbot.waitUntil(streaming(window))
    assert len(window.session.source.options.tables) == 2
    qtbot.waitUntil(lambda: window.session.samples.count > 0)
    assert window.session.samples.last(1)["mag"][0] != pytest.approx(0.0)


def test_a_format_that_the_user_chose_is_not_second_guessed(window: MainWindow, tmp_path: Path) -> None:
    window.bar.format.choose("triplets")
    window.bar.connect_to("replay", str(unsure(tmp_path / "a.csv")))
    assert window.findChild(ColumnMapDialog) is None
    assert window.session.source.format == "triplets"


def test_a_file_that_is_no_table_has_no_columns_to_name(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "prose.txt"
    path.write_text("lorem ipsum\n" * 20)
    window.bar.connect_to("replay", str(path))
    qtbot.waitUntil(lambda: window.session.status().state is State.FAILED)
    assert "no lines of numbers" in window.session.status().sentence
    window.name_columns()
    assert "There are no columns to name" in window.banner.text()


def test_what_was_said_comes_back_and_nonsense_does_not(settings_store: SettingsStore, files: FileColumns) -> None:
    said = Options("aligned", tables=files.guess(str(SAMPLES / "phyphox")).maps)
    keep_options(settings_store, "replay x", said)
    assert kept_options(settings_store, "replay x") == said
    for tables in (3, "x", [1], [{"columns": ["ax"]}], [said.tables[0].to_json(), {"columns": 3}]):
        settings_store.keep_board("replay x", {"tables": tables})
        assert kept_options(settings_store, "replay x") == Options()


def test_lines_are_found_behind_the_reason_in_the_log() -> None:
    texts = ["numbers without a header line: name the columns: 1.5,-2,3e-1", "GO", "malformed: 7;8", "  1\t2\t3"]
    assert bare_lines(texts) == ["1.5,-2,3e-1", "1\t2\t3"]

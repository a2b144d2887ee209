"""The dialog for the columns of a file or a board: guesses with reasons, a live preview, OK only when it can work."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialogButtonBox
from pytestqt.qtbot import QtBot

from imugui.formats import FORMATS
from imugui.formats.layout import TableError
from imugui.formats.table import read_table
from imugui.samples import GRAVITY
from imugui.views import theme
from imugui.views.column_asking import dialog_for_board, dialog_for_file
from imugui.views.column_map_dialog import ColumnMapDialog
from imugui.views.column_words import LEVEL_WORDS, ROLES, unit_title, units_of
from imugui.views.file_columns import FileColumns
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Options

SAMPLES = Path(__file__).resolve().parent.parent / "data"
LINES = ("1000,0.01,-0.02,1.00,0.5,0.6,0.7", "1010,0.02,-0.03,0.99,0.5,0.6,0.7", "1020,0.02,-0.03,0.99,0.5,0.6,0.7")
Show = Callable[[Any], Any]


@pytest.fixture
def files(settings_store: SettingsStore) -> FileColumns:
    return FileColumns(settings_store)


@pytest.fixture
def matlab(files: FileColumns, shown: Show) -> ColumnMapDialog:
    return shown(dialog_for_file(files, str(SAMPLES / "matlab-writetable.csv"), Options()))


def ok(dialog: ColumnMapDialog) -> Any:
    return dialog.findChild(QDialogButtonBox).button(QDialogButtonBox.StandardButton.Ok)


def slots(dialog: ColumnMapDialog, table: int = 0) -> list[str]:
    return [card.role.currentData() for card in dialog.tables[table].cards]


def units(dialog: ColumnMapDialog) -> list[str]:
    return [card.unit.unit() for card in dialog.tables[0].cards]


def found(dialog: ColumnMapDialog) -> str:
    return "\n".join(label.text() for label in dialog.preview.findings)


def test_guesses_stand_above_the_columns_with_their_reasons(matlab: ColumnMapDialog) -> None:
    assert slots(matlab) == ["t", "ax", "ay", "az", "gx", "gy", "gz", "mx", "my", "mz"]
    assert units(matlab)[:8] == ["s", "g", "g", "g", "deg/s", "deg/s", "deg/s", "uT"]
    card = matlab.tables[0].cards[1]
    assert card.mark.text() == "✓ sure"
    assert "gravity reads 9.79 m/s2: right" in card.role.toolTip()
    assert (matlab.chip.tone, ok(matlab).isEnabled()) == ("good", True)


def test_the_preview_shows_what_comes_out(matlab: ColumnMapDialog) -> None:
    assert "gravity reads 9.79 m/s²: right" in found(matlab)
    assert "50 rows a second" in found(matlab)
    first = [label.text() for label in matlab.preview.samples[0]]
    assert first[0] == "0.0000"
    assert first[1].split()[2] == "+9.80"
    turning = np.loadtxt(SAMPLES / "matlab-writetable.csv", delimiter=",", skiprows=1)[:, 4:7]  # in deg/s
    assert matlab.preview.curve.values == pytest.approx(np.linalg.norm(turning, axis=1))


def test_another_unit_is_taken_for_all_axes_and_judged_at_once(matlab: ColumnMapDialog) -> None:
    matlab.tables[0].cards[4].unit.choose_unit("rad/s")
    assert units(matlab)[4:7] == ["rad/s"] * 3
    assert matlab.tables[0].cards[6].mark.text() == "✓ as you say"
    assert "times too fast" in found(matlab)
    assert matlab.chip.tone == "warn"
    assert ok(matlab).isEnabled()
    assert matlab.options().tables[0].columns[4:7] == ("gx_rad/s", "gy_rad/s", "gz_rad/s")


def test_what_cannot_work_is_said_and_cannot_be_used(matlab: ColumnMapDialog) -> None:
    card = matlab.tables[0].cards[3]
    card.role.choose("")
    assert "No column for az" in matlab.verdict.text()
    assert (matlab.chip.tone, ok(matlab).isEnabled()) == ("bad", False)
    card.role.choose("ax")
    assert "Acceleration x is said of two columns" in matlab.verdict.text()
    card.role.choose("az")
    assert card.unit.unit() == "g"
    assert ok(matlab).isEnabled()


def test_a_column_takes_the_unit_of_its_sensor(matlab: ColumnMapDialog) -> None:
    card = matlab.tables[0].cards[7]
    card.role.choose("temp_c")
    assert card.unit.unit() == "C"
    card.role.choose("status")
    assert not card.unit.isEnabled()
    assert card.unit.unit() == ""


def test_a_unit_can_be_typed(matlab: ColumnMapDialog, qtbot: QtBot) -> None:
    box = matlab.tables[0].cards[1].unit
    row = box.count() - 1
    box.setCurrentIndex(row)
    box.activated.emit(row)
    edit = box.lineEdit()
    edit.setText("g/1.5")
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert units(matlab)[1:4] == ["g/1.5"] * 3
    assert "should be" in found(matlab) or "moved" in found(matlab)
    box.activated.emit(box.count() - 1)
    box.lineEdit().setText("furlong")
    qtbot.keyClick(box.lineEdit(), Qt.Key.Key_Return)
    assert box.unit() == "g/1.5"
    assert not box.isEditable()


def test_files_that_belong_together_have_a_tab_each(files: FileColumns, shown: Show, qtbot: QtBot) -> None:
    path = SAMPLES / "phyphox-semicolon/Gyroscope.csv"
    dialog = shown(dialog_for_file(files, str(path), Options()))
    assert [dialog.tabs.tabText(k) for k in range(3)] == ["Gyroscope.csv", "Accelerometer.csv", "Magnetometer.csv"]
    with qtbot.waitSignal(dialog.named) as named:
        qtbot.mouseClick(ok(dialog), Qt.MouseButton.LeftButton)
    rows, _ = read_table(path, named.args[0].tables)
    assert len(rows) == 200
    assert np.median(np.linalg.norm(rows["acc"], axis=1)) == pytest.approx(GRAVITY, rel=0.01)


def test_the_same_sensor_in_two_files_is_said(files: FileColumns, shown: Show) -> None:
    dialog = shown(dialog_for_file(files, str(SAMPLES / "sensor-logger-iphone/Gyroscope.csv"), Options()))
    place = [table.table.file for table in dialog.tables].index("Accelerometer.csv")
    for card, slot in zip(dialog.tables[place].cards[2:], ("az", "ay", "ax"), strict=True):
        card.role.choose(slot)
    assert "is said in AccelerometerUncalibrated.csv and in Accelerometer.csv" in dialog.verdict.text() or (
        "is said in Accelerometer.csv and in AccelerometerUncalibrated.csv" in dialog.verdict.text()
    )
    assert not ok(dialog).isEnabled()


def test_a_rate_is_asked_for_where_there_are_no_times(files: FileColumns, shown: Show, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps\n" + "0,0,1,0,0,0.1\n" * 40)
    dialog = shown(dialog_for_file(files, str(path), Options()))
    assert dialog.rate.isVisible()
    assert "the rate" in dialog.verdict.text()
    dialog.rate.setValue(140.0)
    assert "140 rows a second, as you say" in found(dialog)
    assert dialog.options().tables[0].rate_hz == 140.0
    dialog.tables[0].cards[0].role.choose("t")
    assert not dialog.rate.isVisible()


def test_lines_of_one_kind_can_be_kept(files: FileColumns, shown: Show, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text("".join(f"1 20.{k % 7} -3.5 -40\n2 499.{k % 5} 500.5 1\n" for k in range(40)))
    dialog = shown(dialog_for_file(files, str(path), Options()))
    assert dialog.keep.isVisible()
    assert len(dialog.maps()) == 1
    assert (dialog.maps()[0][1].keep_column, dialog.maps()[0][1].keep_value) == (0, 1.0)
    dialog.keep.setCurrentIndex(2)
    assert dialog.options().tables[0].keep_value == 2.0
    assert "not the earth's" in found(dialog)


def test_what_was_said_before_is_shown_again(files: FileColumns, shown: Show) -> None:
    path = str(SAMPLES / "matlab-writetable.csv")
    first = shown(dialog_for_file(files, path, Options()))
    first.tables[0].cards[4].unit.choose_unit("dps/131")
    first.tables[0].cards[9].role.choose("")
    first.tables[0].cards[8].role.choose("")
    first.tables[0].cards[7].role.choose("status")
    again = shown(dialog_for_file(files, path, first.options()))
    assert again.options() == first.options()
    assert "as you said before" in again.tables[0].cards[4].role.toolTip()


def test_a_boards_lines_are_named_with_whole_samples_only(shown: Show) -> None:
    dialog = shown(dialog_for_board(LINES, "ttyUSB0", Options()))
    assert slots(dialog) == ["t", "ax", "ay", "az", "gx", "gy", "gz"]
    assert not dialog.rate.isVisible()
    options = dialog.options()
    decoder = FORMATS["csv-line"].decoder(options)
    rows = decoder.feed(("\n".join(LINES) + "\n").encode(), 0.0)
    assert rows["acc"][-1, 2] == pytest.approx(0.99 * GRAVITY)
    for card in dialog.tables[0].cards[4:]:
        card.role.choose("")
    assert "No column for gx, gy, gz" in dialog.verdict.text()
    assert not ok(dialog).isEnabled()


def test_a_board_that_was_named_before_keeps_its_names(shown: Show) -> None:
    said = Options("mpu9250", ("t_ms", "ax_g", "ay_g", "az_g", "gx_dps", "gy_dps/2", "gz_dps"))
    dialog = shown(dialog_for_board(LINES, "ttyUSB0", said))
    assert units(dialog) == ["ms", "g", "g", "g", "deg/s", "dps/2", "deg/s"]
    assert dialog.family.currentData() == "mpu9250"


def test_without_lines_there_is_nothing_to_name() -> None:
    with pytest.raises(TableError):
        dialog_for_board((), "ttyUSB0", Options())


def test_cancel_says_nothing(matlab: ColumnMapDialog, qtbot: QtBot) -> None:
    with qtbot.assertNotEmitted(matlab.named):
        qtbot.keyClick(matlab, Qt.Key.Key_Escape)


def test_every_box_is_reached_with_the_tab_key_and_brought_into_view(
    files: FileColumns, shown: Show, data_dir: Path, qtbot: QtBot
) -> None:
    dialog = shown(dialog_for_file(files, str(data_dir / "gnss/car_50hz_gnss10hz.csv"), Options()))
    table = dialog.tables[0]
    table.cards[0].role.setFocus()
    seen = set()
    for _ in range(60):
        seen.add(dialog.focusWidget())
        qtbot.keyClick(dialog.focusWidget(), Qt.Key.Key_Tab)
    reachable = {box for card in table.cards for box in (card.role, card.unit) if box.isEnabled()}
    assert reachable <= seen
    table.cards[-2].role.setFocus()
    qtbot.keyClick(dialog.focusWidget(), Qt.Key.Key_Tab)
    qtbot.keyClick(dialog.focusWidget(), Qt.Key.Key_Tab)
    assert not dialog.focusWidget().visibleRegion().isEmpty()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_curve_and_the_marks_are_seen_in_both_schemes(matlab: ColumnMapDialog, qapp: Any, scheme: str) -> None:
    theme.apply(qapp, scheme)
    picture = matlab.preview.curve.grab().toImage()
    drawn = {picture.pixelColor(x, y).name() for x in range(picture.width()) for y in range(picture.height())}
    assert theme.palette().accent.name() in drawn
    theme.apply(qapp, "light")


def test_every_role_and_unit_has_words() -> None:
    assert all(ROLES.values())
    assert all(unit_title(unit) for slot in ROLES for unit in units_of(slot))
    assert len(set(ROLES.values())) == len(ROLES)
    assert [tone for tone, _ in LEVEL_WORDS.values()] == ["good", "neutral", "warn"]


def test_the_dialog_fits_a_small_screen(files: FileColumns, shown: Show, data_dir: Path) -> None:
    for name in (
        "boards/lines-magnetometer-raw-and-calibrated.txt",
        "calibration/mpu6050_hmc5883l_full_sphere_imu.csv",
    ):
        dialog = shown(dialog_for_file(files, str(data_dir / name), Options()))
        assert dialog.minimumSizeHint().width() <= 1024
        assert dialog.minimumSizeHint().height() <= 680

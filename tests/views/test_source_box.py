"""The list of sources: headings, ports that come and go, typed addresses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from imugui.simulation import MOTION_TITLES
from imugui.views.source_box import OPEN_FILE, TYPE_ADDRESS, SourceBox
from imugui.workers.session import Port

ACM = Port("/dev/ttyACM0", "Arduino Uno", "Arduino Uno")
USB = Port("/dev/ttyUSB0", "USB Serial", "CH340, on many Arduino Nano copies")


@pytest.fixture
def box(shown: Callable[[Any], Any]) -> SourceBox:
    return shown(SourceBox())


def addresses(box: SourceBox, transport: str) -> list[str]:
    return [choice.address for choice in box.choices() if choice.transport == transport]


def pick(box: SourceBox, text: str) -> None:
    """Choose an entry as a click in the list does."""
    row = box.findText(text)
    box.setCurrentIndex(row)
    box.activated.emit(row)


def test_every_motion_and_port_is_offered(box: SourceBox) -> None:
    box.show_ports([ACM, USB])
    assert addresses(box, "simulator") == list(MOTION_TITLES)
    assert addresses(box, "serial") == [ACM.device, USB.device, ""]
    assert addresses(box, "replay") == [""]
    assert "CH340" in box.itemText(box.findText(USB.device, Qt.MatchFlag.MatchStartsWith))


def test_headings_cannot_be_chosen(box: SourceBox) -> None:
    headings = [row for row in range(box.count()) if box.itemData(row) is None]
    assert len(headings) == 3
    assert all(box.model().flags(box.model().index(row, 0)) == Qt.ItemFlag.NoItemFlags for row in headings)


def test_the_choice_outlives_new_ports_and_the_loss_of_its_own(box: SourceBox) -> None:
    box.show_ports([ACM, USB])
    box.choose_source("serial", USB.device)
    box.show_ports([ACM])
    assert box.choice().address == USB.device
    assert box.currentData().address == USB.device
    box.show_ports([ACM, USB])
    assert addresses(box, "serial") == [ACM.device, USB.device, ""]


def test_an_open_list_is_not_changed_under_the_pointer(box: SourceBox, qtbot: QtBot) -> None:
    box.showPopup()
    qtbot.waitUntil(box.view().isVisible)
    box.show_ports([ACM])
    assert ACM.device not in addresses(box, "serial")
    box.hidePopup()
    qtbot.waitUntil(lambda: ACM.device in addresses(box, "serial"))


def test_what_is_clicked_is_chosen_though_the_list_is_renewed(box: SourceBox, qtbot: QtBot) -> None:
    box.show_ports([USB])
    box.showPopup()
    qtbot.waitUntil(box.view().isVisible)
    box.show_ports([ACM, USB])
    index = box.model().index(box.findText(USB.device, Qt.MatchFlag.MatchStartsWith), 0)
    qtbot.mouseClick(box.view().viewport(), Qt.MouseButton.LeftButton, pos=box.view().visualRect(index).center())
    assert box.choice().address == USB.device
    qtbot.waitUntil(lambda: addresses(box, "serial") == [ACM.device, USB.device, ""])
    assert box.currentData().address == USB.device


def test_an_address_is_typed(box: SourceBox, qtbot: QtBot) -> None:
    pick(box, TYPE_ADDRESS.text)
    assert box.isEditable()
    box.show_ports([ACM])
    with qtbot.waitSignal(box.picked):
        qtbot.keyClicks(box.lineEdit(), "socket://10.0.0.5:9000")
        qtbot.keyClick(box.lineEdit(), Qt.Key.Key_Return)
    assert not box.isEditable()
    assert box.choice().key == ("serial", "socket://10.0.0.5:9000")
    box.choose_source("simulator", "rest")
    assert "socket://10.0.0.5:9000" in addresses(box, "serial")


@pytest.mark.parametrize("key", [Qt.Key.Key_Escape, Qt.Key.Key_Return])
def test_typing_nothing_keeps_the_choice(box: SourceBox, qtbot: QtBot, key: Qt.Key) -> None:
    before = box.choice()
    pick(box, TYPE_ADDRESS.text)
    qtbot.keyClick(box.lineEdit(), key)
    assert not box.isEditable()
    assert box.choice() == before
    assert box.currentData().key == before.key


def test_files_are_remembered_newest_first(box: SourceBox) -> None:
    for name in "abcdef":
        box.choose_source("replay", f"/data/{name}.csv")
    assert addresses(box, "replay") == [f"/data/{name}.csv" for name in "fedc"] + [""]
    assert box.choice().text == "f.csv"


def test_picking_tells(box: SourceBox, qtbot: QtBot) -> None:
    with qtbot.waitSignal(box.picked):
        pick(box, OPEN_FILE.text)
    assert box.choice() == OPEN_FILE


def test_a_wheel_that_passes_changes_nothing(box: SourceBox, qapp: QApplication) -> None:
    before = box.currentIndex()
    middle = QPointF(box.rect().center())
    event = QWheelEvent(
        middle, box.mapToGlobal(middle), QPoint(), QPoint(0, -120), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(box, event)
    assert box.currentIndex() == before

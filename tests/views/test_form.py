"""The form, driven as a person would: by keys, wheel and choices."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, cast

import pytest
from PySide6.QtCore import QLocale, QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication, QCheckBox, QComboBox, QDoubleSpinBox, QLabel, QLineEdit, QSpinBox
from pytestqt.qtbot import QtBot

from imugui.fields import field
from imugui.views.form import CUSTOM, Form, decimals


@dataclass(frozen=True)
class Example:
    tau: float = field(3.0, "Time constant", unit="s", low=0.1, high=60.0, step=0.1, tip="Longer is calmer.")
    gain: float = field(0.0865, "Gain", low=0.0, high=5.0)
    count: int = field(5, "Count", low=1, high=99)
    rest: bool = field(True, "Rest detection")
    axes: str = field("nine", "Axes", choices=("six", "nine"))
    name: str = field("board", "Name")
    hidden: int = 7


PRESETS = {"Default": Example(), "Quick": Example(tau=1.25, rest=False)}


@pytest.fixture
def form(qtbot: QtBot) -> Form:
    widget = Form(Example(), PRESETS)
    qtbot.addWidget(widget)
    return widget


@pytest.fixture
def changes(form: Form) -> list[Example]:
    seen: list[Example] = []
    form.changed.connect(seen.append)
    return seen


def editor(form: Form, name: str) -> Any:
    """The widget of a field, of whatever kind."""
    return cast(Any, form.editor(name))


def scroll(widget: Any) -> None:
    """One notch of the wheel over a widget."""
    place = QPointF(5, 5)
    buttons, keys, phase = Qt.MouseButton.NoButton, Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase
    QApplication.sendEvent(widget, QWheelEvent(place, place, QPoint(), QPoint(0, 120), buttons, keys, phase, False))


def preset_box(form: Form) -> QComboBox:
    return next(box for box in form.findChildren(QComboBox) if box.accessibleName() == "Preset")


def choose(box: QComboBox, text: str) -> None:
    """As a person does: the entry becomes current and is activated."""
    box.setCurrentText(text)
    box.activated.emit(box.currentIndex())


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("tau", QDoubleSpinBox),
        ("gain", QDoubleSpinBox),
        ("count", QSpinBox),
        ("rest", QCheckBox),
        ("axes", QComboBox),
        ("name", QLineEdit),
    ],
)
def test_each_kind_of_field_has_its_editor(form: Form, name: str, kind: type) -> None:
    assert type(form.editor(name)) is kind
    assert form.editor(name).accessibleName() == next(
        item.metadata["label"] for item in dataclasses.fields(Example) if item.name == name
    )


def test_fields_without_a_label_are_kept_but_not_shown(form: Form) -> None:
    with pytest.raises(KeyError):
        form.editor("hidden")
    form.set_value(Example(hidden=9))
    editor(form, "count").setValue(6)
    assert form.value() == Example(hidden=9, count=6)


def test_numbers_show_unit_range_and_enough_places(form: Form) -> None:
    tau, gain = editor(form, "tau"), editor(form, "gain")
    assert tau.text() == "3.00 s"  # the "Quick" preset needs two places
    assert (tau.minimum(), tau.maximum(), tau.singleStep()) == (0.1, 60.0, 0.1)
    assert gain.text() == "0.0865"
    assert tau.toolTip() == "Longer is calmer.\n0.1 to 60 s"


@pytest.mark.parametrize(
    ("values", "step", "places"),
    [([3.0], 0.1, 1), ([3.25], 0.5, 2), ([0.0865], None, 4), ([10.0], None, 0), ([1 / 3], None, 6), ([1e-9], None, 0)],
)
def test_decimals(values: list[float], step: float | None, places: int) -> None:
    assert decimals(values, step) == places


def test_numbers_have_a_point_in_every_language(qtbot: QtBot) -> None:
    before = QLocale()
    QLocale.setDefault(QLocale(QLocale.Language.German))
    try:
        form = Form(Example(count=5))
        qtbot.addWidget(form)
        assert editor(form, "gain").text() == "0.0865"
    finally:
        QLocale.setDefault(before)


def test_each_editor_changes_its_field(form: Form, changes: list[Example]) -> None:
    editor(form, "tau").setValue(4.5)
    editor(form, "count").setValue(6)
    editor(form, "rest").setChecked(False)
    editor(form, "axes").setCurrentText("six")
    expected = Example(tau=4.5, count=6, rest=False, axes="six")
    assert form.value() == expected
    assert changes[-1] == expected
    assert len(changes) == 4


def test_text_is_taken_when_it_is_finished(form: Form, changes: list[Example], qtbot: QtBot) -> None:
    line = editor(form, "name")
    line.clear()
    qtbot.keyClicks(line, "left knee")
    assert changes == []
    qtbot.keyClick(line, Qt.Key.Key_Return)
    assert changes == [Example(name="left knee")]


def test_typed_number_is_taken_when_it_is_finished(form: Form, changes: list[Example], qtbot: QtBot) -> None:
    box = editor(form, "count")
    box.selectAll()
    qtbot.keyClicks(box, "42")
    assert changes == []
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert changes == [Example(count=42)]


def test_checkbox_and_arrows_work_by_keyboard(form: Form, changes: list[Example], qtbot: QtBot) -> None:
    qtbot.keyClick(form.editor("rest"), Qt.Key.Key_Space)
    qtbot.keyClick(form.editor("count"), Qt.Key.Key_Up)
    assert changes == [Example(rest=False), Example(rest=False, count=6)]


def test_set_value_shows_without_telling(form: Form, changes: list[Example]) -> None:
    new = Example(tau=12.345678, count=8, rest=False, axes="six", name="b")
    form.set_value(new)
    assert form.value() is new  # nothing is lost to the places shown
    assert editor(form, "count").value() == 8
    assert editor(form, "axes").currentText() == "six"
    assert editor(form, "name").text() == "b"
    assert changes == []


def test_editing_one_field_keeps_the_full_precision_of_the_others(form: Form) -> None:
    form.set_value(Example(tau=12.345678))
    editor(form, "count").setValue(9)
    assert form.value() == Example(tau=12.345678, count=9)


def test_value_of_another_class_is_refused(form: Form) -> None:
    with pytest.raises(TypeError, match="Example"):
        form.set_value(object())


def test_presets_are_recognised(form: Form) -> None:
    assert form.preset() == "Default"
    assert preset_box(form).currentText() == "Default"
    form.set_value(PRESETS["Quick"])
    assert preset_box(form).currentText() == "Quick"
    editor(form, "count").setValue(77)
    assert form.preset() == CUSTOM
    assert preset_box(form).currentText() == CUSTOM


def test_choosing_a_preset_sets_every_field_and_tells_once(form: Form, changes: list[Example]) -> None:
    choose(preset_box(form), "Quick")
    assert changes == [PRESETS["Quick"]]
    assert editor(form, "tau").value() == 1.25
    assert not editor(form, "rest").isChecked()


def test_choosing_custom_changes_nothing(form: Form, changes: list[Example]) -> None:
    choose(preset_box(form), CUSTOM)
    assert preset_box(form).currentText() == "Default"
    assert form.value() == Example()
    assert changes == []


def test_form_without_presets_has_no_preset_row(qtbot: QtBot) -> None:
    form = Form(Example())
    qtbot.addWidget(form)
    texts = [label.text() for label in form.findChildren(QLabel)]
    assert texts == ["Time constant", "Gain", "Count", "Rest detection", "Axes", "Name"]
    assert form.preset() == CUSTOM


@pytest.mark.parametrize("name", ["tau", "count", "axes"])
def test_wheel_over_an_unfocused_editor_changes_nothing(form: Form, changes: list[Example], name: str) -> None:
    assert form.editor(name).focusPolicy() == Qt.FocusPolicy.StrongFocus
    scroll(form.editor(name))
    assert changes == []
    assert form.value() == Example()


@pytest.mark.qt_log_ignore("propagateSizeHints")  # the offscreen platform has no window manager to tell
def test_wheel_over_the_focused_editor_counts(form: Form, changes: list[Example], qtbot: QtBot) -> None:
    with qtbot.waitExposed(form):
        form.show()
    form.activateWindow()
    form.editor("count").setFocus()
    qtbot.waitUntil(form.editor("count").hasFocus)
    scroll(form.editor("count"))
    assert changes == [Example(count=6)]

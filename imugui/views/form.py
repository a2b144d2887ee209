"""Form: edits any dataclass whose fields were made with imugui.fields.field."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QEvent, QLocale, QObject, Qt, Signal, SignalInstance
from PySide6.QtWidgets import (
    QAbstractSpinBox,
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QLabel,
    QLineEdit,
    QSpinBox,
    QWidget,
)

Item = dataclasses.Field[Any]

CUSTOM = "Custom"
_MOST_DECIMALS = 6
_FARTHEST = 1e9  # bound of a number that has none of its own
_INDENT = 6  # pixels; Qt gives a spin box no padding on this side
_FARTHEST_INT = 2**31 - 1


@dataclass(frozen=True)
class Editor:
    """One field's widget, how to read and write its value, and the signal of a change by hand."""

    widget: QWidget
    read: Callable[[], Any]
    write: Callable[[Any], None]
    changed: SignalInstance


class Form(QWidget):
    """Rows of label and editor, under a list of presets when there are any."""

    changed = Signal(object)
    """The new dataclass instance, after a change by hand; not after ``set_value``."""

    def __init__(self, value: Any, presets: Mapping[str, Any] | None = None, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._value = value
        self._presets = dict(presets or {})
        self._guard = _WheelGuard(self)
        self._editors: dict[str, Editor] = {}
        self._preset_box = QComboBox()
        layout = QFormLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setVerticalSpacing(10)
        layout.setHorizontalSpacing(16)
        layout.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        if self._presets:
            self._add_presets(layout)
        for item in dataclasses.fields(value):
            if "label" in item.metadata:
                self._add_row(layout, item)
        self.set_value(value)

    def value(self) -> Any:
        """The dataclass instance as edited so far."""
        return self._value

    def set_value(self, value: Any) -> None:
        """Show another instance of the same class. Raises TypeError when it is of another one."""
        if type(value) is not type(self._value):
            raise TypeError(f"this form edits {type(self._value).__name__}, not {type(value).__name__}")
        self._value = value
        for name, editor in self._editors.items():
            editor.widget.blockSignals(True)
            editor.write(getattr(value, name))
            editor.widget.blockSignals(False)
        self._show_preset()

    def set_presets(self, presets: Mapping[str, Any]) -> None:
        """Give the presets, whose names stay, other values."""
        if presets != self._presets:
            self._presets = dict(presets)
            self._show_preset()

    def preset(self) -> str:
        """Name of the preset whose values are shown, or "Custom"."""
        return next((name for name, preset in self._presets.items() if preset == self._value), CUSTOM)

    def editor(self, name: str) -> QWidget:
        """The widget that edits a field."""
        return self._editors[name].widget

    def _add_presets(self, layout: QFormLayout) -> None:
        box = self._preset_box
        box.addItems([*self._presets, CUSTOM])
        box.setAccessibleName("Preset")
        box.setToolTip("Named sets of values. Shows “Custom” when the values match none of them.")
        box.activated.connect(self._choose_preset)
        self._add_widget(layout, "Preset", box)

    def _add_row(self, layout: QFormLayout, item: Item) -> None:
        values = [getattr(each, item.name) for each in (self._value, *self._presets.values())]
        editor = _EDITORS[_kind(item)](item, values)
        self._editors[item.name] = editor
        editor.widget.setObjectName(item.name)
        editor.widget.setAccessibleName(item.metadata["label"])
        editor.widget.setToolTip(_tip(item))
        editor.changed.connect(lambda *_: self._take(item.name))
        self._add_widget(layout, item.metadata["label"], editor.widget)

    def _add_widget(self, layout: QFormLayout, text: str, widget: QWidget) -> None:
        label = QLabel(text)
        label.setBuddy(widget)
        label.setToolTip(widget.toolTip())
        widget.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        widget.installEventFilter(self._guard)
        layout.addRow(label, widget)

    def _take(self, name: str) -> None:
        """An editor was changed by hand."""
        new = dataclasses.replace(self._value, **{name: self._editors[name].read()})
        if new != self._value:
            self._value = new
            self._show_preset()
            self.changed.emit(new)

    def _choose_preset(self) -> None:
        chosen = self._presets.get(self._preset_box.currentText())
        if chosen is None or chosen == self._value:
            self._show_preset()
            return
        self.set_value(chosen)
        self.changed.emit(chosen)

    def _show_preset(self) -> None:
        self._preset_box.setCurrentText(self.preset())


class _WheelGuard(QObject):
    """Scrolling a page must not change the numbers the pointer happens to pass over."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Wheel and isinstance(watched, QWidget) and not watched.hasFocus():
            event.ignore()
            return True
        return False


def _kind(item: Item) -> str:
    return "choice" if item.metadata["choices"] else type(item.default).__name__


def _tip(item: Item) -> str:
    """The field's explanation and its range."""
    low, high, unit = (item.metadata[key] for key in ("low", "high", "unit"))
    bounds = "" if low is None or high is None else f"{low:g} to {high:g} {unit}".strip()
    return "\n".join(part for part in (item.metadata["tip"], bounds) if part)


def decimals(values: list[float], step: float | None) -> int:
    """Places after the point that show the step and every one of the values in full, at most six."""
    return max(_places(number) for number in [*values, step or 1.0])


def _places(number: float) -> int:
    text = f"{abs(number):.{_MOST_DECIMALS}f}".rstrip("0")
    return len(text.partition(".")[2])


def _float_editor(item: Item, values: list[Any]) -> Editor:
    box = QDoubleSpinBox()
    step = item.metadata["step"]
    box.setDecimals(decimals(values, step))
    if step:
        box.setSingleStep(step)
    else:
        box.setStepType(QAbstractSpinBox.StepType.AdaptiveDecimalStepType)
    _bound(box, item, _FARTHEST)
    return Editor(box, box.value, box.setValue, box.valueChanged)


def _int_editor(item: Item, values: list[Any]) -> Editor:
    box = QSpinBox()
    box.setSingleStep(int(item.metadata["step"] or 1))
    _bound(box, item, _FARTHEST_INT)
    return Editor(box, box.value, box.setValue, box.valueChanged)


def _bound(box: Any, item: Item, farthest: float) -> None:
    """Range and unit of a spin box; a point in numbers whatever the system's language, as everywhere on screen."""
    low, high, unit = (item.metadata[key] for key in ("low", "high", "unit"))
    kind: Any = type(item.default)
    box.setRange(kind(-farthest if low is None else low), kind(farthest if high is None else high))
    box.setSuffix(f" {unit}" if unit else "")
    box.setKeyboardTracking(False)
    box.lineEdit().setTextMargins(_INDENT, 0, 0, 0)
    locale = QLocale.c()
    locale.setNumberOptions(QLocale.NumberOption.OmitGroupSeparator)
    box.setLocale(locale)


def _bool_editor(item: Item, values: list[Any]) -> Editor:
    box = QCheckBox()
    return Editor(box, box.isChecked, box.setChecked, box.toggled)


def _choice_editor(item: Item, values: list[Any]) -> Editor:
    box = QComboBox()
    box.addItems(list(item.metadata["choices"]))
    return Editor(box, box.currentText, box.setCurrentText, box.currentTextChanged)


def _str_editor(item: Item, values: list[Any]) -> Editor:
    line = QLineEdit()
    return Editor(line, line.text, line.setText, line.editingFinished)


_EDITORS: dict[str, Callable[[Item, list[Any]], Editor]] = {
    "float": _float_editor,
    "int": _int_editor,
    "bool": _bool_editor,
    "choice": _choice_editor,
    "str": _str_editor,
}

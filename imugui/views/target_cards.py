"""Cards beside the game's picture: a preset with all its settings folded away, and the keys."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QGridLayout, QLabel, QToolButton

from imugui.targeting.settings import Control
from imugui.views import theme
from imugui.views.controls import StillBox, clear
from imugui.views.form import CUSTOM, Form
from imugui.views.game_keys import key_words
from imugui.views.guide_parts import Card, Complaint
from imugui.views.labels import muted


class PresetCard(Card):
    """One of several sets of values, in words; each value can be changed below."""

    changed = Signal(object)
    """The new dataclass instance, after a change by hand."""

    def __init__(self, title: str, value: Any, presets: Mapping[str, Any], describe: Callable[[Any], str]) -> None:
        super().__init__(title)
        self._presets, self._describe = dict(presets), describe
        self.box = StillBox(f"{title} preset", "Named sets of values. “Custom” when the values match none of them.")
        for name in (*self._presets, CUSTOM):
            self.box.add(name, name)
        self.words = muted()
        self.trouble = Complaint(f"What is wrong with the {title.lower()}")
        self.fold = QToolButton()
        self.fold.setText("All settings")
        self.fold.setProperty("role", "quiet")
        self.fold.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.fold.setCheckable(True)
        self.fold.setToolTip(f"Show or hide every setting of the {title.lower()}")
        self.fold.setAccessibleName(f"All settings of the {title.lower()}")
        self.form = Form(value)
        self.add(self.box, self.words, self.trouble, self.fold, self.form)
        self.box.activated.connect(self._choose)
        self.form.changed.connect(self._take)
        self.fold.toggled.connect(self._unfold)
        self._unfold(False)
        self._tell()

    def value(self) -> Any:
        """The values as they are."""
        return self.form.value()

    def set_value(self, value: Any) -> None:
        """Show other values."""
        self.form.set_value(value)
        self._tell()

    def preset(self) -> str:
        """The name of the set, or "Custom"."""
        return next((name for name, preset in self._presets.items() if preset == self.value()), CUSTOM)

    @Slot()
    def _choose(self) -> None:
        chosen = self._presets.get(self.box.currentData())
        if chosen is not None and chosen != self.value():
            self.form.set_value(chosen)
            self._take(chosen)
        self._tell()

    @Slot(object)
    def _take(self, value: Any) -> None:
        self._tell()
        self.changed.emit(value)

    @Slot(bool)
    def _unfold(self, on: bool) -> None:
        self.form.setVisible(on)
        self.fold.setArrowType(Qt.ArrowType.DownArrow if on else Qt.ArrowType.RightArrow)

    def _tell(self) -> None:
        self.box.choose(self.preset())
        self.words.setText(self._describe(self.value()))


class KeysCard(Card):
    """The keys and mouse buttons of the game, for the mapping in use."""

    def __init__(self) -> None:
        super().__init__("Keys")
        self._grid = QGridLayout()
        self._grid.setVerticalSpacing(3)
        self._grid.setHorizontalSpacing(12)
        self._grid.setColumnStretch(1, 1)
        self._shown: object = None
        self.add(self._grid)

    def show_keys(self, control: Control, hand: bool, board_button: bool) -> None:
        """``hand``: the virtual board is turned with the mouse; ``board_button``: the board sends its button."""
        shown = (control.latch, hand, board_button)
        if shown == self._shown:
            return
        self._shown = shown
        clear(self._grid)
        rows = key_words(control, hand)
        if board_button:
            rows += (("board's button", "short: pan, long: zoom; again: stop"),)
        for row, (keys, what) in enumerate(rows):
            label = QLabel(keys)
            label.setFont(theme.font("small"))
            self._grid.addWidget(label, row, 0)
            self._grid.addWidget(muted(what), row, 1)

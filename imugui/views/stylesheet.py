"""The style sheet over Qt's Fusion, with names for colours: theme.py fills them in.

Widgets pick a part by the dynamic property ``role``:
QPushButton "primary", "quiet" or "recording"; QToolButton "rail"; QLabel "muted" or "heading";
QFrame "card", "bar" or "rail".
"""

from __future__ import annotations

from pathlib import Path
from string import Template
from typing import Any

_SHEET = Template("""
QToolTip { color: $text; background: $panel; border: 1px solid $line; padding: 4px 6px; }
QLabel[role="muted"] { color: $muted; }
QLabel[role="heading"] { font-weight: 600; }
QFrame[role="card"] { background: $panel; border: 1px solid $line; border-radius: 10px; }
QFrame[role="bar"], QFrame[role="rail"] { background: $panel; border: none; }

QPushButton, QToolButton {
    color: $text; background: $raised; border: 1px solid $line; border-radius: 6px; padding: 5px 12px;
}
QToolButton { padding: 5px; }
QPushButton:hover, QToolButton:hover { border-color: $muted; }
QPushButton:pressed, QToolButton:pressed, QPushButton:checked, QToolButton:checked { background: $line; }
QPushButton:focus, QToolButton:focus { border-color: $accent; }
QPushButton:disabled, QToolButton:disabled { color: $muted; background: $window; }
QPushButton[role="primary"] { color: $on_accent; background: $accent; border-color: $accent; font-weight: 600; }
QPushButton[role="primary"]:hover { border-color: $text; }
QPushButton[role="primary"]:focus { border: 2px solid $text; padding: 4px 11px; }
QPushButton[role="primary"]:disabled { color: $muted; background: $raised; border-color: $line; }
QPushButton[role="recording"] { color: $bad; border-color: $bad; }
QPushButton[role="quiet"], QToolButton[role="quiet"], QToolButton[role="rail"] {
    background: transparent; border-color: transparent;
}
QPushButton[role="quiet"]:hover, QToolButton[role="quiet"]:hover, QToolButton[role="rail"]:hover {
    background: $raised;
}
QPushButton[role="quiet"]:focus, QToolButton[role="quiet"]:focus, QToolButton[role="rail"]:focus {
    border-color: $accent;
}
QToolButton[role="rail"] { padding: 8px 4px; color: $muted; border-radius: 8px; }
QToolButton[role="rail"]:checked { background: $raised; color: $accent; font-weight: 600; }

QLineEdit, QComboBox, QAbstractSpinBox, QPlainTextEdit, QListView, QTreeView, QTableView {
    color: $text; background: $panel; border: 1px solid $line; border-radius: 6px;
    selection-background-color: $accent; selection-color: $on_accent;
}
QLineEdit, QComboBox, QAbstractSpinBox { padding: 4px 8px; min-height: 20px; }
QLineEdit:hover, QComboBox:hover, QAbstractSpinBox:hover { border-color: $muted; }
QLineEdit:focus, QComboBox:focus, QAbstractSpinBox:focus, QPlainTextEdit:focus, QListView:focus, QTreeView:focus,
QTableView:focus { border-color: $accent; }
QLineEdit:disabled, QComboBox:disabled, QAbstractSpinBox:disabled { color: $muted; background: $window; }
QComboBox { combobox-popup: 0; }
QComboBox::drop-down { border: none; width: 22px; }
QComboBox::down-arrow { image: url("$icons/arrow-down.svg"); width: 12px; height: 12px; }
QComboBox QAbstractItemView { background: $panel; border: 1px solid $line; padding: 4px; outline: 0; }
QAbstractSpinBox { padding-right: 20px; min-height: 17px; }
QAbstractSpinBox::up-button, QAbstractSpinBox::down-button {
    subcontrol-origin: border; width: 18px; border: none; background: transparent;
}
QAbstractSpinBox::up-button { subcontrol-position: top right; }
QAbstractSpinBox::down-button { subcontrol-position: bottom right; }
QAbstractSpinBox::up-arrow { image: url("$icons/arrow-up.svg"); width: 10px; height: 10px; }
QAbstractSpinBox::down-arrow { image: url("$icons/arrow-down.svg"); width: 10px; height: 10px; }

QCheckBox::indicator { width: 16px; height: 16px; border: 1px solid $muted; border-radius: 4px; background: $panel; }
QCheckBox::indicator:checked { image: url("$icons/tick.svg"); }
QCheckBox::indicator:disabled { border-color: $line; }
QCheckBox::indicator:focus { border: 2px solid $accent; }

QTabBar::tab {
    color: $muted; background: transparent; border: none; border-bottom: 2px solid transparent; padding: 5px 12px;
}
QTabBar::tab:hover { color: $text; }
QTabBar::tab:selected { color: $text; border-bottom-color: $accent; }
QTabBar::tab:focus { border-bottom-color: $text; }

QMenu { background: $panel; border: 1px solid $line; padding: 4px; }
QMenu::item { padding: 5px 20px; border-radius: 4px; }
QMenu::item:selected { background: $raised; }
QProgressBar { background: $raised; border: none; border-radius: 4px; text-align: center; color: $text; }
QProgressBar::chunk { background: $accent; border-radius: 4px; }
QScrollBar:vertical { background: transparent; width: 10px; margin: 0; }
QScrollBar:horizontal { background: transparent; height: 10px; margin: 0; }
QScrollBar::handle { background: $line; border-radius: 4px; min-height: 24px; min-width: 24px; margin: 1px; }
QScrollBar::handle:hover { background: $muted; }
QScrollBar::add-line, QScrollBar::sub-line { width: 0; height: 0; }
QScrollBar::add-page, QScrollBar::sub-page { background: transparent; }
QScrollArea { border: none; background: transparent; }
QSplitter::handle { background: $line; }
""")


def render(colours: Any, icons: Path) -> str:
    """The style sheet with the colours of a theme.Palette and the folder of the arrow images."""
    names = {name: colour.name() for name, colour in vars(colours).items()}
    return _SHEET.substitute(names, icons=icons.as_posix())

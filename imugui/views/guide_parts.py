"""Small parts that the steps of the Guide page share."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRect, QRectF, Qt
from PySide6.QtGui import QPainter, QPalette
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QFrame,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLayout,
    QScrollArea,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from imugui.views import theme
from imugui.views.labels import heading, muted

COLUMN = 336
SCROLL_BAR = 12
_CORNER = "QTableCornerButton::section { background: transparent; border: none; }"


class Complaint(QLabel):
    """A sentence about what is wrong, with a cross in front; takes no room while there is none."""

    def __init__(self, name: str = "") -> None:
        super().__init__()
        self.setFont(theme.font("small"))
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setWordWrap(True)
        self.setForegroundRole(QPalette.ColorRole.BrightText)  # the theme's colour for what is bad
        self.setAccessibleName(name)
        self.hide()

    def show_wrong(self, words: str, tone: str = "bad") -> None:
        """Say it, or nothing; tone "warn" changes the sign in front."""
        self.setText(f"{theme.tone_glyph(tone)} {words}" if words else "")
        self.setVisible(bool(words))


class Card(QFrame):
    """A box with a title; parts are put into ``body``."""

    def __init__(self, title: str = "") -> None:
        super().__init__()
        self.setProperty("role", "card")
        self.body = QVBoxLayout(self)
        self.body.setContentsMargins(14, 10, 14, 12)
        self.body.setSpacing(8)
        self.title = heading(title)
        if title:
            self.body.addWidget(self.title)

    def add(self, *parts: QWidget | QLayout) -> Card:
        """Put parts below each other."""
        for part in parts:
            if isinstance(part, QWidget):
                self.body.addWidget(part)
            else:
                self.body.addLayout(part)
        return self


class PlainHeader(QHeaderView):
    """The heads of a table in the colours of the theme: small and grey over a thin line."""

    def paintSection(self, painter: QPainter, rect: QRect, section: int) -> None:
        colours = theme.palette()
        painter.save()
        painter.fillRect(rect, colours.panel)
        painter.setPen(theme.pen(colours.line))
        edge = QRectF(rect).adjusted(0.5, 0.5, -0.5, -0.5)
        level = self.orientation() == Qt.Orientation.Horizontal
        painter.drawLine(edge.bottomLeft() if level else edge.topRight(), edge.bottomRight())
        painter.setFont(theme.font("small"))
        painter.setPen(colours.muted)
        text = self.model().headerData(section, self.orientation(), Qt.ItemDataRole.DisplayRole)
        side = Qt.AlignmentFlag.AlignLeft if level else Qt.AlignmentFlag.AlignHCenter
        room = edge.adjusted(4.0 if level else 0.0, 0.0, 0.0, 0.0)
        painter.drawText(room, side | Qt.AlignmentFlag.AlignVCenter, str(text))
        painter.restore()


def dress_table(table: QTableView, widths: Sequence[int]) -> None:
    """Rows of one height, selected whole, under heads in the theme's colours; the last column takes what is left."""
    table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    table.setTabKeyNavigation(False)
    table.setShowGrid(False)
    table.setAlternatingRowColors(True)
    table.setVerticalHeader(PlainHeader(Qt.Orientation.Vertical, table))
    table.verticalHeader().setDefaultSectionSize(30)
    table.verticalHeader().setFixedWidth(26)
    header = PlainHeader(Qt.Orientation.Horizontal, table)
    table.setHorizontalHeader(header)
    header.setMinimumSectionSize(40)
    header.setStretchLastSection(True)
    for column, width in enumerate(widths):
        table.setColumnWidth(column, width)
    table.setStyleSheet(_CORNER)
    corner = table.findChild(QAbstractButton)
    if corner is not None:
        corner.setAccessibleName("Select all")
        corner.setToolTip("Select all")


def row_of(*widgets: QWidget, stretch: bool = True) -> QHBoxLayout:
    """Widgets beside each other, flush left."""
    row = QHBoxLayout()
    row.setSpacing(8)
    for widget in widgets:
        row.addWidget(widget)
    if stretch:
        row.addStretch(1)
    return row


def column_of(*cards: QWidget) -> QScrollArea:
    """The one column of controls at the right; the scroll bar comes and goes, the cards keep their width."""
    column = QVBoxLayout()
    column.setContentsMargins(4, 12, 8, 12)
    column.setSpacing(10)
    for card in cards:
        column.addWidget(card)
    column.addStretch(1)
    inside = QWidget()
    inside.setLayout(column)
    inside.setFixedWidth(COLUMN - SCROLL_BAR)
    area = QScrollArea()
    area.setWidget(inside)
    area.setWidgetResizable(True)
    area.setAlignment(Qt.AlignmentFlag.AlignLeft)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    area.setFixedWidth(COLUMN)
    return area


def note(text: str = "") -> QLabel:
    """A small grey line that does not wrap."""
    label = muted(text)
    label.setWordWrap(False)
    return label

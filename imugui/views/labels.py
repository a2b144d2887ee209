"""Small labels: a state as shape, word and colour, and a line of text that is cut with dots."""

from __future__ import annotations

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QFontMetrics, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget

from imugui.views import theme

_PAD = 10
_GAP = 6


class Chip(QWidget):
    """A state in a rounded box: shape, word and colour. As wide as the widest of ``words``, so that nothing jumps."""

    def __init__(self, words: tuple[str, ...] = (), name: str = "", shape: bool = True) -> None:
        super().__init__()
        self._words = words
        self._name = name
        self._shape = shape
        self._tone = "neutral"
        self._text = words[0] if words else ""
        self.setFont(theme.font("small"))
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self._name_it()

    @property
    def tone(self) -> str:
        return self._tone

    def text(self) -> str:
        """The word."""
        return self._text

    def show_state(self, tone: str, word: str) -> None:
        """Tone "neutral", "good", "warn" or "bad", and the word."""
        if (tone, word) == (self._tone, self._text):
            return
        wider = word not in self._words
        self._tone, self._text = tone, word
        self._name_it()
        if wider:
            self.updateGeometry()
        self.update()

    def sizeHint(self) -> QSize:
        metrics = QFontMetrics(self.font())
        width = max((metrics.horizontalAdvance(word) for word in (*self._words, self._text)), default=0)
        return QSize(width + 2 * _PAD + self._room_for_shape(metrics), metrics.height() + 8)

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def paintEvent(self, event: QPaintEvent) -> None:
        colour = theme.tone_colour(self._tone)
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.setPen(theme.pen(theme.faded(colour, 0.45)))
        painter.setBrush(theme.faded(colour, 0.13))
        painter.drawRoundedRect(box, box.height() / 2, box.height() / 2)
        painter.setPen(colour)
        middle = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft
        metrics = QFontMetrics(self.font())
        shape = self._room_for_shape(metrics)
        margin = max(_PAD, (self.width() - shape - metrics.horizontalAdvance(self._text)) // 2)
        inner = self.rect().adjusted(margin, 0, 0, 0)
        if self._shape:
            painter.drawText(inner, middle, theme.tone_glyph(self._tone))
        painter.setPen(colour if self._tone != "neutral" else theme.palette().text)
        painter.drawText(inner.adjusted(shape, 0, 0, 0), middle, self._text)
        painter.end()

    def _room_for_shape(self, metrics: QFontMetrics) -> int:
        if not self._shape:
            return 0
        return max(metrics.horizontalAdvance(glyph) for glyph in theme.TONES.values()) + _GAP

    def _name_it(self) -> None:
        self.setAccessibleName(f"{self._name}: {self._text}" if self._name else self._text)


class ToneLabel(QLabel):
    """One phrase in the colour of its tone; anything but neutral also gets its shape in front."""

    def __init__(self, widest: str = "") -> None:
        super().__init__()
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setFont(theme.font("small"))
        self.setProperty("role", "tone")
        self._widest = widest
        self._tone = "neutral"

    @property
    def tone(self) -> str:
        return self._tone

    def show_phrase(self, tone: str, words: str) -> None:
        """Tone "neutral", "good", "warn" or "bad", and the phrase."""
        text = words if tone == "neutral" or not words else f"{theme.tone_glyph(tone)} {words}"
        if text != self.text():
            self.setText(text)
        self._tone = tone

    def sizeHint(self) -> QSize:
        size = super().sizeHint()
        return size.expandedTo(QSize(QFontMetrics(self.font()).horizontalAdvance(self._widest) + 4, 0))

    def minimumSizeHint(self) -> QSize:
        return self.sizeHint()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setPen(theme.tone_colour(self._tone))
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, self.text())
        painter.end()


class ElidedLabel(QLabel):
    """A line that is cut with dots where room is short; the whole of it is the tooltip."""

    def __init__(self, text: str = "") -> None:
        super().__init__()
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self._whole = ""
        self.show_line(text)

    @property
    def whole(self) -> str:
        """The text uncut."""
        return self._whole

    def show_line(self, text: str) -> None:
        """Show text."""
        if text == self._whole:
            return
        self._whole = text
        self.setAccessibleName(text)
        self._cut()

    def minimumSizeHint(self) -> QSize:
        return QSize(40, super().minimumSizeHint().height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._cut()

    def _cut(self) -> None:
        metrics = QFontMetrics(self.font())
        cut = metrics.elidedText(self._whole, Qt.TextElideMode.ElideRight, self.width())
        self.setText(cut)
        self.setToolTip(self._whole if cut != self._whole else "")


def muted(text: str = "") -> QLabel:
    """A small grey label that wraps."""
    label = QLabel(text)
    label.setProperty("role", "muted")
    label.setFont(theme.font("small"))
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setWordWrap(True)
    return label


def heading(text: str) -> QLabel:
    """A heading."""
    label = QLabel(text)
    label.setProperty("role", "heading")
    label.setFont(theme.font("heading"))
    return label

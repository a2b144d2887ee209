"""How one recording looks in the list: when, what, how long, and a small overview of its turning."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, QSize, Qt
from PySide6.QtGui import QFontMetrics, QPainter
from PySide6.QtWidgets import QStyle, QStyledItemDelegate, QStyleOptionViewItem

from imugui.recording.summary import Summary
from imugui.views import theme
from imugui.views.recording_model import PATH, SUMMARY, facts_of, title_of
from imugui.views.timeline import paint_band

PAD = 14
GAP = 4
PREVIEW_SHARE = 0.3


class RecordingRow(QStyledItemDelegate):
    """Paints title, facts and preview."""

    def sizeHint(self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex) -> QSize:
        title, small = QFontMetrics(theme.font("body")), QFontMetrics(theme.font("small"))
        return QSize(300, title.height() + small.height() + GAP + 2 * 10)

    def paint(
        self, painter: QPainter, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        summary: Summary | None = index.data(SUMMARY)
        area = QRectF(option.rect)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        _paint_ground(painter, area, option.state)
        inner = area.adjusted(PAD, 10, -PAD, -10)
        preview = QRectF(inner)
        preview.setLeft(inner.right() - PREVIEW_SHARE * inner.width())
        words = inner.adjusted(0, 0, -preview.width() - PAD, 0)
        self._paint_words(painter, words, title_of(index.data(PATH), summary), summary)
        self._paint_preview(painter, preview, summary)
        painter.restore()

    def _paint_words(self, painter: QPainter, area: QRectF, title: str, summary: Summary | None) -> None:
        colours = theme.palette()
        font = theme.font("body")
        metrics = QFontMetrics(font)
        elide = Qt.TextElideMode.ElideRight
        painter.setFont(font)
        painter.setPen(colours.text)
        painter.drawText(area, Qt.AlignmentFlag.AlignTop, metrics.elidedText(title, elide, int(area.width())))
        tone = _tone(summary)
        words = facts_of(summary)
        words = words if tone == "neutral" else f"{theme.tone_glyph(tone)} {words}"
        small = theme.font("small")
        painter.setFont(small)
        painter.setPen(theme.tone_colour(tone))
        cut = QFontMetrics(small).elidedText(words, elide, int(area.width()))
        painter.drawText(area, Qt.AlignmentFlag.AlignBottom, cut)

    def _paint_preview(self, painter: QPainter, area: QRectF, summary: Summary | None) -> None:
        colours = theme.palette()
        painter.fillRect(area, theme.mix(colours.panel, colours.window, 0.7))
        if summary is not None and len(summary.preview) > 1:
            times, low, high = summary.preview.T
            paint_band(painter, area, (times, low, high), float(times[-1]), colours.muted)


def _tone(summary: Summary | None) -> str:
    if summary is None:
        return "neutral"
    if summary.problem:
        return "bad"
    return "neutral" if summary.complete and summary.gaps <= 0 else "warn"


def _paint_ground(painter: QPainter, area: QRectF, state: QStyle.StateFlag) -> None:
    colours = theme.palette()
    if state & QStyle.StateFlag.State_Selected:
        painter.fillRect(area, theme.mix(colours.panel, colours.accent, 0.18))
        painter.fillRect(QRectF(area.left(), area.top(), 3.0, area.height()), colours.accent)
    elif state & QStyle.StateFlag.State_MouseOver:
        painter.fillRect(area, colours.raised)
    painter.setPen(theme.pen(theme.faded(colours.line, 0.6)))
    painter.drawLine(area.bottomLeft(), area.bottomRight())

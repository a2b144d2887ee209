"""What would be read: findings, the first samples in SI, and a small curve."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPolygonF
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QSizePolicy, QVBoxLayout, QWidget

from imugui.formats.preview import Preview
from imugui.samples import Rows
from imugui.views import theme
from imugui.views.controls import clear
from imugui.views.labels import ToneLabel, heading, muted

SAMPLES = 3  # that are shown
MOST_FINDINGS = 6
CURVES = (
    ("gyr", "turn rate", 180 / np.pi, "°/s"),
    ("acc", "acceleration", 1.0, "m/s²"),
    ("mag", "field", 1.0, "µT"),
)
"""What is drawn: the first that there is; field of SAMPLE, title, factor to the unit."""
HEADINGS = ("Time, s", "Acceleration, m/s²", "Turn rate, rad/s", "Field, µT")


class MapPreview(QWidget):
    """Follows every change of the map."""

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("What is read")
        self.findings: list[ToneLabel] = []
        self._list = QVBoxLayout()
        self._list.setSpacing(4)
        self.samples = [[QLabel() for _ in HEADINGS] for _ in range(SAMPLES)]
        self.curve = NormCurve()
        left = QVBoxLayout()
        left.setSpacing(8)
        left.addWidget(heading("What comes out"), 0, Qt.AlignmentFlag.AlignTop)
        left.addLayout(self._list)
        left.addStretch(1)
        right = QVBoxLayout()
        right.addLayout(self._sample_grid())
        right.addSpacing(6)
        right.addWidget(self.curve, 1)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(24)
        row.addLayout(left, 2)
        row.addLayout(right, 3)

    def show_preview(self, preview: Preview) -> None:
        """Show what a map gives."""
        clear(self._list)
        self.findings = []
        for finding in preview.findings[:MOST_FINDINGS]:
            line = ToneLabel()
            line.show_phrase(finding.tone, finding.text)
            self._list.addWidget(line)
            self.findings.append(line)
        for k, labels in enumerate(self.samples):
            words = sample_words(preview.rows[k]) if k < len(preview.rows) else [""] * len(HEADINGS)
            for label, text in zip(labels, words, strict=True):
                label.setText(text)
        self.curve.show_rows(preview.rows)

    def _sample_grid(self) -> QGridLayout:
        """The first samples as a little table."""
        grid = QGridLayout()
        grid.setHorizontalSpacing(20)
        grid.setVerticalSpacing(2)
        for column, words in enumerate(HEADINGS):
            grid.addWidget(muted(words), 0, column, Qt.AlignmentFlag.AlignRight)
            grid.setColumnStretch(column, 1)
            for row, labels in enumerate(self.samples, 1):
                labels[column].setFont(theme.font("small"))
                labels[column].setAccessibleName(f"Sample {row}, {words}")
                grid.addWidget(labels[column], row, column, Qt.AlignmentFlag.AlignRight)
        return grid


class NormCurve(QWidget):
    """|gyr| over time, or what there is instead."""

    def __init__(self) -> None:
        super().__init__()
        self.values: NDArray[np.float64] = np.empty(0)
        self._caption = ""
        self.setMinimumHeight(64)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def show_rows(self, rows: Rows) -> None:
        """Take SAMPLE rows, shape (n,)."""
        self.values, self._caption = np.empty(0), "nothing to draw"
        for name, title, factor, unit in CURVES:
            norms = np.linalg.norm(rows[name], axis=1) * factor
            if len(self.values) == 0 and np.isfinite(norms).any():
                self.values = norms[np.isfinite(norms)]
                lasts = float(rows["t"][-1] - rows["t"][0])
                self._caption = f"{title}, up to {self.values.max():.3g} {unit}, first {lasts:.3g} s"
        self.setAccessibleName(self._caption)
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        colours = theme.palette()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.setPen(theme.pen(colours.line))
        painter.setBrush(colours.panel)
        painter.drawRoundedRect(box, 6, 6)
        if len(self.values) > 1:
            area = box.adjusted(8, 22, -8, -8)
            scale = max(float(self.values.max()), 1e-9)
            x = np.linspace(area.left(), area.right(), len(self.values))
            y = area.bottom() - self.values / scale * area.height()
            painter.setPen(theme.pen(colours.accent, 1.4))
            painter.drawPolyline(QPolygonF([QPointF(*point) for point in zip(x.tolist(), y.tolist(), strict=True)]))
        painter.setPen(colours.muted)
        painter.setFont(theme.font("small"))
        painter.drawText(box.adjusted(10, 4, -10, 0), Qt.AlignmentFlag.AlignLeft, self._caption)
        painter.end()


def sample_words(row: Rows) -> list[str]:
    """The numbers of one SAMPLE row under HEADINGS; a dash for what is not there."""
    groups = (("acc", "{:+.2f}"), ("gyr", "{:+.3f}"), ("mag", "{:+.1f}"))
    vectors = [
        "–" if np.isnan(row[name]).any() else "  ".join(pattern.format(value) for value in row[name])
        for name, pattern in groups
    ]
    return [f"{row['t']:.4f}", *vectors]

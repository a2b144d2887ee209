"""The plan that is selected, field by field, each with what is wrong right under it."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QLabel, QLineEdit, QVBoxLayout, QWidget

from imugui.guidance.plan import ANGLES, FIELDS, LEVELS, REFERENCES, plan_words
from imugui.views.controls import StillBox
from imugui.views.guide_parts import Complaint, note
from imugui.views.guide_plan_sheet import PlanSheet
from imugui.views.labels import muted
from imugui.views.side_picture import SidePicture

KINDS = {"projected": "Two plane angles", "plain": "Yaw and pitch from the origin"}
NUMBERS = ("axial_deg", "sagittal_deg", "yaw_deg", "pitch_deg", "roll_deg", "depth_mm", "tolerance_deg", "amber_deg")
HINTS = {
    "axial_deg": "° medial, − lateral",
    "sagittal_deg": "° cranial, − caudal",
    "yaw_deg": "° left, − right",
    "pitch_deg": "° down, − up",
    "roll_deg": "° right, − left",
    "depth_mm": "mm",
    "tolerance_deg": "°",
    "amber_deg": "°",
}
"""What a number's sign means, right of its field."""
LABELS = {"reference": "Reference", "tolerance_deg": "Green", "amber_deg": "Amber"}
"""Shorter than in a file, where the sagittal reference stands for itself."""
ORDER = ("name", "kind", "side", "axial_deg", "sagittal_deg", "reference", *NUMBERS[2:])
ONLY = {"projected": ("side", "reference"), "plain": ()}
"""Fields that only one kind has, beside its angles."""


class LevelBox(StillBox):
    """T1 to S1, or any words."""

    def __init__(self) -> None:
        super().__init__("Level", "T1 to S1, or any words")
        self.setEditable(True)
        self.setInsertPolicy(StillBox.InsertPolicy.NoInsert)
        for level in LEVELS:
            self.add(level, level)


class PlanEditor(QWidget):
    """Writes what is typed into the sheet at once, right or wrong."""

    edited = Signal()

    def __init__(self, sheet: PlanSheet) -> None:
        super().__init__()
        self.sheet = sheet
        self.row = -1
        self._showing = False
        self.level = LevelBox()
        self.kind = StillBox("Kind of plan", "Two plane angles of a screw, or yaw and pitch from the origin")
        self.reference = StillBox("Sagittal reference", "The line from which the sagittal angle was measured")
        self.picture = SidePicture()
        self.picture.setFixedHeight(128)
        self.lines = {name: _line(name) for name in NUMBERS}
        self.errors: dict[str, Complaint] = {}
        self.words = muted()
        for key, text in KINDS.items():
            self.kind.add(text, key)
        for text in REFERENCES:
            self.reference.add(text, text)
        self._lay_out()
        self._connect_parts()
        self.show_row(-1)

    def show_row(self, row: int) -> None:
        """Edit another plan; -1: none."""
        self.row = row
        self.setEnabled(row >= 0)
        self._showing = True
        texts = self.sheet.drafts[row].texts if row >= 0 else {}
        if self.level.currentText() != texts.get("name", ""):
            self.level.setEditText(texts.get("name", ""))
        self.kind.choose(texts.get("kind", "projected"))
        self.reference.choose(texts.get("reference", REFERENCES[0]))
        self.picture.show_side(texts.get("side", "").strip().casefold())
        for name, line in self.lines.items():
            if line.text() != texts.get(name, ""):
                line.setText(texts.get(name, ""))
        self._showing = False
        self._judge()

    def _judge(self) -> None:
        """Show the fields of this kind, what is wrong with each, and the plan in words."""
        kind = self.sheet.drafts[self.row].kind if self.row >= 0 else "projected"
        wrong = self.sheet.problems[self.row] if self.row >= 0 else {}
        hidden = {name for other in ANGLES if other != kind for name in (*ANGLES[other], *ONLY[other])}
        for name, parts in self._rows.items():
            for part in parts:
                part.setVisible(name not in hidden)
        for name, label in self.errors.items():
            label.show_wrong(wrong.get(name, ""))
        self.words.setText("" if wrong or self.row < 0 else plan_words(self.sheet.plan(self.row)))

    def _take(self, name: str, text: str) -> None:
        """A field was changed by hand."""
        if self._showing or self.row < 0 or self.sheet.drafts[self.row].texts.get(name, "") == text:
            return
        more = {"side": ""} if name == "kind" and text == "plain" else {}  # the picture goes, and with it the side
        self.sheet.edit(self.row, **{name: text}, **more)
        self.show_row(self.row)
        self.edited.emit()

    def _connect_parts(self) -> None:
        self.level.editTextChanged.connect(lambda text: self._take("name", text))
        self.kind.currentIndexChanged.connect(lambda _: self._take("kind", self.kind.currentData()))
        self.reference.currentIndexChanged.connect(lambda _: self._take("reference", self.reference.currentData()))
        self.picture.chosen.connect(lambda side: self._take("side", side))
        for name, line in self.lines.items():
            line.textEdited.connect(lambda text, name=name: self._take(name, text))

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setVerticalSpacing(7)
        grid.setHorizontalSpacing(12)
        grid.setColumnStretch(1, 1)
        widgets: dict[str, QWidget] = {"name": self.level, "kind": self.kind, "side": self.picture, **self.lines}
        self._rows: dict[str, list[QWidget]] = {}
        for row, name in enumerate(ORDER):
            widget = {**widgets, "reference": self.reference}[name]
            title = FIELDS[name].metadata["label"]
            self.errors[name] = Complaint(f"{title}: what is wrong")
            box = _box(widget, HINTS.get(name, ""), self.errors[name])
            self._rows[name] = [box]
            if name == "side":
                grid.addWidget(box, row, 0, 1, 2)
                continue
            label = QLabel(LABELS.get(name, title))
            label.setBuddy(widget)
            self._rows[name].append(label)
            grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
            label.setContentsMargins(0, 6, 0, 0)
            grid.addWidget(box, row, 1)
        grid.addWidget(self.words, len(ORDER), 0, 1, 2)


def _line(name: str) -> QLineEdit:
    line = QLineEdit()
    label = FIELDS[name].metadata["label"]
    line.setAccessibleName(label)
    line.setToolTip(FIELDS[name].metadata["tip"] or label)
    line.setFixedWidth(80)
    return line


def _box(widget: QWidget, hint: str, error: Complaint) -> QWidget:
    """A field with its hint at the right and its error under it."""
    box = QWidget()
    column = QVBoxLayout(box)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(2)
    row = QHBoxLayout()
    row.setSpacing(6)
    row.addWidget(widget)
    if hint:
        row.addWidget(note(hint))
        row.addStretch(1)
    column.addLayout(row)
    column.addWidget(error)
    return box

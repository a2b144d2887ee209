"""The Report step: all readings, what they come to, and the files."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from PySide6.QtCore import Qt, QUrl, Signal, Slot
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QFileDialog, QMessageBox, QTableView, QVBoxLayout, QWidget

from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading
from imugui.guidance.report import report_csv, report_html
from imugui.views.controls import Button
from imugui.views.guide_parts import dress_table, row_of
from imugui.views.guide_reading_model import ReadingModel, summary_words
from imugui.views.labels import heading, muted

NONE = "No reading has been taken yet."
WIDTHS = (124, 236, 104, 96, 96, 72, 80)


class ReportPanel(QWidget):
    """Saves what is shown; deleting asks first."""

    said = Signal(str, str)  # tone, sentence
    deleted = Signal(list)  # numbers of readings

    def __init__(self) -> None:
        super().__init__()
        self._plans: tuple[Plan, ...] = ()
        self._about: dict[str, str] = {}
        self.model = ReadingModel()
        self.table = QTableView()
        self.count = heading("")
        self.summary = muted()
        self.html_button = Button("Save report…", "A page with a table and a picture of every reading", role="primary")
        self.browse_button = Button("Show in browser", "The same page in the browser, which prints it too")
        self.csv_button = Button("Save as CSV…", "Every number of every reading")
        self.delete_button = Button("Delete…", "Delete the readings that are selected, or all of them")
        self.html_button.clicked.connect(self.ask_html)
        self.browse_button.clicked.connect(self.browse)
        self.csv_button.clicked.connect(self.ask_csv)
        self.delete_button.clicked.connect(self.ask_delete)
        self._lay_out()
        self.show_readings((), ())

    def show_readings(self, readings: Sequence[Reading], plans: Sequence[Plan], recording: str = "") -> None:
        """Show these; ``recording``: the one that runs, by which they can be computed again."""
        self._plans = tuple(plans)
        self._about = {"Recording": recording or "none"}
        self.model.show_readings(readings)
        n = len(readings)
        self.count.setText(f"{n} reading{'' if n == 1 else 's'}")
        self.summary.setText(summary_words(readings) if n else NONE)
        for button in (self.html_button, self.browse_button, self.csv_button, self.delete_button):
            button.setEnabled(n > 0)

    @Slot()
    def ask_html(self) -> None:
        """Ask where the report shall be written."""
        path = self._ask("guidance.html", "HTML (*.html)")
        if path is not None:
            self._write(path, report_html(*self._content()))

    @Slot()
    def browse(self) -> None:
        """Show the report in the browser, which prints it too."""
        path = Path(tempfile.gettempdir()) / "imugui-guidance.html"
        if self._write(path, report_html(*self._content())):
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(path)))

    @Slot()
    def ask_csv(self) -> None:
        """Ask where the table shall be written."""
        path = self._ask("guidance.csv", "CSV (*.csv)")
        if path is not None:
            self._write(path, report_csv(*self._content()))

    @Slot()
    def ask_delete(self) -> None:
        """Delete readings, after asking."""
        rows = {index.row() for index in self.table.selectionModel().selectedRows()}
        chosen = [self.model.readings[row].number for row in sorted(rows or range(len(self.model.readings)))]
        words = "all readings" if len(chosen) == len(self.model.readings) else f"{len(chosen)} reading(s)"
        answer = QMessageBox.question(self, "Delete readings", f"Delete {words}? A recording still holds them.")
        if answer == QMessageBox.StandardButton.Yes:
            self.deleted.emit(chosen)

    def _content(self) -> tuple[Sequence[Reading], Sequence[Plan], dict[str, str], datetime]:
        """What a report is made of."""
        return self.model.readings, self._plans, self._about, datetime.now(UTC)

    def _ask(self, name: str, kind: str) -> Path | None:
        chosen, _ = QFileDialog.getSaveFileName(self, "Save the report", name, kind)
        return Path(chosen) if chosen else None

    def _write(self, path: Path, text: str) -> bool:
        try:
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            self.said.emit("error", f"The report cannot be written to {path}: {error.strerror or error}.")
            return False
        self.said.emit("info", f"The report is in {path}.")
        return True

    def _lay_out(self) -> None:
        self.table.setModel(self.model)
        self.table.setAccessibleName("Readings")
        dress_table(self.table, WIDTHS)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(10)
        column.addWidget(self.count)
        column.addWidget(self.summary, 0, Qt.AlignmentFlag.AlignTop)
        column.addWidget(self.table, 1)
        column.addLayout(row_of(self.html_button, self.browse_button, self.csv_button, self.delete_button))

"""The Results tab: the runs as a table, what they come to, pictures of it, and the files."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from PySide6.QtCore import Qt, QUrl, Signal, Slot
from PySide6.QtGui import QDesktopServices, QPixmap
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QLabel, QScrollArea, QTableView, QVBoxLayout, QWidget

from imugui.targeting.results import PRIMARY
from imugui.targeting.results_plots import learning_svg, paired_svg
from imugui.targeting.study_store import StudyError
from imugui.targeting.trials import Trial
from imugui.views import theme
from imugui.views.certificate_page import drawn
from imugui.views.controls import Button, StillBox
from imugui.views.guide_parts import dress_table, row_of
from imugui.views.job import Job, Jobs
from imugui.views.labels import heading, muted
from imugui.views.target_results_model import WIDTHS, RunModel
from imugui.views.target_results_source import FREE, Shown, of_file, of_study, of_trials

EMPTY = "No run has been finished yet. Play one, or open the folder of a study."
COMPUTING = "Computing…"
PICTURES_WIDTH = 340
SOURCE_LENGTH = 26
FILES = "Studies and tables of targets (study.json *.csv)"


class ResultsPanel(QWidget):
    """Computes in a thread of its own; shows one source at a time."""

    said = Signal(str, str)  # tone, sentence

    def __init__(self) -> None:
        super().__init__()
        self.shown: Shown | None = None
        self.model, self.table = RunModel(), QTableView()
        self.source = StillBox("Source of the results", "What the results are made from")
        self.source.setMinimumContentsLength(SOURCE_LENGTH)
        self.source.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.headline, self.notes = QLabel(), muted()
        self._pictures = QVBoxLayout()
        self._sources: dict[str, Callable[[], Shown]] = {}
        self._jobs, self._job = Jobs(self), 0
        self.report_button = Button("Save report…", "A page with every figure, test and picture", role="primary")
        self.browse_button = Button("Show in browser", "The same page in the browser, which prints it too")
        self.csv_button = Button("Save targets as CSV…", "Every target with all its figures")
        self.open_button = Button("Open…", "A study's folder, or a table of targets", icon="open")
        self._lay_out()
        self.source.activated.connect(self.refresh_results)
        self.report_button.clicked.connect(self.ask_report)
        self.browse_button.clicked.connect(self.browse)
        self.csv_button.clicked.connect(self.ask_csv)
        self.open_button.clicked.connect(self.ask_file)
        self._show(None)

    # what the page tells

    def offer_free(self, trials: Sequence[Trial]) -> None:
        """Offer what was played in this window; with none there is nothing to offer."""
        kept = tuple(trials)
        if kept:
            self._offer(FREE, lambda: of_trials(FREE, kept))

    def offer_study(self, name: str, folder: Path) -> None:
        """Offer the study that is open."""
        self._offer(f"Study {name}", lambda: of_study(folder))

    @Slot()
    def refresh_results(self) -> None:
        """Compute the chosen source again."""
        make = self._sources.get(self.source.currentData())
        if make is None:
            self._show(None)
            return
        self.notes.setText(COMPUTING)
        self._job += 1
        number = self._job
        self._jobs.start(lambda job: (number, _made(make, job)), self._computed, self._failed)

    def stop(self) -> None:
        """Wait for what is computed."""
        self._jobs.stop()

    # what the buttons do

    @Slot()
    def ask_report(self) -> None:
        """Ask where the report shall be written."""
        path = self._ask("targeting.html", "HTML (*.html)")
        if path is not None and self.shown is not None:
            self._write(path, self.shown.html())

    @Slot()
    def browse(self) -> None:
        """Show the report in the browser."""
        path = Path(tempfile.gettempdir()) / "imugui-targeting.html"
        if self.shown is not None and self._write(path, self.shown.html()):
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(path)))

    @Slot()
    def ask_csv(self) -> None:
        """Ask where the targets shall be written."""
        path = self._ask("targets.csv", "CSV (*.csv)")
        if path is not None and self.shown is not None:
            self._write(path, self.shown.csv())

    @Slot()
    def ask_file(self) -> None:
        """Ask for a study or a table, and show it."""
        chosen, _ = QFileDialog.getOpenFileName(self, "Open results", "", FILES)
        if chosen:
            self.open_file(Path(chosen))

    def open_file(self, path: Path) -> None:
        """Show a study or a table."""
        name = path.parent.name if path.name == "study.json" else path.name
        self._offer(name, lambda: of_file(path))
        self.source.choose(name)
        self.refresh_results()

    # inside

    def _offer(self, name: str, make: Callable[[], Shown]) -> None:
        if name not in self._sources:
            self.source.add(name, name)
        self._sources[name] = make

    @Slot(object)
    def _computed(self, result: tuple[int, Shown | str]) -> None:
        number, made = result
        if number != self._job:  # another source was chosen meanwhile
            return
        if isinstance(made, str):
            self._failed(made)
        else:
            self._show(made)

    @Slot(str)
    def _failed(self, words: str) -> None:
        self._show(None)
        self.said.emit("error", f"There are no results: {words}")

    def _show(self, shown: Shown | None) -> None:
        self.shown = shown
        self.model.show_runs(shown.found.runs if shown is not None else ())
        self.headline.setText(shown.headline if shown is not None else EMPTY)
        self.notes.setText("\n".join((*shown.problems, *shown.found.notes)) if shown is not None else "")
        for button in (self.report_button, self.browse_button, self.csv_button):
            button.setEnabled(shown is not None)
        for k, svg in enumerate(_plots(shown) if shown is not None else ("", "")):
            self._picture(k, svg)

    def _picture(self, place: int, svg: str) -> None:
        item = self._pictures.itemAt(place)
        label = item.widget() if item is not None else None
        if not isinstance(label, QLabel):
            return
        label.setVisible(bool(svg))
        if svg:
            image = drawn(svg)
            ratio = self.devicePixelRatioF()
            width = min(round(PICTURES_WIDTH * ratio), image.width())
            scaled = QPixmap.fromImage(image.scaledToWidth(width, Qt.TransformationMode.SmoothTransformation))
            scaled.setDevicePixelRatio(ratio)
            label.setPixmap(scaled)

    def _ask(self, name: str, kind: str) -> Path | None:
        chosen, _ = QFileDialog.getSaveFileName(self, "Save the results", name, kind)
        return Path(chosen) if chosen else None

    def _write(self, path: Path, text: str) -> bool:
        try:
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            self.said.emit("error", f"The results cannot be written to {path}: {error.strerror or error}.")
            return False
        self.said.emit("info", f"The results are in {path}.")
        return True

    def _lay_out(self) -> None:
        self.headline.setFont(theme.font("heading"))
        self.headline.setWordWrap(True)
        self.headline.setAccessibleName("The comparison")
        self.table.setModel(self.model)
        self.table.setAccessibleName("Runs")
        dress_table(self.table, WIDTHS)
        for words in ("Person by person", "Learning over the blocks"):
            label = QLabel()
            label.setAccessibleName(words)
            self._pictures.addWidget(label)
        self._pictures.addWidget(self.notes)
        self._pictures.addStretch(1)
        side = QWidget()
        side.setLayout(self._pictures)
        side.setFixedWidth(PICTURES_WIDTH + 16)
        area = QScrollArea()
        area.setWidget(side)
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setFixedWidth(PICTURES_WIDTH + 32)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        middle = QHBoxLayout()
        middle.addWidget(self.table, 1)
        middle.addWidget(area)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 12)
        column.setSpacing(10)
        column.addLayout(row_of(heading("Results"), self.source, self.open_button))
        column.addWidget(self.headline)
        column.addLayout(middle, 1)
        column.addLayout(row_of(self.report_button, self.browse_button, self.csv_button))


def _made(make: Callable[[], Shown], job: Job) -> Shown | str:
    """The results, or why there are none."""
    job.progress(0.0)
    try:
        return make()
    except (StudyError, ValueError) as error:
        return str(error)


def _plots(shown: Shown) -> tuple[str, str]:
    """Paired dots and learning, where there is something to show."""
    first = next((one for one in shown.found.comparisons if one.measure == PRIMARY and one.people), None)
    learned = [one for one in shown.found.learning if one.means]
    return (
        paired_svg(first) if first is not None else "",
        learning_svg(learned, "Movement time per target", "s") if any(len(one.blocks) > 1 for one in learned) else "",
    )

"""Taking signals away: the plots as a picture, the data on screen as a CSV file."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Iterator
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QObject, Signal, Slot
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QFileDialog, QWidget

from imugui import __version__, paths
from imugui.signals.choice import Choice
from imugui.signals.feed import Feed
from imugui.signals.table import LINES, Table, csv_pieces
from imugui.views.job import Job, Jobs
from imugui.workers.session import Session

FILTER = "CSV table (*.csv)"


class SignalExport(QObject):
    """Asks for the file, writes it in a thread of its own, and says what became of it."""

    said = Signal(str, str)  # tone, sentence
    progressed = Signal(float)  # share written
    ended = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._parent = parent
        self._jobs = Jobs(self)
        self._job: Job | None = None
        application = QCoreApplication.instance()
        if application is not None:
            application.aboutToQuit.connect(self.stop)

    @property
    def busy(self) -> bool:
        """True while a file is written."""
        return self._job is not None

    def copy(self, widget: QWidget) -> None:
        """Put a picture of the widget on the clipboard."""
        QGuiApplication.clipboard().setPixmap(widget.grab())
        self.said.emit("info", "The plots are on the clipboard as a picture.")

    def ask(self, table: Table, header: dict[str, str]) -> None:
        """Ask for a file name and write the table there."""
        proposed = paths.documents_folder() / file_name(datetime.datetime.now())
        folder = proposed.parent if proposed.parent.is_dir() else Path.home()
        where = str(folder / proposed.name)
        chosen, _ = QFileDialog.getSaveFileName(self._parent, "Export the data on screen", where, FILTER)
        if chosen:
            self.write(Path(chosen), table, header)

    def write(self, path: Path, table: Table, header: dict[str, str]) -> None:
        """Write the table; the file appears when it is complete."""
        if path.suffix == "":
            path = path.with_suffix(".csv")
        self._path, self._rows = path, len(table)

        def work(job: Job) -> None:
            write_whole(path, csv_pieces(table, header), 2 + len(table) / LINES, job.progress)

        self._job = self._jobs.start(work, self._written, self._failed)
        self._job.progressed.connect(self.progressed)

    def cancel(self) -> None:
        """Stop writing; no file is left."""
        if self._job is not None:
            self._job.cancel()
            self._end("info", "The export was cancelled; no file was written.")

    @Slot()
    def stop(self) -> None:
        """Cancel, and wait until the thread is gone."""
        self._jobs.stop()

    @Slot(object)
    def _written(self, _: object) -> None:
        self._end("info", f"{self._rows:,} rows written to {self._path}.")

    @Slot(str)
    def _failed(self, why: str) -> None:
        self._end("error", f"{self._path} could not be written: {why}. Choose another folder.")

    def _end(self, tone: str, sentence: str) -> None:
        self._job = None
        self.said.emit(tone, sentence)
        self.ended.emit()


def file_name(now: datetime.datetime) -> str:
    """A name that sorts by time."""
    return f"signals-{now:%Y%m%d-%H%M%S}.csv"


def export_header(session: Session, feed: Feed, choice: Choice) -> dict[str, str]:
    """What a reader of the file needs to know."""
    source = session.source
    return {
        "program": f"imugui {__version__}",
        "exported": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
        "source": source.address if source else "",
        "sensor data": "raw" if choice.raw else "corrected",
        "time": "s, sample clock",
        "angles": feed.convention,
    }


def write_whole(path: Path, pieces: Iterator[str], total: float, progress: Callable[[float], object]) -> None:
    """Write pieces of text to a file that appears only when it is complete; OSError when that fails."""
    temporary = path.with_name(path.name + ".part")
    try:
        with temporary.open("w", encoding="utf-8", newline="") as stream:
            for number, piece in enumerate(pieces, 1):
                stream.write(piece)
                progress(min(number / total, 1.0))
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)

"""Compare: fuse the recording that is played again, with another filter, and see both attitudes."""

from __future__ import annotations

import dataclasses
import time

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QCheckBox, QDialog, QFrame, QHBoxLayout, QProgressBar, QScrollArea, QVBoxLayout, QWidget

from imugui.fusion import FILTER_TITLES, FILTERS
from imugui.recording.compare import Figures, refuse
from imugui.views.compare_plots import ComparePlots, Comparison
from imugui.views.controls import Button, StillBox
from imugui.views.filters import kept_params
from imugui.views.form import Form
from imugui.views.job import Job, Jobs
from imugui.views.labels import heading, muted
from imugui.views.record_words import elapsed_words
from imugui.views.replay_words import clock_words
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Player, Session

COLUMN = 316
NOT_YET = "Choose a second filter and press Compute. Both run over the whole recording from its first sample."
NO_REPLAY = "Open a recording first: there is nothing to fuse again."
KEYS = (
    "Thin line: first. Wide line: second, as the outline in the picture of the Live page. "
    "Below: their angle (thin), and its part without heading (wide)."
)


class CompareWindow(QDialog):
    """Beside the main window; its cursor and the ghost on the Live page follow the replay."""

    sought = Signal(float)  # s
    ghost = Signal(object)  # the second attitude (w, x, y, z) at this moment, or None

    def __init__(self, session: Session, settings_store: SettingsStore, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Compare filters")
        self.resize(980, 620)
        self._session = session
        self._settings_store = settings_store
        self._player: Player | None = None
        self._result: Comparison | None = None
        self._jobs = Jobs(self)
        self._job: Job | None = None
        self._started = 0.0
        self._ghostly = False
        self.form: Form | None = None
        self.filter = StillBox("Second filter", "The filter to compare with the one in use")
        for name, title in FILTER_TITLES.items():
            self.filter.add(title, name)
        self.mag = QCheckBox("Use the magnetometer")
        self.mag.setToolTip("In the second filter")
        self.mag.setChecked(session.use_mag)
        self.button = Button("Compute", "Fuse the whole recording with both filters", icon="play", role="primary")
        self.bar = QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(8)
        self.bar.setAccessibleName("Progress of the computation")
        self.first = muted()
        self.words = muted(NOT_YET)
        self.plots = ComparePlots()
        self._form_place = QVBoxLayout()
        self._take_filter(self._other_filter())
        self._lay_out()
        self._connect_parts()

    @property
    def comparison(self) -> Comparison | None:
        """What was computed for the recording that is played."""
        return self._result

    def refresh(self) -> None:
        """Follow the replay; to be called for every frame."""
        player, result = self._player, self._result
        shown = self.isVisible() and player is not None and result is not None
        if shown and player is not None and result is not None:
            self.plots.set_position(player.position_s)
            self.ghost.emit(result.second_at(player.position_s))
        elif self._ghostly:
            self.ghost.emit(None)
        self._ghostly = shown

    def slow_refresh(self) -> None:
        """Follow the session."""
        if self._session.player is not self._player:
            self._player = self._session.player
            self._forget()
        self.first.setText(f"First: {_title(self._session.filter_name, self._session.use_mag)}, as on the Live page")
        computing = self._job is not None
        self.button.setText("Cancel" if computing else "Compute")
        self.button.set_icon("stop" if computing else "play")
        self.button.setEnabled(self._player is not None)
        self.button.setToolTip("Fuse the whole recording with both filters" if self._player is not None else NO_REPLAY)
        self.bar.setVisible(computing)

    def stop(self) -> None:
        """End the threads."""
        self._jobs.stop()

    @Slot()
    def compute(self) -> None:
        """Begin, or cancel what was begun."""
        if self._job is not None:
            self._job.cancel()
            self._ended("Cancelled.")
        elif self._player is not None and self.form is not None:
            rows, first = self._player.rows, self._session.fusion_settings | {"origin": None}
            changes = {"filter": self.filter.currentData(), "params": dataclasses.asdict(self.form.value())}
            second = first | changes | {"use_mag": self.mag.isChecked()}

            def work(job: Job) -> Comparison:
                a = refuse(rows, first, lambda share: job.progress(0.5 * share))
                return Comparison.of(a, refuse(rows, second, lambda share: job.progress(0.5 + 0.5 * share)))

            self._started = time.perf_counter()
            self._job = self._jobs.start(work, self._done, self._ended)
            self._job.progressed.connect(self._progressed)
            self.words.setText("Computing…")
        self.slow_refresh()

    @Slot(float)
    def _progressed(self, share: float) -> None:
        if self._job is None:
            return
        self.bar.setValue(round(1000 * share))
        spent = time.perf_counter() - self._started
        if spent > 1.0 and share > 0.0:
            self.words.setText(f"Computing… {elapsed_words(spent * (1.0 - share) / share + 0.999)} left")

    @Slot(object)
    def _done(self, result: Comparison) -> None:
        self._result = result
        self.plots.show_comparison(result)
        whole, tilt = result.figures()
        self._ended(f"Angle between the two: {figure_words(whole)}.\n\nWithout heading: {figure_words(tilt)}.")

    @Slot(str)
    def _ended(self, words: str) -> None:
        self._job = None
        self.bar.setValue(0)
        self.words.setText(words)
        self.slow_refresh()

    def _forget(self) -> None:
        """Another recording is played, or none."""
        if self._job is not None:
            self._job.cancel()
        self._job = self._result = None
        self.words.setText(NOT_YET if self._player is not None else NO_REPLAY)

    def _other_filter(self) -> str:
        return next((name for name in FILTERS if name != self._session.filter_name), self._session.filter_name)

    @Slot(int)
    def _filter_chosen(self, row: int) -> None:
        self._take_filter(self.filter.itemData(row))

    def _take_filter(self, name: str) -> None:
        self.filter.choose(name)
        if self.form is not None:
            self._form_place.removeWidget(self.form)
            self.form.hide()
            self.form.deleteLater()
        self.form = Form(kept_params(self._settings_store, name), FILTERS[name].PRESETS)
        self._form_place.addWidget(self.form)

    def _connect_parts(self) -> None:
        self.filter.activated.connect(self._filter_chosen)
        self.button.clicked.connect(self.compute)
        self.plots.sought.connect(self.sought)
        self.button.setAutoDefault(False)

    def _lay_out(self) -> None:
        settings = QVBoxLayout()
        settings.setContentsMargins(0, 0, 12, 0)
        settings.setSpacing(10)
        settings.addLayout(self._form_place)
        settings.addWidget(self.mag)
        settings.addStretch(1)
        inside = QWidget()
        inside.setLayout(settings)
        area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        for widget in (area.viewport(), inside):
            widget.setAutoFillBackground(False)  # the card shows through
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        card = QFrame()
        card.setProperty("role", "card")
        card.setFixedWidth(COLUMN)
        column = QVBoxLayout(card)
        column.setContentsMargins(16, 12, 8, 14)
        column.setSpacing(10)
        column.addWidget(heading("Second filter"))
        column.addWidget(self.filter)
        column.addWidget(area, 1)
        for widget in (self.first, self.button, self.bar, self.words):
            column.addWidget(widget)
        left = QVBoxLayout()
        left.addWidget(self.plots, 1)
        left.addWidget(muted(KEYS))
        row = QHBoxLayout(self)
        row.setContentsMargins(14, 14, 14, 14)
        row.setSpacing(12)
        row.addLayout(left, 1)
        row.addWidget(card)


def figure_words(one: Figures) -> str:
    """Mean, RMS and largest in words."""
    where = clock_words(one.largest_at_s) if one.largest_at_s == one.largest_at_s else "?"
    return f"mean {one.mean:.2f}°, RMS {one.rms:.2f}°, largest {one.largest:.2f}° at {where}"


def _title(name: str, use_mag: bool) -> str:
    return f"{FILTER_TITLES[name]} {'with' if use_mag else 'without'} magnetometer"

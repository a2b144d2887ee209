"""The collect panel: what to collect, and how far it is."""

from __future__ import annotations

from PySide6.QtCore import Qt, Slot
from PySide6.QtWidgets import QFrame, QLabel, QProgressBar, QStackedLayout, QVBoxLayout, QWidget

from imugui.views import theme
from imugui.views.collection import COUNTDOWN, PAUSE, RECORDING, Collection, Plan, Stage
from imugui.views.controls import Button
from imugui.views.form import Form
from imugui.views.labels import Chip, heading, muted
from imugui.views.record_control import why_not
from imugui.views.record_words import elapsed_words
from imugui.workers.session import Session, Status

PHASES = {COUNTDOWN: ("neutral", "Get ready"), RECORDING: ("good", "Recording"), PAUSE: ("neutral", "Pause")}
START_WORDS = "Record for a set time, once or several times"
ABOUT = "Records for a set time, as often as you like. Every recording is a file of its own."


class CollectPanel(QFrame):
    """A form, or the progress of what it began."""

    def __init__(self, session: Session, collection: Collection) -> None:
        super().__init__()
        self.setProperty("role", "card")
        self._session = session
        self._collection = collection
        self.form = Form(Plan())
        self.start_button = Button("Start collecting", START_WORDS, icon="record", role="primary")
        self.cancel_button = Button("Cancel", "End the collection now; what is complete is kept", icon="stop")
        self.phase = Chip(tuple(word for _, word in PHASES.values()), "Phase")
        self.run = QLabel()
        self.left = QLabel()
        self.left.setFont(theme.font("huge"))
        self.left.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.left.setAccessibleName("Time left")
        self.bar = QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(8)
        self.bar.setAccessibleName("Progress of the collection")
        self.total = muted()
        self.start_button.clicked.connect(self.start)
        self.cancel_button.clicked.connect(collection.cancel)
        collection.changed.connect(self.refresh)
        self._lay_out()

    @Slot()
    def refresh(self) -> None:
        """Follow the collection."""
        stage = self._collection.stage()
        running = self._collection.running
        self._stack.setCurrentIndex(1 if running else 0)
        if running:
            self._show(stage)

    def slow_refresh(self, status: Status) -> None:
        """Follow the session."""
        why = why_not(status)
        if not why and self._session.recording is not None:
            why = "Stop the recording first (R)."
        self.start_button.setEnabled(not why)
        self.start_button.setToolTip(why or START_WORDS)

    @Slot()
    def start(self) -> None:
        """Begin what the form says."""
        plan = self.form.value()
        if self._collection.start(plan):
            self.cancel_button.setFocus()

    def _show(self, stage: Stage) -> None:
        self.phase.show_state(*PHASES[stage.phase])
        asked = self._collection.plan.repeats
        self.run.setText(f"{stage.run} of {asked}")
        self.left.setText(f"{stage.left_s:.1f} s" if stage.left_s < 60.0 else elapsed_words(stage.left_s))
        self.bar.setValue(round(1000 * stage.share))
        self.total.setText(f"{elapsed_words(stage.total_left_s + 0.999)} left of the whole")

    def _lay_out(self) -> None:
        setup = QVBoxLayout()
        setup.setSpacing(12)
        setup.addWidget(muted(ABOUT))
        setup.addWidget(self.form)
        setup.addWidget(self.start_button)
        setup.addStretch(1)
        progress = QVBoxLayout()
        progress.setSpacing(10)
        progress.addWidget(self.phase, 0, Qt.AlignmentFlag.AlignHCenter)
        progress.addWidget(self.left)
        for label in (self.run, self.total):
            label.setAlignment(Qt.AlignmentFlag.AlignCenter)
        progress.addWidget(self.run)
        progress.addWidget(self.bar)
        progress.addWidget(self.total)
        progress.addWidget(self.cancel_button)
        progress.addStretch(1)
        self._stack = QStackedLayout()
        for layout in (setup, progress):
            layout.setContentsMargins(0, 0, 0, 0)
            side = QWidget()
            side.setLayout(layout)
            self._stack.addWidget(side)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 16, 16)
        column.setSpacing(10)
        column.addWidget(heading("Collect data"))
        column.addLayout(self._stack)

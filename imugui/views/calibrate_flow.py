"""FlowPage: one guided calibration: what to do now, the picture, what is missing, and the verdict."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QProgressBar, QScrollArea, QVBoxLayout, QWidget

from imugui.calibration.magnetometer import MagnetometerFlow
from imugui.views.calibrate_feed import Feed
from imugui.views.calibrate_look import Guide, Look, Verdict
from imugui.views.calibrate_picture import CalibratePicture
from imugui.views.calibrate_result import Figures, ResultCard
from imugui.views.calibrate_states import advice
from imugui.views.controls import Button
from imugui.views.flow_runner import FlowRunner, Step
from imugui.views.labels import ElidedLabel, ToneLabel, heading, muted
from imugui.workers.session import Session

COLUMN = 348
HAND_HINT = "Turn it with the mouse or the arrow keys"
KEEPS = "Nothing is changed until you press Apply."


class FlowPage(QWidget):
    """Runs one flow at a time. Nothing leaves this page but the ``apply`` signal, after a press on Apply."""

    closed = Signal()
    applied = Signal(object, object, object)  # Guide, result, the last Look
    failed = Signal(str)

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self.guide: Guide | None = None
        self._runner: FlowRunner | None = None
        self._feed: Feed | None = None
        self._result: Any = None
        self._look = Look()
        self._advice = ""
        self._plot: Any = None
        self.picture = CalibratePicture(session)
        self.title = heading("")
        self.sentence = QLabel()
        self.bar = QProgressBar()
        self.percent = QLabel("0 %")
        self.trouble = ToneLabel()
        self.missing = muted()
        self.figures = Figures()
        self.card = ResultCard()
        self.hint = ElidedLabel(HAND_HINT)
        self._make_buttons()
        self._lay_out()

    # the run

    def begin(self, guide: Guide, profile: Any, field_ut: float = 0.0) -> None:
        """Start a flow afresh; ``profile`` is the one in use, or None; ``field_ut``: the field here, 0 if not known."""
        self.end()
        self.guide, self._profile, self._result = guide, profile, None
        self._advice = advice(guide.first, profile)
        self.title.setText(guide.title)
        self.picture.begin(guide.picture)
        self._new_plot(guide)
        for widget in (self.card, self.apply, self.enough):
            widget.hide()
        flow = guide.start(profile)
        if isinstance(flow, MagnetometerFlow) and field_ut > 0.0:
            flow.expect(field_ut)
        self._runner = FlowRunner(flow, guide.look, guide.pace_s, guide.ends)
        self._runner.stepped.connect(self._take)
        self._runner.failed.connect(self.failed)
        self._feed = Feed(self.session)
        if not self.isVisible():
            self._feed.pause()
        self._runner.start()
        self.picture.setFocus(Qt.FocusReason.OtherFocusReason)
        self.slow_refresh()

    def end(self) -> None:
        """Stop the flow that runs; what it gathered is forgotten."""
        if self._runner is not None:
            self._runner.stepped.disconnect(self._take)
            self._runner.stop()
        self._runner = self._feed = None

    @property
    def running(self) -> bool:
        """Whether a flow runs."""
        return self._runner is not None

    @property
    def gaps(self) -> int:
        """Gaps in the data since the flow began."""
        return self._feed.gaps if self._feed is not None else 0

    def refresh(self) -> None:
        """Turn the picture."""
        self.picture.refresh()

    def slow_refresh(self) -> None:
        """Feed the flow with what came."""
        self.picture.slow_refresh()
        self.hint.setVisible(self.session.hand_turned)
        if self._runner is None or self._feed is None:
            return
        self._runner.feed(self._feed.pull())
        gaps = f"{self._feed.gaps} gaps in the data so far; they are left out." if self._feed.gaps else ""
        words = self._feed.trouble or gaps or self._advice
        self.trouble.show_phrase("warn" if words else "neutral", words)
        self.trouble.setVisible(bool(words))

    @Slot()
    def cancel(self) -> None:
        """Leave; the old calibration stays as it is."""
        self.end()
        self.closed.emit()

    @Slot()
    def restart(self) -> None:
        """Begin the same flow anew."""
        if self.guide is not None:
            self.begin(self.guide, self._profile)

    @Slot()
    def finish(self) -> None:
        """Go on to the next stage with what there is."""
        if self._runner is not None and self.guide is not None:
            self._runner.ask(self.guide.finish)

    @Slot()
    def accept(self) -> None:
        """Apply the result, if there is one above the bar."""
        if self.guide is not None and self._result is not None and self.apply.isVisibleTo(self):
            guide, result, look = self.guide, self._result, self._look
            self.end()
            self.applied.emit(guide, result, look)

    @Slot(object)
    def _take(self, step: Step) -> None:
        """What the flow said after its newest rows."""
        if self.guide is None or self.sender() is not self._runner:
            return
        look: Look = step.picture
        self._look = look
        self.sentence.setText(step.sentence)
        self.bar.setValue(round(1000 * step.progress))
        self.enough.setVisible(look.can_finish)
        self.percent.setText(f"{100 * step.progress:.0f} %")
        self.missing.setText("\n".join(f"· {words}" for words in step.missing) or "Nothing.")
        self.picture.show_look(look)
        self.figures.show_figures(look.figures)
        decided = step.result is not None
        self._figures_card.setVisible(bool(look.figures) and not decided)
        self._missing_card.setVisible(bool(step.missing) or not decided)
        if self._plot is not None:
            self._plot.show_norms(look.plot.before, look.plot.after, look.plot.wanted)
        if step.result is not None:
            self._show(step.result, self.guide.judge(step.result, self._profile))

    def _show(self, result: Any, verdict: Verdict) -> None:
        first = not self.card.isVisibleTo(self)
        self._result = result
        self.card.show_verdict(verdict, self._look.comparison)
        self.card.show()
        self.apply.setVisible(verdict.can_apply)
        self.apply.set_role("" if verdict.keep else "primary")
        self.leave.setText("Keep the old one" if self._profile is not None else "Cancel")
        if first and verdict.can_apply:
            self.apply.setFocus(Qt.FocusReason.OtherFocusReason)

    # Qt's events

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._feed is not None:
            self._feed.resume()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        if self._feed is not None:
            self._feed.pause()

    # parts

    def _new_plot(self, guide: Guide) -> None:
        from imugui.views.calibrate_plots import NormPlot  # pyqtgraph takes a third of a second to import

        if self._plot is not None:
            self._plot_box.removeWidget(self._plot)
            self._plot.deleteLater()
        self._plot = NormPlot(f"{guide.title}: before and after", guide.unit) if guide.unit else None
        self._plot_card.setVisible(self._plot is not None)
        if self._plot is not None:
            self._plot_box.addWidget(self._plot)

    def _make_buttons(self) -> None:
        self.apply = Button("Apply", "Use this calibration from now on and save it for this board", role="primary")
        self.leave = Button("Cancel", "Leave without changing anything (Backspace)")
        self.again = Button("Start again", "Forget what was gathered and begin anew")
        self.enough = Button("Check now", "That is enough: go on to the check without the rest")
        self.enough.clicked.connect(self.finish)
        self.apply.clicked.connect(self.accept)
        self.leave.clicked.connect(self.cancel)
        self.again.clicked.connect(self.restart)

    def _lay_out(self) -> None:
        self.sentence.setFont(self.title.font())
        self.sentence.setWordWrap(True)
        self.sentence.setAccessibleName("What to do now")
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(10)
        self.bar.setAccessibleName("Progress")
        self.percent.setFixedWidth(self.percent.fontMetrics().horizontalAdvance("100 % "))
        self.percent.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.hint.setProperty("role", "muted")
        progress = QHBoxLayout()
        progress.addWidget(self.bar, 1)
        progress.addWidget(self.percent)
        left = QVBoxLayout()
        left.setContentsMargins(16, 12, 0, 6)
        left.setSpacing(8)
        left.addWidget(self.sentence)
        left.addLayout(progress)
        left.addWidget(self.trouble)
        left.addWidget(self.picture, 1)
        left.addWidget(self.hint)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addLayout(left, 1)
        row.addWidget(self._column())

    def _column(self) -> QWidget:
        self._figures_card = self._card("So far", self.figures)
        self._plot_card, self._plot_box = QFrame(), QVBoxLayout()
        self._missing_card = self._card("Still missing", self.missing)
        self._plot_card = self._card("Length before (grey) and after", None)
        cards = QVBoxLayout()
        cards.setContentsMargins(16, 4, 4, 4)
        cards.setSpacing(10)
        for card in (self.card, self._missing_card, self._figures_card, self._plot_card):
            cards.addWidget(card)
        cards.addStretch(1)
        inside = QWidget()
        inside.setLayout(cards)
        inside.setFixedWidth(COLUMN - 12)
        area = QScrollArea()
        area.setWidget(inside)
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        buttons = QHBoxLayout()
        buttons.setContentsMargins(16, 4, 16, 2)
        buttons.setSpacing(8)
        for button in (self.apply, self.enough, self.leave, self.again):
            buttons.addWidget(button)
        buttons.addStretch(1)
        foot = muted(KEEPS)
        foot.setContentsMargins(16, 0, 0, 10)
        self.title.setContentsMargins(16, 12, 0, 4)
        column = QVBoxLayout()
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.title)
        column.addWidget(area, 1)
        column.addLayout(buttons)
        column.addWidget(foot)
        box = QWidget()
        box.setLayout(column)
        box.setFixedWidth(COLUMN)
        return box

    def _card(self, words: str, inside: QWidget | None) -> QFrame:
        card = QFrame()
        card.setProperty("role", "card")
        column = QVBoxLayout(card)
        column.setContentsMargins(14, 10, 14, 12)
        column.setSpacing(6)
        column.addWidget(muted(words))
        if inside is not None:
            column.addWidget(inside)
        else:
            self._plot_box = column
        return card

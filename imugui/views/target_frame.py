"""TargetFrame: the widgets of the Target page, its tabs, and which of them is in front."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QFrame, QHBoxLayout, QStackedWidget, QTabBar, QToolButton, QVBoxLayout, QWidget

from imugui.views.empty import EmptyState
from imugui.views.game_scene import GameScene
from imugui.views.game_words import CIRCLES, SQUARES, Plate
from imugui.views.guide_parts import COLUMN
from imugui.views.target_desk import TargetDesk
from imugui.views.target_file import Kept
from imugui.views.target_foot import TargetFoot
from imugui.views.target_play_panel import PlayPanel
from imugui.views.target_questions import QuestionPage
from imugui.views.target_results_panel import ResultsPanel
from imugui.views.target_run_card import RunCard
from imugui.views.target_study_desk import StudyDesk
from imugui.views.target_study_panel import StudyPanel, invitation, start_words
from imugui.views.target_study_setup import StudySetup
from imugui.workers.session import Session

PLAY, STUDY, RESULTS = "play", "study", "results"
TABS = {
    PLAY: ("Play", "Play a run by yourself"),
    STUDY: ("Study", "Compare mappings with people"),
    RESULTS: ("Results", "Runs, comparison, report"),
}
WILL_SHOW = (
    "This page is a game: turn the board to steer a field of view onto targets. It measures how well, compares "
    "mappings in a fair study, and writes the report. Studies can be planned without a board."
)


class TargetFrame(QWidget):
    """Shows what the two desks say; what is done with it is up to the page."""

    chosen = Signal(str)  # a tab

    def __init__(self, session: Session, desk: TargetDesk, study_desk: StudyDesk, kept: Kept) -> None:
        super().__init__()
        self._desk, self._study_desk = desk, study_desk
        self.scene, self.run = GameScene(), RunCard()
        self.play, self.setup = PlayPanel(kept), StudySetup()
        self.study, self.questions = StudyPanel(study_desk), QuestionPage()
        self.results, self.foot = ResultsPanel(), TargetFoot(session)
        self.empty = EmptyState("target", "No board is connected", WILL_SHOW)
        self.tabs = self._tab_bar()
        self._fronts, self._sides, self._side = QStackedWidget(), QStackedWidget(), QWidget()
        for front in (self.scene, self.empty, self.setup, self.questions, self.results):
            self._fronts.addWidget(front)
        for side in (self.play, self.study):
            self._sides.addWidget(side)
        self._lay_out()
        self.tabs.currentChanged.connect(self._changed)

    @property
    def tab(self) -> str:
        """The tab in front."""
        return str(self.tabs.tabData(self.tabs.currentIndex()))

    @property
    def front(self) -> QWidget | None:
        """What is in front."""
        return self._fronts.currentWidget()

    def select(self, name: str) -> None:
        """Bring a tab to the front."""
        self.tabs.setCurrentIndex(list(TABS).index(name))

    def lock(self, on: bool) -> None:
        """While a run is on, no other tab can be chosen and no setting changed."""
        for place in range(self.tabs.count()):
            self.tabs.setTabEnabled(place, not on or place == self.tabs.currentIndex())
        self.play.set_open(not on)

    def show_front(self, idle: bool, resulting: bool) -> None:
        """The widgets of the tab; ``idle``: nothing is connected, ``resulting``: a run has just ended."""
        study, step = self._study_desk.study, self._study_desk.step
        game = self.empty if idle and not self._desk.playing else self.scene
        if self.tab == RESULTS:
            self._show(self.results, None)
        elif self.tab == PLAY:
            self._show(game, self.play)
        elif study is None:
            self._show(self.setup, None)
        elif step is not None and step.asked and not resulting:
            self.questions.ask(study.plan, step)
            self._show(self.questions, self.study)
        else:
            self._show(game, self.study)

    def offer_start(self, why_not: str) -> None:
        """What the start button says, and what stands on the picture without a run; ``why_not``: it is off."""
        study, step = self._study_desk.study, self._study_desk.step
        if self.tab == STUDY and study is not None:
            self.run.offer(start_words(study, step), why_not)
            plate = invitation(study, step, self._study_desk.rest_left_s)
        else:
            self.run.offer("Start run", why_not)
            words = SQUARES if self.play.task.value().sized else CIRCLES
            plate = Plate("neutral", "Ready", (words, why_not or "Enter: start"))
        self.scene.invite(plate)

    def _show(self, front: QWidget, side: QWidget | None) -> None:
        self._fronts.setCurrentWidget(front)
        self._side.setVisible(side is not None)
        if side is not None:
            self._sides.setCurrentWidget(side)

    @Slot(int)
    def _changed(self, place: int) -> None:
        self.chosen.emit(str(self.tabs.tabData(place)))

    def _tab_bar(self) -> QTabBar:
        tabs = QTabBar()
        tabs.setAccessibleName("Parts of the Target page")
        tabs.setDrawBase(False)
        tabs.setExpanding(False)
        for name, (title, words) in TABS.items():
            place = tabs.addTab(title)
            tabs.setTabData(place, name)
            tabs.setTabToolTip(place, words)
        for button in tabs.findChildren(QToolButton):  # Qt's own, for tabs that find no room
            button.setAccessibleName("More tabs")
            button.setToolTip("Show more tabs")
        return tabs

    def _lay_out(self) -> None:
        bar = QFrame()
        bar.setProperty("role", "bar")
        top = QHBoxLayout(bar)
        top.setContentsMargins(12, 2, 12, 0)
        top.addWidget(self.tabs)
        top.addStretch(1)
        self._side.setFixedWidth(COLUMN)
        card = QVBoxLayout()
        card.setContentsMargins(4, 12, 20, 0)  # as wide as the cards below
        card.addWidget(self.run)
        side = QVBoxLayout(self._side)
        side.setContentsMargins(0, 0, 0, 0)
        side.setSpacing(0)
        side.addLayout(card)
        side.addWidget(self._sides, 1)
        middle = QHBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(self._fronts, 1)
        middle.addWidget(self._side)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(bar, 0, Qt.AlignmentFlag.AlignTop)
        column.addLayout(middle, 1)
        column.addWidget(self.foot)

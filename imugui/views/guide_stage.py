"""Stage: what to do now, how far it is, and the tool as it is held; shared by the steps that measure something."""

from __future__ import annotations

from PySide6.QtWidgets import QLabel, QProgressBar, QVBoxLayout, QWidget

from imugui.views import theme
from imugui.views.guide_parts import note
from imugui.views.guide_scene import GuideScene
from imugui.workers.session import Session, State

HAND_HINT = "Turn it with the mouse or the arrow keys, finely with Ctrl"


class Stage(QWidget):
    """A sentence, a bar and a picture."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self.sentence = QLabel()
        self.sentence.setFont(theme.font("heading"))
        self.sentence.setWordWrap(True)
        self.sentence.setMinimumHeight(2 * self.sentence.fontMetrics().lineSpacing())
        self.sentence.setAccessibleName("What to do now")
        self.bar = QProgressBar()
        self.bar.setRange(0, 1000)
        self.bar.setTextVisible(False)
        self.bar.setFixedHeight(10)
        self.bar.setAccessibleName("Progress")
        self.scene = GuideScene(session)
        self.hint = note(HAND_HINT)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 12, 8, 8)
        column.setSpacing(8)
        for part in (self.sentence, self.bar):
            column.addWidget(part)
        column.addWidget(self.scene, 1)
        column.addWidget(self.hint)

    def show_state(self, sentence: str, progress: float) -> None:
        """What to do now, and the share that is done, 0 to 1."""
        self.sentence.setText(sentence)
        self.bar.setValue(round(1000 * progress))

    def refresh(self, state: State) -> None:
        """Turn the picture."""
        self.scene.refresh(state)

    def slow_refresh(self) -> None:
        """Follow the session."""
        self.scene.slow_refresh()
        self.hint.setVisible(self.session.hand_turned)

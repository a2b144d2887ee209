"""HistoryCard: what the controller did and why, the newest first."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtWidgets import QLabel

from imugui.targeting.states import Transition
from imugui.views.guide_parts import Card
from imugui.views.labels import muted

SHOWN = 6
NONE = "Every change of state will stand here with its cause; a recording keeps them all."


class HistoryCard(Card):
    """The last transitions of the run that is played."""

    def __init__(self) -> None:
        super().__init__("What happened")
        self.lines: QLabel = muted(NONE)
        self.lines.setAccessibleName("Changes of state")
        self.add(self.lines)

    def show_log(self, log: Sequence[Transition]) -> None:
        """Show the end of a controller's log; times count from its first line."""
        newest = list(log[-SHOWN:])[::-1]
        words = "\n".join(line_words(line, log[0].t) for line in newest)
        if (words or NONE) != self.lines.text():
            self.lines.setText(words or NONE)


def line_words(line: Transition, begun: float) -> str:
    """A transition, or what was refused; ``begun`` in s."""
    refused = line.source is line.target
    what = f"still {line.target.word}" if refused else line.target.word
    return f"{line.t - begun:.1f} s  {what}: {line.cause}"

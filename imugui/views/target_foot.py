"""The foot of the Target page: whether the run can be computed again, and what this program is not."""

from __future__ import annotations

from imugui.views.guide_foot import NOTHING, GuideFoot
from imugui.views.record_control import why_not
from imugui.views.record_words import elapsed_words
from imugui.workers.session import Session, Status

WHY = "Without a recording no run can be computed again."
BY_ITSELF = "Each run of the study is recorded into its folder."
LATE = "This run began before the recording: it cannot be computed again, the next one can."


class TargetFoot(GuideFoot):
    """The Guide page's foot, about runs: ``show_run`` stands for its ``refresh``."""

    def __init__(self, session: Session) -> None:
        super().__init__(session)
        self.button.setToolTip(self.button.toolTip().replace("no reading", "no run"))

    def show_run(self, status: Status, unrecorded: bool, by_itself: bool) -> None:
        """Follow the session; ``unrecorded``: a run is on that began without a recording.

        ``by_itself``: the next run of a study will be recorded without being asked to.
        """
        running = self._session.recording
        off = running is None and bool(why_not(status))
        if running is not None:
            said = "good", f"Recording {elapsed_words(running.elapsed_s)}"
            why = LATE if unrecorded else f"Runs are kept in {running.path.name}."
        elif by_itself:
            said, why = ("neutral", "Recording begins with the run"), BY_ITSELF
        else:
            said, why = (("neutral", ""), "") if off else (("warn", NOTHING), WHY)
        self.state.show_phrase(*said)
        self.why.show_line(why)
        self.button.setVisible(running is None and not off and not by_itself)

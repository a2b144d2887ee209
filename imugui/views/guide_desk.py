"""GuideDesk: the guidance engine between the session, the session file and the recording; no picture of its own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal, Slot

from imugui.guidance.facts import Facts
from imugui.guidance.guide import Guide
from imugui.guidance.look import Look
from imugui.guidance.plan import Plan
from imugui.guidance.reading import Reading, Vector, plain
from imugui.guidance.registration import Registration
from imugui.guidance.session_file import load, save
from imugui.samples import ATTITUDE, Rows, empty_rows
from imugui.workers.session import Session

FILE_NAME = "guidance.json"
SAVE_DELAY_MS = 400  # while a plan is typed the file is written once
SINCE = "since the registration"
"""In every reason why a registration is not good any more."""
ANOTHER_FRAME = "The tool is now measured in another frame, so the registration was removed. Register again."
ALIGNED = "The two boards were aligned anew, so the registration was removed. Register again."
MOVED = "The origin was moved, so the registration by it was removed. Register again."


class GuideDesk(QObject):
    """``pull`` it for every frame; whatever changes is kept, and noted in the recording while one runs."""

    said = Signal(str, str)  # tone, sentence
    taken = Signal(object)  # Reading
    refused = Signal(str)

    def __init__(self, session: Session, path: Path | None) -> None:
        """``path``: the session file; with None nothing is written."""
        super().__init__()
        self.guide = Guide()
        self.rows: Rows = empty_rows(ATTITUDE, 0)
        """The attitudes that were new at the last ``pull``, and the number of the first."""
        self.first = session.shown.count
        self.pressed = False
        """The board's button went down within them."""
        self.problems: list[str] = []
        self._session, self._path = session, path
        self._ring = session.shown
        self._count = self._ring.count
        self._epoch: object = -1
        self._seen_epoch: object = -1
        self._button = -1
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(SAVE_DELAY_MS)
        self._timer.timeout.connect(self.flush)
        if path is not None:
            kept, self.problems = load(path)
            self.guide.restore(kept)

    def pull(self) -> Look:
        """Take what is new, and see where the tool points now."""
        if self._session.shown is not self._ring:
            self._change_frame()
        self.rows, self._count, _ = self._ring.since(self._count)
        self.first = self._count - len(self.rows)
        self._watch_button(self.rows["status"])
        values = self._session.guide_facts()
        self._seen_epoch = values.pop("epoch")
        facts = Facts(**values, epoch_same=self._epoch == self._seen_epoch)
        return self.guide.step(self.rows, self.first, facts)

    @property
    def void(self) -> str:
        """Why the registration is not good any more, one sentence; empty when it is, or there is none."""
        if self.guide.registration is None:
            return ""
        return next((reason for reason in self.guide.look.reasons if SINCE in reason), "")

    # what the person does

    def set_plans(self, plans: Sequence[Plan]) -> None:
        """Take a list of plans."""
        self.guide.set_plans(plans)
        self._timer.start()

    def select(self, index: int) -> None:
        """Aim at another plan, if there is one of this number."""
        if 0 <= index < len(self.guide.plans):
            self.guide.select(index)

    def use_magnetometer(self, on: bool) -> None:
        """Have the heading follow the field, or not: it must be so before the registration."""
        if self._session.relative is None and self._session.use_mag != on:
            self._session.set_filter(self._session.filter_name, self._session.filter_params, on)

    def set_axis(self, axis: Vector, quality_deg: float) -> None:
        """Take another tool axis."""
        ended = self.guide.registration is not None and tuple(axis) != self.guide.tool_axis
        self.guide.set_tool_axis(axis, quality_deg)
        if ended:
            self.said.emit("warn", "With another tool axis the registration has ended. Register again.")
        self._note("tool axis", {"tool_axis": list(axis), "quality_deg": quality_deg})

    def register(self, registration: Registration) -> None:
        """Take a registration that was measured just now."""
        self._epoch = self._seen_epoch
        self.guide.register(registration)
        self._session.refer_heading()
        self._note("registration", {"registration": registration.to_dict()}, registration.rows[-1][1])

    @Slot()
    def remove_registration(self) -> None:
        """There is no zero any more."""
        self.guide.clear_registration()
        self._note("registration removed", {})

    def origin_moved(self) -> None:
        """The user has set the origin by hand: a registration by it stands on another one."""
        registration, against = self.guide.registration, self._session.relative is not None
        if registration is not None and (against or registration.method == "origin"):
            self.remove_registration()
            self.said.emit("warn", ALIGNED if against else MOVED)

    @Slot(str)
    def confirm_side(self, side: str) -> None:
        """The person has looked at the patient."""
        self.guide.confirm_side(side)
        self._note("side confirmed", {"side": side})

    @Slot()
    def capture(self) -> None:
        """Take a reading now, or say why not."""
        found = self.guide.capture(self._session.guide_facts()["now"])
        if isinstance(found, Reading):
            self._note("reading", {"reading": found.to_dict()}, found.rows[1])
            self.taken.emit(found)
        else:
            self.refused.emit(found)

    def forget_readings(self, numbers: Sequence[int]) -> None:
        """Delete the readings with these numbers."""
        self.guide.readings = [one for one in self.guide.readings if one.number not in set(numbers)]
        self._note("readings deleted", {"numbers": list(numbers)})

    @Slot()
    def flush(self) -> None:
        """Write the session file now."""
        self._timer.stop()
        if self._path is None:
            return
        try:
            save(self._path, self.guide.kept)
        except OSError as error:
            self.said.emit("warn", f"Plans and readings cannot be kept in {self._path}: {error.strerror or error}.")

    # inside

    def _change_frame(self) -> None:
        """From the earth to a reference board, or back: the attitudes are others, and a registration is none there."""
        self._ring = self._session.shown
        self._count = self._ring.count
        if self.guide.registration is not None:
            self.remove_registration()
            self.said.emit("warn", ANOTHER_FRAME)

    def _note(self, text: str, data: dict[str, object], number: int | None = None) -> None:
        """Keep the change, and note it in the recording; numbers of relative attitudes are none of the board's own."""
        self._session.note("guidance", text, plain(data), number if self._session.relative is None else None)
        self.flush()

    def _watch_button(self, status: np.ndarray) -> None:
        """A press is a step of the status byte from zero to anything above."""
        chain = np.concatenate(([self._button], status))
        self.pressed = bool(((chain[:-1] == 0) & (chain[1:] > 0)).any())
        self._button = int(chain[-1])

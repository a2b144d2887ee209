"""Finding out what a board speaks: its format (detector.py) and its baud rate. Pure: the caller owns port and clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from imugui.formats import STREAM_FORMATS
from imugui.formats.base import Options
from imugui.formats.detector import Detection, Detector, detect_file

__all__ = ["BaudSearch", "Detection", "Detector", "candidate_bauds", "detect_file"]

BAUDS = (115200, 250000, 9600, 57600, 38400, 230400, 460800, 921600, 500000, 1000000, 19200)
BUDGET = 6.0  # s, from opening the port to a verdict
PATIENCE = 2.5  # s of silence that a board may need after the reset that opening its port causes
SHORTEST_LISTEN = 0.3  # s

MOST_TELLING = ("format", "impossible", "text", "garbage", "silent")


def candidate_bauds(hint: int = 0) -> tuple[int, ...]:
    """The baud rates worth trying, the likeliest first; ``hint`` (this port's last one) before all others."""
    return ((hint,) if hint else ()) + tuple(baud for baud in BAUDS if baud != hint)


class BaudSearch:
    """Which baud rate to listen at, and when to move on, so that a verdict comes within BUDGET seconds.

    The caller sets the port to ``baud`` whenever it changes and feeds what arrives, also nothing at time-outs.
    Noise condemns a rate at once. Silence does not: after opening, a board may be in its boot loader, so the first
    rate is kept for PATIENCE. A few lines of text keep their rate, for banners and self-tests come before data; many
    lines without a message do not (230400 baud read at 250000 looks like text). When all rates are through and time
    is left, the round begins again. At the end ``baud`` is the one that made most sense, and ``detector`` may be fed
    on there, in case the board starts to talk later.
    """

    def __init__(
        self,
        bauds: Sequence[int],
        t: float,
        options: Options | None = None,
        budget: float = BUDGET,
        formats: Sequence[str] = STREAM_FORMATS,
    ) -> None:
        """``t`` and ``budget`` in s. ``formats``: only these are looked for."""
        self._bauds = tuple(bauds)
        self._options = options
        self._formats = tuple(formats)
        self._end = t + budget
        self._turn = 0
        self._heard: dict[int, Detector] = {}  # by baud rate, the most telling of its turns
        self._until = t + PATIENCE
        self.done = False
        self.detector = self._listen(t)

    @property
    def baud(self) -> int:
        """The rate to listen at now."""
        return self._bauds[self._turn % len(self._bauds)]

    @property
    def verdict(self) -> Detection:
        """What was found; when nothing was, the most telling of what was heard at all rates."""
        baud = self._best()
        found = self._heard.get(baud, self.detector).verdict
        if found.kind == "garbage" and len(self._heard) > 1:
            tried = ", ".join(str(rate) for rate, detector in self._heard.items() if detector.bytes)
            return replace(found, sentence=f"bytes arrive but make no text at any baud rate tried ({tried})")
        known = baud and found.kind not in ("garbage", "silent")
        return replace(found, sentence=f"{found.sentence} at {baud} baud") if known else found

    def feed(self, chunk: bytes, t: float) -> None:
        """Take the bytes that arrived at t (s), b"" when none did; then look at ``done`` and ``baud``."""
        if self.done:
            return
        self.detector.feed(chunk, t)
        self._remember()
        if self.detector.kind == "format":
            self.done = True
        elif t >= self._end or self.detector.is_hopeless or (t >= self._until and self.detector.kind != "text"):
            self._leave(t)

    def _leave(self, t: float) -> None:
        """Give this rate up, unless the little that came is enough; at the end go back to the best one."""
        found = self.detector.conclude()
        self._remember()
        self.done = bool(found.format) or t >= self._end
        if not self.done:
            self._turn += 1
            left = len(self._bauds) - self._turn % len(self._bauds)
            self._until = t + max(SHORTEST_LISTEN, (self._end - t) / left)
            self.detector = self._listen(t)
        elif not found.format:
            self._turn = self._bauds.index(self._best())
            self.detector = self._heard[self.baud]

    def _listen(self, t: float) -> Detector:
        detector = Detector(self._options, mid_stream=True, formats=self._formats)
        detector.feed(b"", t)
        return detector

    def _remember(self) -> None:
        before = self._heard.get(self.baud, self.detector)
        if _rank(self.detector) <= _rank(before):
            self._heard[self.baud] = self.detector

    def _best(self) -> int:
        """The rate at which most sense was heard."""
        return min(self._heard, key=lambda baud: _rank(self._heard[baud]), default=self.baud)


def _rank(detector: Detector) -> int:
    return MOST_TELLING.index(detector.kind)

"""What every guided calibration has in common: rows go in, a sentence and a verdict come out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from imugui.samples import Rows


@dataclass(frozen=True)
class Result:
    """A verdict: ``reason`` says in words why it was refused, or what was reached. Each flow adds its values."""

    accepted: bool
    reason: str


class Flow(Protocol):
    """A guided calibration as a step machine without a clock: a page feeds it as rows come, a file in one go."""

    title: str

    @property
    def progress(self) -> float:
        """0 to 1, from stillness, positions or coverage really reached."""

    @property
    def sentence(self) -> str:
        """What to do now, one sentence."""

    @property
    def missing(self) -> tuple[str, ...]:
        """What is still missing, in words."""

    @property
    def done(self) -> bool:
        """Whether there is enough for a verdict."""

    def feed(self, rows: Rows) -> None:
        """Take raw SAMPLE rows, shape (n,), as they come."""

    def result(self) -> Result:
        """The verdict on all that came so far; it may be a refusal."""

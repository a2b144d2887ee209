"""What can be calibrated of a board: the parts in the order in which they should be done."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Part:
    """``needed``: the next step leads there by itself; the others are offered."""

    title: str
    words: str
    needed: bool = True
    needs_mag: bool = False


PARTS: dict[str, Part] = {
    "gyr": Part("Gyroscope", "Its reading at rest, which would turn the picture for ever."),
    "acc": Part("Accelerometer", "Bias and scale, from still positions; they decide about roll and pitch."),
    "axes": Part("Axes", "Which magnetometer axis is which accelerometer axis.", needs_mag=True),
    "mag": Part("Magnetometer", "Hard and soft iron; they decide about the heading.", needs_mag=True),
    "mounting": Part("Mounting", "How the sensor sits in its box or on its tool.", needed=False),
    "temperature": Part("Temperature", "How the gyroscope's bias moves as the board warms up.", needed=False),
}


@dataclass(frozen=True)
class PartState:
    """One part of a profile in words: ``good`` says how good in degrees, ``when`` how old."""

    tone: str = "neutral"
    word: str = "Not calibrated"
    good: str = ""
    when: str = ""
    method: str = ""


def next_part(states: dict[str, PartState], has_mag: bool) -> str:
    """The part to do next: the first needed one that is missing, else the first that is no longer good; or ""."""
    open_parts = [name for name, part in PARTS.items() if part.needed and (has_mag or not part.needs_mag)]
    missing = [name for name in open_parts if states[name].tone in ("neutral", "bad")]
    doubtful = [name for name in open_parts if states[name].tone == "warn"]
    return next(iter(missing + doubtful), "")

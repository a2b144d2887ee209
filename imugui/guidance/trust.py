"""Trust: whether the target may be green now, and if not, why and what to do about it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from imugui.guidance.facts import Facts
from imugui.guidance.sigma import (
    COVER,
    axis_sigma,
    fixed_part,
    heading_age,
    heading_sigma,
    heading_source,
    held,
    seconds_left,
)

__all__ = ["LIMITS", "Facts", "Limits", "Trust", "judge"]

CLOCK_SLACK_S = 0.05
"""A sample may be stamped this much after ``now`` was read; one from farther ahead has a wrong time."""


@dataclass(frozen=True)
class Limits:
    """Where trust ends: age of the newest sample for green and for any number at all, s; expected error, rad."""

    age_s: float = 0.1
    blank_s: float = 0.2
    sigma: float = math.radians(1.0)


LIMITS = Limits()


@dataclass(frozen=True)
class Trust:
    """The verdict. ``reasons``: what is wrong and what to do, the most important first; empty when ``ok``.

    ``blank``: no number may be shown. ``sigma``: expected error of the axis, rad (see sigma.py).
    ``heading_from``: what tells ``heading_sigma``, a key of sigma.SOURCES. ``reference_due_s``: until sigma passes the
    limit with the tool as it is. NaN: not known.
    """

    ok: bool
    reasons: tuple[str, ...]
    sigma: float
    blank: bool
    age_s: float
    heading_age_s: float
    heading_sigma: float
    heading_from: str
    reference_due_s: float


def judge(facts: Facts, limits: Limits = LIMITS) -> Trust:
    """Whether to trust the aiming error now. What is not known (NaN) is not trusted."""
    age, sigma = sample_age(facts), axis_sigma(facts)
    checks = (*_stream(facts, age, limits), *_zero(facts), *_board(facts), *_error(facts, sigma, limits))
    reasons = tuple(sentence for wrong, sentence in checks if wrong)
    blank = not (facts.streaming and age <= limits.blank_s)
    heading = heading_age(facts), heading_sigma(facts), heading_source(facts)
    return Trust(not reasons, reasons, sigma, blank, age, *heading, seconds_left(facts, limits.sigma))


def sample_age(facts: Facts) -> float:
    """Age of the newest usable attitude in s; NaN when there is none, or its time lies in the future."""
    age = facts.now - facts.arrival
    return max(0.0, age) if age > -CLOCK_SLACK_S else math.nan


Checks = tuple[tuple[bool, str], ...]


def _stream(facts: Facts, age: float, limits: Limits) -> Checks:
    late = "No attitude has come yet. Wait, or look at the connection."
    if not math.isnan(age):
        late = f"The newest sample is {1000 * age:.0f} ms old. Wait, or look at cable and connection."
    return (
        (not facts.streaming, "No board is sending. Connect one."),
        (facts.streaming and not age <= limits.age_s, late),
    )


def _zero(facts: Facts) -> Checks:
    begun = "The filter has begun anew since the registration. Register again."
    registered = facts.registration is not None
    return (
        (bool(facts.plan_problem), facts.plan_problem),
        (not registered, "There is no registration, so nothing says what zero is. Register first."),
        (registered and bool(facts.epoch_words), facts.epoch_words),
        (registered and not (facts.epoch_same or facts.epoch_words), begun),
        (not facts.side_confirmed, "The side is not confirmed. Look at the patient and confirm the side."),
    )


def _board(facts: Facts) -> Checks:
    never = "The board is not calibrated, so its tilt may be off by degrees. Calibrate the accelerometer."
    old = facts.profile_warning or "The calibration is out of date."
    field = (
        "The magnetic field is disturbed, and the heading follows it. Take iron and magnets away, or switch the "
        "magnetometer off and register again."
    )
    shaken = "The tool is pushed or shaken, which pulls at its tilt. Move it gently."
    return (
        (not facts.calibrated, never),
        (facts.calibrated and facts.profile_expired, f"{old} Calibrate again."),
        (facts.use_mag and facts.mag_disturbed, field),
        (facts.shaken, shaken),
    )


def _error(facts: Facts, sigma: float, limits: Limits) -> Checks:
    if facts.registration is None or sigma <= limits.sigma:
        return ()
    allowed = f"{math.degrees(limits.sigma):g}°"
    if math.isnan(sigma):
        part = "magnetometer, or switch it off and register again" if facts.use_mag else "board"
        return ((True, f"The expected error is not known, because the sensors' errors are not. Calibrate the {part}."),)
    shown = f"{math.degrees(sigma):.1f}°"
    said = f"The expected error has passed {allowed}" + (f": it is {shown}." if sigma > 1.05 * limits.sigma else ".")
    fixed = COVER * fixed_part(held(facts))
    if fixed > limits.sigma:
        residual = facts.registration.residual_deg > 1.0
        cure = (
            "Register again, more exactly." if residual else "Calibrate the accelerometer and the tool's axis better."
        )
    elif axis_sigma(held(facts)) <= limits.sigma:
        cure = "Hold the tool still for a moment: the filter is not sure of its tilt while it is moved."
    elif facts.use_mag:
        cure = "Calibrate the magnetometer better, or switch it off and register again."
    else:
        cure = "The heading has aged: register again."
    return ((True, f"{said} {cure}"),)

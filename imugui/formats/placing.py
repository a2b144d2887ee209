"""Which columns of some tables become which sensor, in which unit, and why."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from imugui.formats.column_map import NOT_USED
from imugui.formats.columns import ACC, GRAVITY_PART, GYR, LINEAR, MAG
from imugui.formats.evidence import Numbers, scale, speed_unit
from imugui.formats.sheet import Sheet, Triple
from imugui.formats.units import (
    LEVELS,
    LIKELY,
    LINEAR_BELOW,
    SURE,
    UNSURE,
    Guessed,
    canonical,
    gravity_share,
    guess_rate,
    judge_acc,
    judge_gyr,
    judge_mag,
)
from imugui.samples import GRAVITY

USUAL_RATE_HZ = 100.0
SINGLE_UNITS = {
    "temp_c": "C",
    "status": "",
    "lat": "deg",
    "lon": "deg",
    "alt": "m",
    "speed": "m/s",
    "course_deg": "deg",
}
"""What stands for itself, with its usual unit."""
REVERSED = "Sensor Logger on an iPhone reverses the sign"
"""And writes uncalibrated acceleration in g: awesome-sensor-logger, UNITS.md and CROSSPLATFORM.md."""
_SAID_RATE = re.compile(r"\b(?:fs|rate|freq\w*|sampl\w*)\b[^0-9\n]{0,20}(\d+(?:\.\d+)?)", re.IGNORECASE)


@dataclass(frozen=True)
class ColumnGuess:
    """What one column seems to be: a slot of a column map ("" = not used) and a unit, how surely, and why."""

    slot: str = ""
    unit: str = ""
    level: str = SURE
    reason: str = "not used"

    @property
    def name(self) -> str:
        """As a column map names it."""
        return (f"{self.slot}_{self.unit}" if self.unit else self.slot) or NOT_USED


class Placing:
    """The sensors found in some tables, and which of them is used."""

    def __init__(self, sheets: Sequence[Sheet]) -> None:
        self._sheets = sheets
        self._guesses: dict[tuple[int, int], ColumnGuess] = {}
        self._acc: tuple[Triple, str] | None = None
        self._gyr: tuple[Triple, str] | None = None
        triples = [triple for number, sheet in enumerate(sheets) for triple in sheet.triples(number)]
        self._find_acc(triples)
        self._find_gyr(_best(triples, "g"))
        self._find_mag(_best(triples, "m"))
        for number, sheet in enumerate(sheets):
            self._find_singles(number, sheet)

    def column(self, sheet: int, column: int) -> ColumnGuess:
        """The guess for one column."""
        return self._guesses.get((sheet, column)) or ColumnGuess(reason=self._why_not(self._sheets[sheet], column))

    def rate(self, sheet: Sheet) -> tuple[float, Guessed]:
        """The rate of a table without times."""
        for line in sheet.layout.above:
            if said := _SAID_RATE.search(line):
                return float(said[1]), Guessed("Hz", SURE, f"the file says {said[0]!r}")
        acc = self._acc[0].values if self._acc else None
        gyr = self._gyr[0].values if self._gyr else None
        hz = guess_rate(acc, gyr, self._gyr[1] if self._gyr else "")
        if not math.isnan(hz):
            rounded = float(f"{hz:.2g}")
            return rounded, Guessed("Hz", UNSURE, "no times; at about this rate turning agrees with gravity")
        return USUAL_RATE_HZ, Guessed("Hz", UNSURE, "no times, and the motion does not tell the rate")

    def _find_acc(self, triples: Sequence[Triple]) -> None:
        whole: list[tuple[Triple, Guessed]] = []
        parts: list[tuple[Triple, Guessed]] = []
        for triple in triples:
            if triple.kind == "a":
                guessed = self._acc_unit(triple)
                share = abs(gravity_share(triple.values, guessed.unit))
                (whole if share > LINEAR_BELOW else parts).append((triple, guessed))
        if whole:
            triple, guessed = min(whole, key=lambda one: (LEVELS.index(one[1].level), one[0].lesser, one[0].sheet))
            self._acc = triple, guessed.unit
            self._use(triple, ACC, guessed)
            return
        self._find_parts(_best(triples, "lin") or (parts[0][0] if parts else None), _best(triples, "grav"))

    def _find_parts(self, linear: Triple | None, gravity: Triple | None) -> None:
        """Acceleration without gravity, and gravity; together they are what an accelerometer measures."""
        judged = judge_acc(gravity.values, gravity.unit) if gravity else Guessed("m/s2", UNSURE, "")
        if gravity and self._is_sensor_logger(gravity):
            # only its iPhone version lacks the whole acceleration
            reason = f"{judged.reason}; {REVERSED} unless units and frames are standardised"
            judged = Guessed(f"{judged.unit}*-1", UNSURE, reason)
        if gravity:
            self._acc = gravity, judged.unit
            self._use(gravity, GRAVITY_PART, judged)
        if linear:
            unit = judged.unit if gravity or not linear.unit else canonical("ax", linear.unit)
            least = f"{gravity_share(linear.values, 'm/s2') * GRAVITY:.2g}"
            reason = f"|acc| is mostly {least}: without gravity" + (", which is added" if gravity else "")
            self._use(linear, LINEAR, Guessed(unit, judged.level, reason))

    def _is_sensor_logger(self, triple: Triple) -> bool:
        return not triple.unit and "seconds_elapsed" in self._sheets[triple.sheet].layout.names

    def _acc_unit(self, triple: Triple) -> Guessed:
        guessed = judge_acc(triple.values, triple.unit)
        if guessed.unit == "g" and self._is_sensor_logger(triple):
            return Guessed("g*-1", LIKELY, f"{guessed.reason}; {REVERSED}")
        return guessed

    def _find_gyr(self, triple: Triple | None) -> None:
        if triple is None:
            return
        t = self._sheets[triple.sheet].seconds
        acc = self._acc_at(triple.sheet, t)
        if t is None:
            t = np.arange(len(triple.values)) / USUAL_RATE_HZ  # near enough to tell rad/s from deg/s
        guessed = judge_gyr(triple.values, triple.unit, acc, self._acc[1] if self._acc else "", t)
        self._gyr = triple, guessed.unit
        self._use(triple, GYR, guessed)

    def _acc_at(self, sheet: int, t: Numbers | None) -> Numbers | None:
        """The accelerometer at the times of a table."""
        if self._acc is None:
            return None
        triple = self._acc[0]
        times = self._sheets[triple.sheet].seconds
        if t is None or times is None:
            return triple.values if triple.sheet == sheet else None
        good = np.isfinite(triple.values).all(axis=1) & np.isfinite(times)
        return np.column_stack([np.interp(t, times[good], axis, np.nan, np.nan) for axis in triple.values[good].T])

    def _find_mag(self, triple: Triple | None) -> None:
        if triple is not None:
            self._use(triple, MAG, judge_mag(triple.values, triple.unit))

    def _use(self, triple: Triple, slots: Iterable[str], guessed: Guessed) -> None:
        for slot, column in zip(slots, triple.columns, strict=True):
            self._place(triple.sheet, column, slot, guessed)

    def _place(self, sheet: int, column: int, slot: str, guessed: Guessed) -> None:
        """Without a header line nothing is certain: that a column is there at all rests on its numbers."""
        named = self._sheets[sheet].layout.has_header
        level, reason = (guessed.level, guessed.reason) if named else (UNSURE, f"no header line; {guessed.reason}")
        self._guesses[sheet, column] = ColumnGuess(slot, guessed.unit, level, reason)

    def _find_singles(self, number: int, sheet: Sheet) -> None:
        if sheet.time is not None:
            column, guessed = sheet.time
            self._place(number, column, "t", guessed)
        taken = {guess.slot for guess in self._guesses.values()}
        for column, meaning in enumerate(sheet.meanings):
            if meaning.kind in SINGLE_UNITS and meaning.kind not in taken:
                taken.add(meaning.kind)
                self._guesses[number, column] = _single(sheet, column)

    def _why_not(self, sheet: Sheet, column: int) -> str:
        meaning = sheet.meanings[column]
        if meaning.kind == "t":
            return "not used: no time, or not the best one"
        if meaning.axis:
            return "not used: another one of its kind is better, or an axis is missing"
        return "not used: its name says nothing that imugui reads" if sheet.layout.has_header else "not used"


def _single(sheet: Sheet, column: int) -> ColumnGuess:
    """A column that stands for itself."""
    meaning = sheet.meanings[column]
    slot = meaning.kind
    if meaning.unit:
        known = not math.isnan(scale(slot, meaning.unit))
        said = f"named {meaning.unit}"
        return ColumnGuess(slot, canonical(slot, meaning.unit), SURE, said) if known else ColumnGuess(reason=said)
    if slot == "speed" and (unit := _speed_unit(sheet, column)):
        return ColumnGuess(slot, unit, LIKELY, f"no unit is named; with {unit} it agrees with the positions")
    usual = SINGLE_UNITS[slot]
    return ColumnGuess(slot, usual, LIKELY, f"no unit is named; {usual} is usual" if usual else "by its name")


def _speed_unit(sheet: Sheet, column: int) -> str:
    places = [[k for k, meaning in enumerate(sheet.meanings) if meaning.kind == kind] for kind in ("lat", "lon")]
    if sheet.seconds is None or not all(places):
        return ""
    lat, lon = (sheet.numbers[:, place[0]] for place in places)
    return speed_unit(lat, lon, sheet.numbers[:, column], sheet.seconds)


def _best(triples: Sequence[Triple], kind: str) -> Triple | None:
    there = [triple for triple in triples if triple.kind == kind and np.isfinite(triple.values).all(axis=1).any()]
    return min(there, key=lambda triple: (triple.lesser, triple.sheet), default=None)

"""Columns of a board of unknown kind: what the user says of them, as names that the csv-line format reads."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field

from imugui.formats.columns import read_name, table_from
from imugui.formats.families import ALIGNED

IGNORED = ""
SKIP = "skip"  # the name of a column that is not used; means nothing to the format
MEANINGS: dict[str, str] = {
    IGNORED: "not used",
    "t": "Time",
    "ax": "Acceleration x",
    "ay": "Acceleration y",
    "az": "Acceleration z",
    "gx": "Angular rate x",
    "gy": "Angular rate y",
    "gz": "Angular rate z",
    "mx": "Magnetic field x",
    "my": "Magnetic field y",
    "mz": "Magnetic field z",
    "temp_c": "Temperature, °C",
    "status": "Status or button",
}
"""What a column can be: slot and title."""

FEWEST = 3  # values that make a line of numbers
_NUMBERS = re.compile(r"[-+0-9.][-+0-9.eE,;\t ]*$")


@dataclass(frozen=True)
class Quantity:
    """A group of columns with one unit; ``units`` maps the format's word to the title on screen."""

    title: str
    units: dict[str, str]


QUANTITIES: dict[str, Quantity] = {
    "a": Quantity("Acceleration", {"g": "g", "mps2": "m/s²", "mg": "mg"}),
    "g": Quantity("Angular rate", {"dps": "°/s", "radps": "rad/s", "mdps": "m°/s"}),
    "m": Quantity("Magnetic field", {"ut": "µT", "mgauss": "mG", "gauss": "G", "nt": "nT"}),
    "t": Quantity("Time", {"s": "s", "ms": "ms", "us": "µs"}),
}


@dataclass(frozen=True)
class Meaning:
    """What the user says: a slot for each column, and unit and counts per unit of each quantity."""

    slots: tuple[str, ...]
    units: dict[str, str] = field(default_factory=lambda: {key: next(iter(q.units)) for key, q in QUANTITIES.items()})
    counts: dict[str, float] = field(default_factory=lambda: dict.fromkeys(QUANTITIES, 1.0))

    def names(self) -> tuple[str, ...]:
        """Column names such as ("t_ms", "ax_g/16384")."""
        return tuple(self._name(slot) for slot in self.slots)

    def problem(self) -> str:
        """Why no sample can be made of these columns, in words; "" when it can."""
        twice = [slot for slot, n in Counter(self.slots).items() if n > 1 and slot != IGNORED]
        if twice:
            return f"{MEANINGS[twice[0]]} is named twice."
        wrong = table_from(self.names(), b",", ALIGNED).problem
        return f"Not enough yet: {wrong}." if wrong else ""

    def _name(self, slot: str) -> str:
        quantity = slot[:1] if slot[:1] in QUANTITIES and slot != "temp_c" else ""
        if not quantity:
            return slot or SKIP
        counts = self.counts[quantity]
        return f"{slot}_{self.units[quantity]}" + (f"/{counts:g}" if counts != 1.0 else "")


def meaning_of(names: Sequence[str], width: int) -> Meaning:
    """What earlier names said, cut or filled up to ``width`` columns; a guess when there are none."""
    if not names:
        return guess(width)
    meaning = Meaning(tuple(_slot(name) for name in [*names, *[SKIP] * width][:width]))
    for name in names:
        slot, _, unit = name.partition("_")
        unit, _, counts = unit.partition("/")
        key = slot[:1]
        if key in QUANTITIES and unit in QUANTITIES[key].units:
            meaning.units[key] = unit
            meaning.counts[key] = float(counts) if re.fullmatch(r"[0-9.]*[0-9][0-9.e+]*", counts) else 1.0
    return meaning


def guess(width: int) -> Meaning:
    """Time first when the rest then fits six or nine values; otherwise accelerometer, gyroscope, magnetometer."""
    slots = [slot for slot in MEANINGS if slot not in (IGNORED, "t", "temp_c", "status")]
    timed = width in (7, 8, 10, 11, 12)
    ordered = (["t"] if timed else []) + slots[: 9 if width >= 9 else 6]
    return Meaning(tuple([*ordered, *[IGNORED] * width][:width]))


def _slot(name: str) -> str:
    column = read_name(name)
    return column.slot if column and column.slot in MEANINGS else IGNORED


def bare_lines(texts: Sequence[str]) -> list[str]:
    """The lines of numbers in entries of the link log, which put a reason before them."""
    found = (_NUMBERS.search(text) for text in texts)
    return [match[0] for match in found if match and len(cells(match[0])) >= FEWEST]


def cells(line: str, delimiter: str = "") -> list[str]:
    """The values of one line; without a delimiter the first of tab, semicolon, comma and space that occurs."""
    found = delimiter or next((sign for sign in "\t;, " if sign in line.strip()), ",")
    parts = line.strip().split(None if found == " " else found)
    return [part.strip() for part in parts]


def width_of(lines: Sequence[str], delimiter: str = "") -> int:
    """The number of columns that most lines have; 0 without lines."""
    widths = Counter(len(cells(line, delimiter)) for line in lines)
    return widths.most_common(1)[0][0] if widths else 0

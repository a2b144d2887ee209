"""What comes out of a table's first rows through a column map, and whether that can be right."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from imugui.formats.column_map import ColumnMap
from imugui.formats.evidence import FIELD_UT, median_norm, turning
from imugui.formats.layout import Layout, TableError
from imugui.formats.table import decode, join
from imugui.formats.units import GRAVITY_BETWEEN, STILL
from imugui.samples import GRAVITY, SAMPLE, Rows

RIGHT = 0.1  # share by which gravity may be off and be called right
TURN_BETWEEN = (0.5, 2.0)


@dataclass(frozen=True)
class Finding:
    """Something that speaks for the map ("good"), against it ("warn"), or neither ("neutral")."""

    about: str  # "rate", "gravity", "turning", "field", "missing" or "lines"
    tone: str
    text: str


@dataclass(frozen=True)
class Preview:
    """SAMPLE rows of the beginning; ``problem`` says why none can be made, "" when they can."""

    rows: Rows
    findings: tuple[Finding, ...]
    problem: str

    @property
    def contradicts(self) -> bool:
        """Whether gravity or the turning say that a unit is wrong, or nothing can be read at all."""
        wrong = any(one.tone == "warn" and one.about in ("gravity", "turning") for one in self.findings)
        return wrong or bool(self.problem)


def preview(tables: Sequence[tuple[Layout, ColumnMap]], rate_hz: float = 0.0) -> Preview:
    """Read the first rows of tables that belong together, as the whole files would be read."""
    none = np.empty(0, SAMPLE)
    wrong = next((column_map.problem for _, column_map in tables if column_map.problem), "")
    if wrong or not tables:
        return Preview(none, (), wrong or "no column is used")
    maps = [column_map for _, column_map in tables]
    read = [
        decode(dataclasses.replace(column_map, skip_lines=0), [layout.text().encode()]) for layout, column_map in tables
    ]
    try:
        rows = join(read, maps, rate_hz)
    except TableError as error:
        return Preview(none, (), str(error))
    bad = sum(decoder.counts.bad_messages for decoder, _ in read)
    if len(rows) == 0:
        refused = next((text for decoder, _ in read for _, kind, text in decoder.log.entries() if kind == "bad"), "")
        return Preview(none, (), f"no line can be read: {refused[:100]}" if refused else "no line can be read")
    has_time = all(decoder.has_time for decoder, _ in read)
    findings = [_pace(rows, has_time), *_gravity(rows), *_turns(rows), *_field(rows), *_missing(rows)]
    if bad:
        findings.append(Finding("lines", "warn", f"{bad} of the first {bad + len(rows)} lines cannot be read"))
    return Preview(rows, tuple(findings), "")


def _pace(rows: Rows, has_time: bool) -> Finding:
    steps = np.diff(rows["t"])
    middle = float(np.median(steps)) if len(steps) else math.nan
    if not middle > 0.0:
        return Finding("rate", "warn", "the times do not go on")
    if (steps < 0.0).any():
        return Finding("rate", "warn", f"{1 / middle:.4g} rows a second, but some times go back")
    source = "from its times" if has_time else "as you say: the table has no times"
    return Finding("rate", "good" if has_time else "neutral", f"{1 / middle:.4g} rows a second, {source}")


def _gravity(rows: Rows) -> list[Finding]:
    norm = median_norm(rows["acc"])
    if math.isnan(norm):
        return []
    text = f"gravity reads {norm:.2f} m/s²"
    if abs(norm / GRAVITY - 1.0) < RIGHT:
        return [Finding("gravity", "good", f"{text}: right"), *_upside_down(rows)]
    if GRAVITY_BETWEEN[0] < norm / GRAVITY < GRAVITY_BETWEEN[1]:
        return [Finding("gravity", "neutral", f"{text}: it was moved, or the scale is off")]
    return [Finding("gravity", "warn", f"{text}, it should be 9.81: another unit?")]


def _upside_down(rows: Rows) -> list[Finding]:
    mean = np.nanmean(rows["acc"], axis=0)
    lies = np.linalg.norm(np.nanstd(rows["acc"], axis=0)) < STILL * GRAVITY and mean[2] < -0.9 * GRAVITY
    words = "it lies upside down, or the sign is reversed, as on an iPhone"
    return [Finding("gravity", "neutral", words)] if lies else []


def _turns(rows: Rows) -> list[Finding]:
    found = turning(rows["acc"], rows["gyr"], rows["t"])
    if found.errors < -5.0:
        return [Finding("turning", "warn", "turns the other way than gravity: a sign or the axes are wrong")]
    if not found.is_clear:
        return []
    if TURN_BETWEEN[0] < found.ratio < TURN_BETWEEN[1]:
        return [Finding("turning", "good", "turning agrees with gravity")]
    pace = "slow" if found.ratio > 1.0 else "fast"
    factor = max(found.ratio, 1.0 / found.ratio)
    return [Finding("turning", "warn", f"turning is {factor:.3g} times too {pace}, as gravity turns: another unit?")]


def _field(rows: Rows) -> list[Finding]:
    norm = median_norm(rows["mag"])
    if math.isnan(norm):
        return []
    if FIELD_UT[0] < norm < FIELD_UT[1]:
        return [Finding("field", "good", f"field {norm:.3g} µT, like the earth's")]
    return [Finding("field", "warn", f"field {norm:.3g} µT, not the earth's: another unit, or a magnet is near")]


def _missing(rows: Rows) -> list[Finding]:
    lacks = [words for name, words in (("acc", "accelerometer"), ("gyr", "gyroscope")) if np.isnan(rows[name]).all()]
    if lacks:
        return [Finding("missing", "warn", f"no {', no '.join(lacks)}: signals to look at, but no attitude")]
    return (
        [Finding("missing", "neutral", "no magnetometer: the heading will drift")]
        if np.isnan(rows["mag"]).all()
        else []
    )

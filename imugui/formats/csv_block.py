"""Many lines of a table at once: the numbers as line by line, all that follows in a few array steps.

Only lines that are as usual come through here. Where one of them needs a second look, nothing is read, and the
decoder goes through them one by one.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from imugui.formats.columns import POSITION, Table
from imugui.formats.values import ACC_LIMIT2, GYR_LIMIT2, MAG_LIMIT2, NAN, TEMP_LIMIT
from imugui.samples import NO_STATUS, SAMPLE, Rows

LARGEST_T = 1e18  # s
LARGEST_STATUS = 32767
LEAST, MOST = np.array([-90.0, -180.0, 0.0, 0.0, 0.0]), np.array([90.0, 180.0, 8999.0, 499.0, 360.0])
"""Of latitude, longitude, altitude, speed and course: what needs no second look."""

Floats = NDArray[np.float64]


def rows_of(table: Table, text: bytes, chars: bytes, t: float | None, arrival: float) -> Rows | None:
    """SAMPLE rows, shape (n,), of whole lines, or None when they are not all as usual.

    ``chars``: those a number may have. ``t``: their time, s; None: it is in the table.
    """
    values = _numbers(table, text, chars)
    if values is None:
        return None
    if table.factors:
        values *= table.factors
    for place, added in table.sums:
        values[:, place] += values[:, added]
    # SAMPLE's order: t, gyr, acc, mag, temp_c, status, position
    columns = [values[:, index] if index < table.width else None for index in table.indices]
    picked = np.array([np.full(len(values), NAN) if column is None else column for column in columns])
    if t is not None:
        picked[0] = t
    picked[11] = np.where(np.isnan(picked[11]), NO_STATUS, picked[11])
    return _filled(picked, arrival) if _is_usual(picked, table.partial) else None


def _numbers(table: Table, text: bytes, chars: bytes) -> Floats | None:
    """The numbers of n whole lines, shape (n, columns), NaN where there is none."""
    mark, n = table.delimiter, text.count(b"\n")
    end = b"\r\n" if text.endswith(b"\r\n") else b"\n"
    if text.translate(None, chars) != (table.shape + end) * n:
        return None
    if text.count(mark + end) == n:  # an empty last column, as ours often is
        text = mark + text.replace(mark + end, mark + b"nan" + mark)
    else:
        text = mark + text.replace(end, mark)
    while mark + mark in text:  # of a run of empty places every second one is found at a time
        text = text.replace(mark + mark, mark + b"nan" + mark)
    try:
        values = np.fromstring(text[1:-1], sep=mark.decode())
    except (ValueError, DeprecationWarning):  # it ends before the text where that is no number
        return None
    return values.reshape(n, table.width) if len(values) == n * table.width else None


@np.errstate(over="ignore", invalid="ignore")  # what a wild number gives is no usual row
def _is_usual(picked: Floats, partial: bool) -> bool:
    """Whether every row is one that the decoder's quick look lets pass; ``picked`` is (17, n), column by column."""
    gyr, acc, mag = ((picked[k : k + 3] ** 2).sum(axis=0) for k in (1, 4, 7))
    no_gyr, no_acc, no_mag = (np.isnan(picked[k : k + 3]).all(axis=0) for k in (1, 4, 7))
    temp, status, position = picked[10], picked[11], picked[12:].T
    good = (np.abs(picked[0]) < LARGEST_T) & (np.abs(status) <= LARGEST_STATUS)
    good &= ((acc > 0.0) & (acc < ACC_LIMIT2)) | (no_acc & partial)
    good &= (gyr < GYR_LIMIT2) | (no_gyr & partial)
    good &= ((mag > 0.0) & (mag < MAG_LIMIT2)) | no_mag
    good &= (np.abs(temp) < TEMP_LIMIT) | np.isnan(temp)
    nowhere = np.isnan(position)
    if not nowhere.all():
        good &= ((position >= LEAST) & (position <= MOST)).all(axis=1) | nowhere.all(axis=1)
    return bool(good.all())


def _filled(picked: Floats, arrival: float) -> Rows:
    rows = np.empty(picked.shape[1], SAMPLE)
    rows["t"], rows["t_arrival"], rows["temp_c"], rows["status"] = picked[0], arrival, picked[10], picked[11]
    for name, first in (("gyr", 1), ("acc", 4), ("mag", 7)):
        rows[name] = picked[first : first + 3].T
    for column, name in enumerate(POSITION, start=12):
        rows[name] = picked[column]
    return rows

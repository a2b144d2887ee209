"""What the filter panel says of the connected board's delays, and of what was learnt of its gyroscope."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from imugui.calibration.learnt import Learnt
    from imugui.formats.families import Delays
    from imugui.workers.session import BoardDelays

JOINED = "\u00a0"
"""Between a number and its unit, which stay on one line."""
ITS_OWN = "A change holds for this board, and is kept with its profile."


def delays_words(known: BoardDelays, connected: bool) -> str:
    """Where the delays in use come from, in a sentence or two; empty without a board."""
    if not connected:
        return ""
    if known.own is not None:
        table = f"From the table: {_figures(known.table)}." if known.table else "The table does not know it."
        return f"Delays as set for this board, kept with its profile. {table}"
    if known.table is not None:
        return f"Delays from the table: {_figures(known.table)}. {ITS_OWN}"
    return f"The table knows no delays of this board. {ITS_OWN}"


def learnt_words(learnt: Learnt) -> str:
    """The largest scale and misalignment, in per cent, with the digits that their 1 sigma supports."""
    sigma = 100.0 * learnt.matrix_sigma
    decimals = places(sigma)
    scale, across = (100.0 * round(value, decimals + 2) for value in (learnt.scale, learnt.misalignment))
    sign = "−" if scale < 0.0 else "+" if scale > 0.0 else ""
    figures = (f"scale {sign}", abs(scale)), ("misalignment ", across), ("each ±", sigma)
    said = ", ".join(f"{words}{value:.{decimals}f}{JOINED}%" for words, value in figures)
    return f"Learnt of the gyroscope: {said}."


def places(sigma: float) -> int:
    """Decimals with which a figure of this 1 sigma is shown: its own first digit is the last."""
    return 0 if sigma >= 1.0 else 1 if sigma >= 0.1 else 2


def _figures(delays: Delays | None) -> str:
    return f"{delays.gyr_ms:g} and {delays.mag_ms:g}{JOINED}ms ({delays.source})" if delays else ""

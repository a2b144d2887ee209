"""Tuned: a session's filter and the board it runs for: its delays, and what is known and learnt of its gyroscope."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

from imugui.calibration.profile import Profile
from imugui.formats.families import Delays
from imugui.fusion import FILTERS
from imugui.fusion.pipeline import Pipeline
from imugui.samples import Rows
from imugui.workers.board_profile import BoardDelays, BoardProfile
from imugui.workers.fused import Fused

if TYPE_CHECKING:  # start-up time
    from imugui.calibration.learnt import Learnt
    from imugui.workers.learning import Learning

FIELDS = ("gyr_latency_ms", "mag_latency_ms")
NO_DELAYS = 0.0, 0.0
WORST = "matrix_worst"
NO_BOARD = "Connect the board itself to keep what is learnt of it."


def delays_of(params: Any) -> tuple[float, float] | None:
    """The delays among a filter's parameters, ms; None where it has none."""
    if not all(hasattr(params, name) for name in FIELDS):
        return None
    gyr_ms, mag_ms = (float(getattr(params, name)) for name in FIELDS)
    return gyr_ms, mag_ms


def with_delays(params: Any, delays: Delays | tuple[float, float] | None) -> Any:
    """The same parameters with these delays, where the filter has any and something is known of them."""
    if delays is None or delays_of(params) is None:
        return params
    values = (delays.gyr_ms, delays.mag_ms) if isinstance(delays, Delays) else delays
    return dataclasses.replace(params, **dict(zip(FIELDS, values, strict=True)))


def with_worst(params: Any, worst: float) -> Any:
    """The same parameters, with the gyroscope's scale and misalignment at worst so, where the filter asks for that."""
    return dataclasses.replace(params, **{WORST: worst}) if hasattr(params, WORST) else params


class Tuned(Fused):
    """The part of a session that fits the filter to the board. All methods are called in the main thread."""

    def __init__(self, filter_name: str, params: Any, use_mag: bool) -> None:
        super().__init__(filter_name, params, use_mag)
        self._known: BoardProfile | None = None
        self._learning: Learning | None = None
        self._format = ""  # which the connected board speaks
        self._general = delays_of(self.filter_params) or NO_DELAYS
        """The user's delays for boards of which nothing is known."""
        self._general_worst = float(getattr(self.filter_params, WORST, math.inf))
        """How bad the gyroscope of such a board may be."""

    def set_filter(self, name: str, params: Any = None, use_mag: bool = True) -> None:
        """As ``Fused``; what is known of the connected board stays, whatever ``params`` say."""
        params = params if params is not None else FILTERS[name].Params()
        used = self.delays.used
        asked = delays_of(params)
        before = delays_of(self.filter_params)
        if asked is not None and asked != before and (used is None or before is None):
            self._general = asked
        worst = getattr(params, WORST, None)
        if worst is not None and worst != getattr(self.filter_params, WORST, None):
            self._general_worst = worst
        super().set_filter(name, self.board_params(params), use_mag)

    @property
    def delays(self) -> BoardDelays:
        """What is known of the delays of the connected board."""
        return self._known.delays(self._format) if self._has_board and self._known else BoardDelays()

    @property
    def has_delays(self) -> bool:
        """Whether the filter takes delays into account."""
        return delays_of(self.filter_params) is not None

    def reset_delays(self) -> bool:
        """Use the table's delays again, or without any the general ones; False, and a message, where that fails."""
        return self._keep_delays(None)

    def set_params(self, params: Any) -> bool:
        """Use what the user made of the present filter's parameters; False, and a message, where that fails.

        Delays that were changed are the connected board's.
        """
        asked = delays_of(params)
        changed = self._has_board and asked is not None and asked != delays_of(self.filter_params)
        if changed and not self._keep_delays(asked):
            return False
        self.set_filter(self.filter_name, params, self.use_mag)
        return True

    def board_params(self, params: Any) -> Any:
        """These parameters with what is known of the connected board, or with the general values."""
        known = self._known.turn_share if self._has_board and self._known else None
        worst = self._general_worst if known is None else min(known, self._general_worst)
        return with_worst(with_delays(params, self.delays.used or self._general), worst)

    def general_params(self, params: Any) -> Any:
        """These parameters as they are for boards of which nothing is known."""
        return with_worst(with_delays(params, self._general) if self.delays.used else params, self._general_worst)

    def learnt(self) -> Learnt | None:
        """What the filter has learnt of the gyroscope, and why it cannot be kept; None where it learns nothing."""
        if self._learning is None or self._known is None:
            return None
        found = self._learning.learnt(self._known.best, self._known.calibrated.factory)
        return found if found is None or self._has_board else dataclasses.replace(found, refusal=NO_BOARD)

    def _taught(self) -> Profile | None:
        """The board's profile with what was learnt in it; None, and a message, where it cannot be kept."""
        from imugui.calibration.learnt import kept_part  # start-up time

        found, known = self.learnt(), self._known
        if found is None or known is None or found.refusal:
            self.message.emit("warn", found.refusal if found else "This filter learns nothing of the gyroscope.")
            return None
        return (known.profile or Profile(known.board)).with_part(kept_part(found, known.best.gyroscope))

    def _watch_learning(self, rows: Rows, now: float) -> None:
        """Take new ATTITUDE rows, shape (n,), at host time ``now``, s."""
        if self._learning is None:
            if not hasattr(type(self._fusion.pipeline.filter), "matrix_sigma"):
                return
            from imugui.workers.learning import Learning  # start-up time

            self._learning = Learning(self._fusion)
        self._learning.watch(rows, now)

    def _follow_board(self, board_format: str = "") -> None:
        """Another board, or its format was found: use what is known of it."""
        self._format = board_format
        if not self._has_board:
            return  # a recording is fused as it was
        params = self.board_params(self.filter_params)
        if params != self.filter_params:
            old = self._fusion.pipeline
            pipeline = Pipeline(old.filter_name, params, old.correction, old.use_mag, spike_mask=old.spike_mask)
            self._fusion.replace(pipeline, carry_on=True)

    def _keep_delays(self, delays_ms: tuple[float, float] | None) -> bool:
        if self._known is None or not self._has_board:
            self.message.emit("warn", "Connect a board first: its delays are kept with its profile.")
            return False
        try:
            self._known.keep_delays(delays_ms)
        except OSError as error:
            self.message.emit("error", f"The profile could not be written: {error.strerror or error}. Nothing changed.")
            return False
        self._follow_board(self._format)
        return True

    @property
    def _has_board(self) -> bool:
        return self._known is not None and bool(self._known.board.address)

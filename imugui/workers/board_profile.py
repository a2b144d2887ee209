"""What is known of the board that is connected: its identity, its profile, the alarm on its field."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from imugui.calibration.profile import Board, Profile, now_utc
from imugui.calibration.profile_file import ProfileError
from imugui.calibration.profile_store import ProfileStore
from imugui.formats.families import Delays, known_delays
from imugui.fusion.correction import Correction
from imugui.samples import Rows
from imugui.workers.recorded_profile import Calibrated, calibrated_then
from imugui.workers.serial_transport import serial_number
from imugui.workers.transport import Source

if TYPE_CHECKING:
    from imugui.calibration.alarm import FieldAlarm
    from imugui.calibration.rest import RestResult

START_UP_S = 12.0  # how long after connecting a board that lies still gives its gyroscope bias by itself
TRY_EVERY_S = 1.0
ALARM_ROWS = 4096
FACTORY = ("ideal", "mpu9250-calibrated")  # errors of virtual boards that need no calibration of ours


def board_of(source: Source) -> Board:
    """Whose profile a source uses; a file has none of its own."""
    if source.transport == "serial":
        return Board("serial", serial_number(source.address) or source.address)
    if source.transport == "ble":
        return Board("ble", source.address.lower(), source.address)
    if source.transport == "simulator":
        return Board("simulator", f"{source.errors}, seed {source.seed}", f"Simulated board {source.seed}")
    return Board()


@dataclass(frozen=True)
class BoardDelays:
    """How late a board's values are: what its user says, what the table says; None where nothing was said."""

    own: Delays | None = None
    table: Delays | None = None

    @property
    def used(self) -> Delays | None:
        """Those in use; None: the filter's own parameters are."""
        return self.own or self.table


class BoardProfile:
    """The profile in use. Told of rows and time by the session; writes a file only when told to keep a profile."""

    def __init__(self, store: ProfileStore, source: Source) -> None:
        self.store = store
        self.board = board_of(source)
        self.profile: Profile | None = None
        self.alarm: FieldAlarm | None = None
        self._tried = -math.inf
        self.biased = False  # the board lay still after connecting and gave its gyroscope bias by itself
        self._bias_known = source.transport == "replay"
        self._rest: tuple[RestResult, str] | None = None  # that bias, and when
        self._source = source

    @property
    def turn_share(self) -> float | None:
        """1 sigma of what is left of the gyroscope's scale and cross-axis terms; None where nobody measured them."""
        gyroscope = self.best.gyroscope
        if not self.calibrated.factory and (gyroscope is None or not gyroscope.matrix_method):
            return None
        from imugui.guidance.trust_profile import turn_share  # start-up time

        return turn_share(self.best, self.calibrated.factory)

    def load(self) -> list[str]:
        """Find the board's profile; returns a sentence for each thing the user should know."""
        if not self.board.address:
            return []
        try:
            profile = self.store.find(self.board)
        except (ProfileError, OSError) as error:
            return [f"The profile of {self.board.title} is not applied: {error}"]
        self._use(profile)
        return profile.warnings(datetime.now(UTC)) if profile else []

    def keep(self, profile: Profile) -> None:
        """Save a profile as this board's and use it; raises OSError."""
        profile = replace(profile, board=replace(self.board, name=profile.board.name or self.board.name))
        if self.board.address:
            self.store.save(profile)
        self._use(profile)

    def keep_delays(self, delays_ms: tuple[float, float] | None) -> None:
        """Save what the user says of the board's delays, None for nothing; all else goes on. Raises OSError."""
        profile = replace(self.profile or Profile(self.board), delays_ms=delays_ms)
        self.store.save(profile)
        self.profile = profile

    def delays(self, board_format: str) -> BoardDelays:
        """What is known of the delays of this board, which speaks that format."""
        said = self.profile.delays_ms if self.profile else None
        real = self._source.transport in ("serial", "ble")
        table = known_delays(board_format, self._source.options.family) if real else None
        return BoardDelays(Delays(*said, "set for this board") if said else None, table)

    @property
    def best(self) -> Profile:
        """The profile, with the bias that the board gave at rest after connecting."""
        profile = self.profile or Profile(self.board)
        if self._rest is None or not self.biased:
            return profile
        from imugui.calibration.build import gyroscope_part  # start-up time

        part = gyroscope_part(self._rest[0], date=self._rest[1])
        return profile.with_part(replace(part, **profile.gyroscope.scale) if profile.gyroscope else part)

    def forget(self) -> None:
        """Use no profile any more, and delete its file; raises OSError."""
        self.store.remove(self.board)
        self._use(None)

    def correction(self, temp_c: float) -> Correction:
        """What the pipeline takes out of every sample, at a temperature in deg C (NaN: not known)."""
        return self.profile.correction(temp_c) if self.profile else Correction()

    def start_up_bias(self, rows: Rows, connected_s: float) -> Correction | None:
        """Once, if the board lies still in these raw SAMPLE rows (n,): the correction with today's gyroscope bias."""
        if self._bias_known or connected_s > START_UP_S or connected_s - self._tried < TRY_EVERY_S:
            return None
        self._tried = connected_s
        from imugui.calibration.rest import auto_bias  # start-up time

        found = auto_bias(rows)
        if not found.accepted:
            return None
        self._bias_known = self.biased = True
        self._rest = found, now_utc()
        return replace(self.correction(found.temp_c), gyr_bias=found.bias)

    def watch(self, rows: Rows) -> str:
        """The alarm's light after new ATTITUDE rows, shape (n,): "off", "green", "yellow" or "red"."""
        return self.alarm.feed(rows[-ALARM_ROWS:]) if self.alarm and len(rows) else self.light

    @property
    def calibrated(self) -> Calibrated:
        """How the board is calibrated; of a recording, how it was."""
        if self._source.transport == "replay":
            return self._then
        return Calibrated(self.profile, self._source.transport == "simulator" and self._source.errors in FACTORY)

    @cached_property
    def _then(self) -> Calibrated:
        return calibrated_then(Path(self._source.address))

    @property
    def words(self) -> str:
        """What is in use, for the status line; "" when nothing is."""
        parts = [self.profile.board.title] if self.profile and self.profile.parts else []
        return " + ".join(parts + ["bias at rest"] * self.biased)

    @property
    def light(self) -> str:
        return self.alarm.light if self.alarm else "off"

    @property
    def has_mag(self) -> bool:
        """Whether the magnetometer was calibrated."""
        return self.profile is not None and self.profile.magnetometer is not None

    def _use(self, profile: Profile | None) -> None:
        self.profile, self.alarm, self.biased = profile, None, False
        part = profile.magnetometer if profile else None
        if part is not None and part.field_ut > 0.0:
            from imugui.calibration.alarm import FieldAlarm  # start-up time

            self.alarm = FieldAlarm(part.field_ut, part.dip_deg if np.isfinite(part.dip_deg) else None)

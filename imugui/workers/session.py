"""Session: owns the rings and the workers; the only object of this package that views talk to."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal, Slot

from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_store import ProfileStore
from imugui.formats import Options
from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE
from imugui.simulation.motions import MOTIONS
from imugui.workers import TRANSPORTS
from imugui.workers.board_profile import START_UP_S, BoardProfile
from imugui.workers.fusion_worker import AgeCounts, FusionWorker
from imugui.workers.player import SPEEDS, Player
from imugui.workers.reader import Reader
from imugui.workers.record_control import RecordControl
from imugui.workers.recorder import LOW_DISK, RecordingStatus, disk_words
from imugui.workers.replay_transport import ReplayTransport
from imugui.workers.serial_transport import Port, list_ports
from imugui.workers.simulator_transport import SimulatorTransport
from imugui.workers.status import Status, mag_trust
from imugui.workers.transport import Source
from imugui.workers.verdict import Facts, State, Verdict, judge, oddity

__all__ = [
    "LOW_DISK",
    "MOTION_TITLES",
    "SPEEDS",
    "Options",
    "Player",
    "Port",
    "RecordingStatus",
    "Session",
    "Source",
    "State",
    "Status",
]

RING_ROWS = 1 << 17  # two minutes at 1 kHz
LOOK_ROWS = 256  # newest rows that the status is judged by
START_UP_ROWS = 6000  # newest rows in which a still span is looked for

MOTION_TITLES = {name: motion.title for name, motion in MOTIONS.items()}
"""Motions of the virtual board, by name."""


class Session(QObject):
    """One run of the program with its connection. All methods are called in the main thread."""

    state_changed = Signal(object)  # State
    message = Signal(str, str)  # tone "info", "warn" or "error"; a sentence

    def __init__(
        self,
        filter_name: str = DEFAULT_FILTER,
        params: Any = None,
        use_mag: bool = True,
        profiles: ProfileStore | None = None,
    ) -> None:
        """``profiles``: where boards' calibrations are kept; without it they live as long as the session."""
        super().__init__()
        self._folder = None if profiles else tempfile.TemporaryDirectory(prefix="imugui-", ignore_cleanup_errors=True)
        self.profiles = profiles or ProfileStore(Path(self._folder.name if self._folder else ""))
        self._known: BoardProfile | None = None
        self._connected = 0.0
        self._watched = 0
        self.samples = Ring(SAMPLE, RING_ROWS)
        self.attitude = Ring(ATTITUDE, RING_ROWS)
        name = filter_name if filter_name in FILTERS else DEFAULT_FILTER
        self._fusion = FusionWorker(self.samples, self.attitude, Pipeline(name, params, use_mag=use_mag))
        self._fusion.failed.connect(self._defect)
        self._reader: Reader | None = None
        self._transport: Any = None
        self._record = RecordControl(self.samples, self.attitude, self._fusion)
        self._origin: tuple[float, ...] | None = None
        self._zeroed: bool | None = None  # what the user did last about the origin; None: a recording may have one
        self._first_row = 0
        self._last_state = State.IDLE

    # connection

    def connect_to(self, source: Source) -> None:
        """Leave the present source and read this one; problems come as a state and in words, never as exceptions."""
        self.disconnect_source()
        self._transport = TRANSPORTS[source.transport](source)
        self._first_row = self.samples.count
        self.reset_ages()
        self._fusion.missed_rows = 0
        self._origin, self._zeroed = None, None
        self._known = BoardProfile(self.profiles, source)
        for warning in self._known.load():
            self.message.emit("warn", warning)
        self._connected, self._watched = time.perf_counter(), self.attitude.count
        self._use(self._known.correction(math.nan), carry_on=False)
        self._reader = Reader(source, self._transport, self.samples, self._fusion)
        if isinstance(self._transport, ReplayTransport):
            self._transport.room = self._room
        self._reader.changed.connect(self._link_changed)
        self._reader.told.connect(self.message)
        self._reader.failed.connect(self._defect)
        self._reader.start()
        if not self._fusion.isRunning():
            self._fusion.start()
        self._announce()

    def disconnect_source(self) -> None:
        """Stop reading, and end a recording; the rings keep what was received."""
        self.stop_recording()
        if self._reader is not None:
            if isinstance(self._transport, ReplayTransport):
                self._transport.cancel()
            reader, self._reader, self._transport = self._reader, None, None
            reader.changed.disconnect(self._link_changed)
            reader.stop()
            self._known = None
        self._announce()

    def close(self) -> None:
        """Stop every thread."""
        self.disconnect_source()
        if self._fusion.isRunning():
            self._fusion.stop()
        if self._folder is not None:
            self._folder.cleanup()

    @property
    def source(self) -> Source | None:
        """What is connected, or None."""
        return self._reader.source if self._reader else None

    def serial_ports(self) -> list[Port]:
        """Serial ports of this computer."""
        return list_ports()

    def link_log(self) -> list[tuple[float, str, str]]:
        """(host time s, kind, text) of everything on the link that was not data, oldest first."""
        return self._reader.intake.log_entries() if self._reader else []

    # the virtual board

    @property
    def hand_turned(self) -> bool:
        """True while the virtual board waits to be turned by the mouse."""
        return isinstance(self._transport, SimulatorTransport) and self._transport.hand is not None

    def turn_board(self, dx_rad: float, dy_rad: float, viewer: NDArray[np.float64]) -> None:
        """Turn the virtual board as a mouse drags it: right by dx, down by dy, rad.

        ``viewer`` (4,) is the rotation from the viewer's axes (x right, y up, z to the eye) to the earth's.
        """
        hand = self._transport.hand if isinstance(self._transport, SimulatorTransport) else None
        if hand is not None:
            hand.viewer = viewer
            hand.turn(dx_rad, dy_rad)

    # fusion

    @property
    def filter_name(self) -> str:
        return self._fusion.pipeline.filter_name

    @property
    def filter_params(self) -> Any:
        return self._fusion.pipeline.params

    @property
    def use_mag(self) -> bool:
        return self._fusion.pipeline.use_mag

    @property
    def fusion_settings(self) -> dict[str, Any]:
        """All that was chosen for the fusion, as plain values: filter, parameters, correction, magnetometer, origin."""
        return self._fusion.pipeline.settings()

    def set_filter(self, name: str, params: Any = None, use_mag: bool = True) -> None:
        """Replace the pipeline whole; the new filter starts from the last attitude and keeps the origin."""
        old = self._fusion.pipeline
        self._fusion.replace(Pipeline(name, params, old.correction, use_mag), carry_on=True)

    @property
    def has_origin(self) -> bool:
        return self._fusion.has_origin if self._zeroed is None else self._zeroed

    def set_origin(self) -> bool:
        """Make the newest attitude the origin; False when there is none."""
        newest = self.attitude.last(1)
        if len(newest) == 0 or self.status().state is not State.STREAMING:
            return False
        self._origin = tuple(float(value) for value in newest["quat"][0])
        self._zeroed = True
        self._fusion.set_origin(self._origin)
        return True

    def clear_origin(self) -> None:
        """Show attitudes in the earth's axes again."""
        self._origin, self._zeroed = None, False
        self._fusion.set_origin(None)

    @property
    def mag_updates(self) -> int:
        """New magnetometer measurements that reached the filter since it was set."""
        return self._fusion.pipeline.mag_updates

    def age_quantiles(self) -> dict[str, float]:
        """{"p50", "p95", "p99"} of arrival of bytes to attitude published, ms."""
        return self._fusion.ages.quantiles()

    def reset_ages(self) -> None:
        """Count ages anew."""
        self._fusion.ages = AgeCounts()

    # calibration

    @property
    def board(self) -> Board | None:
        """Whose calibration is in use; None while nothing is connected, or a file is."""
        return self._known.board if self._known and self._known.board.address else None

    @property
    def profile(self) -> Profile | None:
        """The calibration in use."""
        return self._known.profile if self._known else None

    def apply_profile(self, profile: Profile) -> bool:
        """Keep a profile as that of the connected board, and use it from now on; False, and a message, if it fails."""
        return self._change_profile(lambda known: known.keep(profile))

    def remove_profile(self) -> bool:
        """Delete the connected board's profile, and use none."""
        return self._change_profile(lambda known: known.forget())

    def _change_profile(self, change: Callable[[BoardProfile], None]) -> bool:
        if self._known is None:
            self.message.emit("warn", "Connect a board first: a profile belongs to a board.")
            return False
        try:
            change(self._known)
        except OSError as error:
            self.message.emit("error", f"The profile could not be written: {error.strerror or error}. Nothing changed.")
            return False
        newest = self.samples.last(1)
        self._use(self._known.correction(float(newest["temp_c"][0]) if len(newest) else math.nan), carry_on=False)
        return True

    def _use(self, correction: Correction, carry_on: bool) -> None:
        """Fuse with this correction from now on; not ``carry_on``: from the accelerometer and field, anew."""
        pipeline = Pipeline(self.filter_name, self.filter_params, correction, self.use_mag, self._origin)
        self._fusion.replace(pipeline, carry_on)

    def _look_after(self, now: float) -> None:
        """What the calibration does by itself: the bias of a board that lies still, the alarm on the field."""
        if self._known is None:
            return
        rows, self._watched, _ = self.attitude.since(self._watched)
        self._known.watch(rows)
        connected = now - self._connected
        if connected < START_UP_S:
            raw = self.samples.last(min(START_UP_ROWS, self.samples.count - self._first_row))
            found = self._known.start_up_bias(raw, connected)
            if found is not None:
                self._use(found, carry_on=True)

    # recording

    def record(self, folder: Path, label: str = "", note: str = "") -> bool:
        """Begin a recording in a new folder; False, and a message, when the disk refuses or nothing is connected."""
        if self._reader is None:
            self.message.emit("warn", "Connect a board first: there is nothing to record.")
            return False
        if self.recording is not None:
            self.message.emit("warn", "A recording runs already.")
            return False
        try:
            recorder = self._record.start(folder, self._reader, label, note)
        except OSError as error:
            self.message.emit("error", disk_words(error, folder))
            return False
        recorder.failed.connect(self._defect)
        recorder.stopped_by_disk.connect(self._disk_failed)
        return True

    def stop_recording(self) -> Path | None:
        """End the recording in order; its folder, or None when there was none."""
        return self._record.stop(self._reader)

    @property
    def recording(self) -> RecordingStatus | None:
        """The recording that runs, or None."""
        return self._record.status

    def mark(self, text: str = "") -> bool:
        """Note a marker in the recording at this moment; False when there is none."""
        return self._record.mark(text)

    @property
    def player(self) -> Player | None:
        """Play, pause, seek and speed, while a file is the source."""
        return self._transport.player if isinstance(self._transport, ReplayTransport) else None

    # status

    def status(self) -> Status:
        """A snapshot; cheap enough for ten a second."""
        now = time.perf_counter()
        verdict = self._verdict(now)
        self._note(verdict.state)
        self._look_after(now)
        reader, known = self._reader, self._known
        if reader is None or known is None:
            return Status(verdict.state, verdict.sentence, filter=self.filter_name)
        fused = self.attitude.last(min(LOOK_ROWS, self.attitude.count))
        trust, norm = mag_trust(fused, self.use_mag, known.has_mag, known.light)
        counts, clock = reader.intake.counts, reader.intake.clock
        newest = self.samples.last(1)
        return Status(
            state=verdict.state,
            sentence=verdict.sentence,
            source=reader.source.address,
            format=reader.intake.format,
            seen=reader.intake.seen,
            baud=reader.intake.baud,
            rate_hz=self.rate_hz if verdict.state in (State.STREAMING, State.IMPOSSIBLE) else 0.0,
            jitter_ms=clock.jitter_s * 1e3,
            messages=counts.messages,
            bad_messages=counts.bad_messages,
            samples=self.samples.count - self._first_row,
            gaps=clock.gaps,
            gap_s=clock.gap_s,
            missed_rows=self._fusion.missed_rows,
            age_ms=(now - float(newest["t_arrival"][0])) * 1e3 if len(newest) else math.nan,
            has_mag=trust != "none",
            mag_trust=trust,
            mag_alarm=known.light,
            profile=known.words,
            mag_norm_ut=norm,
            temp_c=float(newest["temp_c"][0]) if len(newest) else math.nan,
            filter=self.filter_name,
        )

    @property
    def rate_hz(self) -> float:
        """Samples a second as fitted over the connection (0.1 % after 10 s), in the board's own time; 0 if unknown."""
        period = self._reader.intake.clock.period if self._reader else math.nan
        return 1.0 / period if period > 0.0 else 0.0

    def _verdict(self, now: float) -> Verdict:
        reader = self._reader
        if reader is None:
            return judge(Facts(now, "idle"))
        newest = self.samples.last(min(LOOK_ROWS, self.samples.count - self._first_row))
        return judge(reader.facts(now, oddity(newest)))

    def _room(self) -> int:
        """How many rows the fusion thread can still take without missing any."""
        return RING_ROWS // 2 - (self.samples.count - self._fusion.done)

    # from the workers

    @Slot()
    def _link_changed(self) -> None:
        if self._reader is None:
            return
        link = self._reader.link
        if link.phase in ("lost", "failed") and link.problem is not None:
            self.message.emit("error", link.problem.sentence)
        elif link.phase == "open" and link.breaks:
            self.message.emit("info", f"{self._reader.source.address} is back.")
        self._announce()

    @Slot(str)
    def _disk_failed(self, text: str) -> None:
        self.message.emit("error", text)
        self.stop_recording()

    @Slot(str)
    def _defect(self, text: str) -> None:
        self.message.emit("error", f"A defect in imugui: {text}. Data keep coming in; please report it.")

    def _announce(self) -> None:
        self._note(self._verdict(time.perf_counter()).state)

    def _note(self, state: State) -> None:
        if state is not self._last_state:
            self._last_state = state
            self.state_changed.emit(state)

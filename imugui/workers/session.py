"""Session: owns the rings and the workers; the only object of this package that views talk to."""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Signal, Slot

from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_store import ProfileStore
from imugui.formats import Options
from imugui.fusion import DEFAULT_FILTER
from imugui.fusion.correction import Correction
from imugui.fusion.pipeline import Pipeline
from imugui.fusion.quaternion import multiply
from imugui.workers import TRANSPORTS
from imugui.workers.bluetooth import Bluetooth
from imugui.workers.board_profile import START_UP_S, BoardDelays, BoardProfile, board_of
from imugui.workers.fused import RING_ROWS
from imugui.workers.player import SPEEDS, Player
from imugui.workers.record_control import RecordControl
from imugui.workers.recorder import LOW_DISK, RecordingStatus, disk_words
from imugui.workers.serial_transport import Port, list_ports
from imugui.workers.snapshot import LOOK_ROWS, fitted_rate_hz, snapshot
from imugui.workers.status import RelativeStatus, Status
from imugui.workers.transport import Source
from imugui.workers.tuned import Tuned
from imugui.workers.verdict import Facts, State, Verdict, judge, oddity

if TYPE_CHECKING:  # start-up time
    from imugui.workers.ble_loop import Radio
    from imugui.workers.ble_scan import Scan, Sighting
    from imugui.workers.reader import Reader

__all__ = [
    "LOW_DISK", "SPEEDS", "BoardDelays", "Options", "Player", "Port", "RecordingStatus", "RelativeStatus",
    "Scan", "Session", "Sighting", "Source", "State", "Status",
]  # fmt: skip

PATIENCE_S = 1.0  # how long the window waits for a port that is being opened to be left
START_UP_ROWS = 6000  # newest rows in which a still span is looked for


class Session(Tuned):
    """One run of the program with its connection. All methods are called in the main thread."""

    state_changed = Signal(object)  # State

    def __init__(
        self,
        filter_name: str = DEFAULT_FILTER,
        params: Any = None,
        use_mag: bool = True,
        profiles: ProfileStore | None = None,
        radio: Radio | None = None,
    ) -> None:
        """``profiles``: where boards' calibrations are kept; without it they live as long as the session.

        ``radio``: Bluetooth, shared by all sessions of a program; its owner stops it.
        """
        super().__init__(filter_name, params, use_mag)
        self.bluetooth = Bluetooth(radio)
        self._folder = None if profiles else tempfile.TemporaryDirectory(prefix="imugui-", ignore_cleanup_errors=True)
        self.profiles = profiles or ProfileStore(Path(self._folder.name if self._folder else ""))
        self._connected = 0.0
        self._watched = 0
        self._reader: Reader | None = None
        self._transport: Any = None
        self._record = RecordControl(self.samples, self.attitude, self._fusion)
        self._reference: Session | None = None
        self._beside: list[Session] = []
        self._beside_of: Session | None = None
        self._origin: tuple[float, ...] | None = None
        self._zeroed: bool | None = None  # what the user did last about the origin; None: a recording may have one
        self._first_row = 0
        self._last_state = State.IDLE
        self._leaving: list[Reader] = []  # told to stop while their port was being opened, which cannot be hurried

    # connection

    def connect_to(self, source: Source) -> None:
        """Leave the present source and read this one; problems come as a state and in words, never as exceptions."""
        self.disconnect_source()
        kind = TRANSPORTS[source.transport]
        self._transport = kind(source, self.radio) if getattr(kind, "wireless", False) else kind(source)
        self._first_row = self.samples.count
        self.reset_ages()
        self._fusion.missed_rows = 0
        self._origin, self._zeroed = None, None
        self._know(source)
        from imugui.workers.reader import Reader  # start-up time

        self._reader = Reader(source, self._transport, self.samples, self._fusion)
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
            self._transport.cancel()
            reader, self._reader, self._transport = self._reader, None, None
            for signal in (reader.changed, reader.told, reader.failed):
                signal.disconnect()
            if not reader.stop(PATIENCE_S):
                self._leaving.append(reader)
            self._known = None
        self._announce()

    def close(self) -> None:
        """Stop every thread, and those of the sessions beside this one."""
        for session in tuple(self._beside):
            session.close()
        if self._beside_of is not None and self in self._beside_of._beside:  # its memory is given back
            self._beside_of._beside.remove(self)
        self.disconnect_source()
        for reader in self._leaving:
            reader.stop()
        self._stop_threads()
        self.bluetooth.stop()
        if self._folder is not None:
            self._folder.cleanup()

    @property
    def source(self) -> Source | None:
        """What is connected, or None."""
        return self._reader.source if self._reader else None

    @property
    def radio(self) -> Radio:
        """Bluetooth's thread."""
        return self.bluetooth.radio

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
        return getattr(self._transport, "hand", None) is not None

    def turn_board(self, dx_rad: float, dy_rad: float, viewer: NDArray[np.float64]) -> None:
        """Turn the virtual board as a mouse drags it: right by dx, down by dy, rad.

        ``viewer`` (4,) is the rotation from the viewer's axes (x right, y up, z to the eye) to those of ``shown``.
        """
        hand = getattr(self._transport, "hand", None)
        if hand is not None:
            hand.viewer = viewer if self.relative is None else multiply(self.relative.to_earth, viewer)
            hand.turn(dx_rad, dy_rad)

    # a second board

    def beside(self) -> Session:
        """A session for another board: with the same filter, profiles and Bluetooth."""
        params = self.general_params(self.filter_params)
        session = Session(self.filter_name, params, self.use_mag, self.profiles, self.radio)
        session._beside_of = self
        self._beside.append(session)
        return session

    @property
    def reference(self) -> Session | None:
        """The board in whose frame this one is looked at, or None."""
        return self._reference

    def measure_against(self, reference: Session | None) -> None:
        """Look at this board in the frame of another one from now on: ``shown``, origin and guidance. None: no more."""
        self._unrelate()
        self._reference = reference
        if reference is not None:
            self._relate(reference)

    # origin

    @property
    def has_origin(self) -> bool:
        if self.relative is not None:
            return self.relative.has_origin
        return self._fusion.has_origin if self._zeroed is None else self._zeroed

    def set_origin(self) -> bool:
        """Make the newest attitude the origin; False when there is none.

        Against a reference board: that the two are held the same way round now, so that their headings are equal.
        """
        if self.relative is not None:
            return self.relative.align()
        newest = self.attitude.last(1)
        if len(newest) == 0 or self.status().state is not State.STREAMING:
            return False
        self._origin = tuple(float(value) for value in newest["quat"][0])
        self._zeroed = True
        self._fusion.set_origin(self._origin)
        return True

    def clear_origin(self) -> None:
        """Show attitudes in the earth's axes again; against a reference board: forget how the two were held."""
        if self.relative is not None:
            self.relative.clear()
            return
        self._origin, self._zeroed = None, False
        self._fusion.set_origin(None)

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

    def keep_learnt(self) -> bool:
        """Keep in the board's profile what the filter has learnt; False, and a message, where that cannot be done."""
        profile = self._taught()
        if profile is None or not self.apply_profile(replace(profile, rate_hz=self.rate_hz or profile.rate_hz)):
            return False
        self.message.emit("info", "What was learnt of the gyroscope is in the profile of this board, and in use.")
        return True

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

    def _know(self, source: Source) -> None:
        """Use the profile of the board behind a source."""
        self._known, self._learning, self._format = BoardProfile(self.profiles, source), None, ""
        for warning in self._known.load():
            self.message.emit("warn", warning)
        self._connected, self._watched = time.perf_counter(), self.attitude.count
        self._use(self._known.correction(math.nan), carry_on=False)

    def _use(self, correction: Correction, carry_on: bool) -> None:
        """Fuse with this correction from now on; not ``carry_on``: from the accelerometer and field, anew."""
        chosen = self.filter_name, self.board_params(self.filter_params), correction, self.use_mag
        pipeline = Pipeline(*chosen, self._origin, self.spike_mask)
        self._fusion.replace(pipeline, carry_on)

    def _look_after(self, now: float) -> None:
        """What the calibration does by itself: the bias of a board that lies still, the alarm on the field."""
        if self._known is None:
            return
        rows, self._watched, _ = self.attitude.since(self._watched)
        self._known.watch(rows)
        self._watch_learning(rows, now)
        connected = now - self._connected
        if connected < START_UP_S:
            raw = self.samples.last(min(START_UP_ROWS, self.samples.count - self._first_row))
            found = self._known.start_up_bias(raw, connected)
            if found is not None:
                self._use(found, carry_on=True)

    # recording

    def record(self, folder: Path, label: str = "", note: str = "") -> bool:
        """Begin a recording in a new folder; False, and a message, when the disk refuses or nothing is connected."""
        if self._reader is None or self._known is None:
            self.message.emit("warn", "Connect a board first: there is nothing to record.")
            return False
        if self.recording is not None:
            self.message.emit("warn", "A recording runs already.")
            return False
        try:
            recorder = self._record.start(folder, self._reader, self._known.calibrated, label, note)
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

    def guide_facts(self) -> dict[str, Any]:
        """What guidance must know of the stream and the calibration to trust an attitude: see workers.guide_facts."""
        from imugui.workers.guide_facts import guide_facts  # start-up time: only the Guide page asks
        from imugui.workers.relative_facts import relative_facts

        state = self._verdict(time.perf_counter()).state
        own = guide_facts(self._fusion, self._known, self.samples, state is State.STREAMING)
        if self.relative is None or self._reference is None:
            return own
        return relative_facts(own, self._reference.guide_facts(), self.relative)

    @property
    def player(self) -> Player | None:
        """Play, pause, seek and speed, while a file is the source."""
        return getattr(self._transport, "player", None)

    # status

    def status(self) -> Status:
        """A snapshot; cheap enough for ten a second."""
        now = time.perf_counter()
        verdict = self._verdict(now)
        self._note(verdict.state)
        self._look_after(now)
        if self._reader is None or self._known is None:
            return Status(verdict.state, verdict.sentence, filter=self.filter_name)
        return snapshot(now, verdict, self._reader, self._known, self._fusion, self._first_row)

    @property
    def rate_hz(self) -> float:
        """Samples a second as fitted over the connection (0.1 % after 10 s), in the board's own time; 0 if unknown."""
        return fitted_rate_hz(self._reader) if self._reader else 0.0

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
        if self._reader is None or self._known is None:
            return
        found = board_of(self._reader.found)
        # it was called by a name and has an address, or has come; one that is gone still is the board it was
        gone = found.transport == "serial" and found.address == self._reader.source.address
        if self._known.board.key != found.key and not gone:
            self._know(self._reader.found)
        self._follow_board(self._reader.intake.format)
        self._announce()

    @Slot(str)
    def _disk_failed(self, text: str) -> None:
        self.message.emit("error", text)
        self.stop_recording()

    def _announce(self) -> None:
        self._note(self._verdict(time.perf_counter()).state)

    def _note(self, state: State) -> None:
        if state is not self._last_state:
            self._last_state = state
            self.state_changed.emit(state)

"""Starting and ending a recording: the recorder and what the reader and fusion threads leave it."""

from __future__ import annotations

import dataclasses
import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from imugui import __version__
from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.recorder import Recorder, RecordingStatus, Tap

if TYPE_CHECKING:  # start-up time
    from imugui.workers.reader import Reader
    from imugui.workers.recorded_profile import Calibrated


class RecordControl:
    """At most one recording at a time."""

    def __init__(self, samples: Ring, attitude: Ring, fusion: FusionWorker) -> None:
        self._samples, self._attitude, self._fusion = samples, attitude, fusion
        self._recorder: Recorder | None = None

    @property
    def status(self) -> RecordingStatus | None:
        """The recording that runs, or None."""
        return self._recorder.status() if self._recorder is not None else None

    def start(self, folder: Path, reader: Reader, calibrated: Calibrated, label: str, note: str) -> Recorder:
        """Begin a recording in a new folder; raises OSError."""
        tap = Tap()
        about = describe(reader, self._fusion.pipeline, label, note) | {"calibration": calibrated.noted()}
        recorder = Recorder(folder, about, self._samples, self._attitude, tap)
        self._recorder = recorder
        reader.record(tap)
        recorder.start()
        return recorder

    def stop(self, reader: Reader | None) -> Path | None:
        """End the recording in order; its folder, or None when there was none."""
        recorder, self._recorder = self._recorder, None
        if recorder is None:
            return None
        recorder.stop()  # first: every sample it takes has its bytes
        if reader is not None:
            reader.record(None)
        self._fusion.end_tap()
        return recorder.status().path

    def mark(self, text: str) -> bool:
        """Note a marker; False when nothing is recorded."""
        if self._recorder is None:
            return False
        self._fusion.mark(text)
        return True


def describe(reader: Reader, pipeline: Pipeline, label: str, note: str) -> dict[str, Any]:
    """What a recording says about itself."""
    source = reader.source
    return {
        "made_by": f"imugui {__version__}",
        "started_utc": datetime.datetime.now(datetime.UTC).isoformat(timespec="milliseconds"),
        "label": label,
        "note": note,
        "transport": source.transport,
        "board": source.address,
        "format": reader.intake.format,
        "found": reader.intake.seen,
        "frame": "quaternions (w, x, y, z) sensor to earth, earth east-north-up",
        "units": "s, m/s2, rad/s, uT, deg C, deg, m, m/s",
        "source": dataclasses.asdict(source),
        "fusion": pipeline.settings(),
    }

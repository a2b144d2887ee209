"""Fused: the rings, what the user chose for the fusion, and the game that is played with it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal, Slot

from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.fusion.pipeline import Pipeline
from imugui.ring import Ring
from imugui.samples import ATTITUDE, SAMPLE
from imugui.workers.fusion_worker import AgeCounts, FusionWorker
from imugui.workers.worker import log_file

if TYPE_CHECKING:
    from imugui.workers.game_worker import GameWorker
    from imugui.workers.relative_worker import RelativeWorker

RING_ROWS = 1 << 17  # two minutes at 1 kHz


class Fused(QObject):
    """The part of a session behind its connection. All methods are called in the main thread."""

    message = Signal(str, str)  # tone "info", "warn" or "error"; a sentence

    def __init__(self, filter_name: str, params: Any, use_mag: bool) -> None:
        super().__init__()
        self.samples = Ring(SAMPLE, RING_ROWS)
        self.attitude = Ring(ATTITUDE, RING_ROWS)
        name = filter_name if filter_name in FILTERS else DEFAULT_FILTER
        self._fusion = FusionWorker(self.samples, self.attitude, Pipeline(name, params, use_mag=use_mag))
        self._fusion.failed.connect(self._defect)
        self._fusion.noted.connect(self._tell_note)
        self._game: GameWorker | None = None
        self.relative: RelativeWorker | None = None
        """The attitude in the frame of another board, while it is looked at so."""

    @property
    def shown(self) -> Ring:
        """The attitudes that pages show: this board's own, or those in the frame of a reference board."""
        return self.attitude if self.relative is None else self.relative.attitude

    def _relate(self, reference: Fused) -> None:
        """Look at this board in the frame of another one from now on."""
        from imugui.workers.relative_worker import RelativeWorker  # start-up time: only two boards need guidance here

        self.relative = RelativeWorker(self._fusion, reference._fusion, RING_ROWS)
        self.relative.failed.connect(self._defect)
        self.relative.start()

    def _unrelate(self) -> None:
        relative, self.relative = self.relative, None
        if relative is not None:
            relative.stop()

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
    def spike_mask(self) -> bool:
        """Whether force and field are left out while the board's button moves."""
        return self._fusion.pipeline.spike_mask

    def set_spike_mask(self, on: bool) -> None:
        """Leave force and field out while the board's button moves, or not; all else goes on."""
        old = self._fusion.pipeline
        pipeline = Pipeline(old.filter_name, old.params, old.correction, old.use_mag, spike_mask=on)
        self._fusion.replace(pipeline, carry_on=True)

    @property
    def fusion_settings(self) -> dict[str, Any]:
        """All that was chosen for the fusion, as plain values: filter, parameters, correction, magnetometer, origin."""
        return self._fusion.pipeline.settings()

    def set_filter(self, name: str, params: Any = None, use_mag: bool = True) -> None:
        """Replace the pipeline whole; the new filter starts from the last attitude and keeps the origin."""
        old = self._fusion.pipeline
        self._fusion.replace(Pipeline(name, params, old.correction, use_mag, spike_mask=old.spike_mask), carry_on=True)

    @property
    def filter_note(self) -> str:
        """Why another filter has taken over from the chosen one for now; empty when none has."""
        return self._fusion.filter_note

    def refer_heading(self) -> None:
        """A registration stands on the heading as it is now: see ``Pipeline.refer_heading``.

        Against a reference board nothing is done: there the headings count from the alignment.
        """
        if self.relative is None:
            self._fusion.refer_heading()

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

    @property
    def game(self) -> GameWorker:
        """The thread that plays the game, started when it is first asked for."""
        if self._game is None:
            from imugui.workers.game_worker import GameWorker  # start-up time: most sessions play none

            self._game = GameWorker(self.attitude, self._note_game)
            self._game.failed.connect(self._defect)
            self._game.start()
        return self._game

    def note(self, kind: str, text: str, data: dict[str, Any], attitude_number: int | None = None) -> bool:
        """Note something of a page's in the running recording, at an attitude (its number in the ring; None: now).

        ``data`` are plain values; False when nothing is recorded.
        """
        if self._fusion.tap is None:
            return False
        self._fusion.note(kind, text, data, attitude_number)
        return True

    def _note_game(self, text: str, data: dict[str, Any], attitude_number: int) -> None:
        self.note("game", text, data, attitude_number)

    def _stop_threads(self) -> None:
        self._unrelate()
        for worker in (self._game, self._fusion):
            if worker is not None and worker.isRunning():
                worker.stop()

    @Slot(str)
    def _tell_note(self, note: str) -> None:
        """Another filter has taken over, or ("") the chosen one is back."""
        from imugui.workers.filter_words import return_words, takeover_words  # start-up time: hardly ever needed

        title = FILTERS[self.filter_name].title
        self.message.emit(*(("warn", takeover_words(title, note)) if note else ("info", return_words(title))))

    @Slot(str)
    def _defect(self, text: str) -> None:
        where = f" The details are in {log}." if (log := log_file()) else ""
        self.message.emit("error", f"A defect in imugui: {text}. Data keep coming in; please report it.{where}")

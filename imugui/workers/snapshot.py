"""The status of a session, put together from its parts."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from imugui.workers.status import Status, mag_trust
from imugui.workers.verdict import State, Verdict

if TYPE_CHECKING:  # start-up time
    from imugui.workers.board_profile import BoardProfile
    from imugui.workers.fusion_worker import FusionWorker
    from imugui.workers.reader import Reader

LOOK_ROWS = 256  # newest rows that the status is judged by


def snapshot(
    now: float, verdict: Verdict, reader: Reader, known: BoardProfile, fusion: FusionWorker, first_row: int
) -> Status:
    """What is so at host time ``now`` (s) of a connection whose first sample has the number ``first_row``."""
    pipeline = fusion.pipeline
    trust, norm = mag_trust(fusion.attitude.last(LOOK_ROWS), pipeline.use_mag, known.has_mag, known.light)
    counts, clock = reader.intake.counts, reader.intake.clock
    newest = fusion.samples.last(1)
    return Status(
        state=verdict.state,
        sentence=verdict.sentence,
        source=reader.source.address,
        format=reader.intake.format,
        seen=reader.intake.seen,
        baud=reader.intake.baud,
        rate_hz=fitted_rate_hz(reader) if verdict.state in (State.STREAMING, State.IMPOSSIBLE) else 0.0,
        jitter_ms=clock.jitter_s * 1e3,
        messages=counts.messages,
        bad_messages=counts.bad_messages,
        samples=fusion.samples.count - first_row,
        gaps=clock.gaps,
        gap_s=clock.gap_s,
        missed_rows=fusion.missed_rows,
        age_ms=(now - float(newest["t_arrival"][0])) * 1e3 if len(newest) else math.nan,
        has_mag=trust != "none",
        mag_trust=trust,
        mag_alarm=known.light,
        profile=known.words,
        mag_norm_ut=norm,
        temp_c=float(newest["temp_c"][0]) if len(newest) else math.nan,
        filter=pipeline.filter_name,
        filter_note=fusion.filter_note,
        **reader.board_facts,
    )


def fitted_rate_hz(reader: Reader) -> float:
    """Samples a second in the board's own time; 0 if not known."""
    period = reader.intake.clock.period
    return 1.0 / period if period > 0.0 else 0.0

"""What guidance must know of the stream and of the calibration, as plain values."""

from __future__ import annotations

import math
import time
from typing import Any

from imugui.guidance.trust_profile import prior_holds, profile_facts
from imugui.ring import Ring
from imugui.workers.board_profile import BoardProfile
from imugui.workers.fusion_worker import FusionWorker
from imugui.workers.recorded_profile import Calibrated


def guide_facts(fusion: FusionWorker, known: BoardProfile | None, samples: Ring, streaming: bool) -> dict[str, Any]:
    """Keyword values of ``guidance.facts.Facts``, and ``epoch``: a registration of another epoch is void."""
    use_mag = fusion.pipeline.use_mag
    newest = samples.last(1)
    temp_c = float(newest["temp_c"][0]) if len(newest) else math.nan
    calibrated = known.calibrated if known else Calibrated()
    worth = profile_facts(calibrated.profile, calibrated.now, use_mag, temp_c, calibrated.factory)
    return {
        "now": time.perf_counter(),
        "streaming": streaming,
        "epoch": fusion.epoch,
        "filter": fusion.pipeline.filter_name,
        "use_mag": use_mag,
        "mag_disturbed": known is not None and known.light == "red",
        **worth,
        "prior_holds": prior_holds(worth["turn_share"], fusion.pipeline.params),
    }

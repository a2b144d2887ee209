"""The calibration that a recording was made with: what it notes of it, and what a replay knows from that."""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from imugui import recording
from imugui.calibration.profile import Profile
from imugui.calibration.profile_file import ProfileError, from_text, to_text


@dataclass(frozen=True)
class Calibrated:
    """How a board was calibrated when: its profile, or at the factory."""

    profile: Profile | None = None
    factory: bool = False
    when: datetime | None = None  # None: now

    @property
    def now(self) -> datetime:
        """The time at which the calibration was, or is, used."""
        return self.when or datetime.now(UTC)

    def noted(self) -> dict[str, Any]:
        """Plain values for the description of a recording."""
        return {"profile": json.loads(to_text(self.profile)) if self.profile else None, "factory": self.factory}


def calibrated_then(path: Path) -> Calibrated:
    """What a recording says; nothing calibrated where it says nothing, or nothing that can be used."""
    if not recording.is_recording(path):
        return Calibrated()
    try:
        about = recording.read_about(path)
        noted, when = about["calibration"], datetime.fromisoformat(about["started_utc"])
        profile = from_text(json.dumps(noted["profile"])) if noted["profile"] else None
        return Calibrated(profile, noted["factory"] is True, when if when.tzinfo else when.replace(tzinfo=UTC))
    except (recording.UnreadableError, ProfileError, KeyError, TypeError, ValueError):
        return Calibrated()

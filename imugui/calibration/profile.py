"""Profile: everything known of one board, what it makes of raw samples, and how far to trust it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from hashlib import sha256
from typing import Any

from imugui.calibration.parts import (
    NAN,
    PARTS,
    AccelerometerPart,
    GyroscopePart,
    MagnetometerPart,
    MountingPart,
    NoisePart,
    Part,
    TemperaturePart,
)
from imugui.fusion.correction import Correction, Vector

LIFE_DAYS = {"gyroscope": 30, "accelerometer": 365, "magnetometer": 30, "temperature": 365}
"""How long a part is good; mounting and noise do not age."""
TEMPERATURE_K = {"gyroscope": 10.0, "accelerometer": 20.0, "magnetometer": 20.0}
"""How far from its own temperature a part is good; a temperature model frees the gyroscope from this."""
SCALE_LIFE_DAYS, SCALE_K = 365, 10.0
"""The same of the gyroscope's scale and cross-axis terms: the MPU-9250's move by up to 4 % over 60 K, 0.7 % in 10 K."""
STEEPEST_DIP = 85.0
"""degrees; nearer to a pole the compass has no heading."""
UNKNOWN_TILT_DEG = 2.0
"""What an accelerometer that was never calibrated may well leave."""


@dataclass(frozen=True)
class Board:
    """Which board: the transport, its serial number or address there, and the name its user gave it."""

    transport: str = ""
    address: str = ""
    name: str = ""

    @property
    def key(self) -> str:
        """The same for the same board, whatever its name."""
        return f"{self.transport}:{self.address}"

    @property
    def file_name(self) -> str:
        """Safe on every file system, and different for different boards."""
        plain = "".join(c if c.isascii() and c.isalnum() else "-" for c in self.key.lower())
        short = "-".join(filter(None, plain.split("-")))[:40]
        return f"{short or 'board'}-{sha256(self.key.encode()).hexdigest()[:8]}.json"

    @property
    def title(self) -> str:
        """What a person calls it."""
        return self.name or self.address or "unnamed board"


@dataclass(frozen=True)
class Ageing:
    """What grows old: since when, for how many days it is good, at which temperature (deg C) and how far from it."""

    name: str
    when: datetime
    days: float
    temp_c: float
    kelvin: float


@dataclass(frozen=True)
class Profile:
    """The calibrated parts of one board; a part that was never calibrated is None."""

    board: Board = Board()
    gyroscope: GyroscopePart | None = None
    accelerometer: AccelerometerPart | None = None
    magnetometer: MagnetometerPart | None = None
    mounting: MountingPart | None = None
    temperature: TemperaturePart | None = None
    noise: NoisePart | None = None
    rate_hz: float = NAN
    made_with: str = ""
    delays_ms: tuple[float, float] | None = None  # of gyroscope and magnetometer, where the user has said them

    @property
    def parts(self) -> dict[str, Part]:
        """The parts there are, by name."""
        return {name: part for name in PARTS if (part := getattr(self, name)) is not None}

    def with_part(self, part: Part) -> Profile:
        """The same with one part new."""
        name = next(name for name, kind in PARTS.items() if type(part) is kind)
        changed: dict[str, Any] = {name: part}
        return replace(self, **changed)

    def renamed(self, name: str) -> Profile:
        """The same under another name, cut to 80 characters."""
        return replace(self, board=replace(self.board, name=" ".join(name.split())[:80]))

    def correction(self, temp_c: float = NAN) -> Correction:
        """What the pipeline takes out of every sample; ``temp_c`` (degrees C) chooses the bias if there is a model."""
        found: dict[str, Any] = {}
        if self.gyroscope:
            found |= {"gyr_bias": self._gyr_bias(temp_c), "gyr_matrix": self.gyroscope.matrix}
        elif self.temperature:
            found["gyr_bias"] = self._gyr_bias(temp_c)
        if self.accelerometer:
            found |= {"acc_bias": self.accelerometer.bias, "acc_matrix": self.accelerometer.matrix}
        if self.magnetometer:
            found |= {"mag_bias": self.magnetometer.hard_iron, "mag_matrix": self.magnetometer.soft_iron}
        if self.mounting:
            found["mounting"] = self.mounting.quat
        return Correction(**found)

    @property
    def tilt_error_deg(self) -> float:
        """Roll and pitch error to expect at rest, degrees; NaN without an accelerometer calibration."""
        return self.accelerometer.tilt_deg if self.accelerometer else NAN

    @property
    def heading_error_deg(self) -> float:
        """Heading error to expect, degrees; NaN without a magnetometer calibration.

        The field's own error is that of the gate's verdict; a tilt error adds tan(dip) times itself. An unknown dip
        counts as 65 degrees, an unknown tilt error as 2.
        """
        mag = self.magnetometer
        if mag is None or math.isnan(mag.predicted_deg):
            return NAN
        from imugui.calibration.gate import TYPICAL_DIP_DEG, heading_error_deg  # start-up time

        dip_deg = min(STEEPEST_DIP, abs(TYPICAL_DIP_DEG if math.isnan(mag.dip_deg) else mag.dip_deg))
        tilt = UNKNOWN_TILT_DEG if math.isnan(self.tilt_error_deg) else self.tilt_error_deg
        uneven = 0.0 if math.isnan(mag.residual_percent) else mag.residual_percent / 100
        field = heading_error_deg(mag.predicted_deg, uneven, dip_deg)
        return min(180.0, math.hypot(field, tilt * math.tan(math.radians(dip_deg))))

    @property
    def good_until(self) -> datetime | None:
        """When the first part will be too old; None when nothing ages."""
        ends = [one.when + timedelta(one.days) for one in self._ageing() if one.days < math.inf]
        return min(ends, default=None)

    def warnings(self, now: datetime, temp_c: float = NAN) -> list[str]:
        """Why not to trust it fully now, at ``temp_c`` degrees C: one sentence for each part that is too old or off."""
        said = []
        for one in self._ageing():
            days = (now - one.when) / timedelta(days=1)
            if days < -1.0:
                said.append(f"The {one.name} calibration is dated in the future: is the clock right?")
            elif days > one.days:
                said.append(f"The {one.name} calibration is {days:.0f} days old; {one.days:.0f} is its life.")
            away = abs(temp_c - one.temp_c)
            # NaN compares False: without temperatures there is nothing to say
            if away > one.kelvin:
                said.append(f"The {one.name} was calibrated at {one.temp_c:.0f} deg C, {away:.0f} K from now.")
        return said

    def _ageing(self) -> Iterator[Ageing]:
        for name, part in self.parts.items():
            free = name == "gyroscope" and self.temperature is not None
            kelvin = math.inf if free else TEMPERATURE_K.get(name, math.inf)
            yield Ageing(name, part.when(), LIFE_DAYS.get(name, math.inf), part.temp_c, kelvin)
        if self.gyroscope is not None and self.gyroscope.matrix_date:
            part = self.gyroscope
            yield Ageing("gyroscope's scale", part.matrix_when(), SCALE_LIFE_DAYS, part.matrix_temp_c, SCALE_K)

    def _gyr_bias(self, temp_c: float) -> Vector:
        """The measured bias, moved along the model from the temperature it was measured at."""
        measured = self.gyroscope.bias if self.gyroscope else None
        if self.temperature is None or math.isnan(temp_c):
            return measured or self._model_bias(self.temperature.reference_c if self.temperature else NAN)
        now = self._model_bias(temp_c)
        if measured is None or self.gyroscope is None or math.isnan(self.gyroscope.temp_c):
            return measured or now
        then = self._model_bias(self.gyroscope.temp_c)
        x, y, z = (m + n - t for m, n, t in zip(measured, now, then, strict=True))
        return x, y, z

    def _model_bias(self, temp_c: float) -> Vector:
        part = self.temperature
        if part is None:
            return (0.0, 0.0, 0.0)
        from imugui.calibration.temperature import TemperatureModel  # start-up time

        model = TemperatureModel(part.coefficients, part.reference_c, part.low_c, part.high_c)
        x, y, z = model.bias(temp_c).tolist()
        return x, y, z


def now_utc() -> str:
    """The time as every part's date carries it."""
    return datetime.now(UTC).isoformat(timespec="seconds")

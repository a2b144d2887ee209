"""The words of the status line: a Status in, short phrases out. Never more digits than the number can bear."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from imugui.fusion import FILTER_TITLES
from imugui.views.ble_words import EMPTY_PERCENT, LOW_PERCENT, WEAK_DBM, signal_words
from imugui.workers.session import Status

NO_NUMBER = "---"


@dataclass(frozen=True)
class Phrase:
    """``tone`` "neutral", "good", "warn" or "bad"; an empty text is not shown."""

    text: str
    tone: str = "neutral"


@dataclass(frozen=True)
class Part:
    """One place of the status line; ``widest`` keeps the room, so that its neighbours stand still."""

    phrase: Callable[[Status], Phrase]
    widest: str
    tip: str


def rate(status: Status) -> Phrase:
    """Samples per second, measured."""
    if not status.rate_hz > 0.0:
        return Phrase(f"{NO_NUMBER} Hz")
    return Phrase(f"{status.rate_hz:.0f} Hz" if status.rate_hz >= 999.5 else f"{status.rate_hz:.1f} Hz")


def gaps(status: Status) -> Phrase:
    """How often samples were missing, and for how long in total."""
    lost = f", {status.missed_rows} rows missed" if status.missed_rows else ""
    lost += f", {status.overflow} messages dropped" if status.overflow else ""
    if not status.gaps:
        return Phrase("no gaps" + lost, "bad" if lost else "neutral")
    count = "1 gap" if status.gaps == 1 else f"{status.gaps} gaps"
    return Phrase(f"{count}, {span(status.gap_s)} lost{lost}", "bad" if lost else "warn")


def age(status: Status) -> Phrase:
    """Age of the newest sample."""
    if math.isnan(status.age_ms):
        return Phrase(f"age {NO_NUMBER} ms")
    return Phrase(f"age {span(status.age_ms / 1e3)}", "bad" if status.age_ms > 500.0 else "neutral")


def bad_messages(status: Status) -> Phrase:
    """Messages that could not be read."""
    if not status.bad_messages:
        return Phrase("0 bad messages")
    return Phrase(f"{status.bad_messages} bad of {status.messages + status.bad_messages}", "warn")


_TRUST = {
    "good": ("field good", "good"),
    "uncalibrated": ("field not calibrated", "warn"),
    "disturbed": ("field disturbed", "warn"),
    "off": ("magnetometer off", "neutral"),
}


def magnetometer(status: Status) -> Phrase:
    """How far the magnetometer is to be trusted, and the field it measures."""
    if status.mag_trust not in _TRUST:
        return Phrase("no magnetometer")
    words, tone = _TRUST[status.mag_trust]
    strength = "" if math.isnan(status.mag_norm_ut) else f" {status.mag_norm_ut:.0f} µT"
    return Phrase(words + strength, tone)


def profile(status: Status) -> Phrase:
    """The calibration in use."""
    return Phrase(f"profile {status.profile}" if status.profile else "no profile")


def temperature(status: Status) -> Phrase:
    """Temperature of the sensor, when the board sends it."""
    return Phrase("" if math.isnan(status.temp_c) else f"{status.temp_c:.1f} °C")


def signal(status: Status) -> Phrase:
    """How strongly a wireless board was heard last."""
    if math.isnan(status.rssi_dbm):
        return Phrase("")
    return Phrase(signal_words(status.rssi_dbm), "warn" if status.rssi_dbm < WEAK_DBM else "neutral")


def battery(status: Status) -> Phrase:
    """How full the battery of a wireless board is."""
    percent = status.battery_percent
    if math.isnan(percent):
        return Phrase("")
    word, tone = next((word, tone) for least, word, tone in _BATTERY if percent > least)
    return Phrase(f"battery {word} {percent:.0f} %".replace("  ", " "), tone)


_BATTERY = (
    (LOW_PERCENT, "", "neutral"),
    (EMPTY_PERCENT, "low", "warn"),
    (-math.inf, "nearly empty", "bad"),
)


def filter_title(status: Status) -> Phrase:
    """The filter in use."""
    return Phrase(FILTER_TITLES.get(status.filter, status.filter))


PARTS: dict[str, Part] = {
    "rate": Part(rate, "888.8 Hz", "Samples per second, measured"),
    "gaps": Part(gaps, "▲ 88 gaps, 88 s lost", "Gaps in the data since Connect, and how much time they cost"),
    "age": Part(age, "age 888 ms", "Age of the newest sample: the worst of the last second"),
    "bad": Part(bad_messages, "0 bad messages", "Messages that could not be read; the link log shows them"),
    "mag": Part(magnetometer, "▲ field disturbed 88 µT", "Trust in the magnetometer, and the strength of the field"),
    "profile": Part(profile, "no profile", "Calibration profile in use"),
    "temperature": Part(temperature, "", "Temperature of the sensor"),
    "signal": Part(signal, "", "Strength of the Bluetooth signal when the board was last found, before it connected"),
    "battery": Part(battery, "", "Battery of the board"),
    "filter": Part(filter_title, "", "Filter in use"),
}
"""Places of the status line, left to right."""

SPARE = ("filter", "temperature", "profile", "bad", "mag", "signal")
"""Those that give way in a narrow window while they are calm, the first first; the filter stands in the bar, too."""


def span(seconds: float) -> str:
    """A duration with the digits it deserves: "7 ms", "1.2 s", "48 s", "3 min", "2 h"."""
    if seconds < 0.9995:
        return f"{max(0.0, seconds) * 1e3:.0f} ms"
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    if seconds < 59.5:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 3570.0 else f"{seconds / 3600.0:.0f} h"

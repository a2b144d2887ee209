"""A replay in words: times, speeds, events."""

from __future__ import annotations

import math

from imugui.recording import Event
from imugui.workers.session import SPEEDS

SPEED_WORDS = {speed: "As fast as it goes" if math.isinf(speed) else f"{speed:g}×" for speed in SPEEDS}
SHORT_SPEED = {speed: "Max" if math.isinf(speed) else f"{speed:g}×" for speed in SPEEDS}
RESTARTED = "Filter restarted from the accelerometer"

EVENT_WORDS = {
    "connect": "connected",
    "lost": "connection lost",
    "disconnect": "disconnected",
    "filter": "filter changed",
    "origin": "origin",
    "restart": "filter restarted",
    "marker": "marker",
    "problem": "problem",
}
"""What is shown of the events; how a recording began and ended is no news."""

EVENT_TONES = {"lost": "bad", "problem": "bad", "disconnect": "warn", "restart": "warn", "marker": "good"}


def clock_words(seconds: float) -> str:
    """A place in a recording: "00:07.3", "12:34.5", "1:02:03.4"."""
    tenths = int(max(seconds, 0.0) * 10.0 + 1e-6)
    minutes, tenths = divmod(tenths, 600)
    hours, minutes = divmod(minutes, 60)
    rest = f"{minutes:02}:{tenths // 10:02}.{tenths % 10}"
    return f"{hours}:{rest}" if hours else rest


def event_words(event: Event, at_s: float) -> str:
    """One event at its place, such as "00:12.3  marker: tip down"."""
    words = EVENT_WORDS.get(event.kind, event.kind)
    text = "" if event.text == words else event.text
    if event.kind == "marker" and text.startswith("marker "):
        words, text = text, ""
    return f"{clock_words(at_s)}  {words}{': ' if text else ''}{text}"


def next_speed(speed: float, step: int) -> float:
    """The speed ``step`` places from the one nearest to this, within SPEEDS."""
    nearest = min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - speed) if SPEEDS[i] != speed else -1.0)
    return SPEEDS[min(max(nearest + step, 0), len(SPEEDS) - 1)]

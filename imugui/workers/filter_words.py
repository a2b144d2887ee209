"""What a person is told when a filter gives up for a while, and when it comes back."""

from __future__ import annotations

from imugui.fusion.self_calibrating_guard import OUT_OF_BOUNDS, RETURN_AFTER, TOO_FAR, WRONG_NORTH

ADVICE = {
    TOO_FAR: "In a vehicle choose its preset Vehicle.",
    WRONG_NORTH: "Take iron and magnets away, or switch the magnetometer off.",
    OUT_OF_BOUNDS: "Lay the board still for a moment; if it happens again, calibrate the gyroscope.",
}
"""What to do about a reason for which a filter gives up."""


def takeover_words(title: str, note: str) -> str:
    """What happened to the filter of this title, why (``note``), and what to do."""
    advice = [words for reason, words in ADVICE.items() if reason in note]
    back = f"{title} comes back by itself after {RETURN_AFTER:.0f} s without trouble."
    return " ".join((note, *advice, back))


def return_words(title: str) -> str:
    """That the filter of this title runs again, and what that means."""
    return f"{title} is back: {RETURN_AFTER:.0f} s went by without trouble. Its heading begins anew: register again."

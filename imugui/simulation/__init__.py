"""The virtual board: true motions, imperfect sensors, any wire format, a pseudo-terminal."""

from __future__ import annotations

MOTION_TITLES = {
    "hand": "Turned by hand",
    "rest": "At rest",
    "turns": "Slow turns",
    "aiming": "Aiming a tool",
    "driving": "Driving a circuit",
    "free": "Turned to all sides",
}
"""What the motions are called, in the order in which they are offered; the motions are in ``motions``."""

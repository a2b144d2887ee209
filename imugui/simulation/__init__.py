"""The virtual board: true motions, imperfect sensors, any wire format, a pseudo-terminal."""

"""What this program says of itself."""

from __future__ import annotations

from imugui import __version__

NAME = f"imugui {__version__}"
NOT_MEDICAL = "A research tool, not a medical device: not for diagnosis, treatment or guidance on patients."
LICENCE = "Free software under the MIT licence, without any warranty."
LINE = f"{NAME}  ·  a research tool, not a medical device"

"""What a transport is: something that opens, is read, and closes. TRANSPORTS lists them all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from imugui.formats import Options
from imugui.samples import Rows

NO_OPTIONS = Options()

Arrivals = list[tuple[float, bytes]]
"""Messages that came one by one: (host time of arrival s, bytes), oldest first."""


@dataclass(frozen=True)
class Source:
    """Where samples come from, as the user chose it."""

    transport: str  # a key of TRANSPORTS
    address: str  # a port or pyserial URL, a file, a motion of the virtual board, or a Bluetooth name or address
    format: str = "auto"  # a key of FORMATS, or "auto"
    baud: int = 0  # 0: find it
    options: Options = NO_OPTIONS
    speed: float = 1.0  # of a replay
    follow: bool = True  # fuse a recording as it was fused when it was made
    rate_hz: float = 0.0  # of the virtual board, or of a capture without times; 0: the usual one
    errors: str = "mpu9250-calibrated"  # of the virtual board: a key of its error presets
    seed: int = 1


class Transport(Protocol):
    """Reads block for 0.1 s at the most, and give bytes, messages with their own times, or finished rows."""

    retries: bool  # True: a port that fails is tried again; False: the failure is final
    baud: int  # 0 where there is none
    wireless: bool = False
    room: Callable[[], int]  # how many rows the receiver can take without losing any; given after it was made

    def open(self) -> None:
        """Open; raises one of PORT_ERRORS."""

    def read(self) -> bytes | Arrivals | Rows:
        """What came since, empty when nothing did; raises one of PORT_ERRORS, EOFError at the end of a file."""

    def close(self) -> None:
        """Close; never raises."""

    def cancel(self) -> None:
        """Give up what may take long, for good; from any thread."""

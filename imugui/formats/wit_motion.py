"""wit-motion: the data notification of WitMotion's Bluetooth LE boards (WT901BLE and its kin), 20 bytes.

0x55 0x61, then acceleration (32768 = 16 g), turn rate (32768 = 2000 deg/s) and the board's own angles
(32768 = 180 deg), three axes each, as little-endian 16-bit numbers (WitMotion, WT901BLECL datasheet v20-0707,
section 6.1.1). The angles are not used: imugui fuses itself. 0x55 0x71 is an answer to a question about a
register; it is no sample and no error.
"""

from __future__ import annotations

import struct

import numpy as np

from imugui.formats.base import Encoder, Options
from imugui.formats.families import family
from imugui.formats.framed import FramedDecoder, to_counts
from imugui.formats.values import NAN, NO_GNSS, RAD_PER_DEG, Row
from imugui.samples import GRAVITY, NO_STATUS, Rows

FAMILY = "aligned"
RATE_HZ = 100.0
ACC_PER_G = 32768 / 16
GYR_PER_DPS = 32768 / 2000
ANGLE_PER_RAD = 32768 / np.pi
HEAD = b"\x55\x61"
ANSWER = b"\x55\x71"
MESSAGE = struct.Struct("<2x6h6x")
WIRE = np.dtype([("head", "S2"), ("acc", "<i2", (3,)), ("gyr", "<i2", (3,)), ("angle", "<i2", (3,))])


class WitMotionDecoder(FramedDecoder):
    """Reads ``wit-motion`` messages."""

    LENGTH = MESSAGE.size

    def __init__(self, options: Options) -> None:
        super().__init__()
        family(options.family, FAMILY)
        self.seen = self._scale = "raw counts, 2048 per g, 16.384 per deg/s"
        self.rate_hz = RATE_HZ

    def _message(self, message: bytes) -> Row | None:
        if message.startswith(ANSWER):
            self.counts.chatter += 1
            self.log.add(self._t, "chatter", f"a register: {message[2:].hex(' ')}")
            return None
        if not message.startswith(HEAD):
            self._bad("no 55 61 at the start", message)
            return None
        values = MESSAGE.unpack(message)
        acc = (value * (GRAVITY / ACC_PER_G) for value in values[0:3])
        gyr = (value * (RAD_PER_DEG / GYR_PER_DPS) for value in values[3:6])
        return (*gyr, *acc, NAN, NAN, NAN, NAN, NO_STATUS, *NO_GNSS)


class WitMotionEncoder(Encoder):
    """Writes what the board sends; its angles are those of the acceleration alone, with no heading."""

    def encode(self, rows: Rows) -> bytes:
        """One message for each row, shape (n,), one after the other."""
        wire = np.zeros(len(rows), WIRE)
        ax, ay, az = rows["acc"].T
        wire["head"] = HEAD
        wire["acc"] = to_counts(rows["acc"] / GRAVITY * ACC_PER_G)
        wire["gyr"] = to_counts(rows["gyr"] / RAD_PER_DEG * GYR_PER_DPS)
        wire["angle"][:, 0] = to_counts(np.arctan2(ay, az) * ANGLE_PER_RAD)
        wire["angle"][:, 1] = to_counts(np.arctan2(-ax, np.hypot(ay, az)) * ANGLE_PER_RAD)
        return wire.tobytes()

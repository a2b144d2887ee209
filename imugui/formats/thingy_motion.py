"""thingy-motion: the raw-data notification of a Nordic Thingy:52's motion service, 18 bytes.

Acceleration in g, turn rate in deg/s and magnetic field in uT, three axes each, as little-endian 16-bit numbers
with 10, 5 and 4 binary places: 6Q10, 11Q5 and 12Q4 (Nordic Thingy:52 firmware documentation, "Firmware
architecture", Motion service, raw data characteristic 0406). Turn rates beyond 1024 deg/s do not fit.
The firmware has turned the magnetic field to the gyroscope's axes, and the acceleration round: it sends +1 g along
the axis that points down (drv_motion.c of release 2.2). Here it is turned back.
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
ACC_PER_G = -(1 << 10)
GYR_PER_DPS = 1 << 5
MAG_PER_UT = 1 << 4
MESSAGE = struct.Struct("<9h")
WIRE = np.dtype([("acc", "<i2", (3,)), ("gyr", "<i2", (3,)), ("mag", "<i2", (3,))])


class ThingyMotionDecoder(FramedDecoder):
    """Reads ``thingy-motion`` messages."""

    LENGTH = MESSAGE.size

    def __init__(self, options: Options) -> None:
        super().__init__()
        family(options.family, FAMILY)
        self.seen = self._scale = "g with 10, deg/s with 5, uT with 4 binary places"
        self.rate_hz = RATE_HZ

    def _message(self, message: bytes) -> Row:
        values = MESSAGE.unpack(message)
        acc = (value * (GRAVITY / ACC_PER_G) for value in values[0:3])
        gyr = (value * (RAD_PER_DEG / GYR_PER_DPS) for value in values[3:6])
        mag = (value / MAG_PER_UT for value in values[6:9])
        return (*gyr, *acc, *mag, NAN, NO_STATUS, *NO_GNSS)


class ThingyMotionEncoder(Encoder):
    """Writes what the Thingy sends; a magnetic field that was not measured is zero."""

    def encode(self, rows: Rows) -> bytes:
        """One message for each row, shape (n,), one after the other."""
        wire = np.empty(len(rows), WIRE)
        wire["acc"] = to_counts(rows["acc"] / GRAVITY * ACC_PER_G)
        wire["gyr"] = to_counts(rows["gyr"] / RAD_PER_DEG * GYR_PER_DPS)
        wire["mag"] = to_counts(rows["mag"] * MAG_PER_UT)
        return wire.tobytes()

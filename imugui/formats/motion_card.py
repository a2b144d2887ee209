"""motion-card: the motion card's notification over Bluetooth LE, 15 bytes, 100 times a second.

Three axes of acceleration, three of turn rate and the temperature, raw counts of its MPU-6050 as big-endian
16-bit numbers, then one byte of status (the button: 0 idle, 1 steering, 2 zoom). No message carries a number
or a time: loss is only seen from the rate.
"""

from __future__ import annotations

import struct

import numpy as np

from imugui.formats.base import Encoder, Options
from imugui.formats.families import FAMILIES, family
from imugui.formats.framed import FramedDecoder, to_counts
from imugui.formats.values import NAN, NO_GNSS, RAD_PER_DEG, Row
from imugui.samples import GRAVITY, Rows

FAMILY = "mpu6050"
RATE_HZ = 100.0
MESSAGE = struct.Struct(">7hB")
WIRE = np.dtype([("acc", ">i2", (3,)), ("gyr", ">i2", (3,)), ("temp", ">i2"), ("status", "u1")])


class MotionCardDecoder(FramedDecoder):
    """Reads ``motion-card`` messages with the scales of the sensor family."""

    LENGTH = MESSAGE.size

    def __init__(self, options: Options) -> None:
        super().__init__()
        sensor = self._sensor = family(options.family, FAMILY)
        self._acc, self._gyr = GRAVITY / sensor.acc_per_g, RAD_PER_DEG / sensor.gyr_per_dps
        self.seen = self._scale = f"raw counts, {sensor.acc_per_g:g} per g, {sensor.gyr_per_dps:g} per deg/s"
        self.rate_hz = RATE_HZ

    def _message(self, message: bytes) -> Row:
        ax, ay, az, gx, gy, gz, temp, status = MESSAGE.unpack(message)
        temp_c = temp / self._sensor.temp_per_c + self._sensor.temp_zero_c
        acc = (ax * self._acc, ay * self._acc, az * self._acc)
        gyr = (gx * self._gyr, gy * self._gyr, gz * self._gyr)
        return (*gyr, *acc, NAN, NAN, NAN, temp_c, status, *NO_GNSS)


class MotionCardEncoder(Encoder):
    """Writes the card's raw counts; a row without status is idle (0)."""

    def encode(self, rows: Rows) -> bytes:
        """One message for each row, shape (n,), one after the other."""
        sensor = FAMILIES[FAMILY]
        wire = np.empty(len(rows), WIRE)
        wire["acc"] = to_counts(rows["acc"] / GRAVITY * sensor.acc_per_g)
        wire["gyr"] = to_counts(rows["gyr"] / RAD_PER_DEG * sensor.gyr_per_dps)
        wire["temp"] = to_counts((rows["temp_c"] - sensor.temp_zero_c) * sensor.temp_per_c)
        wire["status"] = np.clip(rows["status"], 0, 255)
        return wire.tobytes()

"""Board formats: bytes to SAMPLE rows and back. A new format is one file and one line in FORMATS."""

from __future__ import annotations

from imugui.formats import accel_lines, colon_line, csv_line, motion_card, thingy_motion, triplets, wit_motion
from imugui.formats.base import Counts, Decoder, Encoder, Format, LinkLog, Options
from imugui.formats.families import FAMILIES, Family

__all__ = [
    "FAMILIES",
    "FORMATS",
    "STREAM_FORMATS",
    "Counts",
    "Decoder",
    "Encoder",
    "Family",
    "Format",
    "LinkLog",
    "Options",
]

_ALL = (
    Format(
        "accel-lines",
        "ACCEL / GYRO / MAG / TEMP lines",
        "The screw assistant's board and the FaBo 9-axis example: an Arduino with an MPU-9250.",
        (115200,),
        accel_lines.RATE_HZ,
        accel_lines.AccelLinesDecoder,
        accel_lines.AccelLinesEncoder,
    ),
    Format(
        "triplets",
        "ax,ay,az;gx,gy,gz;mx,my,mz; lines",
        "The RC-car tracker's receiver (Uno with radio), with or without a GNSS position.",
        (115200, 250000),
        triplets.IMU_RATE_HZ,
        triplets.TripletsDecoder,
        triplets.TripletsEncoder,
    ),
    Format(
        "colon-line",
        "#:ax:ay:az:wx:wy:wz:temperature:status: lines",
        "The motion card's scanner, with the card's button in the status.",
        (115200,),
        colon_line.RATE_HZ,
        colon_line.ColonLineDecoder,
        colon_line.ColonLineEncoder,
    ),
    Format(
        "csv-line",
        "Any table of numbers with a header line",
        "Your own board, or a file: columns separated by comma, tab, semicolon or blanks.",
        (115200, 250000, 9600, 57600, 38400, 230400, 460800, 921600),
        csv_line.RATE_HZ,
        csv_line.CsvLineDecoder,
        csv_line.CsvLineEncoder,
    ),
    Format(
        "motion-card",
        "Motion card, 15-byte notifications",
        "The motion card itself over Bluetooth LE, without its scanner; the button is in the status.",
        (),
        motion_card.RATE_HZ,
        motion_card.MotionCardDecoder,
        motion_card.MotionCardEncoder,
        motion_card.MESSAGE.size,
    ),
    Format(
        "thingy-motion",
        "Thingy:52, 18-byte raw motion notifications",
        "A Nordic Thingy:52 over Bluetooth LE, with its magnetometer.",
        (),
        thingy_motion.RATE_HZ,
        thingy_motion.ThingyMotionDecoder,
        thingy_motion.ThingyMotionEncoder,
        thingy_motion.MESSAGE.size,
    ),
    Format(
        "wit-motion",
        "WitMotion, 20-byte 55 61 notifications",
        "A WitMotion board of the WT901BLE kind over Bluetooth LE.",
        (),
        wit_motion.RATE_HZ,
        wit_motion.WitMotionDecoder,
        wit_motion.WitMotionEncoder,
        wit_motion.MESSAGE.size,
    ),
)
FORMATS: dict[str, Format] = {entry.name: entry for entry in _ALL}
STREAM_FORMATS: tuple[str, ...] = tuple(name for name, entry in FORMATS.items() if not entry.framed)
"""Those whose messages find their own ends in a stream of bytes: what a serial port or a file can hold."""

"""Board formats: bytes to SAMPLE rows and back. A new format is one file and one line in FORMATS."""

from __future__ import annotations

from imugui.formats import accel_lines, colon_line, csv_line, triplets
from imugui.formats.base import Counts, Decoder, Encoder, Format, LinkLog, Options
from imugui.formats.families import FAMILIES, Family

__all__ = ["FAMILIES", "FORMATS", "Counts", "Decoder", "Encoder", "Family", "Format", "LinkLog", "Options"]

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
)
FORMATS: dict[str, Format] = {entry.name: entry for entry in _ALL}

"""What the name of a column means, in whatever way it is spelt, and what the name of its file adds."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from imugui.formats.columns import LONGEST_NAME, NAMED_UNITS, factor_of, read_name

ACC_WORDS = {"a", "acc", "accel", "accelerometer", "acceleration", "accelerations"}
GYR_WORDS = {
    *("g", "w", "gyr", "gyro", "gyroscope", "omega", "angular", "rotation", "turn", "rotationrate", "angularrate"),
}
MAG_WORDS = {"m", "mag", "magn", "magnetometer", "magnetic", "magneticfield", "bfield", "h"}
TIME_WORDS = {"t", "ts", "time", "timestamp", "elapsed", "epoch", "unix", "clock"}
SENSOR_WORDS = {
    *(ACC_WORDS | GYR_WORDS | MAG_WORDS),
    *("linear", "user", "total", "gravity", "uncalibrated", "calibrated", "raw", "imu", "inertial", "sensor"),
    *("location", "gps", "gnss", "orientation", "attitude", "quaternion", "temperature", "temp", "rate", "field"),
}
"""Words by which the files of one recording differ from one another."""
STRANGE_WORDS = {
    *("q", "quat", "quaternion", "orientation", "attitude", "euler", "vector", "bias", "offset", "norm", "abs"),
    *("absolute", "magnitude", "accuracy", "std", "var", "variance", "error", "pressure", "humidity", "battery"),
    *("relative", "position", "delta", "confidence", "steps", "mean", "hdop", "vdop", "pdop", "scale", "jerk"),
}
"""A column with one of these is none of ours."""
LESSER_WORDS = {"uncalibrated": 1, "raw": 1, "high": 2, "watch": 2, "wrist": 2, "headphone": 2, "second": 1}
"""Words that tell the second choice among sensors of the same kind."""
TURNS = {"roll": "x", "pitch": "y", "yaw": "z"}
TIME_UNITS = {
    **dict.fromkeys(("seconds", "second", "secs", "sec"), "s"),
    **dict.fromkeys(("millis", "milliseconds", "millisecond", "msec"), "ms"),
    **dict.fromkeys(("micros", "microseconds", "microsecond", "usec"), "us"),
    **dict.fromkeys(("nanos", "nanoseconds", "nanosecond", "nsec"), "ns"),
}
SINGLES: dict[str, set[str]] = {
    "temp_c": {"temp", "temperature"},
    "status": {"status", "button"},
    "lat": {"lat", "latitude"},
    "lon": {"lon", "lng", "longitude"},
    "alt": {"alt", "altitude", "height"},
    "speed": {"speed", "velocity", "groundspeed"},
    "course_deg": {"course", "bearing", "direction", "cog"},
}

_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_BRACKETS = re.compile(r"(.*?)\s*[(\[{]\s*(.*?)\s*[)\]}]\s*")
_PER = re.compile(r"(.*?)_(m|deg|rad|km)_(?:per_)?(s2|s|h)", re.IGNORECASE)


@dataclass(frozen=True)
class Meaning:
    """``kind``: "a", "lin" (without gravity), "grav", "g" or "m" with an axis; a slot without one; "" unknown."""

    kind: str
    axis: str = ""
    unit: str = ""  # as written, "" when none was
    group: str = ""  # the same for the three axes of one sensor
    lesser: int = 0  # 0: the first choice among sensors of its kind


UNKNOWN = Meaning("")


def read_spelling(name: str, file: str = "") -> Meaning:
    """The meaning of a column's name; ``file``, its file's name without folder and ending, helps with a bare "x"."""
    if len(name) > LONGEST_NAME:
        return UNKNOWN
    stem, unit = _split_unit(name)
    words = words_of(stem)
    if not words or set(words) & STRANGE_WORDS:
        return UNKNOWN
    known = read_name(name)
    if known and known.slot[1:] in ("x", "y", "z"):
        return Meaning(known.slot[0], known.slot[1], known.unit, _group(words, known.slot[1]), _lesser(words, file))
    if known and known.factor is not None:
        return Meaning(known.slot, "", known.unit)
    if len(words) == 1 and words[0] in ("x", "y", "z") and file:
        kind = _kind(set(words_of(file)))
        return Meaning(kind, words[0], unit, "", _lesser(words, file)) if kind else UNKNOWN
    return _read_words(words, unit, file)


def words_of(text: str) -> list[str]:
    """The words of a name in any style: "rotationRateX", "acc_x", "Angular rate, x" in lower case."""
    return [word.lower() for word in _WORDS.findall(text)]


def _split_unit(name: str) -> tuple[str, str]:
    if brackets := _BRACKETS.fullmatch(name):
        return brackets[1], brackets[2]
    if per := _PER.fullmatch(name):
        return per[1], f"{per[2]}/{per[3]}"
    return name, ""


def _read_words(words: list[str], unit: str, file: str) -> Meaning:
    last = words[-1]
    axis = next((word for word in reversed(words) if word in ("x", "y", "z")), "")
    kind = _kind(set(words))
    turns = [TURNS[word.removesuffix("rate")] for word in words if word.removesuffix("rate") in TURNS]
    if turns and ("rate" in "".join(words) or kind == "g"):
        return Meaning("g", turns[0], unit or _last_unit("gx", last), "turns", _lesser(words, file))
    if kind and axis:
        return Meaning(kind, axis, unit or _last_unit(f"{kind[0]}x", last), _group(words, axis), _lesser(words, file))
    for slot, spelt in SINGLES.items():
        if set(words) & spelt and not kind:
            return Meaning(slot, "", unit or _last_unit(slot, last))
    if set(words) & (TIME_WORDS | set(TIME_UNITS)) or last in NAMED_UNITS:
        named = next((TIME_UNITS[word] for word in words if word in TIME_UNITS), "")
        return Meaning("t", "", unit or named or (_last_unit("t", last) if len(words) > 1 else ""))
    return UNKNOWN


def _last_unit(slot: str, word: str) -> str:
    slot = {"lx": "ax"}.get(slot, slot)
    return word if factor_of(slot, word) is not None and word not in ("x", "y", "z") else ""


def _kind(words: set[str]) -> str:
    """The kind of sensor that some words tell."""
    rules: dict[str, Callable[[], bool]] = {
        "grav": lambda: bool(words & {"gravity", "grav"}),
        "lin": lambda: bool(words & {"linear", "user", "lin"}) and bool(words & ACC_WORDS),
        "m": lambda: bool(words & (MAG_WORDS - {"m", "h"})),
        "g": lambda: bool(words & (GYR_WORDS - {"g", "w"})) and "vector" not in words,
        "a": lambda: bool(words & (ACC_WORDS - {"a"})),
    }
    return next((kind for kind, holds in rules.items() if holds()), "")


def _group(words: list[str], axis: str) -> str:
    """The words without the axis, which stands alone or ends one of them."""
    if axis in words:
        return " ".join(word for word in words if word != axis)
    return " ".join(word.removesuffix(axis) for word in words)


def _lesser(words: list[str], file: str) -> int:
    return sum(LESSER_WORDS.get(word, 0) for word in {*words, *words_of(file)})

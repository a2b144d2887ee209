"""The words of the status line."""

from __future__ import annotations

import dataclasses
import math

import pytest

from imugui.fusion import FILTERS
from imugui.views import status_words
from imugui.views.status_words import PARTS, Phrase, span
from imugui.workers.session import Status


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.0, "0 ms"),
        (-0.001, "0 ms"),
        (0.0066, "7 ms"),
        (0.9994, "999 ms"),
        (0.9996, "1.0 s"),
        (9.94, "9.9 s"),
        (9.96, "10 s"),
        (59.4, "59 s"),
        (60.0, "1 min"),
        (3569.0, "59 min"),
        (3600.0, "1 h"),
    ],
)
def test_span(seconds: float, words: str) -> None:
    assert span(seconds) == words


@pytest.mark.parametrize(
    ("name", "values", "phrase"),
    [
        ("rate", {"rate_hz": 0.0}, Phrase("--- Hz")),
        ("rate", {"rate_hz": math.nan}, Phrase("--- Hz")),
        ("rate", {"rate_hz": 138.64}, Phrase("138.6 Hz")),
        ("rate", {"rate_hz": 1000.4}, Phrase("1000 Hz")),
        ("gaps", {}, Phrase("no gaps")),
        ("gaps", {"gaps": 1, "gap_s": 0.31}, Phrase("1 gap, 310 ms lost", "warn")),
        ("gaps", {"gaps": 3, "gap_s": 4.26}, Phrase("3 gaps, 4.3 s lost", "warn")),
        ("gaps", {"missed_rows": 12}, Phrase("no gaps, 12 rows missed", "bad")),
        ("age", {}, Phrase("age --- ms")),
        ("age", {"age_ms": 6.4}, Phrase("age 6 ms")),
        ("age", {"age_ms": 1500.0}, Phrase("age 1.5 s", "bad")),
        ("bad", {"messages": 10}, Phrase("0 bad messages")),
        ("bad", {"messages": 986, "bad_messages": 1}, Phrase("1 bad of 987", "warn")),
        ("mag", {}, Phrase("no magnetometer")),
        ("mag", {"mag_trust": "good", "mag_norm_ut": 48.4}, Phrase("field good 48 µT", "good")),
        ("mag", {"mag_trust": "disturbed", "mag_norm_ut": 71.6}, Phrase("field disturbed 72 µT", "warn")),
        ("mag", {"mag_trust": "off", "mag_norm_ut": 48.4}, Phrase("magnetometer off 48 µT")),
        ("profile", {}, Phrase("no profile")),
        ("temperature", {}, Phrase("")),
        ("temperature", {"temp_c": 31.24}, Phrase("31.2 °C")),
    ],
)
def test_phrases(name: str, values: dict[str, object], phrase: Phrase) -> None:
    assert PARTS[name].phrase(dataclasses.replace(Status(), **values)) == phrase


@pytest.mark.parametrize("name", FILTERS)
def test_the_filter_is_named_by_its_title(name: str) -> None:
    assert status_words.filter_title(Status(filter=name)).text == FILTERS[name].title

"""Names that sort, and words for lengths, sizes and free space."""

from __future__ import annotations

import datetime
import math
from pathlib import Path

import pytest

from imugui.views.record_words import (
    elapsed_words,
    ended_words,
    file_label,
    free_words,
    is_low,
    length_words,
    recording_path,
    size_words,
)
from imugui.workers.session import LOW_DISK, RecordingStatus

NOW = datetime.datetime(2026, 1, 2, 3, 4, 5)


def status(elapsed_s: float = 10.0, size: int = 1_000_000, free: int = 10**11, missed: int = 0) -> RecordingStatus:
    return RecordingStatus(Path("one.imugui"), elapsed_s, size, free, 2000, missed)


@pytest.mark.parametrize(
    ("label", "name"),
    [("", ""), ("Slow turn", "Slow-turn"), ("../../etc", "etc"), ('a:b*c?"<>|', "a-b-c"), ("Prüfung 2", "Prüfung-2")],
)
def test_a_label_becomes_a_part_of_a_file_name(label: str, name: str) -> None:
    assert file_label(label) == name


def test_a_long_label_is_cut() -> None:
    assert len(file_label("x" * 300)) == 40


def test_names_sort_by_time_and_never_meet(tmp_path: Path) -> None:
    first = recording_path(tmp_path, "a b", NOW)
    assert first.name == "2026-01-02_03-04-05_a-b.imugui"
    first.mkdir()
    second = recording_path(tmp_path, "a b", NOW)
    assert second.name == "2026-01-02_03-04-05_a-b-2.imugui"
    later = recording_path(tmp_path, "", NOW + datetime.timedelta(seconds=1))
    assert sorted([later.name, second.name, first.name])[-1] == later.name


@pytest.mark.parametrize(("seconds", "words"), [(0.0, "0:00"), (7.9, "0:07"), (754.0, "12:34"), (3723.0, "1:02:03")])
def test_elapsed(seconds: float, words: str) -> None:
    assert elapsed_words(seconds) == words


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(12.34, "12.3 s"), (59.97, "1 min 00 s"), (125.0, "2 min 05 s"), (3720.0, "1 h 02 min"), (math.nan, "? s")],
)
def test_lengths(seconds: float, words: str) -> None:
    assert length_words(seconds) == words


@pytest.mark.parametrize(
    ("size", "words"),
    [(0, "0 B"), (980, "980 B"), (1_234_567, "1.2 MB"), (999_999, "1.0 MB"), (123e6, "123 MB"), (12.34e9, "12.3 GB")],
)
def test_sizes(size: float, words: str) -> None:
    assert size_words(size) == words


def test_free_space_is_told_with_how_long_it_lasts() -> None:
    assert (
        free_words(status(size=1_000_000, elapsed_s=10.0, free=360_000_000)) == "360 MB free, enough for about 60 min"
    )
    assert free_words(status(elapsed_s=0.5)) == "100 GB free"  # the rate is not known yet
    assert is_low(status(free=LOW_DISK - 1))
    assert not is_low(status(free=LOW_DISK))


def test_what_was_recorded() -> None:
    assert ended_words(status(12.3, 1_200_000)) == "Recorded 12.3 s, 1.2 MB: one.imugui"
    assert "7 rows" in ended_words(status(missed=7))

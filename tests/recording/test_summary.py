"""A quick look at recordings: right where it counts, honest where it does not, and never an exception."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from imugui.recording import summary
from imugui.recording.folder import ABOUT, SAMPLES, FolderWriter
from imugui.recording.summary import UNKNOWN, recordings_in, summarise
from imugui.samples import SAMPLE, Rows, empty_rows


def rows_of(n: int, rate_hz: float = 100.0) -> Rows:
    rows = empty_rows(SAMPLE, n)
    rows["t"] = 50.0 + np.arange(n) / rate_hz
    rows["acc"] = (0.0, 0.0, 9.81)
    rows["gyr"] = 0.1
    return rows


def write(folder: Path, rows: Rows) -> Path:
    writer = FolderWriter(folder, {"label": "turn", "note": "by hand", "started_utc": "2026-01-02T03:04:05+00:00"})
    writer.samples(rows)
    writer.close({"rows": len(rows), "missed_rows": 0})
    return folder


def test_a_recording_in_numbers(tmp_path: Path) -> None:
    rows = rows_of(1000)
    rows["gyr"][500] = (0.0, 3.0, 4.0)
    rows["t"][700:] += 0.5
    path = write(tmp_path / "a.imugui", rows)
    seen = summarise(path)
    assert (seen.label, seen.note, seen.complete, seen.problem) == ("turn", "by hand", True, "")
    assert (seen.rows, seen.gaps) == (1000, 1)
    assert seen.rate_hz == pytest.approx(100.0)
    assert seen.length_s == pytest.approx(9.99 + 0.5)
    assert seen.size_bytes == sum(part.stat().st_size for part in path.iterdir())
    assert seen.preview[:, 2].max() == pytest.approx(5.0)  # one sample is not hidden
    assert seen.preview[0, 0] == 0.0


def test_a_large_file_is_looked_at_in_places(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write(tmp_path / "a.imugui", rows_of(20_000))
    whole = summarise(path)
    monkeypatch.setattr(summary, "WHOLE_BYTES", 1000)
    monkeypatch.setattr(summary, "LOOKS", 50)
    seen = summarise(path)
    assert seen.gaps == UNKNOWN
    assert seen.rows == whole.rows
    assert seen.rate_hz == pytest.approx(100.0)
    assert seen.length_s == pytest.approx(whole.length_s, abs=0.05)


def test_a_recording_that_was_cut_off(tmp_path: Path) -> None:
    path = write(tmp_path / "a.imugui", rows_of(100))
    about = json.loads((path / ABOUT).read_text())
    del about["ended"]
    (path / ABOUT).write_text(json.dumps(about))
    with (path / SAMPLES).open("ab") as stream:
        stream.write(b"51.0,0.1,0.")
    seen = summarise(path)
    assert not seen.complete
    assert seen.rows == 100


@pytest.mark.parametrize("about", [b"", b"[]", b"{", b"\xff\xfe", b'"text"', b"null"])
def test_damage_is_told(tmp_path: Path, about: bytes) -> None:
    path = write(tmp_path / "a.imugui", rows_of(10))
    (path / ABOUT).write_bytes(about)
    assert "cannot be read" in summarise(path).problem


@pytest.mark.parametrize("samples", [b"", b"# only\n", b"t,gx,gy,gz\n", b"nonsense\n1,2\n", b"\x00" * 5000])
def test_no_samples_are_told(tmp_path: Path, samples: bytes) -> None:
    path = write(tmp_path / "a.imugui", rows_of(10))
    (path / SAMPLES).write_bytes(samples)
    assert summarise(path).problem == "holds no samples"
    (path / SAMPLES).unlink()
    assert "cannot be read" in summarise(path).problem


def test_the_newest_comes_first(tmp_path: Path) -> None:
    names = ["2026-01-01_00-00-00.imugui", "2026-01-03_00-00-00.imugui", "2026-01-02_00-00-00.imugui"]
    for name in names:
        write(tmp_path / name, rows_of(2))
    (tmp_path / "2026-01-09.imugui").mkdir()  # not a recording
    (tmp_path / "notes.txt").write_text("")
    assert [path.name for path in recordings_in(tmp_path)] == sorted(names, reverse=True)
    assert recordings_in(tmp_path / "missing") == []

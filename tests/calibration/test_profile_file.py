"""Profile files: nothing of a bad one is taken, and an old one survives everything."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from imugui.calibration.parts import (
    AccelerometerPart,
    GyroscopePart,
    MagnetometerPart,
    MountingPart,
    NoisePart,
    TemperaturePart,
)
from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_file import LARGEST, MARK, VERSION, ProfileError, from_text, load, save, to_text
from imugui.calibration.profile_store import ProfileStore

DATE = "2026-11-01T12:00:00+00:00"
FULL = Profile(
    Board("serial", "ABC/123", "Müllers probe"),
    GyroscopePart("at rest", DATE, 25.0, 500, "good", "fine", bias=(0.01, -0.02, 0.03)),
    AccelerometerPart("many", DATE, positions=((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)), tilt_deg=0.02),
    MagnetometerPart("tukey", DATE, hard_iron=(1.0, 2.0, 3.0), cells=(0, 5, 99)),
    MountingPart("level, nose up", DATE),
    TemperaturePart("linear", DATE, coefficients=((0.0, 0.0, 0.0), (0.1, 0.0, 0.0))),
    NoisePart("Allan deviation", DATE, rate_hz=99.3),
    rate_hz=100.0,
    delays_ms=(5.9, 1.3),
)
SLOW_SAVE = """
import os, sys, pathlib
from imugui.calibration import profile_file
from imugui.calibration.profile import Board, Profile
step, path = sys.argv[1], pathlib.Path(sys.argv[2])
def stop(*_):
    print("now", flush=True)
    sys.stdin.read()
if step == "writing":
    os.fsync = stop
else:
    pathlib.Path.replace = stop
profile_file.save(path, Profile(Board("serial", "new")))
"""


def changed(path: str, value: object) -> str:
    """The full profile's text with one value, named by its path, replaced."""
    values: dict[str, Any] = json.loads(to_text(FULL))
    *parents, last = path.split(".")
    place = values
    for name in parents:
        place = place[name]
    place[last] = value
    return json.dumps(values)


def test_it_comes_back_as_it_was(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "board.json"
    save(path, FULL)
    back = load(path)
    assert repr(back.parts) == repr(FULL.parts)  # by repr: NaN differs from itself
    assert back.board == FULL.board
    assert back.rate_hz == 100.0
    assert back.made_with.startswith("imugui ")
    assert back.correction() == FULL.correction()
    assert [one.name for one in path.parent.iterdir()] == ["board.json"]


def test_unknown_keys_are_ignored() -> None:
    assert repr(from_text(changed("gyroscope.colour", "blue")).parts) == repr(FULL.parts)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "not valid JSON"),
        (to_text(FULL)[:300], "not valid JSON"),
        ("[" * 100_000, "not valid JSON"),
        ("[]", "not a profile"),
        ('{"settings": {}}', "not a profile"),
        (changed(MARK, VERSION + 1), "newer imugui"),
        (changed(MARK, "1"), "no number"),
        (changed(MARK, True), "no number"),
        (changed("board", None), "board is missing"),
        (changed("board.name", 5), "board: name"),
        (changed("board.name", "a\nb"), "board: name"),
        (changed("board.address", "x" * 1000), "board: address"),
        (changed("gyroscope", []), "gyroscope: expected named values"),
        (changed("gyroscope.bias", [0, 0]), "gyroscope: bias: expected 3 values"),
        (changed("gyroscope.bias", [0, 0, "0"]), "gyroscope: bias: not a number"),
        (changed("gyroscope.bias", [0, 0, 10**400]), "gyroscope: bias: not a number"),
        (changed("gyroscope.bias", [0, 0, None]), "gyroscope: bias: not a number"),
        (changed("gyroscope.date", "soon"), "gyroscope: date"),
        (changed("accelerometer.matrix", [[1, 0, 0], [0, 1, 0]]), "accelerometer: matrix: expected 3 values"),
        (changed("accelerometer.matrix", [[0, 0, 1], [0, 1, 0], [1, 0, 0]]), "accelerometer: matrix: too far"),
        (changed("accelerometer.positions", [[0, 0, 1]] * 501), "accelerometer: positions: expected a list"),
        (changed("magnetometer.soft_iron", [[1, 0, 0], [0, 1, 0], [0, 0, 0]]), "magnetometer: soft_iron"),
        (changed("mounting.quat", [1, 1, 0, 0]), "mounting: quat"),
        (to_text(FULL).replace("0.03", "NaN"), "gyroscope: bias: not a number"),
        (to_text(FULL).replace("0.03", "1e999"), "gyroscope: bias: not a number"),
        (to_text(FULL).replace('"sigma"', '"signa"'), "gyroscope: sigma is missing"),
    ],
)
def test_broken_foreign_and_future_files_are_refused_in_one_line(text: str, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "board.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ProfileError) as caught:
        load(path)
    assert reason in str(caught.value)
    assert str(caught.value).startswith("board.json: ")
    assert "\n" not in str(caught.value)
    assert path.read_text(encoding="utf-8") == text


@pytest.mark.parametrize(("data", "reason"), [(b"\xff\xfe\x00", "not a text"), (b" " * (LARGEST + 1), "larger than")])
def test_binary_and_huge_files_are_refused(data: bytes, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "board.json"
    path.write_bytes(data)
    with pytest.raises(ProfileError, match=reason):
        load(path)


_JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=8,
)


PLACES = [
    *("board", "gyroscope", "gyroscope.bias", "gyroscope.samples", "gyroscope.temp_c", "accelerometer.matrix"),
    *("magnetometer.cells", "mounting.quat", "temperature.coefficients", "noise.gyr_white", "rate_hz"),
]


@given(st.sampled_from([*PLACES, MARK]), _JSON)
def test_whatever_stands_in_a_file_is_taken_whole_or_refused(path: str, value: object) -> None:
    try:
        profile = from_text(changed(path, value))
    except ProfileError as error:
        assert "\n" not in str(error)
    else:
        profile.correction()
        from_text(to_text(profile))


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
@pytest.mark.parametrize("step", ["writing", "replacing"])
def test_killed_in_the_middle_the_old_profile_is_untouched(step: str, tmp_path: Path) -> None:
    path = tmp_path / "board.json"
    save(path, FULL)
    before = path.read_bytes()
    command = [sys.executable, "-c", SLOW_SAVE, step, str(path)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "now\n"
    assert len(list(tmp_path.iterdir())) == 2  # it was really in the middle
    os.kill(process.pid, signal.SIGKILL)
    process.communicate(timeout=10)
    assert path.read_bytes() == before
    assert [entry.path for entry in ProfileStore(tmp_path).entries()] == [path]
    save(path, FULL)


def test_a_full_disk_leaves_the_old_profile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "board.json"
    save(path, FULL)
    before = path.read_bytes()

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space"):
        save(path, Profile(Board("serial", "new")))
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


def test_the_store_finds_lists_renames_exports_and_imports(tmp_path: Path) -> None:
    store = ProfileStore(tmp_path / "profiles")
    other = Board("serial", "Z9", "another")
    assert store.entries() == []
    assert store.find(FULL.board) is None
    store.save(FULL)
    store.save(Profile(other))
    assert [entry.profile.board.name for entry in store.entries() if entry.profile] == ["Müllers probe", "another"]
    assert store.rename(FULL.board, " drill \n 2 ").board.name == "drill 2"
    found = store.find(Board("serial", "ABC/123"))
    assert found is not None
    assert found.board.name == "drill 2"
    store.export(FULL.board, tmp_path / "mine.json")
    taken = store.import_file(tmp_path / "mine.json", Board("serial", "NEW"))
    assert taken.board == Board("serial", "NEW", "drill 2")
    assert len(store.entries()) == 3
    store.remove(other)
    assert store.find(other) is None
    with pytest.raises(ProfileError, match="no profile of another"):
        store.rename(other, "x")


def test_a_bad_file_in_the_folder_is_listed_with_its_reason(tmp_path: Path) -> None:
    store = ProfileStore(tmp_path)
    store.save(FULL)
    (tmp_path / "a-broken.json").write_text("{")
    good, bad = store.entries()
    assert good.profile is not None
    assert bad.profile is None
    assert bad.problem.startswith("a-broken.json: not valid JSON")
    with pytest.raises(ProfileError):
        store.import_file(tmp_path / "a-broken.json")
    assert store.find(FULL.board) is not None


def test_a_file_of_version_1_has_less_and_is_read(tmp_path: Path) -> None:
    values = json.loads(to_text(FULL)) | {MARK: 1}
    for name in ("matrix_sigma", "matrix_date", "matrix_temp_c"):
        del values["gyroscope"][name]
    del values["delays_ms"]
    old = from_text(json.dumps(values))
    assert old.gyroscope == FULL.gyroscope
    assert old.delays_ms is None
    with pytest.raises(ProfileError, match="gyroscope: matrix_sigma is missing"):
        from_text(json.dumps(values | {MARK: VERSION}))


@pytest.mark.parametrize(
    "value", [5.9, [5.9], [5.9, 1.3, 0.0], [-1.0, 0.0], [60.0, 0.0], [0.0, 201.0], ["5", 1], [True, 0]]
)
def test_delays_that_are_none_are_refused(value: object) -> None:
    with pytest.raises(ProfileError, match="delays_ms"):
        from_text(changed("delays_ms", value))


@pytest.mark.parametrize("value", ["yesterday", "0001-01-01"])
def test_a_matrix_without_a_date_of_its_own_is_refused(value: str) -> None:
    with pytest.raises(ProfileError, match="matrix_date"):
        from_text(changed("gyroscope.matrix_date", value))

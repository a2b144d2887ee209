"""Where things are kept: a disk that refuses, a profile of another board, settings of a newer program, huge files."""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_file import ProfileError
from imugui.calibration.profile_store import ProfileStore
from imugui.formats.columns import read_name
from imugui.formats.layout import TableError, read_layout
from imugui.formats.spelling import UNKNOWN, read_spelling
from imugui.guidance.plan_file import read_plans
from imugui.recording import UnreadableError, read_recording, read_samples
from imugui.recording.folder import ABOUT, ATTITUDE, EVENTS, SAMPLES, FolderWriter
from imugui.recording.summary import summarise
from imugui.settings import LARGEST, MARK, Settings, Store, load, save
from imugui.simulation.board import VirtualBoard
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source

ONE, OTHER = Board("simulator", "mpu9250-calibrated, seed 1", "one"), Board("serial", "A600", "other")


@pytest.fixture
def refused(tmp_path: Path) -> Path:
    """A place in which no folder can be made, whoever asks."""
    if sys.platform.startswith("linux"):
        return Path("/sys/imugui")
    (tmp_path / "file").touch()
    return tmp_path / "file" / "below"


def test_a_folder_that_cannot_be_written_is_said_and_samples_go_on(
    session: Session, said: list[str], refused: Path, qtbot
) -> None:
    session.connect_to(Source("simulator", "rest"))
    assert not session.record(refused / "one.imugui")
    assert str(refused) in said[-1]
    assert "cannot be written" in said[-1]
    assert session.recording is None
    before = session.samples.count
    qtbot.waitUntil(lambda: session.samples.count > before + 10)


def test_settings_that_cannot_be_written_are_said_once_and_hold(refused: Path, qapp: object) -> None:
    store = SettingsStore(refused / "settings.json")
    said: list[str] = []
    store.failed.connect(said.append)
    for theme in ("dark", "light"):
        store.update(theme=theme)
        store.flush()
    assert len(said) == 1
    assert "They hold until imugui is closed" in said[0]
    assert store.settings.theme == "light"


def test_a_profile_that_cannot_be_written_changes_nothing(
    qapp: object, refused: Path, said_of: Callable[[Session], list[str]]
) -> None:
    session = Session(profiles=ProfileStore(refused))
    told = said_of(session)
    session.connect_to(Source("simulator", "rest"))
    assert not session.apply_profile(Profile(ONE))
    assert "could not be written" in told[-1]
    assert session.profile is None
    session.close()


@pytest.fixture
def said_of() -> Callable[[Session], list[str]]:
    def listen(session: Session) -> list[str]:
        texts: list[str] = []
        session.message.connect(lambda _, text: texts.append(text))
        return texts

    return listen


def test_a_profile_of_another_board_is_not_applied(
    tmp_path: Path, qapp: object, said_of: Callable[[Session], list[str]]
) -> None:
    store = ProfileStore(tmp_path)
    mine = store.save(Profile(ONE))
    shutil.copyfile(store.save(Profile(OTHER)), mine)  # as somebody does who copies files by hand
    with pytest.raises(ProfileError, match="made for another board"):
        store.find(ONE)
    session = Session(profiles=store)
    told = said_of(session)
    session.connect_to(Source("simulator", "rest"))
    assert session.board is not None
    assert session.board.key == ONE.key
    assert session.profile is None
    assert "is not applied" in told[0]
    assert "import it to use it here" in told[0]
    session.close()
    assert store.import_file(store.path_of(OTHER), ONE).board.key == ONE.key
    assert store.find(ONE) is not None


def test_settings_of_a_newer_program_are_used_and_kept(tmp_path: Path) -> None:
    path = tmp_path / "settings.json"
    newer = {MARK: 99, "settings": {"theme": "dark", "hologram": True}, "boards": {}, "worlds": [1, 2]}
    path.write_text(json.dumps(newer))
    store, said = load(path)
    assert store.settings == Settings(theme="dark")
    assert "newer imugui" in said[0]
    save(path, store)
    assert json.loads((tmp_path / "settings.newer.json").read_text()) == newer
    assert load(path) == (store, [])


@pytest.mark.parametrize(
    "values",
    [
        {"settings": {"field_ut": 10**400}},
        {"settings": {"field_ut": 1e999}},
        {"filters": {"mahony": {"kp": float("nan"), "ki": 1e999}}},
        {"boards": {"usb": {"tables": [[[[[[[[[[1]]]]]]]]]]}}},
        {"boards": {"usb": {"columns": [float("-inf")]}}},
    ],
)
def test_whatever_was_read_can_be_saved(tmp_path: Path, values: dict[str, object]) -> None:
    path = tmp_path / "settings.json"
    path.write_text(json.dumps(values))
    store, _ = load(path)
    assert store.settings == Settings()
    save(path, store)
    assert load(path) == (store, [])


def test_settings_without_end_are_set_aside(tmp_path: Path) -> None:
    path = tmp_path / "settings.json"
    path.write_bytes(b"{" + b" " * LARGEST + b"}")
    store, said = load(path)
    assert store == Store()
    assert "larger than" in said[0]
    assert (tmp_path / "settings.broken.json").exists()


@pytest.fixture
def recorded(tmp_path: Path) -> Path:
    folder = tmp_path / "one.imugui"
    writer = FolderWriter(folder, {"label": "two\nlines", "note": "x" * 100_000})
    writer.samples(VirtualBoard("free", 100.0).rows(50))
    writer.close({"rows": 50})
    return folder


@pytest.mark.parametrize("name", [SAMPLES, ATTITUDE, EVENTS])
def test_a_recording_with_a_line_that_does_not_end_needs_little(recorded: Path, name: str) -> None:
    path = recorded / name
    path.write_bytes(path.read_bytes() + b"x" * 5_000_000)
    found = read_recording(recorded)
    assert len(found.samples) == 50
    assert "damaged" in found.warnings[0]
    assert summarise(recorded).problem == ""


def test_a_table_that_fits_in_no_memory_is_refused_unread(recorded: Path) -> None:
    with (recorded / SAMPLES).open("r+b") as stream:
        stream.truncate(5 << 30)
    with pytest.raises(UnreadableError, match="cut it into pieces"):
        read_recording(recorded)
    with pytest.raises(UnreadableError, match="cut it into pieces"):
        read_samples(recorded / SAMPLES, "csv-line")
    (recorded / ABOUT).unlink()


@pytest.mark.parametrize("name", ["(" * 60_000, " " * 60_000, "[g" * 30_000, "acc_x " + " " * 60_000 + "("])
def test_a_name_of_a_column_that_is_too_long_is_none(name: str) -> None:
    assert read_spelling(name) == UNKNOWN
    assert read_name(name) is None


def test_long_runs_of_digits_are_read_in_one_go() -> None:
    with pytest.raises(TableError):
        read_layout(b"1" * 60_000 + b"x,2\n" + b"1" * 5_000 + b"x")
    plans, said = read_plans("level,side,axial_deg,sagittal_deg\nL4,left," + "1" * 100_000 + "x,1\n")
    assert plans == []
    assert "must be a number" in said[0]

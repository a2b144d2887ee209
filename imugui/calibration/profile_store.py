"""The user's profiles: one file per board in one folder."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from imugui.calibration.profile import Board, Profile
from imugui.calibration.profile_file import ProfileError, load, save


@dataclass(frozen=True)
class Entry:
    """One file of the folder: its profile, or why it cannot be used."""

    path: Path
    profile: Profile | None
    problem: str = ""


@dataclass(frozen=True)
class ProfileStore:
    """Finds, keeps, renames, exports and imports profiles; ``folder`` is made when the first one is saved."""

    folder: Path

    def path_of(self, board: Board) -> Path:
        """Where this board's profile is or would be."""
        return self.folder / board.file_name

    def find(self, board: Board) -> Profile | None:
        """The board's profile, or None; ProfileError or OSError when its file cannot be used."""
        try:
            profile = load(self.path_of(board))
        except FileNotFoundError:
            return None
        if profile.board.key != board.key:
            raise ProfileError(
                f"{self.path_of(board).name}: made for another board ({profile.board.title}); import it to use it here"
            )
        return profile

    def entries(self) -> list[Entry]:
        """Every file, by name of its board; those that cannot be used come last, with the reason."""
        found = [_entry(path) for path in sorted(self.folder.glob("*.json"))] if self.folder.is_dir() else []
        return sorted(found, key=lambda one: (one.profile is None, one.profile.board.title if one.profile else ""))

    def save(self, profile: Profile) -> Path:
        """Keep the profile as that of its board; raises OSError."""
        path = self.path_of(profile.board)
        save(path, profile)
        return path

    def rename(self, board: Board, name: str) -> Profile:
        """Give the board another name; ProfileError without a profile."""
        renamed = self._need(board).renamed(name)
        self.save(renamed)
        return renamed

    def remove(self, board: Board) -> None:
        """Forget the board's profile; raises OSError."""
        self.path_of(board).unlink(missing_ok=True)

    def export(self, board: Board, path: Path) -> None:
        """Write the board's profile to a file of the user's; ProfileError without a profile."""
        save(path, self._need(board))

    def import_file(self, path: Path, board: Board | None = None) -> Profile:
        """Take a profile from a file, for its own board or for ``board``; ProfileError and OSError."""
        profile = load(path)
        if board is not None:
            profile = replace(profile, board=replace(board, name=board.name or profile.board.name))
        self.save(profile)
        return profile

    def _need(self, board: Board) -> Profile:
        profile = self.find(board)
        if profile is None:
            raise ProfileError(f"there is no profile of {board.title}")
        return profile


def _entry(path: Path) -> Entry:
    try:
        return Entry(path, load(path))
    except ProfileError as error:
        return Entry(path, None, str(error))
    except OSError as error:
        return Entry(path, None, f"{path.name}: {error.strerror or error}")

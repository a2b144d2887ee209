"""What the Target page remembers from one run of the program to the next, beside the settings."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

from imugui.fields import field as editable
from imugui.fields import from_mapping
from imugui.paths import replace_file
from imugui.targeting.settings import Control
from imugui.targeting.study_files import read_text
from imugui.targeting.tasks import Task
from imugui.texts import from_json

FILE_NAME = "targeting.json"
ENDOSCOPE, PLAIN = "endoscope", "plain"


@dataclass(frozen=True)
class Play:
    """How the game is played outside of a study."""

    practice: bool = editable(False, "Practice", tip="The run is marked, and left out of the comparison.")
    picture: str = editable(
        ENDOSCOPE, "Picture", choices=(ENDOSCOPE, PLAIN), tip="A round picture of tissue, or squared paper."
    )  # fmt: skip
    sound: bool = editable(True, "Sound", tip="A beep when the view holds, and at an emergency stop.")
    seed: int = editable(
        1, "Target list", low=0, high=99999, step=1,
        tip="The same number gives the same targets. All lists of a task are equally difficult.",
    )  # fmt: skip
    another: bool = editable(True, "Another list for each run", tip="Else every run has the same targets.")


@dataclass(frozen=True)
class Kept:
    """Task, mapping and the rest, as they were last."""

    task: Task = field(default_factory=Task)
    control: Control = field(default_factory=Control)
    play: Play = field(default_factory=Play)
    study: str = ""  # folder of the study that was open last


def load(path: Path) -> tuple[Kept, list[str]]:
    """Read the file; returns what it keeps and one sentence for each thing that was not taken."""
    try:
        values = from_json(read_text(path))
    except FileNotFoundError:
        return Kept(), []
    except (OSError, ValueError, RecursionError) as error:
        return Kept(), [f"{path.name} could not be read ({error}); the game has its defaults."]
    if not isinstance(values, dict):
        return Kept(), [f"{path.name} is no file of the game; it has its defaults."]
    parts, problems = {}, []
    for name, kind in (("task", Task), ("control", Control), ("play", Play)):
        part = values.get(name)
        parts[name], wrong = from_mapping(kind, part if isinstance(part, dict) else {})
        problems += [f"{path.name}: {one}; the default is used." for one in wrong]
    study = values.get("study")
    return Kept(**parts, study=study if isinstance(study, str) else ""), problems


def save(path: Path, kept: Kept) -> None:
    """Write the file whole; raises OSError when the folder cannot be written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, json.dumps(asdict(kept), indent=1, allow_nan=False) + "\n")

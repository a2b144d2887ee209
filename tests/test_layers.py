"""Who may import whom (DESIGN.md section 3), read from the syntax trees; and what no file may contain."""

from __future__ import annotations

import ast
import importlib.util
import os
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
NO_QT_BELOW = 3
RANKS = {
    **dict.fromkeys(("__init__", "samples", "ring", "paths", "fields", "lazy", "texts"), 0),
    "fusion": 1,
    **dict.fromkeys(
        ("formats", "recording", "settings", "signals", "calibration", "guidance", "targeting", "simulation"), 2
    ),
    "workers": NO_QT_BELOW,
    "views": 4,
    **dict.fromkeys(("app", "cli", "commands", "demo", "calibrate", "crash", "study", "__main__"), 5),
}
QT = ("PySide6", "shiboken6", "pyqtgraph")
LAZY = re.compile(r"imugui(\.\w+)+:\w+")
"""A place in a lazy table: it is imported too, only later."""
# an outside package -> the ranks that may import it
OUTSIDE = {
    **dict.fromkeys(("PySide6", "shiboken6"), (3, 4, 5)),
    "pyqtgraph": (4, 5),
    **dict.fromkeys(("serial", "bleak"), (3,)),
    **dict.fromkeys(("bumble", "dbus_fast"), (2,)),
    **dict.fromkeys(("pickle", "cPickle", "dill", "shelve", "marshal"), ()),
}
# a rank and a package -> the only part of it that this rank may import
NARROW = {(3, "PySide6"): "PySide6.QtCore", (4, "imugui.workers"): "imugui.workers.session"}
BANNED_CALLS = ("eval", "exec", "builtins.eval", "builtins.exec", "os.system", "os.popen")
BANNED_KEYWORDS = ("shell", "allow_pickle")
ANYWHERE = ("imugui", "tests", "benchmarks", "docs", "resources", "run.py", "run_system.py")

LOADED_QT = """
import importlib, sys
for name in sys.argv[2:]:
    importlib.import_module(name)
print(*sorted({name.partition(".")[0] for name in sys.modules}.intersection(sys.argv[1].split())))
"""


def module_name(path: Path, root: Path) -> str:
    """The dotted name of a file of the package below ``root``: imugui.fusion for imugui/fusion/__init__.py."""
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def home_of(module: str) -> str:
    """The key of RANKS for a dotted name of our package."""
    return module.split(".")[1] if "." in module else "__init__"


def sources(root: Path, places: Iterable[str]) -> Iterator[tuple[Path, ast.AST]]:
    """Every Python file in these files and folders below ``root``, with its syntax tree."""
    for place in places:
        start = root / place
        for path in sorted(start.rglob("*.py")) if start.is_dir() else [start] * start.is_file():
            yield path, ast.parse(path.read_text(encoding="utf-8"), str(path))


def line_of(node: ast.AST) -> int:
    """The line on which a node starts; 0 for the few kinds without one."""
    return getattr(node, "lineno", 0)


def text_of_name(node: ast.AST) -> str:
    """``a.b.c`` for a chain of names, empty for anything else."""
    return ast.unparse(node) if isinstance(node, ast.Name | ast.Attribute) else ""


def targets(node: ast.AST, package: str) -> list[str]:
    """The absolute dotted names that a node imports, now or later; each name of a ``from`` import is one of them."""
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom):
        base = importlib.util.resolve_name("." * node.level + (node.module or ""), package)
        return [f"{base}.{alias.name}" for alias in node.names]
    if isinstance(node, ast.Constant) and isinstance(node.value, str) and LAZY.fullmatch(node.value):
        return [node.value.replace(":", ".")]
    if isinstance(node, ast.Call) and text_of_name(node.func).split(".")[-1] in ("import_module", "__import__"):
        return [arg.value for arg in node.args[:1] if isinstance(arg, ast.Constant) and isinstance(arg.value, str)]
    return []


def wrong_import(rank: int, target: str) -> str:
    """Why a module of this rank must not import ``target``, in words; empty when it may."""
    top = target.partition(".")[0]
    if top == "imugui":
        home = home_of(target)
        # "from imugui import __version__" has no module of that name
        other = RANKS.get(home, 0 if home.startswith("__") else None)
        if other is None:
            return f"{home} has no rank: give it one in RANKS"
        if other > rank:
            return f"rank {rank} imports rank {other}"
    if rank not in OUTSIDE.get(top, (rank,)):
        return f"rank {rank} must not import {top}"
    for (narrow_rank, package), allowed in NARROW.items():
        inside = [f"{target}.".startswith(f"{name}.") for name in (package, allowed)]
        if rank == narrow_rank and inside == [True, False]:
            return f"rank {rank} imports only {allowed} of {package}"
    return ""


def layer_problems(root: Path) -> list[str]:
    """One line for each import below ``root``/imugui that goes the wrong way."""
    problems = []
    for path, tree in sources(root, ("imugui",)):
        module = module_name(path, root)
        package = module if path.name == "__init__.py" else module.rpartition(".")[0]
        rank = RANKS.get(home_of(module))
        where = path.relative_to(root).as_posix()
        if rank is None:
            problems.append(f"{where}: {home_of(module)} has no rank: give it one in RANKS")
            continue
        found = ((node, target) for node in ast.walk(tree) for target in targets(node, package))
        wrong = ((line_of(node), target, wrong_import(rank, target)) for node, target in found)
        problems += [f"{where}:{line}: {target}: {why}" for line, target, why in wrong if why]
    return problems


def banned(node: ast.AST) -> str:
    """What a node does that no file may do; empty when nothing."""
    if isinstance(node, ast.Global):
        return "global"
    if isinstance(node, ast.Import | ast.ImportFrom):
        tops = [target.partition(".")[0] for target in targets(node, "imugui")]
        return next((f"import {top}" for top in tops if OUTSIDE.get(top) == ()), "")
    if not isinstance(node, ast.Call):
        return ""
    name = text_of_name(node.func)
    true = (key.arg for key in node.keywords if isinstance(key.value, ast.Constant) and key.value.value)
    keyword = next((key for key in true if key in BANNED_KEYWORDS), "")
    return f"{name}()" if name in BANNED_CALLS else f"{keyword}=True" * bool(keyword)


def banned_problems(root: Path) -> list[str]:
    """One line for each banned thing in any of our Python files below ``root``."""
    problems = []
    for path, tree in sources(root, ANYWHERE):
        found = ((line_of(node), banned(node)) for node in ast.walk(tree))
        problems += [f"{path.relative_to(root).as_posix()}:{line}: {what}" for line, what in found if what]
    return problems


def qt_loaded_by(modules: Iterable[str], *folders: Path) -> list[str]:
    """The Qt packages in memory after a fresh Python with these extra folders has imported the modules."""
    environ = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, folders))}
    command = [sys.executable, "-c", LOADED_QT, " ".join(QT), *modules]
    done = subprocess.run(command, env=environ, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def plant(root: Path, place: str, code: str) -> None:
    """Write a file below ``root``."""
    path = root / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(code, encoding="utf-8")


def test_imports_go_to_own_or_lower_rank() -> None:
    assert layer_problems(REPOSITORY) == []


def test_no_file_has_what_is_banned() -> None:
    assert banned_problems(REPOSITORY) == []


def test_no_qt_is_loaded_below_the_workers() -> None:
    files = (path for path, _ in sources(REPOSITORY, ("imugui",)))
    modules = [module_name(path, REPOSITORY) for path in files]
    low = [name for name in modules if RANKS.get(home_of(name), 0) < NO_QT_BELOW]
    assert {"imugui.samples", "imugui.ring"} <= set(low)
    assert qt_loaded_by(low, REPOSITORY) == []


def test_a_planted_qt_is_seen_in_memory(tmp_path: Path) -> None:
    plant(tmp_path, "planted.py", "def harmless():\n    return 1\nimport shiboken6\n")
    assert "shiboken6" in qt_loaded_by(["planted"], tmp_path)


@pytest.mark.parametrize(
    ("place", "code", "said"),
    [
        ("samples.py", "from imugui.fusion import pipeline", "rank 0 imports rank 1"),
        ("fusion/mahony.py", "from ..formats.base import Decoder", "rank 1 imports rank 2"),
        ("fusion/mahony.py", "from .. import formats", "rank 1 imports rank 2"),
        ("formats/__init__.py", "from ..workers import session", "rank 2 imports rank 3"),
        ("formats/detect.py", "def late():\n    import imugui.workers.session", "rank 2 imports rank 3"),
        ("formats/detect.py", "import importlib\nimportlib.import_module('imugui.views')", "rank 2 imports rank 4"),
        ("formats/detect.py", "LATE = {'x': 'imugui.workers.session:Session'}", "rank 2 imports rank 3"),
        ("settings.py", "from PySide6.QtCore import QObject", "rank 2 must not import PySide6"),
        ("simulation/board.py", "import pyqtgraph as pg", "rank 2 must not import pyqtgraph"),
        ("simulation/board.py", "from serial.tools import list_ports", "rank 2 must not import serial"),
        ("workers/reader.py", "from PySide6.QtWidgets import QWidget", "imports only PySide6.QtCore"),
        ("workers/reader.py", "from imugui.views import theme", "rank 3 imports rank 4"),
        ("views/live.py", "from imugui.workers.reader import Reader", "imports only imugui.workers.session"),
        ("views/live.py", "from imugui import workers", "imports only imugui.workers.session"),
        ("views/live.py", "from imugui.app import main", "rank 4 imports rank 5"),
        ("views/live.py", "import serial", "rank 4 must not import serial"),
        ("cli.py", "import bleak", "rank 5 must not import bleak"),
        ("novelty.py", "import numpy", "novelty has no rank"),
        ("ring.py", "import imugui.novelty", "novelty has no rank"),
    ],
)
def test_a_planted_wrong_import_is_reported(tmp_path: Path, place: str, code: str, said: str) -> None:
    plant(tmp_path, f"imugui/{place}", code)
    problems = layer_problems(tmp_path)
    assert len(problems) == 1, problems
    assert problems[0].startswith(f"imugui/{place}")
    assert said in problems[0]


@pytest.mark.parametrize(
    ("place", "code"),
    [
        ("fusion/mahony.py", "from . import quaternion\nfrom imugui.samples import Rows\nimport numpy"),
        ("formats/base.py", "from imugui import __version__\nfrom imugui.simulation import board"),
        ("workers/reader.py", "import serial\nimport bleak\nfrom PySide6.QtCore import QThread"),
        ("views/live.py", "from imugui.workers.session import Session\nfrom imugui.workers import session"),
        ("views/live.py", "from PySide6.QtWidgets import QWidget\nfrom .theme import pen\nimport pyqtgraph"),
        ("__main__.py", "from imugui import app, cli"),
        ("app.py", "from imugui.cli import main\nfrom imugui.workers import reader"),
    ],
)
def test_a_right_import_is_not_reported(tmp_path: Path, place: str, code: str) -> None:
    plant(tmp_path, f"imugui/{place}", code)
    assert layer_problems(tmp_path) == []


@pytest.mark.parametrize(
    ("code", "said"),
    [
        ("x = eval('1')", "eval()"),
        ("def f():\n    exec('x = 1')", "exec()"),
        ("import pickle", "import pickle"),
        ("from pickle import loads", "import pickle"),
        ("import subprocess\nsubprocess.run('ls', shell=True)", "shell=True"),
        ("import numpy\nnumpy.load('f', allow_pickle=True)", "allow_pickle=True"),
        ("import os\nos.system('ls')", "os.system()"),
        ("def f():\n    global x\n    x = 1", "global"),
    ],
)
def test_a_planted_banned_thing_is_reported(tmp_path: Path, code: str, said: str) -> None:
    plant(tmp_path, "benchmarks/speed.py", code)
    problems = banned_problems(tmp_path)
    assert [problem.rpartition(": ")[2] for problem in problems] == [said]


def test_qts_own_exec_is_allowed(tmp_path: Path) -> None:
    plant(tmp_path, "imugui/app.py", "import subprocess\napp.exec()\nsubprocess.run(['ls'], shell=False)")
    assert banned_problems(tmp_path) == []


def test_every_package_is_installed() -> None:
    """The list in pyproject is complete: a package that is missing there is missing from an installed program."""
    listed = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["setuptools"][
        "packages"
    ]
    found = {
        ".".join(path.parent.relative_to(REPOSITORY).parts) for path in (REPOSITORY / "imugui").rglob("__init__.py")
    }
    assert set(listed) == found | {"imugui.resources", "imugui.resources.icons"}

"""The starter's decisions: what to run, what to install, what to tell. Nothing is installed."""

from __future__ import annotations

import importlib
import stat
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
X11 = {"DISPLAY": ":0"}
WAYLAND = {"WAYLAND_DISPLAY": "wayland-0"}
DEMO = ("-P", "-m", "imugui", "demo")


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(REPOSITORY)
    return importlib.import_module("run")


# ---- what to run


@pytest.mark.parametrize(
    ("environ", "platform_name", "groups"),
    [
        (X11, "linux", ("x11",)),
        (WAYLAND, "linux", ("wayland",)),
        ({**X11, **WAYLAND}, "linux", ("wayland", "x11")),
        ({}, "linux", None),
        ({"DISPLAY": ""}, "linux", None),
        ({"QT_QPA_PLATFORM": "offscreen"}, "linux", ()),
        ({"QT_QPA_PLATFORM": "xcb"}, "linux", ("x11",)),
        ({"QT_QPA_PLATFORM": "wayland;xcb"}, "linux", ("wayland", "x11")),
        ({}, "win32", ()),
        ({}, "darwin", ()),
    ],
)
def test_the_display_decides_what_a_window_needs(
    run: ModuleType, environ: dict[str, str], platform_name: str, groups: tuple[str, ...] | None
) -> None:
    assert run.window_groups(environ, platform_name) == groups


def test_arguments_reach_the_program(run: ModuleType) -> None:
    plan = run.make_plan(["replay", "a file", "--filter", "vqf"], {}, "linux")
    assert plan.command == ("-P", "-m", "imugui", "replay", "a file", "--filter", "vqf")
    assert plan.extras == ()
    assert plan.notes == ()


@pytest.mark.parametrize("args", [[], ["--theme", "dark"]])
def test_without_a_display_the_demo_runs_and_says_why(run: ModuleType, args: list[str]) -> None:
    plan = run.make_plan(args, {}, "linux")
    assert plan.command == DEMO
    assert plan.environ == {"QT_QPA_PLATFORM": "offscreen"}
    assert "no display" in plan.notes[0]
    assert "x11" not in plan.groups


@pytest.mark.parametrize("args", [[], ["--theme", "dark"]])
def test_with_a_display_the_window_opens(run: ModuleType, args: list[str]) -> None:
    plan = run.make_plan(args, X11, "linux")
    assert plan.command == ("-P", "-m", "imugui", *args)
    assert plan.groups == ("core", "look", "x11")


@pytest.mark.parametrize("args", [["demo"], ["--help"], ["--version"], ["ports"]])
def test_what_needs_no_window_runs_as_asked_without_a_display(run: ModuleType, args: list[str]) -> None:
    assert run.make_plan(args, {}, "linux").command == ("-P", "-m", "imugui", *args)


def test_tests_run_in_the_projects_folder_with_their_extra(run: ModuleType) -> None:
    plan = run.make_plan(["test", "-q", "tests/test_ring.py"], {}, "linux")
    assert plan.command[:2] == ("-m", "pytest")
    assert plan.command[-2:] == ("-q", "tests/test_ring.py")
    assert plan.extras == ("test",)
    assert plan.in_root
    assert "test" in plan.groups


def test_benchmarks_are_listed_and_run_by_name(
    run: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "benchmarks").mkdir()
    for name in ("speed", "latency", "_shared", "figures"):
        (tmp_path / "benchmarks" / f"{name}.py").touch()
    monkeypatch.setattr(run, "ROOT", tmp_path)
    whole = run.make_plan(["bench"], {}, "linux")
    assert whole.command == (str(tmp_path / "benchmarks" / "figures.py"),)
    assert whole.extras == ("bench",)
    assert whole.notes[0].endswith("the benchmarks are: figures, latency, speed")
    command = run.make_plan(["bench", "speed", "--quick"], {}, "linux").command
    assert command == (str(tmp_path / "benchmarks" / "speed.py"), "--quick")
    assert run.make_plan(["bench", "speed"], {}, "linux").extras == ()
    with pytest.raises(run.Trouble, match="no benchmark 'accuracy'; the benchmarks are: figures, latency, speed"):
        run.make_plan(["bench", "accuracy"], {}, "linux")


# ---- what to install


def test_a_stamp_asks_for_nothing_until_something_changes(run: ModuleType, tmp_path: Path) -> None:
    stamp = run.new_stamp(b"[project]", "3.11", run.ROOT, ["test"])
    assert run.to_install(stamp, b"[project]", "3.11", ["test"]) is None
    assert run.to_install(stamp, b"[project]", "3.11", []) is None
    assert run.to_install(stamp, b"[project] ", "3.11", []) == ("test",)
    assert run.to_install(stamp, b"[project]", "3.12", []) == ("test",)
    moved = run.new_stamp(b"[project]", "3.11", tmp_path, ["test"])
    assert run.to_install(moved, b"[project]", "3.11", []) == ("test",)


def test_an_extra_is_added_to_those_installed(run: ModuleType) -> None:
    bare = run.new_stamp(b"[project]", "3.11", run.ROOT, [])
    assert run.to_install(bare, b"[project]", "3.11", []) is None
    assert run.to_install(bare, b"[project]", "3.11", ["test"]) == ("test",)
    tested = run.new_stamp(b"[project]", "3.11", run.ROOT, ["test"])
    assert run.to_install(tested, b"[project]", "3.11", ["bench"]) == ("bench", "test")
    assert run.to_install("", b"[project]", "3.11", []) == ()


@pytest.mark.parametrize(
    ("config", "python_is_there", "stamp", "said"),
    [
        ("version = 3.11.7\n", True, "0123 test", ""),
        ("version = 3.11.7\n", True, "", ""),
        ("home = /usr/bin\nversion_info = 3.11.2.final.0\n", True, "0123 ", ""),
        ("version = 3.12.1\n", True, "0123 ", "made by Python 3.12, this is 3.11"),
        ("version = 3.11.7\n", True, "unfinished", "not finished"),
        ("version = 3.11.7\n", False, "0123 ", "broken"),
        ("", True, "0123 ", "broken"),
    ],
)
def test_an_environment_that_cannot_be_used_is_recognised(
    run: ModuleType, config: str, python_is_there: bool, stamp: str, said: str
) -> None:
    words = run.fault(config, python_is_there, stamp, "3.11")
    assert said in words
    assert bool(said) == bool(words)


@pytest.mark.parametrize(
    ("output", "cause"),
    [
        ("WARNING: Retrying ... [Errno -3] Temporary failure in name resolution\nERROR: No matching dist", "cannot be"),
        ("ERROR: Could not install packages due to an OSError: [Errno 28] No space left on device", "disk is full"),
        ("HTTPSConnectionPool(): Max retries exceeded (SSLError('[SSL: CERTIFICATE_VERIFY_FAILED]'))", "not trusted"),
        ("[Errno 13] Permission denied: '/opt/imugui/.venv'", "cannot be written"),
        ("/x/.venv/bin/python: No module named pip", "no pip"),
        ("ERROR: No matching distribution found for PySide6-Essentials>=6.10", "no package fits"),
        ("ResolutionImpossible: see topics/dependency-resolution/\nsomething unheard of", "something unheard of"),
    ],
)
def test_a_failed_step_names_its_cause(run: ModuleType, output: str, cause: str) -> None:
    assert cause in run.explain(output)


def test_a_failed_step_is_trouble_with_its_cause(run: ModuleType) -> None:
    with pytest.raises(run.Trouble, match="installing failed: the disk is full; free about 1 GB"):
        run.run_step([sys.executable, "-c", "import sys; sys.exit('No space left on device')"], "installing")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "Downloading pyside6_essentials-6.11.3-cp310-abi3-manylinux_2_34_x86_64.whl (95.2 MB)\n",
            "run.py:   pyside6_essentials (95.2 MB)\n",
        ),
        ("  Using cached numpy-2.3.5-cp311-cp311-linux_x86_64.whl (16.9 MB)\n", "run.py:   numpy (16.9 MB)\n"),
        ("  Downloading numpy-2.3.5-cp311.whl.metadata (62 kB)\n", ""),
        ("Installing collected packages: numpy\n", ""),
    ],
)
def test_large_downloads_are_shown(run: ModuleType, capsys: pytest.CaptureFixture[str], line: str, said: str) -> None:
    run.progress(line)
    assert capsys.readouterr().err == said


def test_the_pythons_are_those_of_pyproject(run: ModuleType) -> None:
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    newest = f"{run.NEWEST[0]}.{run.NEWEST[1] + 1}"
    assert project["requires-python"] == f">={run.OLDEST[0]}.{run.OLDEST[1]},<{newest}"
    assert set(run.plan_test([], {}, "linux").extras) <= set(project["optional-dependencies"])
    run.check_python(run.OLDEST)
    run.check_python(run.NEWEST)


@pytest.mark.parametrize("version", [(3, 10), (2, 7), (3, 14), (4, 0)])
def test_another_python_is_refused_in_words(run: ModuleType, version: tuple[int, int]) -> None:
    with pytest.raises(run.Trouble, match=rf"needs Python 3\.11, 3\.12 or 3\.13; this is {version[0]}\.{version[1]}"):
        run.check_python(version)


# ---- the file CI starts


@pytest.mark.skipif(sys.platform == "win32", reason="CI's script is for bash")
def test_ci_runs_the_tests_through_run_py(tmp_path: Path) -> None:
    script = REPOSITORY / ".ci" / "run"
    assert script.stat().st_mode & stat.S_IXUSR
    (tmp_path / ".ci").mkdir()
    (tmp_path / ".ci" / "run").write_text(script.read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "run.py").write_text("import sys\nprint(sys.argv)\nsys.exit(7)\n", encoding="utf-8")
    done = subprocess.run(["bash", str(tmp_path / ".ci" / "run")], capture_output=True, text=True, timeout=60)
    assert done.stdout == "['run.py', 'test']\n"
    assert done.returncode == 7

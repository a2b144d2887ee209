"""Make imugui's environment beside this file, then start the window, the tests or a benchmark in it.

python3 run.py [arguments of imugui]    python3 run.py test [arguments of pytest]    python3 run.py bench [NAME]
Standard library only. Nothing outside this folder changes, but for Qt's system libraries when root on Debian or Ubuntu.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from subprocess import PIPE, STDOUT, Popen
from typing import NamedTuple

from run_system import check_system

ROOT = Path(__file__).resolve().parent
VENV = ROOT / ".venv"
PYTHON = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
STAMP = VENV / "imugui-installed.txt"  # what was installed, or UNFINISHED
UNFINISHED = "unfinished"
OLDEST, NEWEST = (3, 11), (3, 13)
ALL_BENCHMARKS = "figures"
WITH_PEERS = (ALL_BENCHMARKS, "accuracy")  # benchmarks that compare with other libraries
SIDE_BY_SIDE = ("-n", "2", "--dist", "worksteal")  # tests wait more than they compute; -n 0 after it: one by one
HEADLESS = ("core", "look")  # groups of run_system.NEEDS that every run on Linux needs

# Words in what venv and pip print -> cause, next step; the first that fits is told.
CAUSES = (
    ("No space left|not enough space", "the disk is full", "free about 1 GB, then run this again"),
    ("CERTIFICATE_VERIFY_FAILED", "the network's certificate is not trusted", "set PIP_CERT to the file that holds it"),
    (
        "name resolution|service not known|getaddrinfo|new connection|Connection|unreachable|timed out|ProxyError",
        "the package index cannot be reached",
        "check the network (behind a proxy set HTTPS_PROXY), then run this again",
    ),
    ("Permission denied|Access is denied", "a file cannot be written", f"see that {ROOT} is yours"),
    ("No module named pip|ensurepip", "there is no pip for this Python", "install Python's venv and pip packages"),
    ("No matching distribution", "no package fits", "check the network and that this Python is a 64-bit one"),
)


class Plan(NamedTuple):
    """What one call does, decided before anything is done."""

    command: tuple[str, ...]  # for the environment's Python; () when the notes are all
    groups: tuple[str, ...] = HEADLESS
    extras: tuple[str, ...] = ()
    environ: Mapping[str, str] = {}
    notes: tuple[str, ...] = ()
    in_root: bool = False


class Trouble(Exception):  # noqa: N818 (it is not an error of the program)
    """What the user has to put right: what happened, why, what to do next."""


def say(text: str) -> None:
    """Tell the user one line; standard output stays the program's."""
    print(f"run.py: {text}", file=sys.stderr, flush=True)


def window_groups(environ: Mapping[str, str], platform_name: str) -> tuple[str, ...] | None:
    """The groups of NEEDS of which a window needs one; None where there is no display."""
    if platform_name != "linux":
        return ()
    chosen = environ.get("QT_QPA_PLATFORM", "")
    if chosen:
        return tuple(group for word, group in (("wayland", "wayland"), ("xcb", "x11")) if word in chosen)
    names = (("WAYLAND_DISPLAY", "wayland"), ("DISPLAY", "x11"))
    return tuple(group for name, group in names if environ.get(name)) or None


def plan_app(args: Sequence[str], environ: Mapping[str, str], platform_name: str) -> Plan:
    """The program itself; the demo where a window is asked for and there is no display."""
    # -P: a folder called imugui in the user's current directory must not hide the installed package
    command = ("-P", "-m", "imugui", *args)
    if args and (not args[0].startswith("-") or args[0] in ("-h", "--help", "--version")):
        return Plan(command)
    groups = window_groups(environ, platform_name)
    if groups is not None:
        return Plan(command, (*HEADLESS, *groups))
    notes = (
        "there is no display here (neither DISPLAY nor WAYLAND_DISPLAY is set), so no window can open",
        "the demo runs instead: a virtual board is read, fused and painted off screen; it ends by itself",
    )
    return Plan(("-P", "-m", "imugui", "demo"), environ={"QT_QPA_PLATFORM": "offscreen"}, notes=notes)


def plan_test(args: Sequence[str], environ: Mapping[str, str], platform_name: str) -> Plan:
    """The tests, with pytest's arguments, in the project's folder."""
    return Plan(("-m", "pytest", *SIDE_BY_SIDE, *args), (*HEADLESS, "test"), ("test",), in_root=True)


def plan_bench(args: Sequence[str], environ: Mapping[str, str], platform_name: str) -> Plan:
    """One benchmark, with the rest of the arguments; without any, all of them but the long ones."""
    names = sorted(path.stem for path in (ROOT / "benchmarks").glob("[!_]*.py"))
    listing = f"the benchmarks are: {', '.join(names) or 'none yet'}"
    name, *rest = args or (ALL_BENCHMARKS,)
    if name not in names:
        raise Trouble(f"there is no benchmark {name!r}; {listing}")
    notes = () if args else (f"all but the long ones, for docs/figures.md; {listing}",)
    extras = ("bench",) if name in WITH_PEERS else ()
    return Plan((str(ROOT / "benchmarks" / f"{name}.py"), *rest), extras=extras, notes=notes)


PLANS: dict[str, Callable[..., Plan]] = {"test": plan_test, "bench": plan_bench}


def make_plan(args: Sequence[str], environ: Mapping[str, str], platform_name: str) -> Plan:
    """What ``run.py args`` does on ``platform_name`` (as sys.platform)."""
    if args and args[0] in PLANS:
        return PLANS[args[0]](args[1:], environ, platform_name)
    return plan_app(args, environ, platform_name)


def fault(config: str, python_is_there: bool, stamp: str, version: str) -> str:
    """Why an environment with this pyvenv.cfg and stamp must be made anew, in words; empty when it is sound."""
    made_by = re.search(r"^version(?:_info)?\s*=\s*(\d+\.\d+)", config, re.MULTILINE)
    if not made_by or not python_is_there:
        return "the old one is broken"
    if made_by[1] != version:
        return f"the old one was made by Python {made_by[1]}, this is {version}"
    return "the old one was not finished" if stamp.startswith(UNFINISHED) else ""


def new_stamp(pyproject: bytes, version: str, root: Path, extras: Iterable[str]) -> str:
    """The text that says what is installed: a digest of what decides it, and the extras."""
    digest = hashlib.sha256(b"\0".join((pyproject, version.encode(), os.fsencode(root)))).hexdigest()
    return f"{digest} {' '.join(sorted(extras))}"


def to_install(stamp: str, pyproject: bytes, version: str, extras: Iterable[str]) -> tuple[str, ...] | None:
    """The extras to install with the project, those of ``stamp`` included; None when all is there."""
    have = set(stamp.split()[1:])
    if have.issuperset(extras) and stamp == new_stamp(pyproject, version, ROOT, have):
        return None
    return tuple(sorted(have.union(extras)))


def explain(output: str) -> str:
    """The cause, the next step and the line that shows it, for what venv or pip printed."""
    lines = [line.strip() for line in output.splitlines()]
    for words, cause, step in CAUSES:
        for line in lines:
            if re.search(words, line):
                return f"{cause}; {step} ({line[:160]})"
    return "\n  ".join(("it said last:", *lines[-12:]))


def progress(line: str) -> None:
    """Say what a line of pip's output tells a person: a large package is on its way."""
    shown = re.match(r"\s*(?:Downloading|Using cached) (?:\S+/)?([^-\s]+)-\S+ (\(.* MB\))", line)
    if shown:
        say(f"  {shown[1]} {shown[2]}")


def run_step(command: Sequence[str], what: str) -> None:
    """Run a step of the installation in the project's folder; Trouble with its cause when it fails."""
    lines: list[str] = []
    with Popen(command, cwd=ROOT, stdout=PIPE, stderr=STDOUT, text=True, errors="replace") as process:
        try:
            for line in process.stdout or ():
                lines.append(line)
                progress(line)
        except KeyboardInterrupt:
            process.terminate()
            raise
    if process.returncode:
        full = shutil.disk_usage(ROOT).free < 100e6  # venv and pip do not always say so
        raise Trouble(f"{what} failed: {explain('No space left' if full else ''.join(lines))}")


def text_of(path: Path) -> str:
    """A text file's content; empty when there is none."""
    return path.read_text(encoding="utf-8", errors="replace") if path.is_file() else ""


def prepare(extras: Sequence[str]) -> None:
    """Make the environment if it is not sound, and install what is not installed yet."""
    version = f"{sys.version_info[0]}.{sys.version_info[1]}"
    wrong = fault(text_of(VENV / "pyvenv.cfg"), PYTHON.exists(), text_of(STAMP), version)
    if wrong:
        say(f"making .venv{' anew: ' + wrong if VENV.exists() else ''}")
        shutil.rmtree(VENV, ignore_errors=True)
        VENV.mkdir(exist_ok=True)
        STAMP.write_text(UNFINISHED, encoding="utf-8")
        run_step([sys.executable, "-m", "venv", str(VENV)], "making .venv")
    pyproject = (ROOT / "pyproject.toml").read_bytes()
    wanted = to_install(text_of(STAMP), pyproject, version, extras)
    if wanted is None:
        say("nothing to install")
        return
    say("installing (the first time takes about a minute)" if wrong else "installing what is new")
    pip = [str(PYTHON), "-m", "pip", "--no-input", "--disable-pip-version-check"]
    run_step([*pip, "install", "-e", f".[{','.join(wanted)}]" if wanted else "."], "installing")
    STAMP.write_text(new_stamp(pyproject, version, ROOT, wanted), encoding="utf-8")


def start(plan: Plan) -> int:
    """Run the plan's command in the environment; its exit status."""
    if plan.in_root:
        os.chdir(ROOT)
    command, environ = [str(PYTHON), *plan.command], {**os.environ, **plan.environ}
    if os.name != "nt":
        os.execve(command[0], command, environ)  # noqa: S606 (no shell is wanted)
    child = Popen(command, env=environ)
    while True:
        try:
            return child.wait()
        except KeyboardInterrupt:  # the child got the same Ctrl-C and ends by itself
            continue


def check_python(version: tuple[int, int]) -> None:
    """Trouble on a Python that cannot run imugui; this file therefore reads on Python 3.7 too."""
    if not OLDEST <= version <= NEWEST:
        this = f"this is {version[0]}.{version[1]} ({sys.executable})"
        raise Trouble(f"imugui needs Python 3.11, 3.12 or 3.13; {this}: get one and start with it: python3.12 run.py")


def get_ready(plan: Plan) -> None:
    """See to what the plan needs of the system and of the environment."""
    if sys.platform == "linux" and not check_system(plan.groups, say):
        raise Trouble("Qt cannot start without these: get them, then run this again")
    prepare(plan.extras)


def main(args: Sequence[str]) -> int:
    """Do what ``run.py args`` asks for; 2 when the user has to put something right first."""
    try:
        check_python(sys.version_info[:2])
        plan = make_plan(args, os.environ, sys.platform)
        if plan.command:
            get_ready(plan)
        for note in plan.notes:
            say(note)
        return start(plan) if plan.command else 0
    except (Trouble, OSError) as problem:
        say(str(problem) if isinstance(problem, Trouble) else explain(str(problem)))
        return 2
    except KeyboardInterrupt:
        say("stopped")
        return 130


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""The command line: what opens with the window, and the names of the commands that need none."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from imugui import __version__
from imugui.simulation import MOTION_TITLES

OK, FAILED, REFUSED = 0, 2, 3
NOTE = "A research tool, not a medical device."

COMMANDS = {
    "demo": "the virtual board through a real port, the fusion and every page, without a screen",
    "ports": "list serial ports and Bluetooth boards, one line each",
    "simulate": "a virtual board on a pseudo-terminal or on Bluetooth, until stopped",
    "live": "read a board, fuse, and report",
    "verify": "compute a recording again from its raw bytes and compare",
    "calibrate": "find what is wrong with a board's sensors, from recordings",
    "study": "the targeting game as a study: simulated people play it, or its report is written",
    "replay": "fuse a file as fast as it goes, and write the attitude",
}
"""What each does; how is in commands.TASKS."""


class Command(argparse.ArgumentParser):
    """The parser of one command. It learns its arguments when it is used: the window need not wait for them."""

    name = ""  # a key of COMMANDS, until its arguments are known

    def parse_known_args(self, *args: Any, **named: Any) -> Any:
        """Parse, as the base class does."""
        name, self.name = self.name, ""
        if name:
            from imugui.commands import TASKS  # start-up time

            add, run = TASKS[name]
            add(self)
            self.set_defaults(run=run)
        return super().parse_known_args(*args, **named)


def parser() -> argparse.ArgumentParser:
    """The whole command line."""
    top = argparse.ArgumentParser(prog="imugui", description=f"imugui opens its window. {NOTE}")
    top.add_argument("--version", action="version", version=f"imugui {__version__}")
    top.add_argument("--port", help="connect to this serial port at once")
    top.add_argument("--ble", metavar="NAME", help="connect to this Bluetooth board at once, by its name or address")
    top.add_argument("--recording", help="open this file at once")
    top.add_argument("--simulate", choices=list(MOTION_TITLES), help="start the simulated board at once")
    top.set_defaults(command=None)
    commands = top.add_subparsers(dest="command", title="commands that need no window", parser_class=Command)
    for name, text in COMMANDS.items():
        commands.add_parser(name, help=text, description=text).name = name
    return top


def fail(text: str) -> int:
    """One line that names the cause, and the exit status for it."""
    print(f"imugui: {' '.join(text.split())}", file=sys.stderr)
    return FAILED


def write_report(path: Path, report: dict[str, Any]) -> None:
    """Write a report as JSON; raises OSError."""
    path.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")

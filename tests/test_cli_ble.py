"""The commands on Bluetooth boards, in processes of their own: the emulation in one, the program in another."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from imugui.simulation.ble import missing

NO_BUS = {**os.environ, "DBUS_SYSTEM_BUS_ADDRESS": "unix:path=/nowhere/bus"}


def run(*arguments: object, env: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "imugui", *map(str, arguments)]
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=60.0, check=False)


@pytest.fixture(scope="module")
def reach() -> Iterator[dict[str, str]]:
    """The environment in which the board of ``imugui simulate --ble`` is reached."""
    if lacking := missing():
        pytest.skip(lacking)
    command = [sys.executable, "-m", "imugui", "simulate", "--format", "motion-card", "--ble"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as board:
        assert board.stdout is not None
        assert "CONTROL.CMR (F0:" in board.stdout.readline()
        name, _, address = board.stdout.readline().partition(" ")[0].partition("=")
        yield {**os.environ, name: address}
        board.send_signal(signal.SIGTERM)
        assert board.communicate(timeout=20.0)[1] == ""
    assert board.returncode == 0


def test_boards_are_listed(reach: dict[str, str]) -> None:
    done = run("ports", "--seconds", "0.6", env=reach)
    assert done.returncode == 0
    assert "CONTROL.CMR\tMotion card, -50 dBm" in done.stdout
    assert "Bluetooth" not in done.stderr


def test_live_reads_the_card_and_its_recording_verifies(reach: dict[str, str], tmp_path: Path) -> None:
    report, folder = tmp_path / "report.json", tmp_path / "card.imugui"
    ending = ("--seconds", "1.3", "--report", report, "--record", folder)
    done = run("live", "--ble", "f0:f1:f2:f3:00:01", *ending, env=reach)
    assert (done.returncode, done.stderr) == (0, "")
    figures = json.loads(report.read_text())
    assert (figures["format"], figures["bad_messages"], figures["gaps"]) == ("motion-card", 0, 0)
    assert figures["samples"] > 20
    assert figures["state"] == "streaming"
    verified = run("verify", folder, env=reach)
    assert verified.returncode == 0
    assert "largest difference 0 deg" in verified.stdout


def test_without_bluetooth_the_listing_says_so_and_succeeds() -> None:
    done = run("ports", env=NO_BUS)
    assert done.returncode == 0
    assert "No Bluetooth boards are listed." in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("live", "--ble", "CARD", "--seconds", "0.3"), "imugui: Bluetooth cannot be reached"),
        (("simulate", "--format", "motion-card"), "add --ble"),
        (("simulate", "--format", "triplets", "--ble"), "not spoken over Bluetooth. There are motion-card"),
    ],
)
def test_what_cannot_be_is_said(arguments: tuple[str, ...], words: str) -> None:
    done = run(*arguments, env=NO_BUS)
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr


def test_what_the_emulation_lacks_is_said() -> None:
    done = run("simulate", "--format", "motion-card", "--ble", env={**os.environ, "PATH": ""})
    assert done.returncode == 2
    assert "dbus-daemon" in done.stderr

"""The commands on Bluetooth boards, in processes of their own: the emulation in one, the program in another."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from imugui.recording import UnreadableError, read_recording
from imugui.simulation.ble import missing

NO_BUS = {**os.environ, "DBUS_SYSTEM_BUS_ADDRESS": "unix:path=/nowhere/bus"}


def run(*arguments: object, env: dict[str, str]) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "imugui", *map(str, arguments)]
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=120.0, check=False)


@contextmanager
def started(*arguments: object, env: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    command = [sys.executable, "-m", "imugui", *map(str, arguments)]
    with subprocess.Popen(command, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            yield process
        finally:
            process.kill()  # where the test failed; otherwise it has ended


def recorded(folder: Path) -> int:
    """How many samples a recording has that may have just begun."""
    try:
        return len(read_recording(folder).samples)
    except UnreadableError:
        return 0


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
        assert board.communicate(timeout=60.0)[1] == ""
    assert board.returncode == 0


def test_boards_are_listed(reach: dict[str, str]) -> None:
    done = run("ports", "--seconds", "1.5", env=reach)
    assert done.returncode == 0
    assert "CONTROL.CMR\tMotion card, -50 dBm" in done.stdout
    assert "Bluetooth" not in done.stderr


def test_live_reads_the_card_and_its_recording_verifies(reach: dict[str, str], tmp_path: Path) -> None:
    report, folder = tmp_path / "report.json", tmp_path / "card.imugui"
    arguments = ("live", "--ble", "f0:f1:f2:f3:00:01", "--report", report, "--record", folder)
    with started(*arguments, env=reach) as live:
        end = time.monotonic() + 60.0
        while recorded(folder) <= 20:
            assert time.monotonic() < end, "nothing is recorded"
            assert live.poll() is None
            time.sleep(0.05)
        live.send_signal(signal.SIGINT)
        assert live.communicate(timeout=60.0)[1] == ""
    assert live.returncode == 0
    figures = json.loads(report.read_text())
    assert (figures["format"], figures["bad_messages"]) == ("motion-card", 0)
    assert figures["gaps"] <= np.count_nonzero(np.diff(read_recording(folder).samples["t"]) > 0.025)
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


def test_live_without_bluetooth_says_so() -> None:
    with started("live", "--ble", "CARD", "--seconds", "120", env=NO_BUS) as live:
        assert live.stderr is not None
        assert "Bluetooth cannot be reached" in live.stderr.readline()
        live.send_signal(signal.SIGINT)
        told = live.communicate(timeout=60.0)[1]
    assert live.returncode == 2
    assert told.startswith("imugui: Bluetooth cannot be reached")
    assert "Traceback" not in told


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
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

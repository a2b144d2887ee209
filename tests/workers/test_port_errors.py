"""Errors of ports and files become sentences with a cause and a next step."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import pytest
from serial import SerialException, serial_for_url

from imugui.workers.port_errors import PORT_ERRORS, explain, explain_file

POSIX = pytest.mark.skipif(sys.platform == "win32", reason="errors of POSIX systems")


@POSIX
@pytest.mark.parametrize(
    ("number", "kind", "words"),
    [
        (errno.ENOENT, "missing", "Plug it in"),
        (errno.EACCES, "denied", ""),
        (errno.EBUSY, "busy", "another program"),
        (errno.EAGAIN, "busy", "another program"),
        (errno.EIO, "gone", "carries on"),
    ],
)
def test_system_errors(number: int, kind: str, words: str) -> None:
    problem = explain(SerialException(number, os.strerror(number)), "/dev/ttyX", opening=True)
    assert problem.kind == kind
    assert words in problem.sentence
    assert "/dev/ttyX" in problem.sentence


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="the group of Linux")
def test_no_permission_says_the_command() -> None:
    problem = explain(PermissionError(errno.EACCES, "x"), "/dev/ttyX", opening=True)
    assert "sudo usermod -aG dialout" in problem.sentence


@POSIX
def test_a_real_missing_port_and_a_foolish_address() -> None:
    for address, kind in (("/dev/there-is-no-such-port", "missing"), ("nonsense://x", "address")):
        with pytest.raises(PORT_ERRORS) as caught:
            serial_for_url(address)
        assert explain(caught.value, address, opening=True).kind == kind


@POSIX
def test_an_unplugged_pty_is_gone() -> None:
    master, slave = os.openpty()
    name = os.ttyname(slave)
    with serial_for_url(name, timeout=1.0) as port:
        os.close(slave)
        os.close(master)
        with pytest.raises(PORT_ERRORS) as caught:
            port.read(port.in_waiting or 1)
    assert explain(caught.value, name, opening=False).kind == "gone"


def test_windows_numbers_not_translated_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "win32")
    text = "could not open port 'COM3': PermissionError(13, 'Zugriff verweigert', None, 5)"
    assert explain(SerialException(text), "COM3", opening=True).kind == "busy"
    text = "could not open port 'COM9': FileNotFoundError(2, 'Datei nicht gefunden', None, 2)"
    assert explain(SerialException(text), "COM9", opening=True).kind == "missing"
    text = "ClearCommError failed (PermissionError(13, 'Das Gerät kennt den Befehl nicht', None, 22))"
    assert explain(SerialException(text), "COM9", opening=False).kind == "gone"


def test_files(tmp_path: Path) -> None:
    missing = tmp_path / "none.csv"
    with pytest.raises(OSError, match="none") as caught:
        missing.open()
    assert "No such file" in explain_file(caught.value, str(missing)).sentence
    assert explain_file(ValueError("no sample found"), "x").sentence == "no sample found"

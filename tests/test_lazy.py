"""Tables whose entries are imported when they are asked for; and what the window needs none of to start."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from imugui.lazy import Lazy

START = """
import os, sys
from PySide6.QtCore import QTimer
from imugui import app, cli
show = app.MainWindow.show
def shown(window):
    show(window)
    QTimer.singleShot(0, window, lambda: (print(*sys.modules, flush=True), os._exit(0)))
app.MainWindow.show = shown
app.run_window(cli.parser().parse_args([]))
"""
NOT_NEEDED = (
    "asyncio",
    "bleak",
    "pyqtgraph",
    "imugui.calibration.alarm",
    "imugui.calibration.rest",
    "imugui.commands",
    "imugui.demo",
    "imugui.fusion.imugui_filter",
    "imugui.fusion.madgwick",
    "imugui.guidance",
    "imugui.recording.folder",
    "imugui.simulation.motions",
    "imugui.targeting",
    "imugui.views.form",
    "imugui.views.guide_view",
    "imugui.workers.ble_loop",
    "imugui.workers.reader",
)


def test_the_window_starts_without_what_it_does_not_show(tmp_path: Path) -> None:
    homes = dict.fromkeys(("XDG_DATA_HOME", "XDG_CONFIG_HOME", "APPDATA", "LOCALAPPDATA", "HOME"), str(tmp_path))
    environ = {**os.environ, **homes, "QT_QPA_PLATFORM": "offscreen"}
    done = subprocess.run([sys.executable, "-c", START], env=environ, capture_output=True, text=True, timeout=60)
    loaded = set(done.stdout.split())
    assert "imugui.views.live_view" in loaded, done.stderr
    assert loaded & set(NOT_NEEDED) == set()


def test_an_entry_is_imported_when_it_is_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "late_part.py").write_text("VALUE = 5", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    table: Lazy[int] = Lazy({"one": "late_part:VALUE", "two": "no_such_part:VALUE"})
    assert (list(table), len(table), "two" in table, "three" in table) == (["one", "two"], 2, True, False)
    assert "late_part" not in sys.modules
    assert table["one"] == 5
    assert "late_part" in sys.modules
    monkeypatch.delitem(sys.modules, "late_part")


def test_an_unknown_name_is_a_key_error() -> None:
    table: Lazy[object] = Lazy({"path": "pathlib:Path"})
    assert table.get("file") is None
    with pytest.raises(KeyError, match="file"):
        table["file"]

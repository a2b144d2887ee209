"""Cold start to the first painted frame, against a bare QMainWindow with one pyqtgraph plot; each in a fresh process.

python3 run.py bench start [--rounds 9]

Python has compiled all modules of both, as it has from the second start on: in a folder of the benchmark's own, so
that neither PYTHONDONTWRITEBYTECODE nor bytecode that is lying about gives one of the two a start.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time

from _measure import children_s, line

WANTED = 1.3

PAINTED = """
import os
from PySide6.QtCore import QEvent, QObject, QTimer
class FirstPaint(QObject):
    def __init__(self, widget):
        super().__init__(widget)
        self.painted = False
        widget.installEventFilter(self)
    def eventFilter(self, watched, event):
        if event.type() == QEvent.Type.Paint and not self.painted:
            self.painted = True
            QTimer.singleShot(0, lambda: (print("painted", flush=True), os._exit(0)))
        return False
"""
BARE = (
    PAINTED
    + """
from PySide6.QtWidgets import QApplication, QMainWindow
import pyqtgraph
app = QApplication([])
window = QMainWindow()
plot = pyqtgraph.PlotWidget()
plot.plot([1.0, 3.0, 2.0])
window.setCentralWidget(plot)
window.resize(1280, 800)
watch = FirstPaint(plot.viewport())
window.show()
app.exec()
"""
)
OURS = (
    PAINTED
    + """
from imugui import app as composition
from imugui.__main__ import cli
arguments = cli.parser().parse_args([])
real = composition.MainWindow.show
def show(window):
    global watch
    watch = FirstPaint(window.page())
    real(window)
composition.MainWindow.show = show
composition.run_window(arguments)
"""
)


def start_s(code: str, folder: str) -> tuple[float, float]:
    """Seconds from starting the interpreter until it has painted and ended: by the clock, and of the processor."""
    environ = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "XDG_DATA_HOME": folder, "XDG_CONFIG_HOME": folder}
    environ |= {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": folder}
    begin, used = time.perf_counter(), children_s()
    command = [sys.executable, "-c", code]
    said = subprocess.run(command, env=environ, capture_output=True, text=True, timeout=60, check=False).stdout
    taken = time.perf_counter() - begin
    if said != "painted\n":
        raise RuntimeError("nothing was painted")
    return taken, children_s() - used


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--rounds", type=int, default=9)
    rounds = arguments.parse_args().rounds
    taken: dict[str, list[tuple[float, float]]] = {"bare": [], "ours": []}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds + 1):
            taken["bare"].append(start_s(BARE, folder))
            taken["ours"].append(start_s(OURS, folder))
    for case, which in (("by the clock", 0), ("processor time", 1)):
        # the first start compiles, and fills the disk's cache
        bare, ours = (statistics.median(pair[which] for pair in pairs[1:]) for pairs in taken.values())
        line("start", f"first frame, {case}", ours / bare, WANTED, False, bare_s=round(bare, 3), s=round(ours, 3))
    return 0


if __name__ == "__main__":
    sys.exit(main())

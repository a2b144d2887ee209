"""The composition root: arguments -> settings -> session -> window."""

from __future__ import annotations

import argparse
import gc
import logging
import logging.handlers
import sys
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Slot
from PySide6.QtGui import QGuiApplication, QIcon
from PySide6.QtWidgets import QApplication

from imugui import paths, settings
from imugui.calibration.profile_store import ProfileStore
from imugui.crash import CrashReport
from imugui.fields import from_mapping
from imugui.fusion import DEFAULT_FILTER, FILTERS
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.session import Session, Source

SWITCH_S = 0.0002
"""How soon a painting window hands the interpreter to the reader and fusion threads, s."""

COLLECT_MS = 500


def run_window(arguments: argparse.Namespace) -> int:
    """Open the window and stay until it is closed."""
    app = make_application()
    folder = paths.user_folder()
    store = SettingsStore(folder / settings.FILE_NAME)
    log = start_log(folder)
    session = make_session(store)
    window = MainWindow(session, store)
    crash = CrashReport(log, window.show_message)
    crash.install()
    window.show()
    source = wanted_source(arguments)
    if source is not None and source.transport == "replay":
        window.bar.connect_to("replay", source.address)
    elif source is not None:
        session.connect_to(source)
    try:
        return app.exec()
    finally:
        session.close()
        crash.remove()


def make_application() -> QApplication:
    """The one QApplication, named and with its icon."""
    sys.setswitchinterval(SWITCH_S)
    app = QApplication.instance() or QApplication(sys.argv[:1])
    assert isinstance(app, QApplication)  # noqa: S101
    app.setApplicationName("imugui")
    app.setApplicationDisplayName("imugui")
    QGuiApplication.setDesktopFileName("imugui")
    Collector(app)
    app.setWindowIcon(QIcon(str(paths.resources() / "icons" / "imugui.svg")))
    return app


class Collector(QObject):
    """Collects garbage in the main thread only: Qt widgets must not be freed by a reader or fusion thread."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        gc.disable()
        self._timer = QTimer(self)
        self._timer.timeout.connect(self.collect)
        self._timer.start(COLLECT_MS)

    @Slot()
    def collect(self) -> None:
        """Collect the youngest generations that are full, as the interpreter itself would."""
        counts, limits = gc.get_count(), gc.get_threshold()
        due = [generation for generation in range(3) if counts[generation] > limits[generation]]
        if due:
            gc.collect(due[-1])


def make_session(store: SettingsStore) -> Session:
    """A session with the filter and parameters that were used last."""
    kept = store.store.settings
    name = kept.filter if kept.filter in FILTERS else DEFAULT_FILTER
    params, _ = from_mapping(FILTERS[name].Params, store.store.filters.get(name, {}))
    session = Session(name, params, kept.use_mag, ProfileStore(paths.user_folder() / "profiles"))
    session.set_spike_mask(kept.spike_mask)
    return session


def wanted_source(arguments: argparse.Namespace) -> Source | None:
    """What the command line asks to open at once."""
    places = {"serial": arguments.port, "ble": arguments.ble, "replay": arguments.recording}
    places["simulator"] = arguments.simulate
    return next((Source(kind, place) for kind, place in places.items() if place), None)


def start_log(folder: Path) -> Path | None:
    """Log to a file of the user's; None, and no log, where that cannot be written."""
    path = folder / "imugui.log"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handler = logging.handlers.RotatingFileHandler(path, maxBytes=1_000_000, backupCount=2, encoding="utf-8")
    except OSError:
        return None
    handler.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(name)s: %(message)s"))
    logging.getLogger().addHandler(handler)
    return path

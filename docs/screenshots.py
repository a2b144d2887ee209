"""Make the pictures of README and docs again: .venv/bin/python docs/screenshots.py

Offscreen, on the virtual board with a seed, so that the pictures differ only when the program does.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

os.environ["QT_QPA_PLATFORM"] = "offscreen"

from imugui import app as composition
from imugui.settings import FILE_NAME
from imugui.views.main_window import MainWindow
from imugui.views.settings_store import SettingsStore
from imugui.workers.headless import spin
from imugui.workers.session import Session, Source

DOCS = Path(__file__).resolve().parent
SAMPLES = 1400  # seven seconds: the tool is on its way to a target


def picture(theme: str, path: Path) -> None:
    """One picture of the Live page."""
    application = composition.make_application()
    with tempfile.TemporaryDirectory() as folder:
        store = SettingsStore(Path(folder) / FILE_NAME)
        store.update(theme=theme)
        session = Session()
        window = MainWindow(session, store)
        window.resize(1280, 800)
        window.show()
        session.connect_to(Source("simulator", "aiming", errors="mpu9250-calibrated"))
        spin(session, lambda status: status.samples >= SAMPLES)
        window.show_page("live")
        application.processEvents()
        if not window.grab().save(str(path)):
            raise OSError(f"{path} could not be written")
        window.close()


def main() -> int:
    picture("light", DOCS / "live.png")
    picture("dark", DOCS / "live-dark.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())

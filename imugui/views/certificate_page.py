"""CertificatePage: a document in the window, to be saved as HTML or opened in the browser."""

from __future__ import annotations

import tempfile
from pathlib import Path

from PySide6.QtCore import QByteArray, Qt, QUrl, Signal
from PySide6.QtGui import QDesktopServices, QImage, QPainter, QTextDocument
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QFileDialog, QHBoxLayout, QTextBrowser, QVBoxLayout, QWidget

from imugui.views.controls import Button
from imugui.views.labels import heading

_PICTURE = QUrl("picture:coverage")


def drawn(svg: str) -> QImage:
    """An SVG on white paper."""
    renderer = QSvgRenderer(QByteArray(svg.encode()))
    image = QImage(renderer.defaultSize(), QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    renderer.render(painter)
    painter.end()
    return image


class CertificatePage(QWidget):
    """Shows the certificate of a profile, or the comparison of two."""

    closed = Signal()
    said = Signal(str, str)

    def __init__(self) -> None:
        super().__init__()
        self._html = ""
        self._name = "certificate.html"
        self.title = heading("")
        self.text = QTextBrowser()
        self.text.setAccessibleName("Certificate")
        self.text.setOpenLinks(False)
        self.save = Button("Save as HTML…", "Write this page to a file that any browser shows")
        self.browse = Button("Open in the browser", "Show this page in the browser, to print it for example")
        self.back = Button("Back", "Back to the overview (Backspace)")
        self.save.clicked.connect(self._save)
        self.browse.clicked.connect(self._browse)
        self.back.clicked.connect(self.closed)
        head = QHBoxLayout()
        head.addWidget(self.title, 1)
        for button in (self.save, self.browse, self.back):
            head.addWidget(button)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 12)
        column.addLayout(head)
        column.addWidget(self.text, 1)

    def show_document(self, title: str, shown: str, html: str, name: str, svg: str = "") -> None:
        """Show rich text, with a picture at its foot; ``html`` is what is saved, under ``name``."""
        self.title.setText(title)
        self.text.clear()
        if svg:
            self.text.document().addResource(QTextDocument.ResourceType.ImageResource, _PICTURE, drawn(svg))
            shown += f'<h3>Coverage</h3><img src="{_PICTURE.toString()}">'
        self.text.setHtml(shown)
        self._html, self._name = html, name
        self.back.setFocus()

    def _save(self) -> None:
        name, _ = QFileDialog.getSaveFileName(self, "Save the certificate", self._name, "HTML (*.html)")
        if name:
            self._write(Path(name))

    def _browse(self) -> None:
        path = Path(tempfile.gettempdir()) / self._name
        if self._write(path):
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(path)))

    def _write(self, path: Path) -> bool:
        try:
            path.write_text(self._html, encoding="utf-8")
        except OSError as error:
            self.said.emit("error", f"The certificate cannot be written to {path}: {error.strerror}.")
            return False
        self.said.emit("info", f"The certificate is in {path}.")
        return True

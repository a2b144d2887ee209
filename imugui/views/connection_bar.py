"""The connection bar: where data come from, in which format, and the one verdict on the link."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import QFileDialog, QFrame, QHBoxLayout, QVBoxLayout

from imugui.formats import FORMATS
from imugui.views.ble_search import BleSearch
from imugui.views.boards import bare_lines, identity, keep_options, kept_options
from imugui.views.controls import Button, StillBox
from imugui.views.fusion_tools import FusionTools
from imugui.views.record_tools import RecordLine
from imugui.views.settings_store import SettingsStore
from imugui.views.source_box import SourceBox
from imugui.views.verdict_row import VerdictRow
from imugui.workers.session import Options, Port, Session, Source, State, Status

if TYPE_CHECKING:
    from imugui.views.file_columns import FileColumns

AUTO = "auto"
BAUDS = (9600, 19200, 38400, 57600, 115200, 230400, 250000, 460800, 500000, 921600, 1_000_000, 2_000_000)
FORMAT_TIP = "How the board writes its data; auto finds it within 6 s"
FORMAT_OF_SERVICE = "A Bluetooth board tells its format by its service"
UNCONNECTED = (State.IDLE, State.ENDED, State.FAILED)
FILE_KINDS = "Recordings (*.csv *.txt *.log *.bin);;All files (*)"


class ConnectionBar(QFrame):
    """Choosing and connecting; while connected, another choice takes effect at once."""

    columns_wanted = Signal()
    board_wanted = Signal()  # a second board beside this one
    assumed = Signal(str, str)  # tone and sentence: what is assumed of the columns of the file that is opened

    def __init__(self, session: Session, settings_store: SettingsStore, keeps: bool = True) -> None:
        """``keeps``: what is chosen here is remembered for the next time."""
        super().__init__()
        self._keeps = keeps
        self.setProperty("role", "bar")
        self.setAccessibleName("Connection")
        self._session = session
        self._settings_store = settings_store
        self._asking = False  # a person is asked for the columns before the file is opened
        self.search = BleSearch(session, self)
        self.source = SourceBox(self.search)
        self.format = _format_box()
        self.baud = _baud_box()
        self.button = Button("Connect", "Start or stop the connection", "toggle_connection", "connect", role="primary")
        self.verdict = VerdictRow()
        self.tools = FusionTools(session, settings_store)
        self.recording = RecordLine(session)
        words = "Connect a second board beside this one, for instance as the reference of a tool"
        self.add_button = Button("Add a board", words, role="quiet", small=True)
        self.add_button.clicked.connect(self.board_wanted)
        self._restore()
        self._lay_out()
        self.source.picked.connect(self._changed)
        self.format.activated.connect(self._changed)
        self.baud.activated.connect(self._changed)
        self.button.clicked.connect(self.toggle)
        self.verdict.columns_wanted.connect(self.columns_wanted)

    @cached_property
    def files(self) -> FileColumns:
        """What is known of the columns of files; made when one is opened, as guessing takes a dozen modules."""
        from imugui.views.file_columns import FileColumns

        return FileColumns(self._settings_store)

    def refresh(self, status: Status) -> None:
        """Show a snapshot."""
        connected = status.state not in UNCONNECTED
        self._follow_session()
        choice = self.source.choice()
        asks = choice.transport == "replay" and not choice.address
        self.button.setText("Disconnect" if connected else "Open…" if asks else "Connect")
        self.button.set_icon("disconnect" if connected else "open" if asks else "connect")
        self.button.set_role("" if connected else "primary")
        self.baud.setVisible(choice.transport == "serial")
        self._show_format(choice.transport == "ble")
        source = self._session.source
        self.verdict.refresh(status, plays_table=source is not None and source.transport == "replay")
        self.tools.refresh(status)
        self.recording.refresh()

    def _show_format(self, wireless: bool) -> None:
        """A Bluetooth board tells its format by its service: there is nothing to choose."""
        self.format.setEnabled(not wireless)
        self.format.setToolTip(FORMAT_OF_SERVICE if wireless else FORMAT_TIP)

    @Slot(list)
    def show_ports(self, ports: list[Port]) -> None:
        """Take a new list of serial ports."""
        self.source.show_ports(ports)

    @Slot()
    def toggle(self) -> None:
        """Connect what is chosen, or disconnect."""
        if self._session.status().state in UNCONNECTED:
            self.connect_chosen()
        else:
            self._session.disconnect_source()

    @Slot()
    def connect_chosen(self) -> None:
        """Connect what is chosen; for a file that is not chosen yet, ask for it."""
        self.source.finish_typing()
        choice = self.source.choice()
        if choice.transport == "replay" and choice.address and self.format.currentData() == AUTO:
            self._open_file(choice.address)
        elif choice.address:
            self._remember()
            self._session.connect_to(self.chosen_source())
        elif choice.transport == "replay":
            self.open_recording()

    def _open_file(self, path: str) -> None:
        """Open a file as its columns are known or guessed; where they are unsure, ask first."""
        opening = self.files.opening(path, self.options())
        self._asking = opening.asks
        if opening.asks:
            self._session.disconnect_source()  # else this bar would go back to what is still connected
            self.columns_wanted.emit()
            return
        self._remember()
        self._session.connect_to(replace(self.chosen_source(), options=opening.options))
        if opening.words:
            self.assumed.emit(opening.tone, f"{Path(path).name}: {opening.words}.")

    def open_files(self, paths: list[str]) -> None:
        """Open files that were picked together as one; the first stands for all."""
        self.files.pick(paths)
        self.connect_to("replay", paths[0])

    @Slot(str, str)
    def connect_to(self, transport: str, address: str) -> None:
        """Choose a source and connect it; with an empty address ask for a recording, or search for boards."""
        if address:
            self.source.choose_source(transport, address)
            self.connect_chosen()
        elif transport == "ble":
            self.source.search_bluetooth()
        else:
            self.open_recording()

    @Slot()
    def open_recording(self) -> None:
        """Ask for a file and play it."""
        folder = str(Path(self._settings_store.settings.address).parent)
        paths, _ = QFileDialog.getOpenFileNames(self, "Open a recording", folder, FILE_KINDS)
        if paths:
            self.open_files(paths)

    def chosen_source(self) -> Source:
        """The source as it is chosen here, with what is remembered of the board."""
        choice = self.source.choice()
        baud = self.baud.currentData() if choice.transport == "serial" else 0
        format_ = AUTO if choice.transport == "ble" else self.format.currentData()
        return Source(choice.transport, choice.address, format_, baud, self.options())

    def options(self) -> Options:
        """What the user once said of the chosen board."""
        return kept_options(self._settings_store, self._identity())

    def keep_options(self, options: Options) -> None:
        """Remember what the user says of the chosen board, and listen again with it."""
        keep_options(self._settings_store, self._identity(), options)
        self.files.keep(self.source.choice().address, options)
        self.format.choose("csv-line" if options.columns else AUTO if options.tables else self.format.currentData())
        if self._session.source is not None or self._asking:
            self.connect_chosen()

    def lines(self) -> list[str]:
        """The lines of numbers that came from the chosen board, for naming its columns."""
        return bare_lines([text for _, _, text in self._session.link_log()])

    def _identity(self) -> str:
        return identity(self.source.choice(), self.source.ports())

    @Slot()
    def _changed(self) -> None:
        """Another choice while connected is taken at once."""
        status = self._session.status()
        if status.state not in UNCONNECTED:
            if self.source.choice().address:
                self.connect_chosen()
            else:
                self._session.disconnect_source()
        self.refresh(self._session.status())

    def _follow_session(self) -> None:
        """Show what is connected, also when it was not chosen here."""
        source = self._session.source
        if source is None or self.source.isEditable() or self.source.choice().key == (source.transport, source.address):
            return
        self.source.choose_source(source.transport, source.address)
        if source.transport != "ble":
            self.format.choose(source.format)
        if source.transport == "serial":
            self.baud.choose(source.baud)

    def _remember(self) -> None:
        if not self._keeps:
            return
        choice = self.source.choice()
        self._settings_store.update(
            transport=choice.transport,
            address=choice.address,
            source_name=choice.name,
            format=self.format.currentData(),
            baud=self.baud.currentData(),
        )

    def _restore(self) -> None:
        if not self._keeps:
            return
        kept = self._settings_store.settings
        if kept.transport in ("serial", "replay", "simulator", "ble") and kept.address:
            self.source.choose_source(kept.transport, kept.address, kept.source_name)
        self.format.choose(kept.format)
        self.baud.choose(kept.baud)

    def _lay_out(self) -> None:
        first = QHBoxLayout()
        first.setSpacing(6)
        first.addWidget(self.source, 3)
        first.addWidget(self.format, 1)
        first.addWidget(self.baud)
        first.addWidget(self.button)
        first.addStretch(1)
        first.addSpacing(8)
        first.addWidget(self.tools)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 10, 12, 10)
        column.setSpacing(8)
        column.addLayout(first)
        second = QHBoxLayout()
        second.setSpacing(12)
        second.addWidget(self.verdict, 1)
        second.addWidget(self.recording)
        second.addWidget(self.add_button, 0, Qt.AlignmentFlag.AlignTop)
        column.addLayout(second)


def _format_box() -> StillBox:
    box = StillBox("Format", FORMAT_TIP)
    box.add("Auto format", AUTO)
    for name, format_ in FORMATS.items():
        box.add(format_.title, name, short=name, words=format_.hint)
    box.setMinimumContentsLength(6)
    box.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    return box


def _baud_box() -> StillBox:
    box = StillBox("Baud rate", "Speed of the serial line; auto tries the usual ones")
    box.add("Auto baud", 0)
    for baud in sorted({*BAUDS, *(baud for format_ in FORMATS.values() for baud in format_.bauds)}):
        box.add(f"{baud} baud", baud)
    box.setMinimumContentsLength(6)
    box.setSizeAdjustPolicy(StillBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    return box

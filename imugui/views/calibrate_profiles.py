"""ProfilePanel: the profile in use with its warnings, and all profiles with what can be done to them."""

from __future__ import annotations

import math
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from PySide6.QtCore import Qt, Signal, Slot
from PySide6.QtWidgets import (
    QFileDialog,
    QFrame,
    QGridLayout,
    QListWidget,
    QListWidgetItem,
    QMessageBox,
    QVBoxLayout,
    QWidget,
)

from imugui.calibration.profile import Profile
from imugui.calibration.profile_file import ProfileError
from imugui.calibration.profile_store import Entry
from imugui.views.controls import Button
from imugui.views.labels import ElidedLabel, ToneLabel, heading, muted
from imugui.workers.session import Session

WIDTH = 336
NONE = "None is kept for this board; only a bias that it gave at rest is taken out."
FILTER = "Profiles (*.json)"
ACTIONS: dict[str, tuple[str, str]] = {
    "certificate": ("Certificate", "What was calibrated, when, and how far to trust it"),
    "compare": ("Compare", "Compare the selected profile with the one in use"),
    "rename": ("Rename", "Give the board another name (F2)"),
    "export": ("Export…", "Write the selected profile to a file"),
    "delete": ("Delete…", "Forget the selected profile; asks first"),
    "take": ("Import…", "Take a profile from a file"),
}


class ProfilePanel(QWidget):
    """The right column of the overview."""

    certificate_wanted = Signal(object)  # Profile
    comparison_wanted = Signal(object, object)  # Profile in use, Profile selected
    said = Signal(str, str)

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self._shown: object = self  # nothing shown yet
        self.name = ElidedLabel()
        self.until = muted()
        self.warning = ToneLabel()
        self.list = QListWidget()
        self.list.setAccessibleName("Profiles")
        self.list.setToolTip("Profiles of all boards; the one in use is marked")
        self.buttons = {name: Button(*words) for name, words in ACTIONS.items()}
        for name, button in self.buttons.items():
            button.clicked.connect(lambda _=False, name=name: self.do(name))
        self.list.itemSelectionChanged.connect(self._follow_selection)
        self.list.itemChanged.connect(self._renamed)
        self._lay_out()
        self.refresh()

    def count(self) -> int:
        """How many profiles there are."""
        return self.list.count()

    def refresh(self) -> None:
        """Show what changed."""
        if self.session.profile is not self._shown:
            self.reload()

    def reload(self) -> None:
        """Read the folder again."""
        used = self._shown = self.session.profile
        self.name.show_line(used.board.title if used else NONE)
        self._show_age(used)
        self.list.blockSignals(True)
        self.list.clear()
        for entry in self.session.profiles.entries():
            self.list.addItem(_item(entry, used))
        self.list.blockSignals(False)
        if self.list.count():
            self.list.setCurrentRow(self._row_of(used))
        self._follow_selection()

    def selected(self) -> Profile | None:
        """The profile that is selected, if it can be used."""
        item = self.list.currentItem()
        entry: Entry | None = item.data(Qt.ItemDataRole.UserRole) if item is not None else None
        return entry.profile if entry is not None else None

    @Slot(str)
    def do(self, action: str) -> None:
        """One of ACTIONS on the selected profile; problems are told in words."""
        try:
            getattr(self, f"_{action}")()
        except (ProfileError, OSError) as error:
            self.said.emit("error", f"{ACTIONS[action][0].rstrip('…')}: {error}")

    def _certificate(self) -> None:
        profile = self.selected()
        if profile is not None:
            self.certificate_wanted.emit(profile)

    def _compare(self) -> None:
        profile, used = self.selected(), self.session.profile
        if profile is not None and used is not None:
            self.comparison_wanted.emit(used, profile)

    def _rename(self) -> None:
        if self.selected() is not None:
            self.list.editItem(self.list.currentItem())

    def _export(self) -> None:
        profile = self.selected()
        if profile is None:
            return
        name, _ = QFileDialog.getSaveFileName(self, "Export the profile", f"{profile.board.title}.json", FILTER)
        if name:
            self.session.profiles.export(profile.board, Path(name))
            self.said.emit("info", f"The profile is in {name}.")

    def _take(self) -> None:
        name, _ = QFileDialog.getOpenFileName(self, "Import a profile", "", FILTER)
        if not name:
            return
        profile = self.session.profiles.import_file(Path(name))
        self._use_again(profile)
        self.reload()
        self.said.emit("info", f"The profile of {profile.board.title} is here now.")

    def _delete(self) -> None:
        item = self.list.currentItem()
        if item is None:
            return
        entry: Entry = item.data(Qt.ItemDataRole.UserRole)
        self._ask(f"Forget the profile “{item.text()}”? This cannot be undone.", lambda: self._forget(entry))

    def _forget(self, entry: Entry) -> None:
        used, profile = self.session.profile, entry.profile
        try:
            if used is not None and profile is not None and used.board.key == profile.board.key:
                self.session.remove_profile()
            entry.path.unlink(missing_ok=True)
        except OSError as error:
            self.said.emit("error", f"Delete: {error}")
        self.reload()

    def _ask(self, question: str, then: Callable[[], None]) -> None:
        """Ask without stopping the window."""
        yes, no = QMessageBox.StandardButton.Yes, QMessageBox.StandardButton.Cancel
        box = QMessageBox(QMessageBox.Icon.Question, "Delete", question, yes | no, self)
        box.setDefaultButton(no)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.accepted.connect(then)
        box.open()

    @Slot(QListWidgetItem)
    def _renamed(self, item: QListWidgetItem) -> None:
        """A name was typed into the list."""
        profile = item.data(Qt.ItemDataRole.UserRole).profile
        name = item.text().strip()
        if profile is not None and name and name != profile.board.title:
            try:
                self._use_again(self.session.profiles.rename(profile.board, name))
            except (ProfileError, OSError) as error:
                self.said.emit("error", f"Rename: {error}")
        self.reload()

    def _use_again(self, profile: Profile) -> None:
        """A profile changed on the disk: the board in use takes it over."""
        board = self.session.board
        if board is not None and board.key == profile.board.key:
            self.session.apply_profile(profile)

    def _follow_selection(self) -> None:
        profile, used = self.selected(), self.session.profile
        for name in ("certificate", "rename", "export"):
            self.buttons[name].setEnabled(profile is not None)
        self.buttons["delete"].setEnabled(self.list.currentItem() is not None)
        other = profile is not None and used is not None and profile.board.key != used.board.key
        self.buttons["compare"].setEnabled(other)

    def _show_age(self, used: Profile | None) -> None:
        until = used.good_until if used else None
        self.until.setText(f"Good until {until.day} {until:%b %Y}" if until else "")
        self.until.setVisible(until is not None)
        newest = self.session.samples.last(1)
        temp_c = float(newest["temp_c"][0]) if len(newest) else math.nan
        warnings = used.warnings(datetime.now(UTC), temp_c) if used else []
        self.warning.show_phrase("warn" if warnings else "neutral", warnings[0] if warnings else "")
        self.warning.setVisible(bool(warnings))
        self.warning.setToolTip("\n".join(warnings))

    def _row_of(self, used: Profile | None) -> int:
        for row in range(self.list.count()):
            profile = self.list.item(row).data(Qt.ItemDataRole.UserRole).profile
            if profile is not None and used is not None and profile.board.key == used.board.key:
                return row
        return 0

    def _lay_out(self) -> None:
        grid = QGridLayout()
        grid.setSpacing(6)
        for place, button in enumerate(self.buttons.values()):
            grid.addWidget(button, place // 3, place % 3)
        card = QFrame()
        card.setProperty("role", "card")
        inside = QVBoxLayout(card)
        inside.setContentsMargins(14, 12, 14, 12)
        inside.setSpacing(6)
        for widget in (muted("Profile in use"), self.name, self.until, self.warning):
            inside.addWidget(widget)
        column = QVBoxLayout(self)
        column.setContentsMargins(16, 14, 16, 10)
        column.setSpacing(10)
        column.addWidget(card)
        column.addWidget(heading("Profiles"))
        column.addWidget(self.list, 1)
        column.addLayout(grid)
        self.setFixedWidth(WIDTH)


def _item(entry: Entry, used: Profile | None) -> QListWidgetItem:
    profile = entry.profile
    item = QListWidgetItem(profile.board.title if profile else f"✕ {entry.path.name}")
    item.setData(Qt.ItemDataRole.UserRole, entry)
    if profile is None:
        item.setToolTip(entry.problem)
        return item
    item.setFlags(item.flags() | Qt.ItemFlag.ItemIsEditable)
    in_use = used is not None and used.board.key == profile.board.key
    item.setToolTip(f"{profile.board.key}{', in use' if in_use else ''}")
    if in_use:
        bold = item.font()
        bold.setBold(True)
        item.setFont(bold)
    return item

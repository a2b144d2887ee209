"""The Calibrate page: what of this board is calibrated, and the guided flows that do it."""

from __future__ import annotations

import dataclasses
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, Slot
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QHBoxLayout, QStackedWidget, QVBoxLayout, QWidget

from imugui import __version__
from imugui.calibration.certificate import certificate_html
from imugui.calibration.profile import Profile
from imugui.views.calibrate_choice import Choice
from imugui.views.calibrate_flow import FlowPage
from imugui.views.calibrate_guides import GUIDES
from imugui.views.calibrate_look import Guide, Look
from imugui.views.calibrate_overview import Overview
from imugui.views.calibrate_parts import PARTS
from imugui.views.calibrate_profiles import ProfilePanel
from imugui.views.calibrate_states import field_of, fresh_profile, part_states
from imugui.views.calibrate_trust import TrustStrip
from imugui.views.certificate_page import CertificatePage
from imugui.views.certificate_words import certificate_text, comparison_text, page
from imugui.views.empty import EmptyState
from imugui.views.settings_store import SettingsStore
from imugui.views.view import View
from imugui.workers.session import Port, Session, State

WILL_SHOW = (
    "This page shows what of the board is calibrated and how good, in degrees, and leads through the rest: "
    "gyroscope, accelerometer, magnetometer, axes, mounting and temperature."
)


class CalibrateView(View):
    """Only Apply changes anything: until then the old profile stays as it is, in use and on the disk."""

    title = "Calibrate"
    icon = "calibrate"
    tip = "Calibrate the board, and see how far to trust it"

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        self.empty = EmptyState("calibrate", "No board is connected", WILL_SHOW)
        self.overview = Overview()
        self.profiles = ProfilePanel(session)
        self.choice = Choice()
        self.flow = FlowPage(session)
        self.certificate = CertificatePage()
        self.trust = TrustStrip(session)
        self._lay_out()
        self._connect_parts()
        self.slow_refresh()

    def refresh(self) -> None:
        if self._stack.currentWidget() is self.flow:
            self.flow.refresh()

    def slow_refresh(self) -> None:
        status = self.session.status()
        connected = status.state is not State.IDLE
        front = self._stack.currentWidget()
        if front in (self.empty, self._home):
            self._stack.setCurrentWidget(self._home if connected or self.profiles.count() else self.empty)
        if front is self.flow:
            self.flow.slow_refresh()
        profile = self.session.profile
        has_mag = status.has_mag or status.mag_trust == "off"
        self.overview.show_states(part_states(profile), connected, has_mag)
        self.profiles.refresh()
        self.trust.refresh(status, field_of(profile))

    def stop(self) -> None:
        self.flow.end()

    def show_ports(self, ports: list[Port]) -> None:
        self.empty.show_ports(ports)

    @Slot(str)
    def calibrate(self, part: str) -> None:
        """Begin with one part of the board: a flow, or the choice of one."""
        guides = [guide for guide in GUIDES.values() if guide.part == part]
        if len(guides) == 1:
            self.begin(guides[0].key)
        elif guides:
            self.choice.offer(PARTS[part].title, guides)
            self._stack.setCurrentWidget(self.choice)

    @Slot(str)
    def begin(self, key: str) -> None:
        """Begin a guided flow, by its key in GUIDES."""
        self._stack.setCurrentWidget(self.flow)
        self.flow.begin(GUIDES[key], self.session.profile, self.settings_store.settings.field_ut)

    @Slot()
    def go_home(self) -> None:
        """Back to the overview; a flow that runs is forgotten."""
        self.flow.end()
        self._stack.setCurrentWidget(self._home)
        self.slow_refresh()
        if self.overview.next.isVisible():
            self.overview.next.setFocus(Qt.FocusReason.OtherFocusReason)

    def view_from_x(self) -> None:
        """Look along the x axis."""
        self.flow.picture.scene().view_from("x")

    def view_from_y(self) -> None:
        """Look along the y axis."""
        self.flow.picture.scene().view_from("y")

    def view_from_z(self) -> None:
        """Look along the z axis."""
        self.flow.picture.scene().view_from("z")

    def view_default(self) -> None:
        """Look from the usual place."""
        self.flow.picture.scene().view_from("default")

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Backspace leads back."""
        if event.key() == Qt.Key.Key_Backspace and self._stack.currentWidget() not in (self._home, self.empty):
            self.go_home()
        else:
            super().keyPressEvent(event)

    @Slot(object, object, object)
    def _apply(self, guide: Guide, result: Any, look: Look) -> None:
        """Apply was pressed."""
        profile = self.session.profile or fresh_profile(self.session)
        made = guide.apply(profile, result, look)
        rate_hz = self.session.rate_hz or profile.rate_hz
        if self.session.apply_profile(dataclasses.replace(made, rate_hz=rate_hz, made_with=f"imugui {__version__}")):
            self.said.emit("info", f"{PARTS[guide.part].title} calibrated, in use and saved for this board.")
        self.go_home()

    @Slot(object)
    def _show_certificate(self, profile: Profile) -> None:
        now = datetime.now(UTC)
        html = certificate_html(profile, now)
        name = f"certificate-{Path(profile.board.file_name).stem}.html"
        self.certificate.show_document(
            f"Certificate: {profile.board.title}", certificate_text(profile, now), html, name
        )
        self._stack.setCurrentWidget(self.certificate)

    @Slot(object, object)
    def _show_comparison(self, used: Profile, other: Profile) -> None:
        text = comparison_text(used, other)
        title = f"{other.board.title} against the profile in use"
        self.certificate.show_document(title, text, page(title, text), "comparison.html")
        self._stack.setCurrentWidget(self.certificate)

    @Slot(str)
    def _failed(self, text: str) -> None:
        self.said.emit("error", text)
        self.go_home()

    def _connect_parts(self) -> None:
        self.empty.wanted.connect(self.wanted)
        self.overview.wanted.connect(self.calibrate)
        self.profiles.certificate_wanted.connect(self._show_certificate)
        self.profiles.comparison_wanted.connect(self._show_comparison)
        for part in (self.profiles, self.certificate):
            part.said.connect(self.said)
        self.choice.chosen.connect(self.begin)
        self.flow.applied.connect(self._apply)
        self.flow.failed.connect(self._failed)
        for sub in (self.choice, self.flow, self.certificate):
            sub.closed.connect(self.go_home)

    def _lay_out(self) -> None:
        self._home = QWidget()
        row = QHBoxLayout(self._home)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.overview, 1)
        row.addWidget(self.profiles)
        self._stack = QStackedWidget()
        for widget in (self.empty, self._home, self.choice, self.flow, self.certificate):
            self._stack.addWidget(widget)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self._stack, 1)
        column.addWidget(self.trust)

"""CalibratePicture: the moving picture of a flow: the board in a sphere of directions or in a cube of positions."""

from __future__ import annotations

import math
import time

import numpy as np
from PySide6.QtCore import Slot
from PySide6.QtWidgets import QStackedWidget

from imugui.calibration.coverage import CELLS, fibonacci
from imugui.fusion.quaternion import IDENTITY, from_matrix, multiply
from imugui.views.calibrate_look import Floats, Look
from imugui.views.hand_scene import HandScene
from imugui.views.live_words import stale_word
from imugui.views.position_scene import PositionScene
from imugui.views.sphere_scene import SphereScene
from imugui.workers.session import Session, State


class CalibratePicture(QStackedWidget):
    """Follows the live board 60 times a second, and a flow's Look whenever there is a new one."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session
        self.sphere = SphereScene()
        self.cube = PositionScene()
        self._look = Look()
        self._state = State.IDLE
        for scene in (self.cube, self.sphere):
            self.addWidget(scene)
            scene.hand_turned.connect(self.turn_board)
        self.setFocusPolicy(self.cube.focusPolicy())
        self.begin("board")

    def begin(self, picture: str) -> None:
        """Show an empty picture: "board", "sphere" or "cube"."""
        self.setCurrentWidget(self.sphere if picture == "sphere" else self.cube)
        self.setFocusProxy(self.scene())
        self.scene().view_from("default")
        self.show_look(Look(levels=np.zeros(CELLS)) if picture == "sphere" else Look())

    def scene(self) -> HandScene:
        """The scene in front."""
        scene = self.currentWidget()
        assert isinstance(scene, HandScene)  # noqa: S101
        return scene

    def show_look(self, look: Look) -> None:
        """Show what a flow has gathered."""
        if look.level_turn and not self._look.level_turn and self.session.hand_turned:
            self.scene().view_from("y")  # from here a drag to the side turns the board about the vertical
        self._look = look
        if self.currentWidget() is self.sphere:
            self.sphere.set_cells(fibonacci(CELLS), look.levels)
            self.sphere.set_cloud(look.cloud, look.outliers)
        else:
            self.cube.set_positions(look.directions, look.reached, look.goal)

    def refresh(self) -> None:
        """Turn the board as it is held now; an old attitude is greyed."""
        rows = self.session.attitude.last(1)
        age_s = time.perf_counter() - float(rows["t_arrival"][0]) if len(rows) else math.nan
        self.scene().set_dimmed(stale_word(self._state, age_s) or None)
        if len(rows):
            profile = self.session.profile
            mounting = profile.mounting.quat if profile and profile.mounting else IDENTITY
            self.scene().set_quat(multiply(rows["quat"][0], mounting))  # cloud and cube are in the sensor's own axes
        if self.currentWidget() is self.sphere:
            self.sphere.set_needle(self._needle(), self._look.goal)
        else:
            self.cube.show_turn(time.perf_counter())

    def slow_refresh(self) -> None:
        """Take the mouse and the arrow keys for the virtual board while there is one."""
        state = self.session.status().state
        self._state = State.STREAMING if state is State.IMPOSSIBLE else state  # what is to be calibrated may look odd
        hand = self.session.hand_turned
        for scene in (self.cube, self.sphere):
            if scene.turned_by_hand != hand:
                scene.set_hand_mode(hand)

    @Slot(float, float)
    def turn_board(self, dx_rad: float, dy_rad: float) -> None:
        """Turn the virtual board as seen on screen: right by dx, down by dy, rad."""
        self.session.turn_board(dx_rad, dy_rad, from_matrix(self.scene().camera().basis.T))

    def _needle(self) -> Floats | None:
        """Where the measured field points now, from the centre of the cloud; None without one."""
        rows = self.session.samples.last(1)
        if len(rows) == 0 or self._look.centre is None:
            return None
        away = rows["mag"][0] - self._look.centre
        length = float(np.linalg.norm(away))
        return away / length if math.isfinite(length) and length > 1e-9 else None

"""GameScene: the picture of the targeting game, and the keys and mouse buttons that play it."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPointF, QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QSizePolicy

from imugui.targeting.game_look import GameLook
from imugui.views import game_labels as labels
from imugui.views import game_paint as marks
from imugui.views import game_words as words
from imugui.views.game_backdrop import Backdrop
from imugui.views.game_colours import colours
from imugui.views.game_keys import ARROWS, BUTTON_KEYS, GO_ON, MOUSE_BUTTONS, RESET, TAKEN, Held
from imugui.views.game_map import FieldMap, picture
from imugui.views.game_words import Plate
from imugui.views.painted import Painted

TAP_PX, HELD_PX_S = 4.0, 110.0
"""What an arrow key asks for at once, px of the field, and a second while it is held."""
_REPEAT_S = 0.2  # an arrow that is held for longer goes on
_LONGEST_S = 0.1  # of one frame
_TIP = "Red brackets: the target. Blue frame: the field of view. The keys are listed beside."


class GameScene(Painted):
    """Shows a GameLook. What the person does goes out as signals, while ``playing``."""

    pressed = Signal(str)
    released = Signal(str)
    """Buttons as ``targeting.activation.Input`` names them."""
    turned = Signal(float, float)
    """Hand mode only: how far the virtual board shall move the view, to the right and up, px of the field."""
    go_on = Signal()
    """Select, confirm or start."""
    reset_wanted = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.plain = False
        self._look: GameLook | None = None
        self._invitation = Plate("neutral", "")
        self.hint = ""
        """The line under what is to be done."""
        self._playing = self._hand_mode = self._mouse_presses = False
        self._backdrop = Backdrop()
        self._held = Held()
        self._grabbed: QPointF | None = None
        self._arrows: dict[Qt.Key, float] = {}  # s, for how long each is down
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setAccessibleName("Field of the targeting game")
        self.setToolTip(_TIP)

    # what is shown

    def show_look(self, look: GameLook | None) -> None:
        """Show a run as it stands; None: the invitation."""
        if look is self._look:
            return
        self._look = look
        self.setAccessibleDescription(words.spoken(look) if look is not None else self._invitation.title)
        self.update()

    def invite(self, plate: Plate) -> None:
        """What stands on the picture while nothing is played."""
        if plate != self._invitation:
            self._invitation = plate
            self.update()

    def set_hint(self, words: str) -> None:
        """A line under what is to be done."""
        if words != self.hint:
            self.hint = words
            self.update()

    def set_plain(self, plain: bool) -> None:
        """Squared paper instead of an endoscope's picture."""
        if plain != self.plain:
            self.plain = plain
            self.update()

    def set_playing(self, on: bool, hand: bool = False, mouse_presses: bool = True) -> None:
        """While on, keys and mouse buttons are the game's; ``hand``: a drag and the arrow keys turn the board."""
        if not on:
            self.let_go()
        self._playing, self._hand_mode, self._mouse_presses = on, hand, mouse_presses
        self.setCursor(Qt.CursorShape.CrossCursor if on else Qt.CursorShape.ArrowCursor)

    def place(self) -> FieldMap:
        """Where the field lies in the widget."""
        return FieldMap(self.width(), self.height())

    # what the person does

    def let_go(self) -> None:
        """Every button and key comes up."""
        self._arrows.clear()
        self._grabbed = None
        for button in self._held.drop():
            self.released.emit(button)

    def carry_on(self, dt: float) -> None:
        """Turn on while arrow keys are held; ``dt`` in s since the frame before."""
        dt = min(dt, _LONGEST_S)
        right = up = 0.0
        for key in self._arrows:
            self._arrows[key] += dt
            if self._arrows[key] > _REPEAT_S:
                right, up = right + ARROWS[key][0], up + ARROWS[key][1]
        if right or up:
            self.turned.emit(right * HELD_PX_S * dt, up * HELD_PX_S * dt)

    # Qt's events

    def sizeHint(self) -> QSize:
        return QSize(800, 700)

    def minimumSizeHint(self) -> QSize:
        return QSize(360, 320)

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self._takes(event):
            event.accept()
            return True
        return super().event(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """A key that comes up elsewhere is not heard here."""
        self.let_go()
        super().focusOutEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if not self._takes(event):
            super().keyPressEvent(event)
        elif event.isAutoRepeat():
            event.accept()
        elif key in BUTTON_KEYS:
            self._press(BUTTON_KEYS[key], key)
        elif key in ARROWS:
            self._begin_arrow(key)
        elif key == RESET:
            self.reset_wanted.emit()
        else:
            self.go_on.emit()

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if event.isAutoRepeat() or key not in TAKEN:
            super().keyReleaseEvent(event)
            return
        self._arrows.pop(key, None)
        if key in BUTTON_KEYS:
            self._release(BUTTON_KEYS[key], key)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if not self._playing:
            return
        self._grabbed = event.position()
        if event.button() == Qt.MouseButton.MiddleButton:
            self.go_on.emit()
        elif self._mouse_presses and event.button() in MOUSE_BUTTONS:
            self._press(MOUSE_BUTTONS[event.button()], event.button())

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grabbed is None or not self._hand_mode:
            return
        step = (event.position() - self._grabbed) / self.place().scale
        self._grabbed = event.position()
        self.turned.emit(step.x(), -step.y())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if not event.buttons():
            self._grabbed = None
        if event.button() in MOUSE_BUTTONS:
            self._release(MOUSE_BUTTONS[event.button()], event.button())

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        try:
            self._paint(painter)
        finally:
            painter.end()

    # parts

    def _takes(self, event: QKeyEvent) -> bool:
        """Whether a key is the game's: all its keys while it is played, else only the one that starts it."""
        plain = not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier & ~Qt.KeyboardModifier.ShiftModifier
        key = Qt.Key(event.key())
        if key in ARROWS and not self._hand_mode:
            return False
        return plain and key in (TAKEN if self._playing else GO_ON)

    def _press(self, button: str, holder: object) -> None:
        if self._held.down(button, holder):
            self.pressed.emit(button)

    def _release(self, button: str, holder: object) -> None:
        if self._held.up(button, holder):
            self.released.emit(button)

    def _begin_arrow(self, key: Qt.Key) -> None:
        self._arrows[key] = 0.0
        right, up = ARROWS[key]
        self.turned.emit(right * TAP_PX, up * TAP_PX)

    def _paint(self, painter: QPainter) -> None:
        look, place = self._look, self.place()
        lit = place.lit(look.view, look.task.sized) if look is not None else None
        self._backdrop.paint(painter, self.size(), self.devicePixelRatioF(), self.plain, lit)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        plate = words.plate(look) if look is not None else self._invitation
        if look is not None:
            marks.paint_marks(painter, place, look, colours(self.plain))
            labels.paint_top(painter, place, look)
        if plate is not None:
            marks.paint_veil(painter, picture(place, self.plain), plate.tone)
            labels.paint_plate(painter, place, plate)
        main = look.to_do if look is not None and plate is None else ""
        labels.paint_bottom(painter, place, main, look.message if look is not None else "", self.hint)
        self._paint_focus(painter)

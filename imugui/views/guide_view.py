"""The Guide page: plan, tool, registration, target, report; one step is in front."""

from __future__ import annotations

from PySide6.QtCore import Slot
from PySide6.QtWidgets import QStackedWidget, QVBoxLayout, QWidget

from imugui.guidance.reading import Reading, Vector
from imugui.guidance.registration import Registration
from imugui.views.empty import EmptyState
from imugui.views.guide_aim_panel import AimPanel
from imugui.views.guide_desk import FILE_NAME, GuideDesk
from imugui.views.guide_foot import GuideFoot
from imugui.views.guide_plan_panel import PlanPanel
from imugui.views.guide_register_panel import RegisterPanel
from imugui.views.guide_report_panel import ReportPanel
from imugui.views.guide_steps import STEPS, StepBar, step_states
from imugui.views.guide_tool_panel import ToolPanel
from imugui.views.settings_store import SettingsStore
from imugui.views.view import View
from imugui.workers.session import Port, Session, State

WILL_SHOW = (
    "This page shows where a tool points against a planned direction, and how far to trust that. Plans need no board."
)
NEEDS_BOARD = ("", "tool", "register", "aim")
MEASURES = ("tool", "register", "aim")


class GuideView(View):
    """Without a registration, and with anything that is not to be trusted, nothing turns green."""

    title = "Guide"
    icon = "guide"
    tip = "Aim a tool at a planned direction"

    def __init__(self, session: Session, settings_store: SettingsStore) -> None:
        super().__init__(session, settings_store)
        path = settings_store.path
        self.desk = GuideDesk(session, path.parent / FILE_NAME if path is not None else None)
        self.step = ""
        """The step in front; "" until the user chose one, while nothing is connected."""
        self._state = State.IDLE
        self.steps = StepBar()
        self.empty = EmptyState("guide", "No board is connected", WILL_SHOW)
        self.plan = PlanPanel()
        self.tool = ToolPanel(session)
        self.register_panel = RegisterPanel(session)
        self.aim = AimPanel(session, self.desk.guide)
        self.report = ReportPanel()
        self.foot = GuideFoot(session)
        self.plan.load(self.desk.guide.plans)
        self._lay_out()
        self._connect_parts()
        self.slow_refresh()

    # the window's timers

    def refresh(self) -> None:
        look = self.desk.pull()
        if self.desk.pressed and self.step in MEASURES:
            self.take()
        self.tool.feed(self.desk.rows)
        self.register_panel.feed(self.desk.rows, self.desk.first)
        if self.step == "aim":
            self.aim.refresh(look, self.session.shown.count)
        elif self.step in ("tool", "register"):
            (self.tool if self.step == "tool" else self.register_panel).refresh(self._state)

    def slow_refresh(self) -> None:
        status = self.session.status()
        self._state = status.state
        if self.isVisible():
            for problem in self.desk.problems:
                self.said.emit("warn", problem)
            self.desk.problems = []
        guide = self.desk.guide
        if not self.step and (self._state is not State.IDLE or guide.plans):
            measure = guide.plans and self._state is not State.IDLE
            self.go("plan" if not measure else "register" if guide.registration is None else "aim")
        self.tool.slow_refresh()
        self.tool.show_axis(guide.tool_axis, guide.tool_axis_quality_deg)
        self.register_panel.show_tool(guide.tool_axis)
        self.register_panel.slow_refresh()
        self.register_panel.show_registration(guide.registration, self.desk.void)
        self.aim.slow_refresh(guide.readings)
        running = self.session.recording
        self.report.show_readings(guide.readings, guide.plans, str(running.path) if running is not None else "")
        self.foot.refresh(status)
        self._show_front()
        self._tell_steps()

    def show_ports(self, ports: list[Port]) -> None:
        self.empty.show_ports(ports)

    def origin_moved(self) -> None:
        self.desk.origin_moved()

    def stop(self) -> None:
        self.desk.flush()

    # what the keys and buttons do

    @Slot(str)
    def go(self, step: str) -> None:
        """Bring a step to the front, and its keys with it."""
        self.step = step
        self._show_front()
        if step == "aim":
            self.aim.take_keys()
        elif step in ("tool", "register"):
            panel = self.tool if step == "tool" else self.register_panel
            panel.stage.scene.setFocus()

    @Slot()
    def take(self) -> None:
        """Take what this step measures: the reading, the pose, the spin."""
        measures = {"aim": self.desk.capture, "register": self.register_panel.take, "tool": self.tool.take}
        if self._stack.currentWidget() is not self.empty and self.step in measures:
            measures[self.step]()

    @Slot()
    def next_plan(self) -> None:
        """Aim at the next trajectory."""
        self._select(self.desk.guide.index + 1)

    @Slot()
    def previous_plan(self) -> None:
        """Aim at the trajectory before."""
        self._select(self.desk.guide.index - 1)

    @Slot()
    def register(self) -> None:
        """To the registration, to begin it anew."""
        self.go("register")

    def view_from_x(self) -> None:
        """Look along the x axis."""
        self._look_from("x")

    def view_from_y(self) -> None:
        """Look along the y axis."""
        self._look_from("y")

    def view_from_z(self) -> None:
        """Look along the z axis."""
        self._look_from("z")

    def view_default(self) -> None:
        """Look from the usual place."""
        self._look_from("default")

    # inside

    def _look_from(self, view: str) -> None:
        for panel in (self.tool, self.register_panel):
            panel.stage.scene.view_from(view)

    @Slot(int)
    def _select(self, index: int) -> None:
        self.desk.select(index)
        self.slow_refresh()

    @Slot()
    def _plans_changed(self) -> None:
        self.desk.set_plans(self.plan.plans())
        self._tell_steps()

    @Slot(object, float)
    def _axis_chosen(self, axis: Vector, quality_deg: float) -> None:
        self.desk.set_axis(axis, quality_deg)
        self.slow_refresh()

    @Slot(object)
    def _registered(self, registration: Registration) -> None:
        self.desk.register(registration)
        if registration.method == "origin" and self.session.relative is None:
            self.session.set_origin()
        if registration.warning:
            self.said.emit("warn", registration.warning)
        self.slow_refresh()
        self.register_panel.next_button.setFocus()

    @Slot()
    def _removed(self) -> None:
        self.desk.remove_registration()
        self.slow_refresh()

    @Slot(str)
    def _side_confirmed(self, side: str) -> None:
        self.desk.confirm_side(side)
        self.slow_refresh()

    @Slot(object)
    def _taken(self, reading: Reading) -> None:
        self.aim.reading.show_reading(reading, recorded=self.session.recording is not None)
        self.slow_refresh()

    @Slot(str)
    def _refused(self, why: str) -> None:
        self.aim.reading.show_result("warn", why)

    @Slot(list)
    def _delete(self, numbers: list[int]) -> None:
        self.desk.forget_readings(numbers)
        self.slow_refresh()

    def _show_front(self) -> None:
        """The step in front, or how to get data where it needs them and there are none."""
        idle = self._state is State.IDLE and self.step in NEEDS_BOARD
        self._stack.setCurrentWidget(self.empty if idle else self._panels[self.step])
        self.steps.select(self.step)

    def _tell_steps(self) -> None:
        """What of each step is done, as shape and word."""
        for name, state in step_states(self.desk.guide, len(self.plan.sheet.drafts), self.desk.void).items():
            self.steps.show_state(name, *state)

    def _connect_parts(self) -> None:
        self.steps.chosen.connect(self.go)
        self.empty.wanted.connect(self.wanted)
        self.plan.changed.connect(self._plans_changed)
        self.plan.finished.connect(lambda: self.go("tool"))
        self.tool.chosen.connect(self._axis_chosen)
        self.tool.finished.connect(lambda: self.go("register"))
        self.register_panel.started.connect(self.desk.use_magnetometer)
        self.register_panel.registered.connect(self._registered)
        self.register_panel.removed.connect(self._removed)
        self.register_panel.finished.connect(lambda: self.go("aim"))
        self.aim.wanted.connect(self.desk.capture)
        self.aim.selected.connect(self._select)
        self.aim.side_confirmed.connect(self._side_confirmed)
        self.aim.register_wanted.connect(self.register)
        self.report.deleted.connect(self._delete)
        self.desk.taken.connect(self._taken)
        self.desk.refused.connect(self._refused)
        self.foot.record_wanted.connect(self.record_wanted)
        for part in (self.plan, self.report, self.desk):
            part.said.connect(self.said)

    def _lay_out(self) -> None:
        parts: tuple[QWidget, ...] = (self.plan, self.tool, self.register_panel, self.aim, self.report)
        self._panels = dict(zip(STEPS, parts, strict=True))
        self._stack = QStackedWidget()
        for widget in (self.empty, *parts):
            self._stack.addWidget(widget)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.steps)
        column.addWidget(self._stack, 1)
        column.addWidget(self.foot)

"""The cards and panels of the Target page, each by itself."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLabel
from pytestqt.qtbot import QtBot

from imugui.targeting.activation import Input
from imugui.targeting.game_look import GameLook
from imugui.targeting.play_again import Setup
from imugui.targeting.settings import PRESETS, Control
from imugui.targeting.states import State, Transition
from imugui.targeting.study_plan import StudyPlan, codes
from imugui.targeting.study_simulated import simulate_study
from imugui.targeting.study_steps import PREFERENCE, SUS, TLX, Step
from imugui.targeting.tasks import PRESETS as TASKS
from imugui.targeting.tasks import RING, Task
from imugui.targeting.trials import Trial, trials_csv
from imugui.views import target_file
from imugui.views.scale_bar import ScaleBar
from imugui.views.target_cards import KeysCard, PresetCard
from imugui.views.target_file import Kept, Play
from imugui.views.target_history import HistoryCard
from imugui.views.target_plan_cards import AS_PLAYED, ConditionsCard, PeopleCard
from imugui.views.target_play_panel import PlayPanel
from imugui.views.target_questions import NONE, QuestionPage
from imugui.views.target_results_panel import EMPTY, ResultsPanel
from imugui.views.target_run_card import RunCard
from imugui.views.target_study_setup import StudySetup
from imugui.views.target_words import control_words, task_words, trial_words

Own = Callable[[Any], Any]
LEVEL = (1.0, 0.0, 0.0, 0.0)


def look(*inputs: str) -> GameLook:
    """A run after one row for each of these inputs."""
    game = Setup(Task(), Control(mask_s=0.0)).game()
    for number, kind in enumerate(("", *inputs)):
        game.step(0.01 * number, LEVEL, (0.0, 0.0, 0.0), -1, (Input(*kind.split()),) if kind else ())
    return game.look()


# words


def test_tasks_and_mappings_in_words() -> None:
    assert task_words(TASKS["thesis"]).startswith("5 squares to match in place and size within 9 px")
    assert "no error is possible" in task_words(TASKS["thesis"])
    assert "errors count" in task_words(TASKS["confirmed by hand"])
    assert "4 rings of 11 circles" in task_words(TASKS["ring, dwell"])
    assert "0.5 s" in task_words(TASKS["ring, dwell"])
    assert control_words(PRESETS["position"]) == "An angle is a place: 8 px per degree, hold to run."
    assert "dead zone 1.5°" in control_words(PRESETS["speed"])
    assert "lag 0.25 s" in control_words(PRESETS["thesis speed"])
    assert "a press latches" in control_words(PRESETS["thesis speed"])


def test_a_target_in_words() -> None:
    assert trial_words(Trial(movement_time_s=3.24, activations=2)) == ("good", "hit, 3.2 s, 2 presses")
    missed = Trial(movement_time_s=1.0, activations=1, overshoots=2, error=True)
    assert trial_words(missed) == ("bad", "missed, 1.0 s, 1 press, 2 overshoots")


# cards


def test_the_run_card_offers_what_is_possible(owned: Own) -> None:
    card = owned(RunCard())

    def enabled() -> tuple[bool, ...]:
        buttons = (card.stop_button, card.reset_button, card.confirm_button, card.leave_button)
        return tuple(button.isEnabled() for button in buttons)

    assert enabled() == (False, False, False, False)
    for inputs, expected, word in (
        (("confirm",), (True, False, False, True), "Ready"),
        (("confirm", "stop"), (False, True, False, True), "Stopped"),
        (("confirm", "stop", "reset"), (True, False, True, True), "Not armed"),
        (("confirm", "press zoom"), (True, False, False, True), "Zooming"),
    ):
        card.show_run(look(*inputs), playing=True)
        assert (enabled(), card.chip.text()) == (expected, word)
    assert card.numbers["left"].text() == "5 of 5"
    card.show_run(None, playing=False)
    assert card.chip.text() == "No run"


def test_the_stop_button_stops(owned: Own, qtbot: QtBot) -> None:
    card = owned(RunCard())
    card.show_run(look("confirm"), playing=True)
    with qtbot.waitSignal(card.stop_wanted):
        QTest.mouseClick(card.stop_button, Qt.MouseButton.LeftButton)


def test_a_preset_brings_its_values_and_a_change_makes_it_custom(owned: Own) -> None:
    card = owned(PresetCard("Mapping", Control(), PRESETS, control_words))
    changes: list[Control] = []
    card.changed.connect(changes.append)
    assert (card.preset(), card.form.isHidden()) == ("position", True)
    card.fold.setChecked(True)
    assert not card.form.isHidden()
    card.box.setCurrentText("thesis speed")
    card.box.activated.emit(card.box.currentIndex())
    assert changes == [PRESETS["thesis speed"]]
    assert "lag 0.25 s" in card.words.text()
    card.form.editor("gain").setValue(12.0)
    assert card.value().gain == 12.0
    assert (card.preset(), card.box.currentText()) == ("Custom", "Custom")


def test_the_keys_follow_the_mapping(owned: Own) -> None:
    card = owned(KeysCard())

    def words() -> str:
        return " ".join(label.text() for label in card.findChildren(QLabel) if not label.isHidden())

    card.show_keys(PRESETS["position"], hand=True, board_button=False)
    assert "hold Space" in words()
    assert "turn the virtual board" in words()
    card.show_keys(PRESETS["thesis position"], hand=False, board_button=True)
    assert "Space, short" in words()
    assert "board's button" in words()
    assert "turn the virtual board" not in words()
    assert "emergency stop" in words()


def test_what_happened_and_why(owned: Own) -> None:
    card = owned(HistoryCard())
    log = [
        Transition(10.0, State.DISARMED, State.READY, "confirmed", ""),
        Transition(12.5, State.READY, State.READY, "pan button pressed: refused, ready", "pan"),
        Transition(13.0, State.READY, State.FAULT, "emergency stop", ""),
    ]
    card.show_log(log)
    assert card.lines.text().splitlines() == [
        "3.0 s  Stopped: emergency stop",
        "2.5 s  still Ready: pan button pressed: refused, ready",
        "0.0 s  Ready: confirmed",
    ]


def test_each_run_has_a_number_and_another_list(owned: Own) -> None:
    panel = owned(PlayPanel(Kept(play=Play(seed=7, practice=True))))
    first = panel.setup()
    panel.next_list()
    second = panel.setup()
    assert (first.seed, second.seed) == (7, 8)
    assert (first.labels.run, second.labels.run) == (1, 2)
    assert first.labels.practice
    assert first.labels.condition == "position"
    panel.play.set_value(dataclasses.replace(panel.play.value(), another=False))
    panel.next_list()
    assert panel.setup().seed == 8


def test_targets_that_do_not_fit_are_said(owned: Own) -> None:
    panel = owned(PlayPanel(Kept()))
    panel.task.form.editor("pan_low_px").setValue(590.0)
    panel.task.form.editor("pan_high_px").setValue(600.0)
    assert panel.problems()
    assert "fit into the field" in panel.task.trouble.text()


def test_what_is_remembered(tmp_path: Path) -> None:
    path = tmp_path / "kept" / target_file.FILE_NAME
    kept = Kept(Task(kind=RING), PRESETS["thesis speed"], Play(seed=5, sound=False), "/a/study")
    assert target_file.load(path) == (Kept(), [])
    target_file.save(path, kept)
    assert target_file.load(path) == (kept, [])
    path.write_text('{"task": {"targets": "many"}, "play": 3}', encoding="utf-8")
    found, problems = target_file.load(path)
    assert found == Kept()
    assert len(problems) == 1
    path.write_text("{", encoding="utf-8")
    assert target_file.load(path)[0] == Kept()


# the plan of a study


def test_people_are_codes(owned: Own) -> None:
    card = owned(PeopleCard(codes(3)))
    card.count.setValue(5)
    assert card.people() == codes(5)
    card.codes.setText("A1, B2;C3  ")
    card.codes.editingFinished.emit()
    assert card.people() == ("A1", "B2", "C3")
    assert card.count.value() == 3


def test_conditions_come_from_presets_and_from_play(owned: Own) -> None:
    card = owned(ConditionsCard({name: PRESETS[name] for name in ("position", "speed")}))
    card.set_played(Control(gain=3.0))
    for name in ("speed", AS_PLAYED):
        card.more.choose(name)
        card.add_button.click()
    assert list(card.conditions()) == ["position", "speed", "speed 2", "custom"]
    assert card.conditions()["custom"].gain == 3.0
    card.names[3].setText("position")
    assert card.twice == "position"


def test_the_setup_says_what_the_number_can_show(owned: Own) -> None:
    setup = owned(StudySetup())
    assert "0.031" in setup.honest.text()
    assert "1.43" in setup.honest.text()
    setup.people.count.setValue(4)
    assert "0.12" in setup.honest.text()
    assert "no result can fall below" in setup.honest.text()
    assert setup.create_button.isEnabled()


def test_a_wrong_plan_cannot_begin(owned: Own) -> None:
    setup = owned(StudySetup())
    setup.people.codes.setText("P01 P01 Ann?")
    setup.people.codes.editingFinished.emit()
    assert not setup.create_button.isEnabled()
    assert "twice" in setup.trouble.text()
    assert "'Ann?' is no code" in setup.trouble.text()


def test_a_study_gets_a_folder_of_its_own(owned: Own, tmp_path: Path, qtbot: QtBot) -> None:
    setup = owned(StudySetup())
    setup.set_parent(tmp_path)
    (tmp_path / "study").mkdir()
    with qtbot.waitSignal(setup.create_wanted) as wanted:
        setup.create_button.click()
    folder, plan = wanted.args
    assert folder == tmp_path / "study-2"
    assert isinstance(plan, StudyPlan)
    assert plan.participants == codes(6)
    assert not folder.exists()


def test_simulated_people_play_the_plan(owned: Own, tmp_path: Path, qtbot: QtBot) -> None:
    setup = owned(StudySetup())
    setup.set_parent(tmp_path)
    plan = StudyPlan(blocks=1, practice_runs=0, rest_s=0.0)
    setup.form.set_value(plan)
    setup.people.set_people(codes(1))
    setup.task.set_value(Task(targets=1))
    with qtbot.waitSignal(setup.simulation.finished) as finished:
        setup.simulation.button.click()
        assert not setup.simulation.button.isEnabled()
    assert (finished.args[0] / "trials.csv").is_file()
    assert setup.simulation.button.isEnabled()
    setup.simulation.stop()


# questions


def test_a_scale_has_no_answer_until_one_is_given(owned: Own) -> None:
    scale = owned(ScaleBar("Effort", "not at all", "very hard", tuple(range(0, 101, 5))))
    scale.resize(400, 46)
    assert scale.value is None
    QTest.mouseClick(scale, Qt.MouseButton.LeftButton, pos=QPoint(386, 15))
    assert scale.value == 100
    QTest.keyClick(scale, Qt.Key.Key_Left)
    assert scale.value == 95
    QTest.mouseClick(scale, Qt.MouseButton.LeftButton, pos=QPoint(2, 15))
    assert (scale.value, scale.accessibleDescription()) == (0, "0")


@pytest.mark.parametrize(("kind", "count", "best"), [(TLX, 6, 100.0), (SUS, 10, 5.0)])
def test_a_form_is_answered_whole_or_not_at_all(owned: Own, qtbot: QtBot, kind: str, count: int, best: float) -> None:
    page = owned(QuestionPage())
    page.ask(StudyPlan(codes(1)), Step(kind, "P01", 3, "position"))
    assert len(page.scales) == count
    assert not page.save_button.isEnabled()
    for scale in page.scales[1:]:
        scale.choose(0)
    assert page.left.text() == f"1 of {count} are not answered yet."
    page.scales[0].choose(99)
    with qtbot.waitSignal(page.answered) as answered:
        page.save_button.click()
    assert answered.args[0][0] == best
    assert len(answered.args[0]) == count
    with qtbot.waitSignal(page.answered) as answered:
        page.skip_button.click()
    assert answered.args[0] == ()


def test_the_preference_may_be_none(owned: Own, qtbot: QtBot) -> None:
    page = owned(QuestionPage())
    page.ask(StudyPlan(codes(1)), Step(PREFERENCE, "P01", 9))
    assert [button.text() for button in page.choices] == ["position", "speed", NONE]
    for place, liked in ((1, "speed"), (2, "")):
        with qtbot.waitSignal(page.liked) as said:
            page.choices[place].click()
        assert said.args == [liked]


# results


@pytest.fixture(scope="module")
def simulated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study that two simulated people have played."""
    folder = tmp_path_factory.mktemp("studies") / "demo"
    plan = StudyPlan(codes(2), simulated=True, name="demo", blocks=1, practice_runs=0, rest_s=0.0, task=Task(targets=1))
    simulate_study(plan, folder)
    return folder


@pytest.fixture
def panel(owned: Own) -> Any:
    one = owned(ResultsPanel())
    yield one
    one.stop()


def test_without_a_run_the_panel_says_what_to_do(panel: ResultsPanel) -> None:
    assert panel.headline.text() == EMPTY
    assert not panel.report_button.isEnabled()


def test_a_study_is_shown_with_its_comparison(panel: ResultsPanel, simulated: Path, qtbot: QtBot) -> None:
    panel.open_file(simulated / "study.json")
    qtbot.waitUntil(lambda: panel.shown is not None)
    assert panel.model.rowCount() == 4
    assert panel.headline.text().startswith("Simulated people: Movement time per target with speed is")
    assert "Nobody took part" in panel.notes.text()
    assert panel.source.currentText() == "demo"
    cells = [panel.model.data(panel.model.index(0, column)) for column in range(4)]
    assert cells == ["P01", "position", "1", "1"]


def test_report_and_table_are_written(
    panel: ResultsPanel, simulated: Path, qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    panel.open_file(simulated / "study.json")
    qtbot.waitUntil(lambda: panel.shown is not None)
    for button, name, start in (
        (panel.report_button, "report.html", "<!DOCTYPE html>"),
        (panel.csv_button, "targets.csv", "# source: Study demo"),
    ):
        path = tmp_path / name
        monkeypatch.setattr(
            "imugui.views.target_results_panel.QFileDialog.getSaveFileName", lambda *_, path=path: (str(path), "")
        )
        button.click()
        assert path.read_text(encoding="utf-8").startswith(start)


def test_a_table_of_targets_opens_too(panel: ResultsPanel, tmp_path: Path, qtbot: QtBot) -> None:
    trials = [
        Trial(participant="P01", condition=name, block=1, run=run, movement_time_s=time)
        for name, time in (("a", 2.0), ("b", 4.0))
        for run in (1, 2)
    ]
    path = tmp_path / "some.csv"
    path.write_text(trials_csv(trials), encoding="utf-8")
    panel.open_file(path)
    qtbot.waitUntil(lambda: panel.shown is not None)
    assert panel.headline.text() == "P01: 2.00 s per target with a, 4.00 s with b. One person tests nothing."


def test_a_file_that_is_no_table_is_refused_in_words(panel: ResultsPanel, tmp_path: Path, qtbot: QtBot) -> None:
    path = tmp_path / "other.csv"
    path.write_text("a,b\n1,2\n", encoding="utf-8")
    with qtbot.waitSignal(panel.said) as said:
        panel.open_file(path)
    assert said.args[0] == "error"
    assert "no table of trials" in said.args[1]

"""Between the page and the game's thread, row by row: what a run yields, and what of it reaches the study."""

from __future__ import annotations

from math import radians
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from imugui.fusion.scalar import Quat, turned_in_sensor
from imugui.samples import ATTITUDE, empty_rows
from imugui.targeting import study_store
from imugui.targeting.game_look import GameLook
from imugui.targeting.play_again import Setup
from imugui.targeting.settings import Control
from imugui.targeting.states import State
from imugui.targeting.study import Study
from imugui.targeting.study_plan import StudyPlan
from imugui.targeting.study_steps import PREFERENCE, REST
from imugui.targeting.tally import Labels
from imugui.targeting.tasks import BUTTON, Task
from imugui.views.target_desk import TargetDesk
from imugui.views.target_study_desk import StudyDesk
from imugui.workers.session import Session

PLAIN = Control(smoothing=False, gain_ramp_s=0.0, mask_s=0.0)
ONE = Task(targets=1, selection=BUTTON)


class Hand:
    """Turns a board row by row; the game's thread is stopped, its work is done here."""

    def __init__(self, session: Session, desk: TargetDesk) -> None:
        self.session, self.desk = session, desk
        self.worker = session.game
        self.worker.stop()
        self.t, self.quat = 100.0, (1.0, 0.0, 0.0, 0.0)

    def rows(self, count: int = 1, x_deg: float = 0.0, z_deg: float = 0.0) -> GameLook | None:
        """So many rows, 10 ms apart, turned by these angles in all."""
        for _ in range(count):
            self.t += 0.01
            self.quat: Quat = turned_in_sensor(self.quat, radians(x_deg / count), 0.0, radians(z_deg / count))
            row = empty_rows(ATTITUDE, 1)
            row["t"], row["quat"], row["gyr"] = self.t, self.quat, 0.0
            self.session.attitude.push(row)
            self.worker.drain(self.t)
        return self.desk.pull()

    def hit(self) -> None:
        """Bring the view onto the target, and select it."""
        look = self.rows()
        assert look is not None
        right, up = look.target.x - look.view.x, look.target.y - look.view.y
        self.desk.press("")
        self.rows()
        self.rows(40, up / 8.0, -right / 8.0)
        self.desk.release("")
        self.rows()
        self.desk.press("zoom")
        self.rows()
        self.rows(20, (look.target.size - look.view.size) / 8.0)
        self.desk.release("zoom")
        self.rows()
        self.desk.go_on()
        self.rows()


@pytest.fixture
def desk(session: Session) -> TargetDesk:
    return TargetDesk(session)


@pytest.fixture
def hand(session: Session, desk: TargetDesk) -> Hand:
    return Hand(session, desk)


@pytest.fixture
def study_desk(session: Session, desk: TargetDesk) -> StudyDesk:
    one = StudyDesk(session, desk)
    one.record_runs = False
    return one


def free_run(seed: int = 1, number: int = 1) -> Setup:
    return Setup(ONE, PLAIN, seed, labels=Labels("", "free", "plain", 0, False, number))


def plan(**values: object) -> StudyPlan:
    """Two people, two conditions, one block of one target each."""
    made = {"blocks": 1, "practice_runs": 0, "rest_s": 5.0, **values}
    return StudyPlan(("P01", "P02"), {"a": PLAIN, "b": PLAIN}, ONE, **made)  # type: ignore[arg-type]


def test_a_run_is_armed_and_played_to_its_end(qtbot: QtBot, desk: TargetDesk, hand: Hand) -> None:
    desk.begin(free_run().game())
    assert desk.playing
    assert hand.rows().state is State.READY
    with qtbot.waitSignals([desk.target_done, desk.run_done]):
        hand.hit()
    assert not desk.playing
    (trial,) = desk.trials
    assert (trial.participant, trial.error, trial.activations) == ("free", False, 2)
    assert desk.pull().phase == "done"
    assert [line.cause for line in desk.log][:2] == ["confirmed", "button pressed"]


def test_the_stop_latches_until_reset_and_confirmed(desk: TargetDesk, hand: Hand) -> None:
    desk.begin(free_run().game())
    hand.rows()
    states = []
    for act in (desk.stop, desk.confirm, desk.reset, desk.go_on):
        act()
        states.append(hand.rows().state)
    assert states == [State.FAULT, State.FAULT, State.DISARMED, State.READY]


def test_a_run_that_is_left_yields_nothing(desk: TargetDesk, hand: Hand) -> None:
    desk.begin(free_run().game())
    hand.rows(5)
    desk.leave()
    hand.rows(5)
    assert not desk.playing
    assert desk.pull() is None
    assert desk.trials == []


def test_the_next_run_never_shows_the_one_before(desk: TargetDesk, hand: Hand) -> None:
    desk.begin(free_run().game())
    hand.rows(3)
    desk.begin(free_run(2, 2).game())
    assert desk.pull() is None
    assert hand.rows().labels.run == 2


def test_hold_and_stop_are_heard(monkeypatch: pytest.MonkeyPatch, desk: TargetDesk, hand: Hand) -> None:
    beeps: list[str] = []
    monkeypatch.setattr("imugui.views.target_desk.QApplication.beep", lambda: beeps.append("beep"))
    desk.begin(free_run().game())
    hand.rows()
    desk.stop()
    hand.rows(3)
    assert beeps == ["beep"]
    desk.sound = False
    desk.reset()
    hand.rows()
    desk.stop()
    hand.rows()
    assert beeps == ["beep"]


def test_a_study_keeps_each_target_and_goes_on(
    study_desk: StudyDesk, desk: TargetDesk, hand: Hand, tmp_path: Path
) -> None:
    assert study_desk.create(tmp_path / "study", plan())
    assert (study_desk.person, study_desk.step.condition) == ("P01", "a")
    study_desk.start()
    assert study_desk.playing
    hand.hit()
    assert not study_desk.playing
    assert study_desk.step.kind == REST
    assert 0.0 < study_desk.rest_left_s <= 5.0
    study_desk.start()  # cuts the rest short
    study_desk.start()
    hand.hit()
    assert study_desk.step.kind == PREFERENCE
    study_desk.answer(liked="b")
    assert study_desk.step is None
    study_desk.start()  # on to the next person
    assert (study_desk.person, study_desk.step.condition) == ("P02", "b")
    again = Study.open(tmp_path / "study")
    assert again.progress("P01").done == again.progress("P01").total
    assert again.problems == []


def test_a_rest_ends_by_itself(study_desk: StudyDesk, hand: Hand, tmp_path: Path, qtbot: QtBot) -> None:
    study_desk.create(tmp_path / "study", plan(rest_s=0.05))
    study_desk.start()
    hand.hit()
    assert study_desk.step.kind == REST

    def over() -> bool:
        study_desk.tick()
        return study_desk.step.kind != REST

    qtbot.waitUntil(over)
    assert study_desk.step.condition == "b"


@pytest.mark.parametrize("leave", [True, False], ids=["left", "killed"])
def test_an_interrupted_block_begins_again(
    study_desk: StudyDesk, desk: TargetDesk, hand: Hand, tmp_path: Path, session: Session, leave: bool
) -> None:
    folder = tmp_path / "study"
    study_desk.create(folder, plan(runs=2))
    study_desk.start()
    hand.hit()
    assert study_desk.step.run == 2
    study_desk.start()
    hand.rows(5)
    if leave:
        study_desk.leave()
        assert not desk.playing
    other = StudyDesk(session, TargetDesk(session))
    said: list[str] = []
    other.said.connect(lambda tone, words: said.append(words))
    assert other.open_folder(folder)
    assert (other.step.block, other.step.run) == (1, 1)
    assert any("begins again" in words for words in said) is not leave
    # the target that was done is still in the file, marked
    rows = [line for line in (folder / "trials.csv").read_text().splitlines() if "P01" in line]
    assert [row[:2] for row in rows] == ["1,"]


def test_a_folder_without_a_study_is_refused_in_words(study_desk: StudyDesk, tmp_path: Path) -> None:
    said: list[tuple[str, str]] = []
    study_desk.said.connect(lambda tone, words: said.append((tone, words)))
    assert not study_desk.open_folder(tmp_path)
    assert study_desk.study is None
    assert [tone for tone, _ in said] == ["error"]


def test_a_target_that_cannot_be_written_is_said(
    study_desk: StudyDesk, hand: Hand, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    said: list[str] = []
    study_desk.said.connect(lambda tone, words: said.append(words))
    study_desk.create(tmp_path / "study", plan())
    study_desk.start()
    hand.rows()
    append = study_store.append

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(study_store, "append", full)
    hand.hit()
    assert any("No space left on device" in words for words in said)
    monkeypatch.setattr(study_store, "append", append)
    study_desk.start()  # the rest; whatever is kept in memory is written before the next run
    study_desk.start()
    assert Study.open(tmp_path / "study").progress("P01").done >= 1

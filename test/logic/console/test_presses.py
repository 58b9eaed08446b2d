"""What is pressed: how its goals end, what has failed of it until somebody has looked, and that it is not sent late."""

from __future__ import annotations

import json
import threading
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from fake_goals import FakeActionClient
from played_study import Trial

from nao_library_actions.msg import NaoLedAction, NaoLedGoal
from nao_library_modules.console.access.connections import console_time
from nao_library_modules.console.access.sessions import OPERATOR, Session
from nao_library_modules.console.pages.frame import BROKEN, PageContext, unsent_presses
from nao_library_modules.console.robots.robot_client import RobotClient
from nao_library_modules.console.robots.robot_goals import (
    ABORTED,
    ENDS,
    GOAL_ENDS,
    LOST,
    MOST,
    NOT_SENT,
    PREEMPTED,
    SUCCEEDED,
    Press,
    Presses,
    end_of,
)
from nao_library_modules.console.wizard.layout import layout_message, read_layout
from nao_library_modules.studies.commands import CommandGoal
from nao_library_modules.studies.robot_events import EventStream
from nao_library_modules.studies.trial_log import read_events

ACCEPTED = "This goal has been accepted by the simple action server"
LIMIT = 60.0


# --- ends of goals ----------------------------------------------------------------------------------------------------


def test_every_end_that_actionlib_knows_is_in_the_table():
    codes = {getattr(GoalStatus, end.state.upper()): end for end in GOAL_ENDS if end.status is not None}
    over = ("PREEMPTED", "SUCCEEDED", "ABORTED", "REJECTED", "RECALLED", "LOST")
    assert codes == ENDS and {*codes} == {getattr(GoalStatus, name) for name in over}
    assert [end.state for end in GOAL_ENDS if not end.failed] == ["succeeded"]
    assert all(end_of(end.state) is end for end in GOAL_ENDS)


def test_the_page_has_the_words_of_the_table():
    words = json.loads(json.dumps(layout_message(read_layout(""))))["words"]
    assert {end.state: end.word for end in GOAL_ENDS if end.failed}.items() <= words.items()


@pytest.fixture
def robot(monkeypatch):
    """A robot whose server does what a test says: `server.goals`, `server.dies()`."""
    monkeypatch.setattr(RobotClient, "now", lambda self: 1.0)
    made = RobotClient("/nao1/", SimpleNamespace())
    server = FakeActionClient(lambda goal: None)
    listeners = []
    impl = SimpleNamespace(connections=[*server.pub_goal.impl.connections], add_subscriber_listener=listeners.append)
    server.pub_goal = SimpleNamespace(impl=impl)

    def dies():
        impl.connections = []
        listeners[0].peer_unsubscribe("goal", 0)

    server.dies = dies
    monkeypatch.setattr("nao_library_modules.console.robots.robot_client.actionlib.ActionClient", lambda *_: server)
    monkeypatch.setattr(made, "_owner_line", lambda server: None)
    made.server = server
    return made


def send(robot):
    return robot.send_goal(CommandGoal("NaoLights", NaoLedAction, NaoLedGoal()), "eva", "Green eyes")


def test_a_goal_whose_server_died_is_lost_and_says_what_died_and_what_to_do(robot):
    run = send(robot)
    robot.server.goals[0].tell(GoalStatus.ACTIVE, text=ACCEPTED)
    robot.server.dies()
    assert run.wait(LIMIT) and run.state == LOST.state
    assert "/nao1/NaoLights died" in run.text and "Look at the robot" in run.text and ACCEPTED not in run.text
    ended = robot.events.last()[-1]
    assert (ended.kind, ended.data["state"], ended.data["reason"]) == ("ended", "lost", run.text)
    assert robot.runs == []


def test_a_goal_of_which_a_server_that_was_started_again_knows_nothing_is_lost_in_our_words(robot):
    run = send(robot)
    robot.server.goals[0].tell(GoalStatus.ACTIVE, text=ACCEPTED)
    robot.server.goals[0].tell()
    assert run.wait(LIMIT) and run.state == LOST.state
    assert "died or was started again" in run.text and ACCEPTED not in run.text


def test_a_goal_that_its_server_had_not_acknowledged_is_lost_with_it(robot):
    run = send(robot)
    robot.server.dies()
    assert run.wait(LIMIT) and run.state == LOST.state


def test_a_goal_that_is_sent_while_its_server_dies_is_lost(robot):
    robot.server.pub_goal.impl.connections[:] = [SimpleNamespace(endpoint_id="/server")]
    robot.server._on_sent = lambda goal: robot.server.dies()
    assert send(robot).wait(LIMIT)


def test_what_a_server_answers_is_what_is_told(robot):
    run = send(robot)
    robot.server.goals[0].tell(GoalStatus.ACTIVE, text=ACCEPTED)
    robot.server.goals[0].end(GoalStatus.ABORTED, "the robot is disconnected")
    assert run.wait(LIMIT) and (run.state, run.text) == ("aborted", "the robot is disconnected")


# --- failed presses ---------------------------------------------------------------------------------------------------


@pytest.fixture
def streams():
    return EventStream("/", lambda: 1.0), EventStream("/nao2/", lambda: 2.0)


@pytest.fixture
def presses():
    return Presses()


def press(label="Hello", by="eva", streams=(), **more):
    return Press(label, by, "/wizard", streams=streams, **more)


def test_a_failed_press_is_told_to_who_pressed_until_that_one_has_looked(presses):
    presses.report(press(), ABORTED, "no voice")
    assert [each.text.split("  ")[1] for each in presses.unseen("eva")] == ["Hello: failed: no voice"]
    assert presses.unseen("bob") == []
    presses.seen("bob")
    (failed,) = presses.unseen("eva")
    presses.seen("eva", failed.id)
    assert presses.unseen("eva") == []


def test_a_press_that_went_well_is_not_told(presses, streams):
    presses.report(press(streams=streams), SUCCEEDED)
    assert presses.unseen("eva") == [] and streams[0].last() == []


def test_a_failed_press_is_in_the_logs_of_the_page_and_of_the_robot_it_is_for(presses, streams):
    presses.report(
        press(streams=(*streams, streams[0]), robot="/nao2/", group="Words"), PREEMPTED, "stopped", goal="g1"
    )
    for stream in streams:
        (event,) = stream.last()
        assert (event.kind, event.by, event.text) == ("failed", "eva", "Hello: stopped: stopped")
        wanted = {"button": "Hello", "group": "Words", "of": "/nao2/", "state": "preempted", "goal": "g1"}
        assert wanted.items() <= event.data.items()


def test_a_failed_press_is_in_the_log_of_the_trial_that_runs(presses, tmp_path):
    trial = Trial(tmp_path).begin()
    presses.report(press(streams=(trial.robot.events,), via="key"), ABORTED, "no voice", goal="g1")
    trial.runner.abort()
    trial.end()
    (event,) = [each for each in read_events(trial.files.trial(trial.runner.id).path) if each["kind"] == "failed"]
    assert (event["stamp"], event["by"], event["data"]["button"]) == (100.0, "eva", "Hello")
    assert (event["data"]["state"], event["data"]["reason"], event["data"]["via"]) == ("aborted", "no voice", "key")


def test_presses_that_fail_alike_are_one_line_with_their_number(presses):
    for _ in range(3):
        presses.report(press(), ABORTED, "no voice")
    presses.report(press(), LOST)
    assert [(each.end, each.count) for each in presses.unseen("eva")] == [(LOST, 1), (ABORTED, 3)]
    assert "failed (3 times): no voice" in presses.unseen("eva")[1].text


def test_who_never_looks_does_not_fill_the_memory(presses):
    for number in range(MOST + 5):
        presses.report(press(f"button {number}"), NOT_SENT)
    unseen = presses.unseen("eva")
    assert len(unseen) == MOST and unseen[0].press.label == f"button {MOST + 4}"


def test_who_listens_is_told_of_a_failure_and_that_it_was_seen(presses):
    told = threading.Semaphore(0)
    end = presses.subscribe(told.release)
    presses.report(press(), ABORTED)
    presses.seen("eva")
    assert told.acquire(timeout=LIMIT) and told.acquire(timeout=LIMIT)
    end()
    presses.report(press(), ABORTED)
    assert not told.acquire(blocking=False)


# --- pages ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("age, done", [(0.0, True), (60.0, False)])
def test_a_page_refuses_what_was_pressed_long_ago_and_says_so(age, done):
    handled, failed = [], []
    page = SimpleNamespace(_handle_event=handled.append, failed=lambda *told: failed.append(told))
    message = {"id": 3, "listener_id": "x", "args": [], "at": console_time() - age, "label": "Send NaoMotion.rest"}
    PageContext._take_event(page, message)
    assert handled == ([message] if done else [])
    assert [label for label, _ in failed] == ([] if done else [message["label"]])


def test_a_page_takes_what_was_typed_however_old_it_is():
    handled = []
    PageContext._take_event(SimpleNamespace(_handle_event=handled.append), {"id": 3, "listener_id": "x", "args": []})
    assert handled


def test_what_a_page_could_not_send_is_in_the_log_and_told_until_it_was_seen(presses, streams):
    told = [
        {"label": "Hello", "group": "Words", "page": "/wizard", "via": "key", "robot": "nao1", "age": 12.3},
        {"label": "Nod", "group": "Words", "page": "/wizard", "robot": "nao1", "of": "nao2", "age": 3, "seen": True},
    ]
    known = {"nao1": SimpleNamespace(events=streams[0])}.get
    for press_, reason, more in unsent_presses(told, Session("eva", OPERATOR), known):
        presses.report(press_, NOT_SENT, reason, **more)
    first, second = streams[0].last()
    assert (first.data["button"], first.data["age"], first.data["via"], first.by) == ("Hello", 12.3, "key", "eva")
    assert (second.data["button"], second.data["of"]) == ("Nod", "/nao2/")
    assert [each.press.place for each in presses.unseen("eva")] == [("/nao1/", "Words", "Hello")]


def test_a_press_that_may_be_lost_is_done_or_told_as_not_sent_and_never_both(presses):
    """Its page does not know whether it has arrived, and tells of it; both come in any order."""
    page = SimpleNamespace(console=SimpleNamespace(presses=presses), handled=[])
    page._handle_event = page.handled.append

    def arrives(press_id):
        PageContext._take_event(page, {"id": 3, "listener_id": "x", "args": [], "press_id": press_id})

    def is_told(press_id):
        told = [{"label": "Note", "press_id": press_id, "doubt": True}]
        return [reason for _, reason, _ in unsent_presses(told, Session("eva", OPERATOR), {}.get, presses.is_new)]

    arrives("first")
    assert is_told("first") == [] and is_told("second") == [BROKEN] and is_told("second") == []
    arrives("second")
    assert [message["press_id"] for message in page.handled] == ["first"]


@pytest.mark.parametrize("told", [None, {}, "x", [3], [None], [{"age": "x"}], [{"age": float("nan"), "label": {}}]])
def test_whatever_a_browser_says_that_it_could_not_send_is_taken(told):
    assert all(more["age"] == 0.0 for _, _, more in unsent_presses(told, Session("eva", OPERATOR), lambda _: None))

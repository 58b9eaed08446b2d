"""States of a robot, as latched topics tell them: what has changed is an event, what is told again is none."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest
from told_robot import ADDRESS, ToldRobot, reported, status, wait_for, watched

from nao_library_modules.console.view.robot_state import (
    ASKED,
    FALLEN,
    FAMILY,
    LATE,
    POSTURE,
    REACHED,
    SILENT_FOR,
    SIMULATION,
    Diagnosis,
    state_of,
    state_text,
)
from nao_library_modules.console.view.senses import SENTENCE, Latched, Senses
from nao_library_modules.core.health import connection_report, recordings_report
from nao_sim_bridge.ros import side
from naoqi.limits import DEFAULT_TIMING

# --- one topic --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "values, news",
    [(["Stand"], [False]), (["Stand", "Stand"], [False, False]), (["Stand", "Sit", "Sit"], [False, True, False])],
)
def test_another_state_is_news_and_the_first_one_is_none(values, news):
    posture = Latched()
    assert [posture.take(value) for value in values] == news


def test_a_fall_counts_each_time_but_not_the_one_that_was_held():
    link = SimpleNamespace(_connection_header={})
    old, none = Latched(repeats=True), Latched(repeats=True)
    old.held = True
    assert [old.take(True, link) for _ in range(3)] == [False, True, True]
    assert none.take(True, link)  # the first fall since the robot was started


def test_what_a_publisher_that_is_back_tells_first_is_a_state():
    fall = Latched(repeats=True)
    news = [fall.take(True, SimpleNamespace(_connection_header=header)) for header in [{}] * 2 + [{"again": 1}] * 2]
    assert news[2:] == [False, True]


# --- a robot ----------------------------------------------------------------------------------------------------------


def test_a_fall_before_anybody_looked_is_no_event_of_now():
    robot = ToldRobot(**{FALLEN: "true"})
    body = watched(robot)
    assert robot.texts == [] and not body.stance.fallen  # it stands: it has got up since


def test_a_robot_that_lies_behind_a_fall_has_fallen_without_an_event():
    robot = ToldRobot(**{FALLEN: "true", FAMILY: "LyingBack", POSTURE: "Unknown"})
    assert watched(robot).stance.fallen and robot.texts == []


def test_a_robot_that_lies_down_by_itself_has_not_fallen():
    robot = ToldRobot()
    body = watched(robot)
    robot.tell(FAMILY, "LyingBack")
    assert not body.stance.fallen


def test_each_fall_is_an_event_and_the_robot_has_fallen_until_it_stands():
    robot = ToldRobot(**{FALLEN: "true"})
    body = watched(robot)
    robot.tell(FALLEN, "true")
    robot.tell(FAMILY, "LyingBelly")
    assert robot.texts == ["has fallen"] and body.stance.fallen
    robot.tell(FAMILY, "Standing")
    assert not body.stance.fallen
    robot.tell(FALLEN, "true")
    assert robot.texts == ["has fallen"] * 2 and body.stance.fallen


@pytest.mark.parametrize("keys", [{}, {FALLEN: "false"}])
def test_the_first_fall_since_the_start_of_the_robot_is_an_event(keys):
    robot = ToldRobot(**keys)
    watched(robot)
    robot.tell(FALLEN, "true")
    assert robot.texts == ["has fallen"]


@pytest.mark.parametrize("driver", [False, True])
@pytest.mark.parametrize("fallen", [False, True])
def test_the_same_state_behind_a_lost_connection_is_no_event(fallen, driver):
    keys = {FALLEN: "true", **({FAMILY: "LyingBack", POSTURE: "Unknown"} if fallen else {})}
    robot = ToldRobot(**keys)
    body = watched(robot)
    robot.stand(True)
    robot.restart(driver)
    robot.stand(True)
    assert robot.texts == [] and body.stance.fallen is fallen
    robot.tell(FALLEN, "true")
    assert robot.texts == ["has fallen"]


def test_a_robot_that_fell_while_it_was_lost_is_known_to_lie():
    robot = ToldRobot()
    body = watched(robot)
    robot.keys.update({FALLEN: "true", FAMILY: "LyingBack", POSTURE: "LyingBack"})
    robot.restart()
    assert body.stance.fallen and robot.texts == ["posture LyingBack"]


def test_a_change_of_posture_or_of_the_ground_is_an_event():
    robot = ToldRobot()
    watched(robot)
    robot.stand(True)
    robot.stand(False)
    robot.tell(POSTURE, "Sit")
    assert robot.texts == ["has lost the ground", "posture Sit"]


def test_what_was_said_before_anybody_listened_or_while_the_robot_was_lost_is_no_news():
    robot = ToldRobot(**{SENTENCE: "Walker online"})
    release = Senses(robot, robot).acquire()
    wait_for(robot, SENTENCE)
    for text in ("Hello", "Hello"):
        robot.tell(SENTENCE, text)
    robot.restart()
    release()
    assert [(event.kind, event.text) for event in robot.events.last()] == [("said", "Hello")] * 2


def test_a_hand_that_is_told_again_by_a_driver_that_is_back_is_no_new_touch():
    robot = ToldRobot()
    Senses(robot, robot).acquire()
    wait_for(robot, SENTENCE)
    press, release = (SimpleNamespace(button=1, state=state) for state in (1, 0))
    robot.callbacks["head_touch"](press)
    robot.connect("connecting")
    robot.callbacks["head_touch"](press)
    robot.connect("connected")
    for told in (release, press):
        robot.callbacks["head_touch"](told)
    assert robot.texts == ["front head pressed", "front head released", "front head pressed"]


# --- how old ----------------------------------------------------------------------------------------------------------


def test_a_state_is_old_when_its_next_report_is_late_or_the_robot_was_not_there_for_it():
    robot = ToldRobot()
    body = watched(robot)
    assert (body.old, body.report_age) == (None, None)
    robot.report(*reported())
    assert body.old is None and body.report_age == 0.0
    robot.time = LATE * body.report_period + 1.0
    assert body.old == robot.time
    robot.report(*reported(stale=True))
    assert body.old == robot.time and body.report_age == 0.0  # old values, told anew
    robot.report(*reported())
    assert body.old is None


@pytest.mark.parametrize("silent, age", [(0.0, None), (1.9, None), (2.5, 2.5)])
def test_the_age_of_the_connection_is_that_of_the_last_answer(silent, age):
    robot = ToldRobot()
    body = watched(robot)
    told = {"latency": 0.1, "silent": silent, "state": "connected", "generation": 1, "last_error": ""}
    report = connection_report(ADDRESS, SimpleNamespace(**told, timing=DEFAULT_TIMING))
    robot.time = 10.0
    robot.report(status("nao_driver: robot", **report.values), status("other", hardware="x", **report.values))
    assert body.unheard == age
    robot.time = 20.0
    assert body.unheard == 10.0 + silent


def test_the_state_of_a_robot_for_a_log_has_what_is_known():
    robot = ToldRobot(**{FALLEN: "true", FAMILY: "LyingBack", POSTURE: "LyingBack"})
    body = watched(robot)
    assert not body.complete and state_of(body)["battery"] is None
    robot.report(*reported(stiffness=0.0, charge=0.155, temperature=70.0))
    state = state_of(body)
    assert body.complete and json.dumps(state)
    assert state["fallen"] and state["limp"] and (state["battery"], state["hot"]) == (15.5, ["HeadYaw"])
    assert state_text(state) == "connected, posture LyingBack, fallen, limp, battery 15.5 %, hot: HeadYaw"


# --- what else is reported --------------------------------------------------------------------------------------------


def test_what_the_simulator_reports_of_its_speed_is_read():
    assert (side.STATUS_NAME, side.ASKED, side.REACHED) == (SIMULATION, ASKED, REACHED)
    diagnosis = Diagnosis()
    diagnosis.take([status(SIMULATION, **{ASKED: "1", REACHED: "0.8"})], ADDRESS, 3.0)
    assert (diagnosis.speed.asked, diagnosis.speed.reached) == (1.0, 0.8)
    diagnosis.take([status(SIMULATION)], ADDRESS, 4.0)
    assert diagnosis.speed is None  # its time stands still


def test_the_reached_speed_is_measured_between_looks_at_the_same_asked_speed():
    meter = side.SpeedMeter()
    looks = [(0.0, 0.0, 1.0), (1.0, 0.8, 1.0), (2.0, 1.0, None), (3.0, 1.0, 1.0), (4.0, 2.0, 1.0), (5.0, 4.0, 2.0)]
    assert [meter.reached(*look) for look in looks] == [None, 0.8, None, None, 1.0, None]


def test_a_server_that_waited_in_vain_takes_back_that_the_robot_has_answered():
    diagnosis = Diagnosis()
    for silent, now in ((0.0, 1.0), (0.0, 2.0), (1.9, 3.0)):
        values = {"state": "silent" if silent else "connected", SILENT_FOR: str(silent)}
        diagnosis.take([status("NaoLights: NaoLights robot", **values)], ADDRESS, now)
    assert diagnosis.answered == pytest.approx(1.1)
    diagnosis.take([status("NaoMotion: NaoMotion robot", state="connected", **{SILENT_FOR: "0.0"})], ADDRESS, 3.5)
    assert diagnosis.answered == 3.5


def test_what_servers_record_is_read_of_the_robot_that_they_serve():
    diagnosis = Diagnosis()
    values = recordings_report(["b", "a"]).values
    diagnosis.take([status("nao_vision: NaoVision recordings", **values)], ADDRESS, 1.0)
    diagnosis.take(
        [status("nao_vision: NaoVision recordings", hardware="x", **recordings_report([]).values)], ADDRESS, 2.0
    )
    told = diagnosis.recordings["NaoVision"]
    assert (told.names, told.heard) == ({"a", "b"}, 1.0)

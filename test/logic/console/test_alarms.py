"""Alarms: when they begin and end, what is in the log of a trial, and what the documents say of them."""

from __future__ import annotations

import math
import re
from functools import partial
from pathlib import Path

import pytest
from played_study import PlayedRobot, Trial
from told_robot import ToldRobot, reported, status, watched

from nao_library_modules.console.pages.robot_page import aged
from nao_library_modules.console.view import alarms as watch_module
from nao_library_modules.console.view.alarms import (
    BATTERY_MARGIN,
    CODES,
    LEAST_DISK,
    LOST,
    LOWEST_BATTERY,
    PATIENCE,
    RULES,
    SILENCE,
    SLOW_FOR,
    AlarmBook,
    AlarmWatch,
    Facts,
    TrialFacts,
)
from nao_library_modules.console.view.robot_state import (
    ASKED,
    FALLEN,
    FAMILY,
    REACHED,
    SIMULATION,
    BodyWatch,
    ServerRecordings,
)
from nao_library_modules.console.watched_studies import watch_trial
from nao_library_modules.studies import studies as module
from nao_library_modules.studies import trial_recordings as recordings_module
from nao_library_modules.studies.protocol import WantedRecordings
from nao_library_modules.studies.studies import Studies
from nao_library_modules.studies.study_table import table_of
from nao_library_modules.studies.trial_log import read_events
from nao_library_modules.studies.trial_recordings import BEGUN_AFTER, GONE_AFTER, TrialRecordings

DOCUMENT = Path(__file__).resolve().parents[3] / "docs" / "console.md"
WELL = {
    "connection": "connected",
    "silence": 0.1,
    "report_age": 0.1,
    "charge": 80.0,
    "hot": (),
    "limp": False,
    "fallen": False,
    "free": 10 * LEAST_DISK,
}
"""Facts of a robot of which all is known."""


def codes(*facts):
    """Codes of the alarms behind some looks, a second apart."""
    book = AlarmBook()
    for now, more in enumerate(facts):
        book.look(Facts(float(now), **{**WELL, **more}), 1000.0 + now)
    return [alarm.code for alarm in book.alarms]


# --- the rules --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "facts, code",
    [
        ({"fallen": True}, "fallen"),
        ({"limp": True, "should_stand": True}, "limp"),
        ({"connection": "lost"}, "connection"),
        ({"connection": "closed"}, "connection"),
        ({"connection": "silent", "silence": SILENCE + 0.1}, "connection"),
        ({"connection": "", "watched": PATIENCE + 1.0}, "connection"),
        ({"report_age": LOST + 0.1}, "old_reports"),
        ({"charge": LOWEST_BATTERY - 0.1}, "battery"),
        ({"hot": ("LKneePitch",)}, "hot_joint"),
        ({"stopped": {"bag": "gone"}}, "recorder_bag"),
        ({"stopped": {"video": "gone"}}, "recorder_video"),
        ({"stopped": {"sound": "gone"}}, "recorder_sound"),
        ({"log": "no room"}, "log"),
        ({"free": LEAST_DISK - 1}, "disk"),
    ],
)
def test_an_alarm_begins(facts, code):
    assert codes({}, facts) == [code]
    assert codes({}, facts, {}) == []


@pytest.mark.parametrize(
    "facts",
    [
        {},
        {"limp": True},  # it rests
        {"charge": 5.0, "charging": True},
        {"charge": LOWEST_BATTERY},
        {"silence": SILENCE},
        {"connection": "", "watched": PATIENCE},
        {"charge": math.nan, "hot": None, "limp": None, "fallen": None, "free": None},
        {"speed": (math.inf, 0.5)},
    ],
)
def test_there_is_no_alarm(facts):
    assert codes({}, facts, facts, facts, facts) == []


def test_a_simulation_is_too_slow_when_it_is_so_for_a_while():
    slow = {"speed": (2.0, 1.7)}
    looks = [slow] * round(SLOW_FOR)
    assert codes({}, *looks) == [] and codes({}, *looks, slow) == ["slow_simulation"]
    assert codes({}, *looks, slow, {"speed": (2.0, 1.92)}) == ["slow_simulation"]  # not yet as it should be
    assert codes({}, *looks, slow, {"speed": (2.0, 2.0)}) == codes({}, *looks, slow, {}) == []


def test_a_charge_that_flickers_is_one_alarm():
    low, more = {"charge": LOWEST_BATTERY - 0.1}, {"charge": LOWEST_BATTERY + 0.1}
    assert codes({}, low, more) == ["battery"]
    assert codes({}, low, more, {"charge": LOWEST_BATTERY + BATTERY_MARGIN}) == []


def test_what_is_not_known_ends_no_alarm():
    assert codes({}, {"fallen": True}, {"fallen": None}) == ["fallen"]


def test_what_was_so_at_the_first_look_has_not_begun():
    book, facts = AlarmBook(), Facts(0.0, **{**WELL, "fallen": True, "charge": math.nan})
    assert book.look(facts, 1000.0) == ([], [])
    assert [(alarm.code, alarm.since, alarm.found) for alarm in book.alarms] == [("fallen", 1000.0, True)]
    begun, ended = book.look(Facts(1.0, **{**WELL, "hot": ("HeadYaw",)}), 1001.0)
    assert [[alarm.code for alarm in each] for each in (begun, ended)] == [["hot_joint"], ["fallen"]]


def test_an_alarm_that_goes_on_keeps_its_words_and_its_begin():
    book, shown = AlarmBook(), []
    for now, charge in enumerate((80.0, 19.0, 18.0, 17.0)):
        book.look(Facts(float(now), **{**WELL, "charge": charge}), 1000.0 + now)
        shown.append(book.alarms)
    assert shown[1] == shown[2] == shown[3] and [alarm.since for alarm in shown[3]] == [1001.0]


def test_the_document_says_of_each_alarm_what_it_means_and_what_to_do():
    documented = re.findall(r"^\| `(\w+)` \| .+ \| .+ \|$", DOCUMENT.read_text(encoding="utf-8"), re.MULTILINE)
    assert [code for code in documented if code in CODES] == list(CODES)
    assert all(rule.action.endswith(".") for rule in RULES)


# --- the watch --------------------------------------------------------------------------------------------------------


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    monkeypatch.setattr(module, "ros_after", lambda seconds, callback: lambda: None)
    monkeypatch.setattr(watch_module, "free_bytes", lambda folder: 10 * LEAST_DISK)


class LookedAt(AlarmWatch):
    """A watch that looks when a test says so."""

    def _run(self, over):
        pass


def watch_of(robot, tmp_path):
    body = watched(robot)
    robot.report(*reported())
    watch = LookedAt(robot, body, tmp_path, robot.clock)
    watch.acquire()
    watch.look()
    return watch


def alarms_in(robot):
    return [(e.data["what"], e.data["code"]) for e in robot.events.last() if e.kind == "alarm"]


def test_each_begin_and_end_of_an_alarm_is_one_event(tmp_path):
    robot = ToldRobot()
    watch = watch_of(robot, tmp_path)
    robot.tell(FALLEN, "true")
    for _ in range(3):
        watch.look()
    robot.tell(FAMILY, "Standing")
    watch.look()
    assert alarms_in(robot) == [("began", "fallen"), ("ended", "fallen")]


def test_a_robot_that_goes_limp_while_it_stands_is_an_alarm_and_one_that_rests_is_none(tmp_path):
    robot = ToldRobot()
    watch = watch_of(robot, tmp_path)
    robot.report(*reported(stiffness=0.0))
    watch.look()
    assert [alarm.code for alarm in watch.alarms] == ["limp"]
    robot.report(*reported(stiffness=1.0))
    robot.tell(FAMILY, "Crouching")
    robot.report(*reported(stiffness=0.0))
    watch.look()
    assert watch.alarms == ()


def test_a_joint_is_hot_by_the_limit_of_the_driver(tmp_path):
    robot = ToldRobot()
    watch = watch_of(robot, tmp_path)
    robot.report(*reported(temperature=68.0))
    watch.look()
    assert [alarm.what for alarm in watch.alarms] == ["Hot joints: HeadYaw"]


def test_the_speed_of_a_simulator_that_is_gone_is_no_alarm(tmp_path):
    robot = ToldRobot()
    watch = watch_of(robot, tmp_path)
    for second in range(10):
        robot.time = float(second)
        robot.report(*reported(), status(SIMULATION, **{ASKED: "1", REACHED: "0.8"}))
        watch.look()
    assert [alarm.code for alarm in watch.alarms] == ["slow_simulation"]
    robot.time += 5.0
    robot.report(*reported())
    watch.look()
    assert watch.alarms == ()


def test_nothing_is_followed_before_somebody_wants_it_and_after(tmp_path):
    robot = ToldRobot()
    watch = AlarmWatch(robot, BodyWatch(robot, robot, robot.clock), tmp_path, robot.clock)
    assert robot.callbacks == {}
    watch.acquire()()
    assert watch.alarms == () and watch.body.status.joints == {}


def test_a_state_that_is_old_says_so():
    assert aged("Low (25 % left)", None) == "Low (25 % left)" and aged("Low (25 % left)", 12.3).endswith("12 s ago")


# --- recordings -------------------------------------------------------------------------------------------------------


def test_a_recording_that_stops_by_itself_is_told_and_one_that_is_ended_is_not(tmp_path, monkeypatch):
    monkeypatch.setattr(recordings_module, "is_bag", lambda file, about: about["pid"] == 1)
    recordings = TrialRecordings(tmp_path, WantedRecordings())
    running = {"bag": {"file": "trial.bag", "pid": 1}, "video": {}, "sound": {}}
    told = lambda now, video=("P01",): {"NaoVision": ServerRecordings(frozenset(video), now)}  # noqa: E731
    assert recordings.stopped(running, told(0.0, ()), 0.0) == {}  # its begin is not reported yet
    now = BEGUN_AFTER + 1.0
    assert recordings.stopped(running, told(now), now) == {}
    assert set(recordings.stopped(running, told(now, ()), now)) == {"video"}
    assert set(recordings.stopped(running, told(now), now + GONE_AFTER + 1.0)) == {"video"}
    again = {"NaoVision": ServerRecordings(frozenset({"P01"}), now, "2.0")}
    assert set(recordings.stopped(running, again, now)) == {"video"}
    running["bag"]["pid"] = 2
    assert set(recordings.stopped(running, told(now), now)) == {"bag"}
    recordings.end(Trial(tmp_path).begin().runner)
    assert recordings.stopped(running, told(now), now) == {}


# --- a trial ----------------------------------------------------------------------------------------------------------


class BothRobots(PlayedRobot, ToldRobot):
    """Plays goals, and tells states."""

    def __init__(self, **keys):
        ToldRobot.__init__(self, **keys)
        PlayedRobot.__init__(self)


def watched_trial(folder, robot):
    trial = Trial(folder, robot)
    watch = watch_of(robot, folder)
    trial.studies = Studies(trial.files, watch=partial(watch_trial, watch))
    return trial, watch


def logged(trial):
    return read_events(trial.files.trials(trial.protocol.name)[-1].path)


def test_a_trial_logs_how_the_robot_is_and_not_what_happened_before(tmp_path):
    robot = BothRobots(**{FALLEN: "true", FAMILY: "LyingBack", "PostureChanged": "LyingBack"})
    trial, watch = watched_trial(tmp_path, robot)
    trial.begin().at("2.1")
    watch.look()
    trial.runner.abort()
    trial.end()
    events = logged(trial)
    assert [event["kind"] for event in events[:2]] == ["trial", "state"]
    assert [event["kind"] for event in events].count("state") == 1
    assert not [event for event in events if event["kind"] in ("felt", "alarm")]
    state = events[1]["data"]
    assert state["fallen"] and state["posture"] == "LyingBack" and state["alarms"] == ["fallen"]


def test_the_table_of_trials_has_the_state_at_the_begin_and_how_many_alarms_began(tmp_path):
    robot = BothRobots()
    trial, watch = watched_trial(tmp_path, robot)
    trial.begin().at("2.1")
    robot.tell(FALLEN, "true")
    watch.look()
    trial.runner.abort()
    trial.end()
    assert [event["text"] for event in logged(trial) if event["kind"] == "alarm"] == ["The robot has fallen"]
    (row,) = table_of(trial.files, trial.protocol.name).trials
    told = {name: row[name] for name in ("begin_posture", "begin_fallen", "begin_limp", "begin_battery", "alarms")}
    assert told == {
        "begin_posture": "Stand",
        "begin_fallen": False,
        "begin_limp": False,
        "begin_battery": 80.0,
        "alarms": 1,
    }


def test_a_state_that_is_not_told_in_time_is_logged_as_far_as_it_is_known(tmp_path, monkeypatch):
    monkeypatch.setattr("nao_library_modules.console.watched_studies.PATIENCE", -1.0)
    robot = BothRobots()
    trial = Trial(tmp_path, robot)
    watch = LookedAt(robot, watched(robot), tmp_path, robot.clock)
    trial.studies = Studies(trial.files, watch=partial(watch_trial, watch))
    trial.begin().at("2.1")
    watch.look()
    robot.report(*reported(charge=0.1))
    watch.look()
    watch.look()
    trial.runner.abort()
    trial.end()
    states = [event["data"] for event in logged(trial) if event["kind"] == "state"]
    assert [each.get("battery") for each in states] == [None, None] and states[1]["alarms"] == ["battery"]


def test_a_log_that_cannot_be_written_and_a_recorder_that_stopped_are_alarms_of_the_robot(tmp_path):
    robot = ToldRobot()
    watch = watch_of(robot, tmp_path)
    end = watch.follow(lambda recorded, now: TrialFacts({"bag": "its process has ended"}, "no room"), lambda: None)
    watch.look()
    assert [alarm.code for alarm in watch.alarms] == ["recorder_bag", "log"]
    end()
    watch.look()
    assert alarms_in(robot)[-1] == ("ended", "log")

"""Goals of NaoTactile: what the robot feels, waiting for it, and behaviours that a touch starts."""

from __future__ import annotations

import math
import threading
from collections import defaultdict

import pytest
from goal_functions import tactile as f
from sensor_msgs.msg import BatteryState

from nao_library_actions.msg import NaoTactileGoal
from nao_library_modules.core.files import Kept
from nao_library_modules.tactile.readings import Senses
from nao_library_modules.tactile.tactile_fields import CLICKS
from nao_library_modules.tactile.tactile_server import NaoTactile
from nao_library_modules.tactile.touch_bindings import TouchBindings
from nao_library_msgs.msg import TactileFunction

FRONT, MIDDLE, REAR = (f"Head/Touch/{place}" for place in ("Front", "Middle", "Rear"))
CHEST, LEFT_BUMPER, HAND = "ChestBoard/Button", "LFoot/Bumper/Left", "RHand/Touch/Back"
WALL = "{name: wall, box: [0.1, 2.0, 2.0], position: [%g, 0.0, 1.0]}"
HELLO = TactileFunction(function="onTouch", sensors=["head"], behavior="hello", parameters=["text=Hi"])
SLACK = 0.8
"""Simulated time that the way of an event takes on a busy computer, s."""


class Runner:
    """Runs behaviours as long as the test wants."""

    def __init__(self):
        self.runs, self.ends = [], []
        self.closed = False
        self.started = threading.Semaphore(0)

    def run(self, behavior, parameters, done):
        self.started.release()
        self.runs.append((behavior, list(parameters)))
        self.ends.append(done)

    def close(self):
        self.closed = True


@pytest.fixture
def runner():
    return Runner()


@pytest.fixture
def tactile(goals_to, runner):
    return goals_to(NaoTactile, NaoTactileGoal, runner=runner)


@pytest.fixture
def press(robot):
    def press(*sensors, duration=0.1):
        """Press these sensors and no others for a while."""
        robot.NaoSimulation.press(list(sensors))
        robot.advance(duration)

    return press


@pytest.fixture
def tap(press):
    def tap(sensor):
        press(sensor)
        press()

    return tap


@pytest.fixture
def truth(robot):
    """Simulated times, s, at which the physics had a sensor begin and end to be pressed: name -> [begin, end, ...]."""
    times, before = defaultdict(list), set()

    def look(snapshot):
        for name in snapshot.touched ^ before:
            times[name].append(snapshot.time)
        before.clear()
        before.update(snapshot.touched)

    robot.server.simulation.after_tick.append(look)
    return times


@pytest.fixture
def idle(robot):
    """The sonars measure for nobody."""
    return lambda: robot.ALSonar.getSubscribersInfo() == []


def test_what_is_touched_is_read(tactile, press):
    press(REAR, "LFoot/Bumper/Right", HAND)
    result = tactile.succeed(
        f("getTouched"), f("getBumpers"), f("getTouched", sensors=["head"]), f("getTouched", sensors=["chest"])
    )
    assert [each.values for each in result.results] == [
        ["rear head", "right hand back", "left bumper"], ["left bumper"], ["rear head"], [],
    ]  # fmt: skip
    assert result.touched == result.memList


def test_sonars_measure_for_a_reading_only_and_silence_is_infinitely_far(robot, tactile, idle):
    result = tactile.succeed(f("getSonar"))
    assert (result.sonar_names, list(result.sonar)) == (["left", "right"], [math.inf, math.inf])
    assert idle()
    robot.NaoSimulation.placeObject(WALL % 0.7)
    tactile.succeed(f("setSonarEnabled", enable=True))
    assert len(robot.ALSonar.getSubscribersInfo()) == 1
    tactile.succeed(f("setSonarEnabled", enable=False))
    result = tactile.succeed(f("getSonar", sensors=["right"]))
    assert result.sonar_names == ["right"] and 0.45 < result.sonar[0] < 0.75 and idle()


def test_weights_of_the_feet_have_names(robot, tactile):
    robot.advance(0.5)
    result = tactile.succeed(f("getFsr"))
    corners = [f"left foot {corner}" for corner in ("front left", "front right", "rear left", "rear right")]
    assert result.fsr_names[:5] == [*corners, "left foot"] and len(result.fsr_names) == 10
    assert sum(result.fsr[:4]) == pytest.approx(result.fsr[4], abs=0.05)
    assert result.fsr[4] + result.fsr[9] == pytest.approx(5.4, abs=0.5)
    assert tactile.succeed(f("getFsr", sensors=["right foot"])).fsr_names == result.fsr_names[5:]


def test_the_battery_is_a_message(robot, tactile):
    for charge, plugged, status in (
        (0.8, False, BatteryState.POWER_SUPPLY_STATUS_DISCHARGING),
        (0.5, True, BatteryState.POWER_SUPPLY_STATUS_CHARGING),
        (1.0, True, BatteryState.POWER_SUPPLY_STATUS_FULL),
    ):
        robot.NaoSimulation.setBatteryCharge(charge)
        robot.NaoSimulation.plugCharger(plugged)
        robot.advance(1.0)
        result = tactile.succeed(f("getBattery"))
        (battery,) = result.battery
        assert battery.percentage == pytest.approx(charge, abs=0.01) and battery.present
        assert battery.power_supply_status == status, charge
        assert 15.0 < battery.voltage < 30.0 and (charge == 1.0 or (battery.current > 0.0) is plugged)
        assert float(result.memList[0]) == pytest.approx(battery.percentage)


def test_temperatures_of_joints_chains_and_computers(robot, tactile):
    robot.NaoSimulation.setTemperature("HeadPitch", 86.0)
    robot.advance(0.1)
    result = tactile.succeed(f("getTemperatures", sensors=["Head", "battery"]))
    assert result.devices == ["HeadYaw", "HeadPitch", "battery"]
    assert result.temperatures[1] == pytest.approx(86.0, abs=0.5) and 15.0 < result.temperatures[2] < 60.0
    assert result.heat[0] == result.heat[2] == 0 < result.heat[1]
    everything = tactile.succeed(f("getTemperatures"))
    assert len(everything.devices) == 28 and everything.devices[-2:] == ["head", "battery"]
    assert tactile.succeed(f("getTemperatures", sensors=["head"])).devices == ["head"]
    assert "did you mean 'Head'" in tactile.refused(f("getTemperatures", sensors=["Heed"]))


def test_a_wait_ends_with_its_touch_and_with_no_other(robot, tactile, tap, press):
    goal = tactile.send(f("waitForTouch", sensors=["head", "chest"], timeout=60.0))
    robot.advance(0.3)
    tap(LEFT_BUMPER)
    assert goal.active
    press(MIDDLE)
    goal.finish()
    assert goal.result.touched == goal.result.memList == ["middle head"]
    assert (goal.feedback[-1].status, goal.feedback[-1].touched) == ("waiting", ["middle head"])


def test_releases_holds_and_counts(robot, tactile, press, tap):
    def wait(*taps, **fields):
        goal = tactile.send(f("waitForTouch", **{"timeout": 4.0, **fields}))
        robot.advance(0.3)
        for sensors, duration in taps:
            press(*sensors, duration=duration)
        return goal.finish().result

    press(CHEST)
    assert wait(([], 0.1), sensors=["chest"], touch="release").touched == ["chest"]
    held = wait(([HAND], 0.1), sensors=["right hand"], touch="hold", duration=1.5)
    assert held.touched == ["right hand back"] and 1.5 <= held.results[0].elapsed.to_sec() < 1.8 + SLACK
    press()
    short = wait(([HAND], 0.5), ([], 0.1), touch="hold", duration=1.5)
    assert short.touched == [] and 4.0 <= short.results[0].elapsed.to_sec() < 4.0 + SLACK
    three = [step for _ in range(3) for step in (([FRONT], 0.1), ([], 0.1))]
    assert wait(*three, touch="count", count=3).touched == ["front head"]


def seconds(*times):
    return [time.to_sec() for time in times]


def test_results_and_feedback_have_the_times_of_contact(robot, tactile, press, truth):
    def wait(*taps, **fields):
        truth.clear()
        goal = tactile.send(f("waitForTouch", timeout=8.0, **fields))
        robot.advance(0.3)
        for sensors, duration in taps:
            press(*sensors, duration=duration)
        result = goal.finish().result
        (one,) = result.results
        return goal.feedback, seconds(*result.touch_times), seconds(one.onset, one.offset)

    feedback, first, times = wait(([MIDDLE], 0.2), ([], 0.1))
    begin, end = truth[MIDDLE]
    assert [*first, *times] == pytest.approx([begin, begin, 0.0], abs=0.010)
    assert seconds(feedback[-1].stamp) == pytest.approx([begin], abs=0.010)
    _, first, times = wait(([FRONT], 0.4), ([], 0.1), touch="release")
    assert [*first, *times] == pytest.approx([truth[FRONT][0], *truth[FRONT]], abs=0.010)
    _, first, times = wait(([HAND], 1.8), ([], 0.1), touch="hold", duration=1.5)
    assert [*first, *times] == pytest.approx([truth[HAND][0], truth[HAND][0], 0.0], abs=0.010)
    _, first, times = wait(([REAR], 0.2), ([], 0.2), ([CHEST], 0.2), ([], 0.1), touch="count", count=2)
    assert [*first, *times] == pytest.approx([truth[REAR][0], truth[CHEST][0], truth[REAR][0], 0.0], abs=0.010)


def test_a_touch_that_began_before_the_wait_has_its_startup_grace(robot, tactile, press, truth):
    press(FRONT, duration=0.6)
    before = truth[FRONT][0]
    (since,) = seconds(*tactile.succeed(f("getTouched")).touch_times)
    assert since == pytest.approx(before, abs=0.010)
    hold = tactile.succeed(f("waitForTouch", touch="hold", duration=1.0))
    assert 1.0 <= hold.results[0].elapsed.to_sec() < 1.0 + SLACK, "it is held from now on"
    assert seconds(hold.results[0].onset) == pytest.approx([before], abs=0.010)
    goal = tactile.send(f("waitForTouch", touch="release", timeout=8.0))
    robot.advance_until(lambda: "waiting" in [told.status for told in goal.feedback], 5.0)
    press()
    (release,) = goal.finish().result.results
    assert seconds(release.onset, release.offset) == pytest.approx(truth[FRONT], abs=0.010)


def test_the_contact_is_that_of_the_first_touch_however_late_the_robot_is_asked(
    robot, tactile, press, truth, monkeypatch
):
    asked, event_time = threading.Event(), Senses.event_time
    monkeypatch.setattr(Senses, "event_time", lambda senses, event: asked.wait(60.0) and event_time(senses, event))
    goal = tactile.send(f("waitForTouch", timeout=60.0))
    robot.advance(0.3)
    for touched in ([MIDDLE], [], [MIDDLE]):
        press(*touched)
    asked.set()
    (one,) = goal.finish().result.results
    assert seconds(one.onset) == pytest.approx(truth[MIDDLE][:1], abs=0.010)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_clicks_have_first_and_last_contact_however_late_they_are_told(robot, tactile, press, truth, count):
    clicked = []
    robot.server.memory.listen(CLICKS[count], lambda _: clicked.append(robot.now.time))
    goal = tactile.send(f("waitForChestButton", count=count, timeout=8.0))
    robot.advance(0.3)
    for _ in range(count):
        press(CHEST, duration=0.15)
        press(duration=0.15)
    (one,) = goal.finish().result.results
    first, last = truth[CHEST][0], truth[CHEST][-1]
    assert seconds(one.onset, one.offset) == pytest.approx([first, last], abs=0.010)
    # Another click might follow one or two of them, so the robot waits; how late its event comes is up to the computer.
    assert clicked == pytest.approx([last + (0.5 if count < 3 else 0.0)], abs=0.010)
    assert one.end.to_sec() > clicked[0] - 0.010


def test_a_binding_knows_the_first_contact_of_the_touch_that_started_it(tactile, press, truth, runner, started):
    tactile.succeed(f("onTouch", sensors=["head"], touch="release", behavior="nod"))
    press(FRONT, duration=0.5)
    press()
    started()
    (binding,) = tactile.succeed(f("listOnTouch")).bindings
    assert seconds(binding.touched) == pytest.approx(truth[FRONT][:1], abs=0.010)


def test_a_binding_knows_it_however_late_the_robot_is_asked(tactile, press, truth, runner, started, monkeypatch):
    asked, time_of = threading.Event(), TouchBindings._time_of
    monkeypatch.setattr(TouchBindings, "_time_of", lambda links, event: asked.wait(60.0) and time_of(links, event))
    tactile.succeed(f("onTouch", sensors=["head"], behavior="nod"))
    for touched in ([FRONT], [], [FRONT]):
        press(*touched)
    asked.set()
    started()
    (binding,) = tactile.succeed(f("listOnTouch")).bindings
    assert seconds(binding.touched) == pytest.approx(truth[FRONT][:1], abs=0.010)


def test_an_obstacle_comes_near(robot, tactile, idle):
    robot.NaoSimulation.placeObject(WALL % 1.5)
    goal = tactile.send(f("waitForObstacle", distance=0.8, timeout=20.0))
    robot.advance(1.5)
    assert goal.active and len(robot.ALSonar.getSubscribersInfo()) == 1
    moved = robot.now.time
    robot.NaoSimulation.moveObject("wall", [0.7, 0.0, 1.0], [0.0, 0.0, 0.0], 0.0)
    result = goal.finish().result
    assert 0.0 <= result.results[0].onset.to_sec() - moved < 0.22, "it measures, and is asked, every 0.1 s"
    assert set(result.sonar_names) == set(result.memList) == {"left", "right"} and idle()
    assert all(0.45 < metres < 0.75 for metres in result.sonar)
    assert (
        goal.feedback[-1].sonar == result.sonar and min(next(told.sonar for told in goal.feedback if told.sonar)) > 0.8
    )


def test_a_fall(robot, tactile):
    goal = tactile.send(f("waitForFall", timeout=60.0))
    robot.advance(0.2)
    fallen = robot.now.time
    robot.ALMemory.raiseEvent("robotHasFallen", True)
    assert goal.finish().result.fell is True
    assert seconds(goal.result.results[0].onset) == pytest.approx([fallen], abs=0.010)
    assert goal.result.memList == ["True"]


def test_nothing_in_time_is_an_answer_and_a_cancel_leaves_nothing(robot, tactile, idle):
    began = robot.now.time
    goal = tactile.play(
        f("waitForTouch", timeout=0.5), f("waitForFall", timeout=0.5), f("waitForObstacle", timeout=0.5)
    )
    assert (goal.result.touched, goal.result.fell, goal.result.memList) == ([], False, ["False"])
    assert goal.state == "succeeded" and [text.partition(": ")[2] for text in goal.text.split("; ")] == [
        "no touch within 0.5 s", "no fall within 0.5 s", "nothing nearer than 0.5 m within 0.5 s"
    ]  # fmt: skip
    assert robot.now.time - began == pytest.approx(1.5, abs=0.6) and idle()
    for function in ("waitForTouch", "waitForChestButton", "waitForObstacle", "waitForFall"):
        goal = tactile.send(f(function, timeout=100.0))
        robot.advance(0.3)
        assert goal.cancel().state == "preempted" and idle()


REFUSED = [
    (f("waitForTouch", sensors=["nose"]), "nothing that can be touched"),
    (f("waitForTouch", touch="stroke"), "press, release, hold, count"),
    (f("waitForTouch", touch="count", count=21), "0..20"),
    (f("waitForTouch", timeout=-1.0), "0..3600 s"),
    (f("waitForChestButton", count=4), "0..3"),
    (f("waitForObstacle", distance=3.0), "0.1..2.5 m"),
    (f("getSonar", sensors=["rear"]), "left, right"),
    (f("getBumpers", sensors=["chest"]), "chest is no bumper"),
    (f("getFsr", sensors=["left hand"]), "left foot, right foot"),
    (f("onTouch"), "the name of a stored behaviour"),
    (f("onTouch", behavior="hello", cooldown=-1.0), "0..3600 s"),
]


def test_what_makes_no_sense_is_refused_before_anything_begins(tactile, idle):
    for function, text in REFUSED:
        refusal = tactile.refused(f("setSonarEnabled", enable=True), function)
        assert refusal.startswith("function 2") and text in refusal
        assert idle(), function


@pytest.fixture
def started(runner):
    """Waits for the next start."""
    return lambda: runner.started.acquire(timeout=60.0) or pytest.fail("nothing was started")


def test_a_touch_starts_its_behaviour_each_time(tactile, tap, runner, started):
    result = tactile.succeed(HELLO)
    assert result.memList == ["hello"]
    (binding,) = result.bindings
    assert binding.sensors == ["front head", "middle head", "rear head"]
    assert (binding.touch, binding.behavior, binding.parameters) == ("press", "hello", ["text=Hi"])
    for count in (1, 2):
        tap(FRONT)
        started()
        (binding,) = tactile.succeed(f("listOnTouch")).bindings
        assert (binding.runs, binding.running) == (count, True)
        runner.ends[-1]("succeeded", "")
    assert runner.runs == [("hello", ["text=Hi"])] * 2
    (binding,) = tactile.succeed(f("listOnTouch")).bindings
    assert (binding.runs, binding.running, binding.last) == (2, False, "succeeded")


def test_links_of_a_server_that_died_are_there_again_in_the_next(goals_to, tap, tmp_path):
    first, second = Runner(), Runner()
    link = f("onTouch", sensors=["head"], touch="press", behavior="hello", parameters=["text=Hi"], cooldown=1.0)
    tactile = goals_to(NaoTactile, NaoTactileGoal, runner=first, kept=Kept(tmp_path / "kept.json", "run"))
    (before,) = tactile.succeed(link).bindings
    tactile.succeed(f("onTouch", sensors=["chest"], behavior="bow"), f("removeOnTouch", str_param="bow"))
    tactile = goals_to(NaoTactile, NaoTactileGoal, runner=second, kept=Kept(tmp_path / "kept.json", "run"))
    (after,) = tactile.succeed(f("listOnTouch")).bindings
    assert after == before
    tap(FRONT)
    assert second.started.acquire(timeout=60.0)
    assert second.runs == [("hello", ["text=Hi"])]


def test_touches_while_it_runs_and_cools_down_do_not_count(robot, tactile, tap, runner, started):
    tactile.succeed(
        f("onTouch", sensors=["chest"], behavior="bow", cooldown=5.0), f("onTouch", sensors=["head"], behavior="nod")
    )
    tap(CHEST)
    started()
    tap(CHEST)  # it still runs
    runner.ends[0]("succeeded", "")
    tap(CHEST)  # it has just ended
    tap(FRONT)  # touches are followed in their order
    started()
    assert [name for name, _ in runner.runs] == ["bow", "nod"]
    robot.advance(5.0)
    tap(CHEST)
    started()
    assert runner.runs[-1][0] == "bow"


def test_a_binding_is_replaced_and_removed(tactile, tap, runner, started):
    tactile.succeed(HELLO, f("onTouch", str_param="left", sensors=["left bumper"], behavior="nod"))
    tactile.succeed(f("onTouch", str_param="hello", sensors=["rear head"], behavior="bow"))
    tap(FRONT)
    tap(REAR)
    started()
    assert runner.runs == [("bow", [])]
    assert tactile.succeed(f("removeOnTouch", str_param="hello"), f("listOnTouch")).memList == ["left"]
    tap(REAR)
    tap(LEFT_BUMPER)
    started()
    assert runner.runs[1:] == [("nod", [])]
    tactile.succeed(HELLO, f("removeOnTouch", str_param="hello"), f("removeOnTouch"))
    assert tactile.succeed(f("listOnTouch")).memList == []

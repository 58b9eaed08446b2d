"""Joints, sensors of the body, memory, touch and lights, as the driver asks the robot."""

from __future__ import annotations

import math
import random
from types import SimpleNamespace

import pytest

from nao_library_modules.core.errors import BadGoal, Preempted
from nao_library_modules.core.joint_trajectory import H25_BODY
from nao_library_modules.core.nao_facts import SONARS as SONAR_KEYS
from nao_library_modules.core.waiting import CancellationToken
from nao_library_modules.driver.base import lazy_subscription
from nao_library_modules.driver.joints.joint_controller import JointController
from nao_library_modules.driver.joints.joint_sensors import JointSensors
from nao_library_modules.driver.life.nao_leds import Blinks, blink, fade
from nao_library_modules.driver.memory.memory_rules import MemoryAccess, MemoryRule
from nao_library_modules.driver.memory.memory_watch import MemoryWatch
from nao_library_modules.driver.sensors.nao_sonar import Sonars
from nao_library_modules.driver.sensors.nao_tactile import BUMPER, FEET, HAND, HEAD, TouchSensors
from nao_library_modules.ros.action_server import Replaced
from naoqi.errors import NaoError

CHARGE = "Device/SubDeviceList/Battery/Charge/Sensor/Value"
FRONT = "FrontTactilTouched"


def angles(robot, *names):
    return robot.ALMotion.getAngles(list(names), True)


@pytest.fixture
def joints(stiff_robot, driver_robot):
    stiff_robot.ALMotion.setAngles(["HeadYaw", "HeadPitch"], [0.0, 0.0], 0.5)
    stiff_robot.advance(0.5)
    return JointController(driver_robot)


def trajectory(names, *points):
    rows = [SimpleNamespace(time_from_start=t, positions=p, velocities=v, accelerations=()) for t, p, v in points]
    return SimpleNamespace(joint_names=names, points=rows)


def test_angles_are_set_changed_and_moved_to_until_an_interrupt(joints, robot, until, begin):
    joints.set_angles(["Head"], [0.3, -0.2], 0.5, relative=False)
    robot.advance(1.0)
    joints.set_angles(["HeadYaw"], [0.1], 0.5, relative=True)
    robot.advance(1.0)
    assert angles(robot, "HeadYaw", "HeadPitch") == pytest.approx([0.4, -0.2], abs=0.03)
    for names, values, speed, field in (
        (["Tail"], [0.0], 0.2, "joint_names"),
        (["Head"], [0.0, 0.0, 0.0], 0.2, "joint_angles"),
        (["Head"], [0.0], 0.0, "speed"),
        (["Head"], [0.0], 1.1, "speed"),
    ):
        with pytest.raises(BadGoal) as caught:
            joints.set_angles(names, values, speed, False)
        assert caught.value.field == field
    move = begin(joints.move, ["Head"], [-0.2, 0.1], 0.5, True, CancellationToken())
    until(move.done)
    assert move.result().values == pytest.approx([0.2, -0.1], abs=0.03) and not move.result().preempted
    assert tuple(joints.names.body) == tuple(H25_BODY) and joints.joints_of(["Head"]) == ("HeadYaw", "HeadPitch")
    interrupt = CancellationToken()
    move = begin(joints.move, ["HeadYaw"], [1.5], 0.1, False, interrupt)
    until(lambda: angles(robot, "HeadYaw")[0] > 0.4)
    interrupt.trigger()
    until(move.done, limit=0.5)
    assert move.result().preempted and 0.3 < move.result().values[0] < 1.2
    robot.advance(1.0)
    assert angles(robot, "HeadYaw") == pytest.approx(move.result().values, abs=0.15)


def test_stiffnesses_have_a_range_and_trajectories(joints, robot, until, begin):
    joints.set_stiffnesses(["Body"], [0.75])
    assert set(robot.ALMotion.getStiffnesses("Body")) == {0.75}
    with pytest.raises(BadGoal, match="HeadPitch is to be 1.5: 0 to 1"):
        joints.set_stiffnesses(["Head"], [1.0, 1.5])
    with pytest.raises(BadGoal, match="HeadYaw is to be -0.1"):
        joints.stiffness_trajectory(trajectory(["HeadYaw"], (1, [-0.1], ())))
    frames = joints.stiffness_trajectory(trajectory(["Head"], (0.5, [0.25], ())))
    stiffen = begin(joints.stiffen, frames, CancellationToken())
    until(stiffen.done, limit=1.0)
    assert stiffen.result().values == pytest.approx([0.25, 0.25]) and not stiffen.result().preempted
    interrupt = CancellationToken()
    stiffen = begin(joints.stiffen, joints.stiffness_trajectory(trajectory(["HeadYaw"], (9, [1.0], ()))), interrupt)
    until(lambda: robot.ALMotion.getStiffnesses("HeadYaw")[0] > 0.4)
    interrupt.trigger()
    until(stiffen.done, limit=1.0)
    robot.advance(1.0)
    assert stiffen.result().preempted and 0.4 < stiffen.result().values[0] < 0.9
    assert robot.ALMotion.getStiffnesses("HeadYaw") == pytest.approx(stiffen.result().values, abs=0.01)


@pytest.mark.parametrize("velocities", [(), (0.0, 0.0)], ids=["interpolation", "bezier"])
def test_a_trajectory_ends_at_its_last_point_counted_from_the_command_and_tells_where(
    joints, robot, until, velocities, begin
):
    joints.set_angles(["Head"], [0.1, 0.1], 0.5, relative=False)
    robot.advance(0.5)
    frames = joints.trajectory(
        trajectory(["Head"], (0.5, [0.4, 0.0], velocities), (1, [0.2, -0.2], velocities)), relative=True
    )
    follow, yaws = begin(joints.follow, frames, CancellationToken()), []
    until(lambda: yaws.append(angles(robot, "HeadYaw")[0]) or follow.done(), limit=4.0, step=0.02)
    assert max(yaws) == pytest.approx(0.5, abs=0.06)
    assert follow.result().values == pytest.approx([0.3, -0.1], abs=0.03)


def test_the_whole_body_gets_stiff_wakes_up_rests_and_lives(joints, robot, until, begin):
    for service, arguments in (("set_body_stiffness", (0.5,)), ("wake_up", ()), ("rest", ())):
        call = begin(getattr(joints, service), *arguments)
        until(call.done, limit=15.0, step=0.25)
        call.result()
        stiffness = {"set_body_stiffness": 0.5, "wake_up": 1.0, "rest": 0.0}[service]
        assert set(robot.ALMotion.getStiffnesses("Head")) == {stiffness}
    assert joints.life_state() == "disabled"
    call = begin(joints.set_life, True)
    until(call.done, limit=20.0, step=0.25)
    assert joints.life_state() == "solitary"


def test_a_reading_is_what_the_robot_says_of_joints_inertial_unit_and_odometry(joints, robot, driver_robot):
    joints.set_angles(["HeadYaw"], [0.5], 1.0, relative=False)
    robot.advance(1.0)
    names = ("HeadYaw", "LHipYawPitch", "RHipYawPitch", "LHand")
    sensors = JointSensors(driver_robot, names)
    reading = sensors.read()
    assert reading.positions == pytest.approx(angles(robot, *names), abs=1e-3)
    assert reading.torso == pytest.approx(robot.ALMotion.getPosition("Torso", 1, True), abs=1e-4)
    assert reading.acceleration[2] == pytest.approx(9.81, abs=0.5) and abs(reading.roll) < 0.05
    assert sensors.read_stiffnesses() == pytest.approx((1.0,) * 4)
    assert all(math.isfinite(effort) for effort in reading.efforts)
    robot.ALMotion.setAngles("HeadYaw", -1.0, 1.0)
    robot.advance(0.1)
    moving = JointSensors(driver_robot, ["HeadYaw"], use_sensors=False, use_odometry=False).read()
    assert moving.torso is None and moving.efforts[0] < 0.0  # towards the command
    assert moving.positions == pytest.approx(robot.ALMotion.getAngles("HeadYaw", False), abs=0.02)


def test_what_is_wanted_is_tried_again_until_it_works_and_started_anew_when_it_died(
    driver_robot, closing, eventually, monkeypatch
):
    monkeypatch.setattr(lazy_subscription, "LOOK_PERIOD", 0.02)
    calls, failures, alive = [], [NaoError("not yet"), ValueError("a mistake"), NaoError("not yet")], [True]

    def start():
        calls.append("start")
        if failures:
            raise failures.pop()

    made = closing(
        lazy_subscription.LazySubscription(
            driver_robot, "thing", start, lambda: calls.append("stop"), lambda: alive[0]
        ),
        5.0,
    )
    with pytest.raises(NaoError, match="not yet"):
        made.start_now()
    assert not made.wanted and not made.running
    made.want(True)
    eventually(lambda: made.running)
    assert calls == ["start"] * 4 and made.problem == ""
    made.restart()
    eventually(lambda: calls[4:] == ["stop", "start"] and made.running)
    alive[0] = False
    eventually(lambda: calls[6:8] == ["stop", "start"])


def test_sonars_measure_only_while_somebody_listens_and_after_a_loss(robot, driver_robot, clock, until, closing):
    told = []
    sonars = closing(Sonars(driver_robot, "ros_nao_sonar", 20.0, clock, told.append))
    assert sonars.report().message == "no subscriber"
    sonars.want(True)
    begin = robot.now.time
    until(lambda: len(told) > 8, step=0.02)
    assert 0.3 < robot.now.time - begin  # 20 Hz
    assert [name for name, *_ in robot.ALSonar.getSubscribersInfo()] == ["ros_nao_sonar"]
    assert set(told[-1]) == set(SONAR_KEYS) and sonars.report().message == "read"
    driver_robot.lose()
    told.clear()
    until(lambda: len(told) > 2)
    sonars.want(False)
    until(lambda: not robot.ALSonar.getSubscribersInfo())
    told.clear()
    lacks = {"ALSonar": "ALSonarX"}
    lacking = SimpleNamespace(
        connection=driver_robot.connection, proxy=lambda name: driver_robot.proxy(lacks.get(name, name))
    )
    sonars = closing(Sonars(lacking, "ros_nao_sonar", 20.0, clock, told.append))
    sonars.want(True)
    until(lambda: "no module 'ALSonarX" in sonars.report().message)
    robot.advance(1.0)
    assert told == []  # the memory holds what was measured for others


class Topics(dict):
    """Opens topics, which keep what is published, by name."""

    def make(self, name, kind, tell):
        topic = self[name] = SimpleNamespace(kind=kind, tell=tell, messages=[])
        topic.publish = topic.messages.append
        topic.close = lambda: self.pop(name) if self.get(name) is topic else None
        return topic


@pytest.fixture
def topics():
    return Topics()


@pytest.fixture
def watch(robot, driver_robot, clock, topics, closing):
    return closing(MemoryWatch(driver_robot, clock, topics.make, 5000))


def test_keys_are_found_by_name_and_pattern_and_written_as_they_are(robot, driver_robot):
    access = MemoryAccess(driver_robot)
    robot.ALMemory.insertListData([[f"Mine/{number}", number] for number in range(1200)])
    known = access.known()
    assert len(known) > 1200 and known[FRONT] is True and known["Mine/7"] is False
    keys = [f"Mine/{number}" for number in range(1200)]
    assert access.values(keys) == list(range(1200)) and access.values([]) == []
    assert access.find("Mine/119?") == {f"Mine/119{i}": 1190 + i for i in range(10)}
    assert access.find("Mine/5") == {"Mine/5": 5} and access.values(["Never"]) == [None]
    for pattern, words in (("Mine/x", "key 'Mine/x' not found"), ("x*", "no key matches"), ("", "empty")):
        with pytest.raises(BadGoal, match=words):
            access.find(pattern)
    with pytest.raises(BadGoal, match=f"did you mean '{FRONT}'"):
        access.find("FrontTactilTouchd")
    access.write("Flag", True, as_event=False)
    assert robot.value("Flag") is True
    heard = robot.heard("MyEvent")
    access.write("MyEvent", 1.5, as_event=True)
    assert heard.get(timeout=robot.patience) == 1.5


def test_the_rate_at_which_data_is_read_is_told_beside_the_one_asked_for(watch, topics, until):
    watch.watch([MemoryRule(CHARGE, 20.0)])
    assert not [name for name in watch.report().values if name.startswith("rate")]
    topics[CHARGE].tell(True)
    until(lambda: watch.report().values.get("rate reached of 20 (1/s)"), step=0.025)


def test_a_rate_is_measured_anew_after_a_loss(watch, driver_robot, topics, until):
    watch.watch([MemoryRule(CHARGE, 20.0)])
    topics[CHARGE].tell(True)
    rate = lambda: watch.report().values.get("rate reached of 20 (1/s)")  # noqa: E731
    until(rate, step=0.025)
    driver_robot.lose()
    until(lambda: rate() == "", step=0.025)  # it takes a second of readings to be known


def test_data_is_published_at_its_rate_while_somebody_listens(watch, robot, topics, until, eventually):
    watch.watch([MemoryRule(CHARGE, 20.0), MemoryRule("Device/SubDeviceList/*/Position/Sensor/Value", 10.0)])
    assert watch.watched(CHARGE) == {CHARGE: CHARGE} and topics[CHARGE].kind == "float"
    assert len(watch.watched("*/Position/Sensor/Value")) >= 25
    head = topics["Device/SubDeviceList/HeadYaw/Position/Sensor/Value"]
    for topic in (topics[CHARGE], head):
        topic.tell(True)
    start = robot.now.time
    until(lambda: len(topics[CHARGE].messages) >= 8, step=0.025)
    rate = len(topics[CHARGE].messages) / (robot.now.time - start)
    assert rate < 25.0 and topics[CHARGE].messages[-1] == pytest.approx(robot.value(CHARGE), abs=1e-3)
    assert head.messages and head.messages[-1] == pytest.approx(angles(robot, "HeadYaw")[0], abs=0.01)
    assert not topics["Device/SubDeviceList/HeadPitch/Position/Sensor/Value"].messages
    topics[CHARGE].tell(False)
    watch.unwatch("Nothing")  # it waits for a reading that is under way
    count = len(topics[CHARGE].messages)
    robot.advance(0.5)
    assert len(topics[CHARGE].messages) == count


def test_events_are_published_as_they_stand_and_while_somebody_listens_also_after_a_loss(
    watch, robot, driver_robot, topics, eventually, until
):
    robot.ALMemory.raiseEvent(FRONT, 0.0)
    watch.watch([MemoryRule(FRONT), MemoryRule(CHARGE, 20.0)])
    for name in (FRONT, CHARGE):
        topics[name].tell(True)
    until(lambda: topics[CHARGE].messages and topics[FRONT].messages)
    driver_robot.lose()
    count = len(topics[CHARGE].messages)
    until(lambda: len(topics[CHARGE].messages) > count)
    told = len(topics[FRONT].messages)
    robot.ALMemory.raiseEvent(FRONT, 1.0)
    eventually(lambda: topics[FRONT].messages[told:] == [1.0])  # once
    topics[FRONT].tell(False)
    robot.ALMemory.raiseEvent(FRONT, 0.0)
    watch.unwatch("Nothing")
    topics[FRONT].tell(True)
    eventually(lambda: topics[FRONT].messages[told:] == [1.0, 0.0])


def test_how_an_event_stands_is_asked_again_when_it_could_not_be_read(watch, robot, topics, eventually, monkeypatch):
    values, failures = MemoryAccess.values, [NaoError("no answer")]

    def sometimes(access, keys):
        if keys and failures:
            raise failures.pop()
        return values(access, keys)

    robot.ALMemory.raiseEvent(FRONT, 0.0)
    watch.watch([MemoryRule(FRONT)])
    monkeypatch.setattr(MemoryAccess, "values", sometimes)
    topics[FRONT].tell(True)
    eventually(lambda: topics[FRONT].messages == [0.0])


def test_unwatching_closes_topics_and_too_many_are_refused(robot, driver_robot, clock, topics, closing, eventually):
    watch = closing(MemoryWatch(driver_robot, clock, topics.make, 3))
    robot.ALMemory.insertListData([["Few/1", 1], ["Few/2", "two"]])
    watch.watch([MemoryRule(CHARGE), MemoryRule("Few/*")])
    with pytest.raises(BadGoal, match="keys.*3 at most"):
        watch.watch([MemoryRule("*")])
    assert set(watch.watched()) == {CHARGE, "Few/1", "Few/2"}
    assert sorted(watch.unwatch("Few/*")) == ["Few/1", "Few/2"]
    assert set(topics) == {CHARGE}
    watch.unwatch("*")
    assert watch.watched() == {} and watch.report().message == "nothing is watched"


def test_every_change_of_every_touch_sensor_is_told_once(robot, driver_robot, closing, eventually, monkeypatch):
    told, memory = [], robot.server.memory
    monkeypatch.setattr(lazy_subscription, "LOOK_PERIOD", 0.02)
    robot.server.press(["Head/Touch/Front"])
    robot.advance(0.1)
    sensors = closing(TouchSensors(driver_robot, lambda s, now: told.append((s.place, s.number, now)), told.append))
    eventually(lambda: sensors.report().message == "touches are published")
    assert set(told) == {(HEAD, 1, True), (FEET, 0, True)}  # how it is at the beginning
    told.clear()
    for pressed in (["LHand/Touch/Left", "RFoot/Bumper/Right"], []):
        robot.server.press(pressed)
        robot.advance(0.1)
    expected = [(HEAD, 1, False), (HAND, 4, True), (BUMPER, 0, True), (HAND, 4, False), (BUMPER, 0, False)]
    eventually(lambda: len(told) >= 5)
    assert sorted(told) == sorted(expected)
    told.clear()
    robot.ALMemory.raiseEvent("footContactChanged", False)  # while a foot touches the ground: it bounces
    eventually(lambda: told == [(FEET, 0, False)])
    for _ in range(2):
        told.clear()
        # Let go at once, the events swapped.
        memory.next_change(FRONT).add_done_callback(lambda _: memory.put_quietly(FRONT, 0.0))
        robot.ALMemory.raiseEvent(FRONT, 1.0)
        eventually(lambda: told == [(HEAD, 1, True), (HEAD, 1, False)])
    assert sensors.report().values["footContactChanged"] == ""
    robot.ALMemory.raiseEvent("footContactChanged", True)
    robot.ALMemory.raiseEvent("ALChestButton/DoubleClickOccurred", None)
    eventually(lambda: 2 in told)
    told.clear()
    robot.server.press(["LFoot/Bumper/Left"])
    driver_robot.lose()
    robot.advance(0.1)
    eventually(lambda: (BUMPER, 1, True) in told)
    assert sensors.report().values["LeftBumperPressed"] == "touched" and told == [(BUMPER, 1, True)]


RED, GREEN, BLACK = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)


def eye(robot):
    return [robot.led(f"Face/Led/{name}/Left/0Deg") for name in ("Red", "Green", "Blue")]


def test_a_newer_goal_takes_the_eyes_as_they_are_and_a_fade_ends_with_the_interrupt(
    robot, driver_robot, clock, until, begin
):
    interrupt = CancellationToken()
    blinks = Blinks([RED], BLACK, 3.0, 0.5, 0.0)
    blinking = begin(blink, driver_robot, blinks, clock, interrupt, lambda colour: None, random.Random(1))
    robot.advance(0.5)
    interrupt.trigger(Replaced())
    until(blinking.done, limit=1.0)
    assert blinking.result() is True
    before = eye(robot)
    assert 0.2 < before[1] < 0.8  # on the way from white to red
    interrupt = CancellationToken()
    interrupt.trigger()
    with pytest.raises(Preempted):
        fade(driver_robot, "FaceLeds", GREEN, 10.0, interrupt)
    robot.advance(1.0)
    assert eye(robot) == before

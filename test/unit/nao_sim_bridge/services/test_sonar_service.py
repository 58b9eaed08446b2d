"""ALSonar: sonars that fire while somebody is subscribed, keys and events."""

from __future__ import annotations

import math
import threading
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from nao_sim_bridge.services import sonar as module
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.sim.errors import ConfigError, SimulationStopped
from nao_sim_bridge.sim.settings import load_settings
from nao_sim_bridge.sim.tasks import stopped_error

KEY = "Device/SubDeviceList/US/{}/Sensor/Value"
WALL = "{{name: wall, box: [0.1, 3, 2], position: [{}, 0, 1]}}"
FIRST = 0.15
"""Time for one measurement, s."""
TICK = load_settings().tick_s


@pytest.fixture
def fresh(robot):
    """A robot that nobody listens to; what the keys kept of other tests is old."""
    robot.advance(0.2)
    yield robot
    for name, _, _ in robot.ALSonar.getSubscribersInfo():
        robot.ALSonar.unsubscribe(name)


def wall(robot, distance):
    """Put a wall so far from the sonars."""
    if "wall" in robot.NaoSimulation.objects():
        robot.NaoSimulation.removeObject("wall")
    robot.NaoSimulation.placeObject(WALL.format(distance + 0.05))


def keys(robot):
    return [robot.ALMemory.getData(KEY.format(side)) for side in ("Left", "Right")]


@contextmanager
def within_a_tick(robot):
    """Time runs, and has got into a tick when the sensors have been read; it goes on after the block."""
    begun, go_on = threading.Event(), threading.Event()

    def wait(_):
        begun.set()
        go_on.wait(robot.patience)

    looks = robot.server.simulation.after_tick
    looks.insert(0, wait)
    tick = robot.post("NaoSimulation", "advance", TICK)
    try:
        assert begun.wait(robot.patience)
        yield
    finally:
        go_on.set()
        robot.answer(tick)
        robot.server.runner.call(lambda: looks.remove(wait), robot.patience)


def test_before_the_first_shot_nothing_is_known():
    class Nobody:
        firing = False

        def echoes(self, side):
            return ()

    read = module.sonar_keys(Nobody())
    assert len(read) == 22
    assert {reader() for reader in read.values()} == {0.0}


def test_a_key_that_nothing_can_read_is_an_error(monkeypatch):
    tables = {"_meta": {"prefix": ""}, "devices": {"sonar": {"keys": ["US/Nose/Sensor/Value"]}}}
    monkeypatch.setattr(module, "read_json", lambda path: tables)
    with pytest.raises(ConfigError, match="nothing in the simulation can read 'US/Nose/Sensor/Value'"):
        module.sonar_keys(None)


def test_they_fire_while_somebody_is_subscribed_and_keys_keep_what_was_last(fresh):
    wall(fresh, 0.8)
    before = keys(fresh)
    fresh.advance(0.3)
    assert keys(fresh) == before, "nobody is subscribed"
    fresh.ALSonar.subscribe("test")
    fresh.advance(FIRST)
    assert keys(fresh) == pytest.approx([0.8, 0.8], abs=0.015)
    assert fresh.ALMemory.getData("Device/SubDeviceList/US/Actuator/Value") == 68.0
    wall(fresh, 0.6)
    fresh.advance(FIRST)
    assert keys(fresh) == pytest.approx([0.6, 0.6], abs=0.015)
    fresh.ALSonar.unsubscribe("test")
    wall(fresh, 0.9)
    fresh.advance(0.5)
    assert keys(fresh) == pytest.approx([0.6, 0.6], abs=0.015)
    assert fresh.ALMemory.getData("Device/SubDeviceList/US/Actuator/Value") == 0.0


def test_who_looks_right_after_subscribing_sees_what_is_there_now(fresh):
    wall(fresh, 0.9)
    fresh.ALSonar.subscribe("test")
    assert keys(fresh) == pytest.approx([0.9, 0.9], abs=0.015), "time stands still"
    assert fresh.ALSonar.getFilteredValues() == pytest.approx([0.9, 0.9], abs=0.015)
    assert fresh.ALMemory.getData("Device/SubDeviceList/US/Actuator/Value") == 68.0
    fresh.ALSonar.unsubscribe("test")
    fresh.advance(0.2)
    wall(fresh, 0.5)
    fresh.ALMemory.subscribeToEvent("SonarLeftDetected", "Nobody", "onEvent")
    fresh.settled()
    assert keys(fresh) == pytest.approx([0.5, 0.5], abs=0.015), "also who listens to an event"
    fresh.ALMemory.unsubscribeToEvent("SonarLeftDetected", "Nobody")


def test_who_subscribes_within_a_tick_sees_what_is_there_now(fresh):
    wall(fresh, 0.9)
    with within_a_tick(fresh):
        subscribed = fresh.post("ALSonar", "subscribe", "test")
        assert fresh.ALSonar.getSubscribersInfo() == [["test", 100, 0.0]]
    fresh.answer(subscribed)
    assert keys(fresh) == pytest.approx([0.9, 0.9], abs=0.015)


def test_who_subscribes_while_time_runs_sees_what_is_there_now(fresh):
    runner = fresh.server.runner
    speed = runner.speed
    runner.set_speed(math.inf)
    runner.resume()
    try:
        for distance in (0.9, 0.5) * 5:
            wall(fresh, distance)
            fresh.ALSonar.subscribe("test")
            assert keys(fresh) == pytest.approx([distance, distance], abs=0.03)
            fresh.ALSonar.unsubscribe("test")
    finally:
        runner.pause()
        runner.set_speed(speed)


def test_who_is_not_the_first_waits_for_the_first_shot_too(fresh):
    wall(fresh, 0.9)
    with within_a_tick(fresh):
        waiting = [fresh.post("ALSonar", "subscribe", name) for name in ("one", "two")]
        assert len(fresh.ALSonar.getSubscribersInfo()) == 2
        assert not any(future.isFinished() for future in waiting)
    fresh.answer(waiting[1])
    assert keys(fresh) == pytest.approx([0.9, 0.9], abs=0.015)


def test_who_subscribes_again_while_time_stands_still_sees_what_is_there_now(fresh):
    wall(fresh, 0.9)
    fresh.ALSonar.subscribe("test")
    fresh.ALSonar.unsubscribe("test")
    fresh.settled()
    assert fresh.ALMemory.getData("Device/SubDeviceList/US/Actuator/Value") == 0.0
    wall(fresh, 0.5)
    fresh.ALSonar.subscribe("test")
    assert keys(fresh) == pytest.approx([0.5, 0.5], abs=0.015)
    assert fresh.ALSonar.getFilteredValues() == pytest.approx([0.5, 0.5], abs=0.015)


def test_a_simulation_that_has_stopped_has_no_subscribers():
    class Stopped:
        def execute(self, command, name):
            raise stopped_error()

    simulation = SimpleNamespace(robot=SimpleNamespace(locomotion=SimpleNamespace(active=False)))
    sonar = module.Sonar(simulation, Stopped(), MemoryStore(lambda: 0.0))
    with pytest.raises(SimulationStopped):
        sonar.start()
    sonar(SimpleNamespace(time=0.0, sonars=(1.0, 1.0), echoes=((1.0,), (1.0,))))
    assert not sonar.firing
    sonar.stop()


@pytest.mark.parametrize("device", ["Head/Touch/Rear", "US/Left"])
def test_medians_are_those_of_shots_also_when_something_is_broken(fresh, device):
    fresh.NaoSimulation.breakDevice(device)
    wall(fresh, 1.0)
    fresh.ALSonar.subscribe("test")
    fresh.advance(0.6)
    wall(fresh, 0.4)
    fresh.advance(FIRST)
    right, _ = fresh.ALSonar.getFilteredValues()
    assert keys(fresh)[1] == pytest.approx(0.4, abs=0.02)
    assert right == pytest.approx(1.0, abs=0.02)


def test_they_fire_for_a_robot_that_walks(fresh):
    fresh.ALMotion.setStiffnesses("Body", 1.0)
    fresh.advance(0.2)
    wall(fresh, 1.5)
    fresh.ALMotion.move(0.03, 0.0, 0.0)
    fresh.settled()
    fresh.advance(TICK)
    assert keys(fresh) == pytest.approx([1.5, 1.5], abs=0.06), "from the first tick on"
    fresh.advance(1.0)
    assert keys(fresh) == pytest.approx([1.5, 1.5], abs=0.06)
    assert not fresh.ALSonar.getSubscribersInfo()


def test_events_say_what_is_near_and_what_is_free(fresh):
    heard = {}
    for event in (*module.DETECTED, *module.NOTHING):
        fresh.server.memory.listen(event, lambda value, event=event: heard.setdefault(event, []).append(value))
    fresh.NaoSimulation.placeObject("{name: post, cylinder: [0.06, 1.0], position: [0.35, 0.3, 0.5]}")
    fresh.ALSonar.subscribe("test", 200, 0.0)
    fresh.advance(1.0)
    near, free = heard.pop("SonarLeftDetected"), heard.pop("SonarRightNothingDetected")
    assert not heard
    assert 5 <= len(near) == len(free) <= 6
    assert set(free) == {5.0} and all(0.3 < distance < 0.5 for distance in near)
    fresh.ALSonar.unsubscribe("test")
    fresh.advance(1.0)
    assert not heard


def test_who_listens_to_an_event_need_not_subscribe_to_the_module(fresh, listener):
    wall(fresh, 0.4)
    fresh.ALMemory.subscribeToEvent("SonarLeftDetected", "Listener", "onEvent")
    fresh.ALMemory.subscribeToEvent("SonarRightDetected", "Listener", "onEvent")
    assert fresh.ALSonar.getSubscribersInfo() == [["Listener", 100, 0.0]]
    fresh.advance(FIRST)
    assert {listener.heard.get(timeout=fresh.patience)[0] for _ in range(2)} == set(module.DETECTED)
    fresh.ALMemory.unsubscribeToEvent("SonarLeftDetected", "Listener")
    assert fresh.ALSonar.getSubscribersInfo()
    fresh.ALMemory.unsubscribeToEvent("SonarRightDetected", "Listener")
    assert not fresh.ALSonar.getSubscribersInfo()


def test_values_come_in_steps_and_tell_only_that_there_is_something_near(fresh):
    fresh.ALSonar.subscribe("test")
    wall(fresh, 0.7234)
    fresh.advance(FIRST)
    assert keys(fresh)[0] == pytest.approx(round(keys(fresh)[0], 2))
    wall(fresh, 0.13)
    fresh.advance(FIRST)
    assert keys(fresh) == pytest.approx([0.2, 0.2])


def test_further_echoes_have_keys_of_their_own(fresh):
    wall(fresh, 1.2)
    fresh.NaoSimulation.placeObject("{name: post, cylinder: [0.06, 1.0], position: [0.6, 0, 0.5]}")
    fresh.ALSonar.subscribe("test")
    fresh.advance(FIRST)
    read = [fresh.ALMemory.getData(KEY.format("Left") + number) for number in ("", "1", "2")]
    assert read == pytest.approx([0.54, 1.2, 5.0], abs=0.02)
    nearer = min(keys(fresh))
    assert fresh.ALMemory.getData("Device/SubDeviceList/US/Sensor/Value") == pytest.approx(nearer)


def test_filtered_values_are_right_then_left_and_forget_a_slip(fresh):
    wall(fresh, 1.0)
    fresh.ALSonar.subscribe("test")
    fresh.advance(0.6)
    wall(fresh, 0.4)
    fresh.advance(0.1)
    fresh.NaoSimulation.removeObject("wall")
    wall(fresh, 1.0)
    fresh.advance(0.1)
    assert fresh.ALSonar.getFilteredValues() == pytest.approx([1.0, 1.0], abs=0.02)
    fresh.NaoSimulation.removeObject("wall")
    fresh.NaoSimulation.placeObject("{name: post, cylinder: [0.06, 1.0], position: [0.35, 0.3, 0.5]}")
    fresh.advance(0.6)
    right, left = fresh.ALSonar.getFilteredValues()
    assert right == 5.0 and left < 0.5


def test_the_module_tells_about_itself(fresh):
    assert fresh.ALSonar.getCurrentPeriod() == 100
    assert set(fresh.ALSonar.getEventList()) == {*module.DETECTED, *module.NOTHING}
    assert KEY.format("Left") in fresh.ALSonar.getMemoryKeyList()

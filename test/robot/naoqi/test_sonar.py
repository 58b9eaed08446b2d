"""ALSonar: sonars that fire while somebody is subscribed, keys and events."""

import pytest

from nao_sim_bridge.naoqi.body.sonar import DETECTED, NOTHING

KEY = "Device/SubDeviceList/US/{}/Sensor/Value"
POST = "{name: post, cylinder: [0.06, 1.0], position: [0.35, 0.3, 0.5]}"
FIRST = 0.15
"""Time for one measurement, s."""


@pytest.fixture
def sonar(robot):
    return robot.ALSonar


@pytest.fixture
def wall(robot):
    """Puts a wall so far from the sonars; None takes it away."""

    def put(distance):
        if "wall" in robot.NaoSimulation.objects():
            robot.NaoSimulation.removeObject("wall")
        if distance is not None:
            where = distance + 0.05
            robot.NaoSimulation.placeObject(f"{{name: wall, box: [0.1, 3, 2], position: [{where}, 0, 1]}}")

    return put


@pytest.fixture
def keys(robot):
    return lambda: [robot.value(KEY.format(side)) for side in ("Left", "Right")]


def both(distance, within=0.015):
    return pytest.approx([distance, distance], abs=within)


def test_they_fire_while_somebody_is_subscribed_and_keys_keep_what_was_last(robot, sonar, wall, keys):
    def fires():
        return robot.value("Device/SubDeviceList/US/Actuator/Value") == 68.0

    wall(0.8)
    robot.advance(0.3)
    assert keys() == [0.0, 0.0] and not fires()
    sonar.subscribe("test")
    assert keys() == both(0.8) and fires()  # also while time stands still
    assert sonar.getFilteredValues() == both(0.8)
    wall(0.6)
    robot.advance(FIRST)
    assert keys() == both(0.6)
    sonar.unsubscribe("test")
    wall(0.9)
    robot.advance(0.5)
    assert keys() == both(0.6) and not fires()
    sonar.subscribe("test")
    assert keys() == both(0.9)
    assert sonar.getCurrentPeriod() == 100 and set(sonar.getEventList()) == {*DETECTED, *NOTHING}
    assert KEY.format("Left") in sonar.getMemoryKeyList()


def test_events_say_what_is_near_and_what_is_free(robot, sonar):
    heard = {}
    for event in (*DETECTED, *NOTHING):
        robot.server.memory.listen(event, lambda value, event=event: heard.setdefault(event, []).append(value))
    robot.NaoSimulation.placeObject(POST)
    sonar.subscribe("test", 200, 0.0)
    robot.advance(1.0)
    near, free = heard.pop("SonarLeftDetected"), heard.pop("SonarRightNothingDetected")
    assert not heard and 5 <= len(near) == len(free) <= 6
    assert set(free) == {5.0} and all(0.3 < distance < 0.5 for distance in near)
    sonar.unsubscribe("test")
    robot.advance(1.0)
    assert not heard


def test_who_listens_to_an_event_need_not_subscribe_to_the_module(robot, sonar, wall, keys, listener):
    wall(0.4)
    for event in DETECTED:
        robot.ALMemory.subscribeToEvent(event, "Listener", "onEvent")
    assert sonar.getSubscribersInfo() == [["Listener", 100, 0.0]]
    robot.advance(FIRST)
    assert keys() == both(0.4)
    assert {listener.next()[0] for _ in range(2)} == set(DETECTED)
    robot.ALMemory.unsubscribeToEvent(DETECTED[0], "Listener")
    assert sonar.getSubscribersInfo()
    robot.ALMemory.unsubscribeToEvent(DETECTED[1], "Listener")
    assert not sonar.getSubscribersInfo()


def test_values_come_in_steps_with_further_echoes_and_forget_a_slip(robot, sonar, wall, keys):
    sonar.subscribe("test")
    for distance, read in ((0.7234, None), (0.13, 0.2)):  # nearer than 0.2 m is just near
        wall(distance)
        robot.advance(FIRST)
        assert keys()[0] == pytest.approx(round(keys()[0], 2) if read is None else read)
    wall(1.2)
    robot.NaoSimulation.placeObject("{name: post, cylinder: [0.06, 1.0], position: [0.6, 0, 0.5]}")
    robot.advance(FIRST)
    echoes = [robot.value(KEY.format("Left") + number) for number in ("", "1", "2")]
    assert echoes == pytest.approx([0.54, 1.2, 5.0], abs=0.02)
    assert robot.value("Device/SubDeviceList/US/Sensor/Value") == pytest.approx(min(keys()))

"""ALTouch, ALChestButton, ALTactileGesture: what a client of the robot hears of touches."""

import queue

import pytest
from simulator import PATIENCE

from nao_sim_bridge.model.touch_names import CHEST_BUTTON, EVENTS, HEAD, SENSORS

TICK = 1.0 / 120.0


@pytest.fixture
def press(robot):
    """Presses sensors for a while, then lets go."""

    def press(*sensors, seconds=0.1, pause=0.1):
        robot.NaoSimulation.press(list(sensors))
        robot.advance(seconds)
        robot.NaoSimulation.press([])
        robot.advance(pause)

    return press


def hand(robot, method, *arguments, after):
    """Have a hand touch, and let time pass."""
    future = robot.post("NaoSimulation", method, *arguments)
    robot.NaoSimulation.time()  # one call at a time: the hand is on its way
    robot.settled()
    robot.advance(after)
    return robot.answer(future)


def values(heard):
    return [value for value, _ in heard]


def test_each_sensor_has_its_event_known_before_anything_was_touched(robot, press, told):
    for event in EVENTS:
        assert robot.value(event) == 0.0 and robot.ALMemory.getType(event) == "Event"
    for sensor in (*SENSORS, CHEST_BUTTON):
        event = next(event for event, sensors in EVENTS.items() if sensor in sensors)
        heard = told(event, lambda sensor=sensor: press(sensor))
        assert values(heard) == [1.0, 0.0], sensor
        # In the tick after the finger comes and goes.
        assert [when for _, when in heard] == pytest.approx([TICK, 0.1 + TICK], abs=1e-3)


def test_bumpers_are_told_as_one_and_changes_by_part_and_by_sensor(robot, press, told):
    def over_the_toes():
        for halves in (["Left"], ["Left", "Right"], ["Right"], []):
            robot.NaoSimulation.press([f"LFoot/Bumper/{half}" for half in halves])
            robot.advance(0.05)

    assert values(told("LeftBumperPressed", over_the_toes)) == [1.0, 0.0]
    heard = told("TouchChanged", lambda: press(HEAD[1], "LHand/Touch/Back", CHEST_BUTTON))
    parts = ["Head", "LHand", HEAD[1], "LHand/Touch/Back"]
    assert values(heard) == [[[name, True] for name in parts], [[name, False] for name in parts]]


def test_the_status_tells_name_touch_and_a_list_of_each_part_and_sensor(robot):
    robot.NaoSimulation.press([HEAD[0]])
    robot.advance(0.1)
    status = robot.ALTouch.getStatus()
    robot.NaoSimulation.press([])
    touched = [entry for entry in status if entry != [entry[0], False, []]]
    assert touched == [["Head", True, [1]], [HEAD[0], True, [1]]]


@pytest.fixture
def gestures(robot):
    """ALTactileGesture, and what each of its signals says: libqi brings them in threads of their own."""
    service, gestures, releases = robot.ALTactileGesture, queue.Queue(), queue.Queue()
    links = service.onGesture.connect(gestures.put), service.onRelease.connect(lambda: releases.put("released"))
    yield service, gestures, releases
    for signal, link in zip((service.onGesture, service.onRelease), links):
        signal.disconnect(link)


def test_a_stroke_is_a_caress_as_event_and_as_signal(robot, told, gestures):
    _, heard, released = gestures
    events = told("ALTactileGesture/Gesture", lambda: hand(robot, "stroke", HEAD, 0.5, after=1.5))
    assert values(events) == ["CaressFtoR"] and robot.value("ALTactileGesture/Release") == 1
    assert (heard.get(timeout=PATIENCE), released.get(timeout=PATIENCE)) == ("CaressFtoR", "released")
    assert heard.empty() and released.empty()


def test_a_gesture_of_ones_own_is_heard_and_times_can_be_changed(robot, press, gestures, refuses):
    service, heard, _ = gestures
    name, sequence = service.createGesture("000,110,000,001,000"), ["000", "110", "000", "001", "000"]
    assert service.getSequence(name) == sequence and service.getGesture(sequence) == name
    assert name in service.getGestures() and service.getSequence("nobody") == [] and not service.getGesture("000,011")
    press(HEAD[0], HEAD[1])
    press(HEAD[2])
    robot.advance(0.5)
    assert heard.get(timeout=PATIENCE) == name
    assert service.setHoldTime(0.2) and service.setSequenceTime("0.1") and service.setSettleTime(0.02)
    press(HEAD[0], seconds=0.3)
    assert heard.get(timeout=PATIENCE) == "SingleFrontHold"
    refuses("ALTactileGesture", """
        setHoldTime(-1.0) -> hold time is -1.0, allowed is 0 to 10
        createGesture(['000', '200']) -> sensor sequence is
    """)  # fmt: skip


def test_a_hand_touches_and_goes_or_stays_until_it_is_released(robot, told, refuses):
    heard = told("MiddleTactilTouched", lambda: hand(robot, "touch", HEAD[1], 0.3, after=1.0))
    assert values(heard) == [1.0, 0.0] and heard[1][1] - heard[0][1] == pytest.approx(0.3, abs=0.05)
    height = robot.NaoSimulation.torsoPose()[2]
    hand(robot, "touch", "ChestButtonPressed", 0.0, after=0.5)
    robot.advance(1.0)
    assert robot.value("ChestButtonPressed") == 1.0
    robot.NaoSimulation.release([])
    robot.advance(0.5)
    assert robot.value("ChestButtonPressed") == 0.0
    assert robot.NaoSimulation.torsoPose()[2] == pytest.approx(height, abs=0.005)
    refuses("NaoSimulation", """
        touch('Head/Touch/Fron', 1.0) -> unknown touch sensor 'Head/Touch/Fron'
        stroke(['Head/Touch/Front', 'Head/Touch/Rear'], 0.0) -> duration is 0.0, allowed is above 0 for a stroke
    """)  # fmt: skip

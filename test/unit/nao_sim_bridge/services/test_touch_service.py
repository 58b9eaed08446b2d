"""ALTouch, ALChestButton, ALTactileGesture, ALFsr and ALSensors: what a client of the robot hears of touches."""

from __future__ import annotations

import queue

import pytest

from nao_sim_bridge.sim.touch_names import CHEST_BUTTON, EVENTS, HEAD, SENSORS

TICK = 1.0 / 120.0
NAMES = (*SENSORS, CHEST_BUTTON)


@pytest.fixture
def press(robot):
    """Presses sensors for a while, then lets go."""

    def press(*sensors, seconds=0.1, pause=0.1):
        robot.NaoSimulation.press(list(sensors))
        robot.advance(seconds)
        robot.NaoSimulation.press([])
        robot.advance(pause)

    yield press
    robot.NaoSimulation.press([])
    robot.advance(1.0)


def touch(robot, method, *arguments, after):
    """Have a hand touch, and let time pass."""
    future = robot.post("NaoSimulation", method, *arguments)
    robot.NaoSimulation.time()  # one call at a time: the hand is on its way
    robot.settled()
    robot.advance(after)
    return robot.answer(future)


def values(heard):
    return [value for value, _ in heard]


def test_a_client_can_ask_for_the_state_before_anything_was_touched(robot):
    for event in EVENTS:
        assert robot.ALMemory.getData(event) == 0.0
        assert robot.ALMemory.getType(event) == "Event"
    assert robot.ALTouch.getSensorList() == list(SENSORS)
    status = robot.ALTouch.getStatus()
    assert [name for name, _ in status[7:]] == list(SENSORS)
    assert not any(touched for _, touched in status)


@pytest.mark.parametrize("sensor", NAMES)
def test_each_sensor_has_its_event(robot, press, told, sensor):
    event = next(event for event, sensors in EVENTS.items() if sensor in sensors)
    heard = told(event, lambda: press(sensor, seconds=0.1))
    assert values(heard) == [1.0, 0.0]
    # In the tick after the finger comes and goes.
    assert [when for _, when in heard] == pytest.approx([TICK, 0.1 + TICK], abs=1e-3)


def test_a_bumper_event_is_about_either_half(robot, press, told):
    def over_the_toes():
        for halves in (["Left"], ["Left", "Right"], ["Right"]):
            robot.NaoSimulation.press([f"LFoot/Bumper/{half}" for half in halves])
            robot.advance(0.05)
        robot.NaoSimulation.press([])
        robot.advance(0.05)

    assert values(told("LeftBumperPressed", over_the_toes)) == [1.0, 0.0]


def test_changes_are_told_by_part_and_by_sensor(robot, press, told):
    heard = told("TouchChanged", lambda: press(HEAD[1], "LHand/Touch/Back"))
    parts = ["Head", "LHand", HEAD[1], "LHand/Touch/Back"]
    assert values(heard) == [[[name, True] for name in parts], [[name, False] for name in parts]]


def test_the_status_is_that_of_now(robot):
    robot.NaoSimulation.press([HEAD[0]])
    robot.advance(0.05)
    assert [name for name, touched in robot.ALTouch.getStatus() if touched] == ["Head", HEAD[0]]
    robot.NaoSimulation.press([])
    robot.advance(0.05)
    assert not any(touched for _, touched in robot.ALTouch.getStatus())


def test_an_arm_that_somebody_holds_is_touched(stiff_robot, told):
    def hold():
        stiff_robot.advance(0.8)
        stiff_robot.NaoSimulation.push([12.0, 0.0, 0.0], 1.0, "l_wrist")
        stiff_robot.advance(2.0)

    assert values(told("TouchChanged", hold)) == [[["LArm", True]], [["LArm", False]]]


def test_a_callback_gets_an_event_as_it_happens(robot, listener, press):
    robot.ALMemory.subscribeToEvent("FrontTactilTouched", "Listener", "onEvent")
    try:
        press(HEAD[0])
        heard = [listener.heard.get(timeout=robot.patience)[:2] for _ in range(2)]
    finally:
        robot.ALMemory.unsubscribeToEvent("FrontTactilTouched", "Listener")
    assert heard == [("FrontTactilTouched", 1.0), ("FrontTactilTouched", 0.0)]


# --- chest button -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count, word", [(1, "Simple"), (2, "Double"), (3, "Triple")])
def test_clicks_of_the_chest_button_are_counted(robot, told, press, count, word):
    def click():
        for _ in range(count):
            press(CHEST_BUTTON)
        robot.advance(0.8)

    events = [f"ALChestButton/{one}ClickOccurred" for one in ("Simple", "Double", "Triple")]
    heard = {}
    for event in events[1:]:
        robot.server.memory.listen(event, lambda value, event=event: heard.setdefault(event, []).append(value))
    heard[events[0]] = values(told(events[0], click))
    assert {event: heard.get(event, []) for event in events} == {
        event: [None] if word in event else [] for event in events
    }


def test_clicks_of_before_a_reset_count_for_nothing(robot, press):
    """Whoever falls on the button, bounces and is put back on its feet has not been told to live."""
    heard = []
    for word in ("Simple", "Double"):
        robot.server.memory.listen(f"ALChestButton/{word}ClickOccurred", heard.append)
    press(CHEST_BUTTON)
    press(CHEST_BUTTON)
    robot.NaoSimulation.reset()
    robot.advance(0.8)
    assert heard == []
    press(CHEST_BUTTON)
    robot.advance(0.8)
    assert heard == [None]


# --- gestures ---------------------------------------------------------------------------------------------------------


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
    events = told("ALTactileGesture/Gesture", lambda: touch(robot, "stroke", HEAD, 0.5, after=1.5))
    assert values(events) == ["CaressFtoR"]
    assert robot.ALMemory.getData("ALTactileGesture/Release") == 1
    assert heard.get(timeout=robot.patience) == "CaressFtoR"
    assert released.get(timeout=robot.patience) == "released"
    assert heard.empty() and released.empty()


def test_a_gesture_of_ones_own_is_heard_by_its_name(robot, press, gestures):
    service, heard, _ = gestures
    name = service.createGesture("000,110,000,001,000")
    assert service.getSequence(name) == ["000", "110", "000", "001", "000"]
    assert service.getGesture(["000", "110", "000", "001", "000"]) == name
    assert name in service.getGestures() and service.getSequence("nobody") == [] and not service.getGesture("000,011")
    press(HEAD[0], HEAD[1])
    press(HEAD[2])
    robot.advance(0.5)
    assert heard.get(timeout=robot.patience) == name


def test_how_long_a_touch_is_held_can_be_changed(robot, press, gestures):
    service, heard, _ = gestures
    assert service.setHoldTime(0.2) and service.setSequenceTime("0.1") and service.setSettleTime(0.02)
    try:
        press(HEAD[0], seconds=0.3)
        assert heard.get(timeout=robot.patience) == "SingleFrontHold"
        with pytest.raises(RuntimeError, match="setHoldTime hold time is -1.0, allowed is 0 to 10"):
            service.setHoldTime(-1.0)
        with pytest.raises(RuntimeError, match="a number of seconds"):
            service.setSettleTime("soon")
    finally:
        service.setHoldTime(0.8), service.setSequenceTime(0.2), service.setSettleTime(0.04)


def test_a_sequence_that_no_head_can_feel_is_refused(gestures):
    with pytest.raises(RuntimeError, match="ALTactileGesture::createGesture sensor sequence is"):
        gestures[0].createGesture(["000", "200"])


# --- hands ------------------------------------------------------------------------------------------------------------


def test_a_hand_touches_and_goes(robot, told):
    heard = told("MiddleTactilTouched", lambda: touch(robot, "touch", HEAD[1], 0.3, after=1.0))
    assert values(heard) == [1.0, 0.0]
    assert heard[1][1] - heard[0][1] == pytest.approx(0.3, abs=0.05)


def test_a_hand_stays_until_it_is_released(robot):
    touch(robot, "touch", "ChestButtonPressed", 0.0, after=0.5)
    robot.advance(1.0)
    assert robot.ALMemory.getData("ChestButtonPressed") == 1.0
    robot.NaoSimulation.release([])
    robot.advance(0.5)
    assert robot.ALMemory.getData("ChestButtonPressed") == 0.0


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda s: s.touch("Head/Touch/Fron", 1.0), "NaoSimulation::touch unknown touch sensor 'Head/Touch/Fron'"),
        (lambda s: s.touch(HEAD[0], -1.0), "NaoSimulation::touch duration is -1.0"),
        (lambda s: s.stroke([HEAD[0], CHEST_BUTTON], 1.0), "NaoSimulation::stroke sensors is"),
        (lambda s: s.release(["nose"]), "NaoSimulation::release unknown touch sensor 'nose'"),
    ],
)
def test_what_no_hand_can_do_is_refused(robot, call, text):
    with pytest.raises(RuntimeError, match=text):
        call(robot.NaoSimulation)


# --- stiffness, feet --------------------------------------------------------------------------------------------------


def test_the_level_of_stiffness_is_told_when_it_changes(robot, told):
    def stiffen():
        robot.ALMotion.setStiffnesses("Body", 0.0)
        robot.advance(0.1)
        for stiffness in (0.5, 1.0, 1.0):
            robot.ALMotion.setStiffnesses("Body", stiffness)
            robot.advance(0.1)

    assert values(told("BodyStiffnessChanged", stiffen))[-2:] == [1, 2]
    assert robot.ALSensors.getEventList() == ["BodyStiffnessChanged"]
    robot.ALSensors.run()
    assert robot.ALMemory.getExtractorEvent("ALFsr") == ["footContactChanged"]

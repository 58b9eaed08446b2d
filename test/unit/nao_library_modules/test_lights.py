"""The light module on a stand-in for ALLeds: what is called, what goes back, what is refused."""

from __future__ import annotations

import pytest
from genpy import Duration

from nao_library_actions.msg import NaoLedGoal
from nao_library_msgs.msg import LedFunction

LIMIT = 5.0
RED, GREEN, BLUE = (f"Face/Led/{part}/Left/0Deg/Actuator/Value" for part in ("Red", "Green", "Blue"))
BEFORE = 0.25


def f(function, **fields):
    return LedFunction(function=function, **fields)


def play(lights, *functions):
    return lights.server.play(NaoLedGoal(list(functions)))


def calls(robot, *methods):
    """Calls of ALLeds with these names, in order."""
    return [call for call in robot.proxy("ALLeds").calls if call[0] in methods]


def finish(robot):
    """End what fades and animations are under way."""
    for call in robot.leds.pending:
        call.end()
    robot.leds.pending.clear()
    robot.leds.started.clear()


def in_background(lights, robot, *functions):
    thread = lights.server.play_in_background(NaoLedGoal(list(functions)))
    assert robot.leds.started.wait(LIMIT)
    return thread


def test_one_light_to_half_intensity(lights, robot):
    server = play(lights, LedFunction(function="setIntensity", lights=["Brain0"], i_values=[0.5]))
    assert server.end == "succeeded"
    assert calls(robot, "setIntensity") == [("setIntensity", "Brain0", 0.5)]
    assert (server.result.lights, server.result.intensities) == (["Brain0"], [0.5])


def test_both_eyes_green_and_back_after_the_wait(lights, robot, edge):
    eyes = ["LeftFaceLeds", "RightFaceLeds"]
    green = LedFunction(function="setColor", lights=eyes, i_values=[0, 1, 0], time=Duration.from_sec(0.05), revert=True)
    seen = []
    wait = edge.clock.wait

    def look_while_waiting(*args):
        seen.extend(robot.leds.values[device] for device in (RED, GREEN, BLUE))
        return wait(*args)

    edge.clock.wait = look_while_waiting
    server = lights.server.play(NaoLedGoal([green]))
    assert server.end == "succeeded"
    assert calls(robot, "fadeRGB")[:2] == [("fadeRGB", eye, 0, 1, 0, 0.0) for eye in eyes]
    assert seen == [0, 1, 0]
    assert set(robot.leds.values.values()) == {BEFORE}
    assert server.result.lights == ["LeftFaceLed1", "LeftFaceLed2", "RightFaceLed1", "RightFaceLed2"]
    assert server.result.intensities == [BEFORE] * 4


def test_lights_and_groups_are_used_alike_with_one_value_each(lights, robot):
    play(lights, f("setIntensity", lights=["BrainLeds", "LeftEarLed1"], i_values=[0.1, 0.9]))
    assert calls(robot, "setIntensity") == [
        ("setIntensity", "BrainLeds", 0.1),
        ("setIntensity", "LeftEarLed1", 0.9),
    ]


def test_colours_by_name_and_one_colour_each(lights, robot):
    play(lights, f("setColor", lights=["LeftFaceLeds"], str_param="magenta"))
    play(lights, f("setColor", lights=["LeftFaceLeds", "ChestLeds"], i_values=[1, 0, 0, 0, 0, 1]))
    assert calls(robot, "fadeRGB") == [
        ("fadeRGB", "LeftFaceLeds", 1, 0, 1, 0.0),
        ("fadeRGB", "LeftFaceLeds", 1, 0, 0, 0.0),
        ("fadeRGB", "ChestLeds", 0, 0, 1, 0.0),
    ]


@pytest.mark.parametrize("function, value", [("on", 1.0), ("off", 0.0), ("reset", 0.0)])
def test_on_off_and_reset(lights, robot, function, value):
    server = play(lights, f(function, lights=["Brain0", "Brain1"]))
    assert calls(robot, function) == [(function, "Brain0"), (function, "Brain1")]
    assert server.result.intensities == [value, value]


def test_fades_of_several_lights_run_together(lights, robot):
    thread = in_background(lights, robot, f("fade", lights=["Brain0", "Brain1"], i_values=[0.5, 1.0], duration=2.0))
    while len(robot.leds.pending) < 2 and thread.is_alive():
        thread.join(0.001)
    assert calls(robot, "fade") == [("fade", "Brain0", 0.5, 2.0), ("fade", "Brain1", 1.0, 2.0)]
    finish(robot)
    thread.join(LIMIT)
    assert lights.server.end == "succeeded"


@pytest.mark.parametrize(
    "message, call, touched",
    [
        (
            f("fadeRGB", lights=["ChestLeds"], str_param="yellow", duration=1.5),
            ("fadeRGB", "ChestLeds", 1, 1, 0, 1.5),
            ["ChestLedsRed", "ChestLedsGreen", "ChestLedsBlue"],
        ),
        (
            f("fadeListRGB", lights=["LeftFaceLed1"], str_param="red, #0000FF", times=[0.5, 1.0]),
            ("fadeListRGB", "LeftFaceLed1", [0xFF0000, 0x0000FF], [0.5, 1.0]),
            ["LeftFaceLed1"],
        ),
        (
            f("randomEyes", duration=2.0),
            ("randomEyes", 2.0),
            ["LeftFaceLed1", "LeftFaceLed2", "RightFaceLed1", "RightFaceLed2"],
        ),
        (
            f("rotateEyes", i_values=[0, 1, 0], rotation_time=0.5, duration=2.0),
            ("rotateEyes", 0x00FF00, 0.5, 2.0),
            ["LeftFaceLed1", "LeftFaceLed2", "RightFaceLed1", "RightFaceLed2"],
        ),
        (
            f("earLedsSetAngle", angle=90, duration=1.0, leave_on=True),
            ("earLedsSetAngle", 90, 1.0, True),
            ["LeftEarLed1"],
        ),
    ],
    ids=lambda value: value.function if isinstance(value, LedFunction) else "",
)
def test_slow_functions_reach_the_robot_and_report_what_they_touch(lights, robot, message, call, touched):
    thread = in_background(lights, robot, message)
    finish(robot)
    thread.join(LIMIT)
    assert lights.server.end == "succeeded"
    assert calls(robot, call[0]) == [call]
    assert lights.server.result.lights == touched


def test_rasta_touches_every_light(lights, robot):
    thread = in_background(lights, robot, f("rasta", duration=1.0))
    finish(robot)
    thread.join(LIMIT)
    assert set(lights.server.result.lights) == set(robot.leds.lights)


def test_preempting_a_fade_stops_it_where_it_is(lights, robot):
    thread = in_background(lights, robot, f("fade", lights=["Brain0"], i_values=[1.0], duration=60.0))
    lights.server.preempt()
    thread.join(LIMIT)
    assert lights.server.end == "preempted"
    assert robot.leds.pending[0].canceled
    assert robot.leds.values["Head/Led/Front/0/Actuator/Value"] == 1.0, "no revert was asked for"


def test_preempting_an_animation_that_reverts_brings_the_eyes_back(lights, robot):
    thread = in_background(lights, robot, f("randomEyes", duration=60.0, revert=True))
    assert robot.leds.values[RED] == 0.75
    lights.server.preempt()
    thread.join(LIMIT)
    assert lights.server.end == "preempted"
    assert robot.leds.values[RED] == BEFORE
    assert lights.server.result.intensities == [BEFORE] * 4


def test_a_failing_call_reverts_what_was_done_before_it(lights, robot):
    from naoqi.errors import RobotError

    def fail(name):
        raise RobotError("ALLeds", "on", "board does not answer")

    on = robot.leds.on
    robot.leds.on = lambda name: fail(name) if name == "Brain1" else on(name)
    server = play(lights, f("on", lights=["Brain0", "Brain1"], revert=True))
    assert server.end == "aborted"
    assert server.text == "function 1 (on): ALLeds.on failed: board does not answer"
    assert robot.leds.values["Head/Led/Front/0/Actuator/Value"] == BEFORE


def test_each_function_reverts_before_the_next_one_begins(lights, robot):
    server = play(lights, f("on", lights=["Brain0"], revert=True), f("getIntensity", lights=["Brain0"]), f("ping"))
    assert server.result.results[1].values == [str(BEFORE)]


def test_intensities_are_read_for_lights_and_groups_in_one_call(lights, robot):
    play(lights, f("setIntensity", lights=["Brain0", "Brain1"], i_values=[0.5, 1.0]))
    robot.proxy("ALMemory").calls.clear()
    server = play(lights, f("getIntensity", lights=["BrainLeds", "Brain0"]))
    assert server.result.results[0].values == ["0.75", "0.5"]
    assert (server.result.lights, server.result.intensities) == (["Brain0", "Brain1"], [0.5, 1.0])
    assert server.result.memList == [], "the result has fields for it"
    assert [call[0] for call in robot.proxy("ALMemory").calls] == ["getListData"] * 2


def test_intensities_come_back_as_they_were_given_although_the_robot_keeps_32_bits(lights, robot):
    robot.leds.values["Head/Led/Front/0/Actuator/Value"] = 0.30000001192092896
    server = play(lights, f("getIntensity", lights=["Brain0"]))
    assert server.result.results[0].values == ["0.3"]
    assert server.result.intensities == [0.3]


def test_colours_are_read_for_lights_and_groups(lights, robot):
    server = play(
        lights,
        f("setColor", lights=["LeftFaceLeds"], str_param="cyan"),
        f("getColor", lights=["LeftFaceLeds", "LeftFaceLed2"]),
    )
    assert server.result.results[1].values == ["[0.0, 1.0, 1.0]", "[0.0, 1.0, 1.0]"]


def test_a_group_made_in_a_chain_is_used_later_in_the_same_chain(lights, robot):
    server = play(
        lights,
        f("createGroup", str_param="Mine", lights=["LeftFaceLeds", "Brain0"]),
        f("setIntensity", lights=["Mine"], i_values=[1.0]),
        f("listGroup", str_param="Mine"),
    )
    assert server.end == "succeeded"
    assert calls(robot, "createGroup") == [("createGroup", "Mine", ["LeftFaceLed1", "LeftFaceLed2", "Brain0"])]
    assert server.result.memList == ["LeftFaceLed1", "LeftFaceLed2", "Brain0"]
    assert play(lights, f("on", lights=["Mine"])).end == "succeeded", "and in a later one"


def test_a_group_that_is_made_too_late_is_unknown(lights):
    server = play(lights, f("on", lights=["Mine"]), f("createGroup", str_param="Mine", lights=["Brain0"]))
    assert server.text.startswith("function 1 (on): field lights: unknown light 'Mine'")


def test_a_group_that_another_program_made_is_found(lights, robot):
    play(lights, f("on", lights=["Brain0"]))
    robot.leds.groups["Theirs"] = ["Brain1"]
    assert play(lights, f("on", lights=["Theirs"])).end == "succeeded"


def test_names_are_read_once_and_again_after_a_reconnection_and_once_for_an_unknown_name(lights, robot):
    for _ in range(3):
        play(lights, f("on", lights=["Brain0"]))
    assert len(calls(robot, "listGroups")) == 1
    robot.connection.become("connected")
    play(lights, f("on", lights=["Brain0"]))
    assert len(calls(robot, "listGroups")) == 2
    play(lights, f("on", lights=["Nothing"]), f("off", lights=["Nothing"]))
    assert len(calls(robot, "listGroups")) == 3


def test_lists_of_names(lights, robot):
    assert play(lights, f("listLEDs")).result.memList == list(robot.leds.lights)
    assert play(lights, f("listGroups")).result.memList == list(robot.leds.groups)
    assert lights.leds.groups["FaceLeds"] == (
        "LeftFaceLed1",
        "LeftFaceLed2",
        "RightFaceLed1",
        "RightFaceLed2",
    )


@pytest.mark.parametrize(
    "message, text",
    [
        (
            f("setColor", lights=["LeftFaceLed"], i_values=[0, 1, 0]),
            "field lights: unknown light 'LeftFaceLed': did you",
        ),
        (f("on"), "field lights: it is empty: at least one light or group"),
        (
            f("setIntensity", lights=["Brain0"], i_values=[]),
            "field i_values: 0 values for 1 light: allowed are 1",
        ),
        (
            f("setIntensity", lights=["Brain0"], i_values=[1.1]),
            "field i_values: 1.1 is not allowed: each within 0..1",
        ),
        (
            f("fade", lights=["Brain0"], i_values=[1], duration=-1.0),
            "field duration: -1.0 is not allowed: 0 s or more",
        ),
        (
            f("setColor", lights=["Brain0"], str_param="red"),
            "field lights: 'Brain0' has one colour only: a light with",
        ),
        (f("getColor", lights=["LeftEarLed1"]), "field lights: 'LeftEarLed1' has one colour only"),
        (f("setColor", lights=["LeftFaceLedsRed"], str_param="red"), "'LeftFaceLedsRed' has one colour only"),
        (
            f("setColor", lights=["FaceLeds"], str_param="grean"),
            "field str_param: unknown colour 'grean': did you mean",
        ),
        (
            f("setColor", lights=["FaceLeds"]),
            "field i_values: 0 values for the colours of 1 light: allowed are 3",
        ),
        (f("fadeRGB", lights=["FaceLeds"], str_param="red", duration=-1.0), "field duration"),
        (f("fadeListRGB", lights=["FaceLeds"], str_param="red", times=[]), "field times: it is empty"),
        (
            f("fadeListRGB", lights=["FaceLeds"], str_param="red", times=[1, 2]),
            "field str_param: 1 colour for 2 times",
        ),
        (f("randomEyes"), "field duration: 0.0 is not allowed: more than 0 s"),
        (f("rasta", duration=-1.0), "field duration: -1.0 is not allowed: more than 0 s"),
        (f("rotateEyes", str_param="red", duration=1.0), "field rotation_time"),
        (f("rotateEyes", i_values=[1, 0], rotation_time=1.0, duration=1.0), "field i_values: 2 values"),
        (f("earLedsSetAngle", angle=400, duration=1.0), "field angle: 400 is not allowed: 0..360 deg"),
        (f("createGroup", lights=["Brain0"]), "field str_param: it is empty: the name of the new group"),
        (f("createGroup", str_param="Brain0", lights=["Brain1"]), "field str_param: 'Brain0' is a light"),
        (f("createGroup", str_param="New"), "field lights: it is empty"),
        (
            f("listGroup", str_param="FaceLedz"),
            "field lights: unknown light 'FaceLedz': did you mean 'FaceLeds'",
        ),
        (f("on", lights=["Brain0"], time=Duration(-1)), "field time: -1.0 is not allowed: 0 s or more"),
    ],
    ids=lambda value: value.function if isinstance(value, LedFunction) else "",
)
def test_a_bad_function_in_a_chain_moves_nothing_and_says_what_is_wrong(lights, robot, message, text):
    server = play(lights, f("on", lights=["Brain1"]), message)
    assert server.end == "aborted"
    assert server.text.startswith(f"function 2 ({message.function}): ")
    assert text in server.text
    assert set(robot.leds.values.values()) == {BEFORE}
    assert server.result.results == []
    assert play(lights, f("on", lights=["Brain1"])).end == "succeeded", "the server lives on"


def test_a_robot_that_does_not_tell_a_value_aborts_with_the_name_of_the_led(lights, robot):
    del robot.leds.values["Head/Led/Front/0/Actuator/Value"]
    server = play(lights, f("getIntensity", lights=["Brain0"]))
    assert server.end == "aborted"
    assert "None as the value of LED 'Head/Led/Front/0/Actuator/Value'" in server.text

"""Every function of NaoLights, with what the LEDs of the robot do."""

from __future__ import annotations

import traceback

import pytest
from goal_functions import led as f

from naoqi.calls import RemoteMethod

EYES = [f"Face/Led/{{}}/{side}/{angle}Deg" for side in ("Left", "Right") for angle in range(0, 360, 45)]
PARTS = ("Red", "Green", "Blue")
BRAIN0, BRAIN1, REAR = "Head/Led/Front/Right/1", "Head/Led/Front/Right/0", "Head/Led/Rear/Left/0"
CHEST = "ChestBoard/Led/{}"
DARK, WHITE, GREEN, CYAN = (0, 0, 0), (1, 1, 1), (0, 1, 0), (0, 1, 1)
BOTH_EYES = ["LeftFaceLeds", "RightFaceLeds"]


def lasted(seconds):
    """A time that something took, with what the way of a call takes on a busy computer, s."""
    return pytest.approx(seconds + 0.35, abs=0.45)


@pytest.fixture
def eyes(robot):
    """The different colours that the 16 segments of the eyes have."""
    return lambda: {tuple(round(robot.led(eye.format(part)), 3) for part in PARTS) for eye in EYES}


def test_on_off_and_reset(robot, lights, eyes):
    result = lights.succeed(f("off", lights=["AllLeds"]))
    assert eyes() == {DARK} and robot.led(BRAIN0) == 0.0
    assert len(result.lights) == 57 and set(result.intensities) == {0.0}
    result = lights.succeed(f("on", lights=["FaceLeds", "Brain0"]))
    assert eyes() == {WHITE} and (robot.led(BRAIN0), robot.led(REAR)) == (1.0, 0.0)
    assert len(result.lights) == 17 and set(result.intensities) == {1.0}
    lights.succeed(f("reset", lights=["AllLeds"]))
    assert eyes() == {WHITE} and (robot.led(REAR), robot.led(CHEST.format("Red"))) == (1.0, 0.0)


def test_intensities_one_for_all_one_each_and_read_back(robot, lights):
    result = lights.succeed(f("setIntensity", lights=["Brain0"], i_values=[0.5]))
    assert (result.lights, result.intensities) == (["Brain0"], [0.5])
    lights.succeed(f("setIntensity", lights=["Brain0", "Brain1"], i_values=[0.25]))
    assert (robot.led(BRAIN0), robot.led(BRAIN1)) == (0.25, 0.25)
    lights.succeed(f("setIntensity", lights=["Brain0", "ChestLedsBlue"], i_values=[0.3, 0.75]))
    assert (robot.led(BRAIN0), robot.led(CHEST.format("Blue"))) == (pytest.approx(0.3), 0.75)
    robot.ALLeds.createGroup("Pair", ["Brain0", "Brain1"])
    result = lights.succeed(f("getIntensity", lights=["ChestLedsBlue", "Brain0", "Pair"]))
    # The robot keeps 32 bits: 0.3 comes back as it was given all the same; of a group the mean is told.
    assert result.results[0].values == ["0.75", "0.3", "0.275"]
    assert result.memList == [], "the result has fields for it"
    blue, *rest = zip(result.lights, result.intensities)
    assert blue[1] == 0.75 and rest == [("Brain0", 0.3), ("Brain1", 0.25)]


def test_colours_by_value_by_name_and_each(robot, lights, eyes):
    lights.succeed(f("setColor", lights=["FaceLeds"], str_param="yellow"))
    assert eyes() == {(1, 1, 0)}
    result = lights.succeed(f("setColor", lights=[BOTH_EYES[0], "ChestLeds"], i_values=[1, 0, 0, 0, 0, 1]))
    assert eyes() == {(1, 0, 0), (1, 1, 0)}
    assert [robot.led(CHEST.format(part)) for part in PARTS] == [0.0, 0.0, 1.0]
    assert result.results[0].values == []
    result = lights.succeed(f("getColor", lights=["ChestLeds", "FaceLeds"]))
    assert result.results[0].values == ["[0.0, 0.0, 1.0]", "[1.0, 0.5, 0.0]"]
    assert result.memList == []


def test_plain_words_for_lights_are_taken_wherever_a_group_is(robot, lights, eyes):
    result = lights.succeed(f("setColor", lights=["LeftEye", "Chest"], i_values=[1, 0, 0, 0, 0, 1]))
    assert eyes() == {(1, 0, 0), (1, 1, 1)} and [robot.led(CHEST.format(part)) for part in PARTS] == [0, 0, 1]
    assert {"LeftFaceLed1", "ChestLedsBlue"} <= set(result.lights), "by the robot's names"
    lights.succeed(f("setColor", lights=["Eyes"], str_param="green", revert=True))
    assert eyes() == {(1, 0, 0), (1, 1, 1)}
    result = lights.succeed(f("fade", lights=["Ears"], i_values=[0.5]), f("getIntensity", lights=["Ears", "RightEar"]))
    assert result.results[1].values == ["0.5", "0.5"]
    assert robot.led("Ears/Led/Left/72Deg") == 0.5


def test_fades_take_their_time_all_lights_together(robot, lights, eyes):
    lights.succeed(f("off", lights=["AllLeds"]))
    goal = lights.send(f("fade", lights=["Brain0", "Brain1"], i_values=[0.2, 1.0], duration=1.0))
    robot.advance(0.5)
    before = robot.led(BRAIN0), robot.led(BRAIN1)
    robot.advance(0.2)
    assert robot.led(BRAIN0) - before[0] == pytest.approx(0.04) and robot.led(BRAIN1) - before[1] == pytest.approx(0.2)
    (done,) = goal.finish().result.results
    assert done.elapsed.to_sec() == lasted(1.0)
    assert (robot.led(BRAIN0), robot.led(BRAIN1)) == pytest.approx((0.2, 1.0), abs=0.01)
    goal = lights.send(f("fadeRGB", lights=BOTH_EYES, i_values=[0, 0, 1, 0, 0, 0.5], duration=0.5))
    robot.advance(0.25)
    assert 0.0 < robot.led("Face/Led/Blue/Left/0Deg") < 0.6
    assert goal.finish().result.results[0].elapsed.to_sec() == lasted(0.5)
    robot.advance(0.05)
    assert eyes() == {(0, 0, 1), (0, 0, 0.5)}
    lights.succeed(f("fade", lights=["Brain0"], i_values=[0.9]), f("fadeRGB", lights=["FaceLeds"], str_param="#FF0000"))
    assert robot.led(BRAIN0) == pytest.approx(0.9) and eyes() == {(1, 0, 0)}, "without a duration at once"


def test_a_fade_through_colours_reaches_each_at_its_time(robot, lights, eyes):
    goal = lights.send(f("fadeListRGB", lights=["FaceLeds"], str_param="red, green,#0000ff", times=[1, 3, 4]))
    robot.advance(2.0)
    (colour,) = eyes()
    assert 0.49 < colour[0] <= 1.0 and colour[0] + colour[1] == pytest.approx(1.0, abs=1e-3)
    robot.advance(0.5)
    (later,) = eyes()
    assert later == pytest.approx((colour[0] - 0.25, colour[1] + 0.25, 0.0), abs=1e-3)
    goal.finish()
    robot.advance(0.05)
    assert (goal.state, eyes()) == ("succeeded", {(0, 0, 1)})
    assert goal.result.results[0].elapsed.to_sec() == lasted(4.0)


ANIMATIONS = [
    (f("randomEyes", duration=0.6), lambda colours: len(colours) == 16),
    (f("rasta", duration=0.6), lambda colours: len(colours) == 1 and colours < {GREEN, (1, 1, 0), (1, 0, 0)}),
    (f("rotateEyes", i_values=CYAN, rotation_time=0.4, duration=0.6), lambda colours: colours == {CYAN, DARK}),
]


@pytest.mark.parametrize("function, shown", ANIMATIONS, ids=lambda value: getattr(value, "function", ""))
def test_animations_change_the_eyes_for_their_time(robot, lights, eyes, function, shown):
    result = lights.succeed(function)
    assert result.results[0].elapsed.to_sec() == lasted(0.6)
    assert shown(eyes()), eyes()
    assert len(result.lights) == (57 if function.function == "rasta" else 16)


def test_ears_show_a_direction(robot, lights):
    result = lights.succeed(f("earLedsSetAngle", angle=90, duration=0.2, leave_on=True))
    assert robot.led("Ears/Led/Left/72Deg") > 0.9 and robot.led("Ears/Led/Left/252Deg") == 0.0
    assert len(result.lights) == 20 and all("Ear" in light for light in result.lights)
    lights.succeed(f("earLedsSetAngle", angle=90, duration=0.2))
    robot.advance(0.05)
    assert robot.led("Ears/Led/Left/72Deg") == 0.0


def test_groups_are_made_listed_and_used_like_any_other(robot, lights):
    make = f("createGroup", str_param="Mine", lights=["Brain0", "ChestLeds"])
    text = lights.refused(f("on", lights=["Mine"]), make)
    assert text.startswith("function 1 (on): field lights: unknown light 'Mine'")
    result = lights.succeed(
        make, f("setIntensity", lights=["Mine"], i_values=[0.4]), f("listGroup", str_param="Mine"), f("listGroups"),
        f("listLEDs"),
    )  # fmt: skip
    assert robot.led(BRAIN0) == robot.led(CHEST.format("Red")) == pytest.approx(0.4)
    members, groups, leds = (done.values for done in result.results[2:])
    assert members[0] == "Brain0" and "Mine" in groups and len(leds) == 57
    assert result.memList == [*members, *groups, *leds]
    assert lights.module.leds.groups["Mine"] == tuple(members)
    robot.ALLeds.createGroup("Theirs", ["Brain1"])
    lights.succeed(f("off", lights=["Theirs", "Mine"]))
    assert (robot.led(BRAIN0), robot.led(BRAIN1)) == (0.0, 0.0), "also what another program has made"


def test_each_function_reverts_before_the_next_begins_to_what_was_before_it(robot, lights, eyes):
    result = lights.succeed(
        f("setIntensity", lights=["Brain0"], i_values=[0.7]),
        f("setColor", lights=["LeftFaceLed1"], i_values=[0.1, 0.2, 0.3]),
        f("off", lights=["Brain0", "FaceLeds"], revert=True),
        f("getIntensity", lights=["Brain0"]),
        f("getColor", lights=["LeftFaceLed1"]),
        f("rasta", duration=0.5, revert=True),
        f("getColor", lights=["LeftFaceLed1"]),
    )
    assert [result.results[n].values for n in (3, 4, 6)] == [["0.7"], ["[0.1, 0.2, 0.3]"], ["[0.1, 0.2, 0.3]"]]
    assert len(eyes()) == 2 and WHITE in eyes()


def test_a_cancelled_fade_stops_where_it_is_and_goes_back_only_on_demand(robot, lights):
    fade = {"lights": ["Brain0"], "i_values": [0.0], "duration": 4.0}
    goal = lights.send(f("fade", **fade))
    robot.advance(2.0)
    assert goal.cancel().state == "preempted"
    stopped = robot.led(BRAIN0)
    assert 0.49 < stopped < 0.75 and goal.result.intensities == [pytest.approx(stopped, abs=1e-6)]
    robot.advance(0.5)
    assert robot.led(BRAIN0) == stopped
    goal = lights.send(f("fade", revert=True, **fade))
    robot.advance(1.0)
    goal.cancel()
    assert (goal.state, robot.led(BRAIN0)) == ("preempted", pytest.approx(stopped, abs=1e-6))
    robot.advance(0.5)
    assert robot.led(BRAIN0) == pytest.approx(stopped, abs=1e-6)


REFUSED = [
    (f("setColor", lights=["LeftFaceLed"], i_values=GREEN), "field lights: unknown light 'LeftFaceLed': did you mean"),
    (f("on"), "field lights: it is empty: at least one light or group"),
    (f("setIntensity", lights=["Brain0"]), "field i_values: 0 values for 1 light: allowed are 1"),
    (f("setIntensity", lights=["Brain0"], i_values=[1.1]), "field i_values: 1.1 is not allowed: each within 0..1"),
    (f("fade", lights=["Brain0"], i_values=[1], duration=-1.0), "duration: -1.0 is not allowed: 0.001..86400 s, or 0"),
    (f("setColor", lights=["Brain0"], str_param="red"), "field lights: 'Brain0' has one colour only: a light with"),
    (f("setColor", lights=["FaceLeds"], str_param="grean"), "field str_param: unknown colour 'grean': did you mean"),
    (f("setColor", lights=["FaceLeds"]), "field str_param: there is no colour: a name or '#RRGGBB' here"),
    (f("fadeListRGB", lights=["FaceLeds"], str_param="red"), "s from the start, at least one"),
    (f("fadeListRGB", lights=["FaceLeds"], str_param="red", times=[1, 2]), "field str_param: 1 colour for 2 times"),
    (f("randomEyes"), "field duration: 0.0 is not allowed: 0.001..86400 s"),
    (f("rotateEyes", str_param="red", duration=1.0), "field rotation_time: 0.0 is not allowed: 0.001..86400 s"),
    (f("earLedsSetAngle", angle=400, duration=1.0), "field angle: 400 is not allowed: 0..360 deg"),
    (f("createGroup", lights=["Brain0"]), "field str_param: it is empty: the name of the new group"),
    (f("createGroup", str_param="Brain0", lights=["Brain1"]), "field str_param: 'Brain0' is a light"),
    (f("listGroup", str_param="FaceLedz"), "field lights: unknown light 'FaceLedz': did you mean 'FaceLeds'"),
    (f("on", -1.0, lights=["Brain0"]), "field time: -1.0 is not allowed: 0..86400 s"),
    (f("on", 1e6, lights=["Brain0"]), "field time: 1000000.0 is not allowed: 0..86400 s"),
    (f("fadeListRGB", lights=["FaceLeds"], str_param="red", times=[1.7e308]), "field times: [1.7e+308] is not allowed"),
    (f("rotateEyes", str_param="red", duration=1.0, rotation_time=1e-320), "field rotation_time: "),
]  # fmt: skip


def test_a_bad_function_in_a_chain_changes_nothing_and_says_what_is_wrong(robot, lights):
    for message, text in REFUSED:
        goal = lights.play(f("off", lights=["AllLeds"]), message)
        assert (goal.state, goal.result.results, goal.feedback) == ("aborted", [], []), message
        assert goal.text.startswith(f"function 2 ({message.function}): ") and text in goal.text
    assert robot.led(BRAIN0) == 1.0
    lights.succeed(f("off", lights=["Brain0"]))


def test_names_are_read_again_only_for_a_light_that_is_not_known(lights, monkeypatch):
    leds, looks = lights.module.leds, []
    assert leds.names.knows("Brain0")
    read = leds.read_names
    monkeypatch.setattr(leds, "read_names", lambda: looks.append(1) or read())
    lights.succeed(f("on", lights=["Brain0"]), f("off", lights=["Brain0"]))
    assert not looks
    assert lights.play(f("on", lights=["Nothing"])).state == "aborted" and len(looks) == 1


def test_the_way_of_a_goal_to_the_robot_is_short(lights, monkeypatch):
    ways = []
    start = RemoteMethod.start

    def seen(method, *arguments):
        frames = [frame.name for frame in traceback.extract_stack() if "/src/" in frame.filename]
        if method.name == "fadeRGB":
            ways.append(frames[frames.index("execute_cb") :])
        return start(method, *arguments)

    monkeypatch.setattr(RemoteMethod, "start", seen)
    lights.succeed(f("setColor", lights=["FaceLeds"], str_param="green"))
    assert ways == [["execute_cb", "_run_chain", "_run_step", "run", "set_color", "_act", "call", "call_async"]]

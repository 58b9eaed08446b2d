"""Behaviours in files and of Choregraphe: what they become, and what is refused."""

from __future__ import annotations

import math
import zipfile

import pytest
from choregraphe import (
    HEADER,
    NOD,
    OWN,
    SAYS,
    box,
    curve,
    diagram,
    goes,
    link,
    parameters,
    project,
    says,
    timeline,
    waits,
)

from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.behaviors.packages import read_package, renamed
from nao_sim_bridge.behaviors.reader import behaviors_of
from nao_sim_bridge.behaviors.steps import (
    GoToPosture,
    Joints,
    Lights,
    Refused,
    Repeat,
    Say,
    Together,
    Wait,
    joints_of,
    length_of,
)
from nao_sim_bridge.behaviors.xar import xar_step
from nao_sim_bridge.model.model_reader import load_model

RED = {"lights": "FaceLeds", "color": "red"}


def steps(*entries, name="test"):
    return behaviors_of({"behaviors": {name: {"do": list(entries)}}}, "file")[name].step.steps


def test_every_kind_of_step_is_read():
    read = steps(
        {"posture": "Stand", "speed": 0.5},
        {"lights": "FaceLeds", "color": "#ff8000", "duration": 0.5},
        {"say": "Hello", "animated": True},
        {"wait": 1.5},
        {"together": [{"wait": 1.0}, [{"wait": 1.0}, {"wait": 2.0}]]},
        {"repeat": 0, "do": [{"wait": 1.0}]},
        {"frames": [{"time": 0.5, "angles": {"HeadYaw": 0.1}}, {"time": 0.5, "angles": {"HeadPitch": 0.2}}]},
        {"joints": {"HeadYaw": {"times": [0.5, 1.0], "angles": [0.1, 0.2]}}},
    )
    lights = Lights("FaceLeds", (1.0, 128 / 255, 0.0), 0.5)
    assert read[:4] == (GoToPosture("Stand", 0.5), lights, Say("Hello", True), Wait(1.5))
    assert steps({"repeat": 100000, "do": [RED, {"wait": 0.1}]}) and steps({"repeat": 3, "do": [{"say": "Hello"}]})
    both, again, frames, joints = read[4:]
    assert isinstance(both, Together) and length_of(both) == 3.0
    assert isinstance(again, Repeat) and again.times is None and length_of(Repeat(Wait(2.0), 3)) == 6.0
    # Times of frames add up, those of joints count from the begin.
    assert isinstance(frames, Joints) and frames.ways["HeadPitch"].points[0].time == 1.0
    assert frames.length == joints.length == 1.0 and joints_of(frames) == {"HeadYaw", "HeadPitch"}


@pytest.mark.parametrize(
    "entry, told",
    [
        ({"posture": "Handstand"}, "allowed is Stand"),
        ({"frames": [{"time": 0.5, "angles": {"HeadYaw": 9.0}}]}, "HeadYaw: is 9"),
        ({"joints": {"HeadYaw": {"times": [0.5, 0.5], "angles": [0.1, 0.2]}}}, "do not rise"),
        ({"wait": -1.0}, "allowed is 0"),
        ({"repeat": 0, "do": [RED]}, "takes no time"),
        ({"repeat": 100000, "do": [RED]}, "beyond step 5000"),
        ({"repeat": 100, "do": [{"repeat": 100, "do": [RED]}]}, "beyond step 5000"),
        ({"dance": "tango"}, "has not one of"),
        ({"wait": 1.0, "until": 2.0}, "unknown key 'until'"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(entry, told):
    with pytest.raises(ConfigError, match=told) as error:
        steps({"wait": 0.1}, entry)
    assert error.value.where.startswith("file: test: do[1]")


def read(boxes, *links):
    return xar_step(project(boxes, "".join(link(*one) for one in ((0, 1), *links))), "file")


def inside(step):
    """What the boxes of a diagram do."""
    return [one.step for one in step.boxes]


def test_a_timeline_becomes_joints_in_radians_and_seconds_shaped_by_tangents():
    ways = inside(read(box(1, "Nod", NOD)))[0].joints.ways
    assert ways["LHand"].points[0].angle == 0.5
    found = [(point.time, point.angle) for point in ways["HeadPitch"].points]
    assert found == [(0.5, pytest.approx(math.radians(10.0))), (1.0, 0.0)]
    tangent = '<Tangent side="right" interpType="bezier" abscissaParam="2" ordinateParam="5"/>'
    turns = timeline(curve("HeadYaw", (5, 10.0, tangent), (10, 0.0)))
    way = inside(read(box(1, "Look", turns)))[0].joints.ways["HeadYaw"]
    after = way.points[0].after
    assert way.curved and (after.time, after.angle) == (0.2, pytest.approx(math.radians(5.0)))


@pytest.mark.parametrize("unit", [0, -1, 1])
def test_angles_are_in_degrees_whatever_the_unit_of_their_curve(unit):
    turns = timeline(curve("HeadYaw", (5, 20.0), unit=unit), curve("LHand", (5, 0.5), unit=unit))
    ways = inside(read(box(1, "Turn", turns)))[0].joints.ways
    assert ways["HeadYaw"].points[0].angle == pytest.approx(math.radians(20.0))
    assert ways["LHand"].points[0].angle == 0.5, "hands open by shares"


def test_a_joint_goes_as_far_as_it_can_and_that_is_told(caplog):
    ways = inside(read(box(1, "Turn", timeline(curve("HeadYaw", (5, 150.0))))))[0].joints.ways
    assert ways["HeadYaw"].points[0].angle == pytest.approx(load_model().joint("HeadYaw").upper)
    assert "box 'Turn' moves HeadYaw to 2.618" in caplog.text


def test_a_posture_is_that_of_the_parameter_name_or_of_the_script():
    assert inside(read(goes(1, "Sit"))) == [GoToPosture("Sit", 0.5)]
    script = 'ALRobotPosture\nresult = self.postureService.goToPosture("Stand", 0.8)'
    assert inside(read(box(1, "Go to position Stand", "", script))) == [GoToPosture("Stand", 0.8)]


def test_a_say_box_has_its_speed_and_voice_and_an_animated_one_its_mode():
    given = {"Text": "Hi", "Speed (%)": 80, "Voice shaping (%)": 120}
    assert inside(read(box(1, "Say", parameters(**given), SAYS))) == [Say("\\rspd=80\\ \\vct=120\\ Hi")]
    given = {"Text": "Hi", "Speaking movement mode": "disabled", "Animation": "Hey_1"}
    animated = box(1, "Animated Say", parameters(**given), "service('ALAnimatedSpeech')")
    assert inside(read(animated)) == [Say("^mode(disabled) ^start(Hey_1) Hi ^wait(Hey_1)", True)]


def test_a_chain_of_boxes_may_be_long():
    step = read("".join(waits(number, number) for number in range(1, 1001)), *((n, n + 1) for n in range(1, 1000)))
    assert length_of(step) == sum(range(1, 1001))


def moves(*keys, fps=10):
    moving = timeline(curve("HeadYaw", *keys)).replace('fps="10"', f'fps="{fps}"')
    return project(box(1, "Move", moving), link(0, 1))


def nested(depth):
    inner = says(1, "deep")
    for _ in range(depth):
        inner = box(1, "Box", diagram(inner, link(0, 1)))
    return project(inner, link(0, 1))


def told_once(*boxes):
    return project("".join(boxes), "".join(link(0, number) for number in range(1, len(boxes) + 1)))


@pytest.mark.parametrize(
    "content, told",
    [
        (told_once(*(says(number, "Hi") for number in range(1, 2002))), "too many boxes"),
        (nested(52), "nested too deep"),
        (moves((5, 1.0), fps="1e-310"), "frames a second is 1e-310, allowed is 1 to 100"),
        (moves((5, 1.0), fps="0"), "frames a second is 0"),
        (moves(("1e308", 1.0)), "frame of a key of HeadYaw is 1e308, allowed is -36000 to 36000"),
        (moves((5, "inf")), "a key of HeadYaw is inf"),
        (moves((5, 1.0, '<Tangent ordinateParam="1e308"/>')), "the tangent of a key of HeadYaw is 1e308"),
        (told_once(waits(1, 1e9)), "the time of box 'Wait' is 1000000000"),
        (told_once(says(1, "x" * 10001)), "a text of 10001 characters"),
        (told_once(box(1, "Mine", "", OWN)), "1 of its boxes cannot be played: 'Mine': a script of its own"),
        (told_once(box(1, "Mine", diagram(says(1, "Hi"), link(0, 1)), OWN)), "'Mine': a script of its own"),
        (told_once(box(1, "Say", parameters(Text="Hi"), f"{SAYS}; os.remove('x')")), "'Say': a script of its own"),
        (told_once(box(1, "Talk", "<dialogFile>talk.dlg</dialogFile>")), "'Talk': a dialogue, which is not held"),
        (told_once(goes(1, "Handstand")), "'Goto Posture': it goes to posture 'Handstand', there are Stand"),
        (told_once(box(1, "A", timeline(curve("WheelB", (5, 1.0))))), "no joint of a NAO"),
        (b"<html/>", "no behaviour of Choregraphe"),
        (b'<!DOCTYPE a [<!ENTITY x "x">]><a/>', "document type"),
        ("<a/>".encode("utf-16"), "is not in UTF-8"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_cannot_be_played_is_told(content, told):
    with pytest.raises(ConfigError, match=told):
        xar_step(content, "file")


def test_one_refusal_names_all_boxes_that_cannot_play():
    inner = box(2, "Part", diagram(box(1, "Mine", "", OWN) + says(2, "Hi"), link(0, 1) + link(0, 2)))
    talk = box(3, "Talk", "<dialogFile>talk.dlg</dialogFile>")
    with pytest.raises(ConfigError) as error:
        xar_step(told_once(box(1, "Mine", "", OWN), inner, talk, says(4, "Hi")), "file")
    refusal = str(error.value)
    assert "3 of its boxes cannot be played" in refusal
    assert "'Mine', 'Part/Mine': a script of its own" in refusal and "'Talk': a dialogue" in refusal


def test_a_box_that_no_link_leads_to_is_left_out(caplog):
    assert len(read(says(1, "Hi") + box(2, "Mine", "", OWN)).boxes) == 1
    assert "no link leads to 'Mine': left out, with the onLoad of their scripts" in caplog.text


MANIFEST = f"""{HEADER}<package uuid="greeter" version="1.0.0"><contents><behaviorContent path="behavior_1">
<nature>interactive</nature><tags><tag>hello</tag></tags></behaviorContent></contents></package>"""


def test_a_package_is_read_from_its_folder_and_from_its_archive_and_from_nowhere_else(tmp_path):
    folder, song = tmp_path / "project", tmp_path / "song.mp3"
    (folder / "behavior_1").mkdir(parents=True)
    (folder / "manifest.xml").write_text(MANIFEST)
    (folder / "behavior_1" / "behavior.xar").write_bytes(project(box(1, "Nod", NOD), link(0, 1)))
    with zipfile.ZipFile(tmp_path / "greeter.pkg", "w") as archive:
        for path in folder.rglob("*.*"):
            archive.write(path, path.relative_to(folder))
    for path in (folder / "manifest.xml", tmp_path / "greeter.pkg"):
        (behavior,) = read_package(path)
        assert (behavior.name, behavior.nature, behavior.tags) == ("greeter/behavior_1", "interactive", ("hello",))
        assert length_of(behavior.step) == 1.0
    assert renamed([behavior], "mine")[0].name == "mine"
    (tmp_path / "secret.xar").write_bytes(project(box(1, "Nod", NOD), link(0, 1)))
    (folder / "manifest.xml").write_text(MANIFEST.replace("behavior_1", "../.."))
    song.write_bytes(b"")
    for path, told in ((folder / "manifest.xml", "not in the package"), (song, "known are .yaml")):
        with pytest.raises(ConfigError, match=told):
            read_package(path)


TWO = MANIFEST.replace("</contents>", '<behaviorContent path="other"/></contents>')


def test_the_other_behaviours_of_a_package_are_read_when_one_cannot_be_played(tmp_path):
    for name, script in (("behavior_1", OWN), ("other", SAYS)):
        (tmp_path / name).mkdir()
        content = told_once(box(1, "Mine", parameters(Text="Hi"), script))
        (tmp_path / name / "behavior.xar").write_bytes(content)
    (tmp_path / "manifest.xml").write_text(TWO)
    refused, other = read_package(tmp_path / "manifest.xml")
    assert isinstance(refused.step, Refused) and "'Mine': a script of its own" in refused.step.reason
    assert other.name == "greeter/other" and not isinstance(other.step, Refused)
    (tmp_path / "other" / "behavior.xar").unlink()
    with pytest.raises(ConfigError, match="none of its behaviors can be played: .*'Mine'.*other/behavior.xar"):
        read_package(tmp_path / "manifest.xml")

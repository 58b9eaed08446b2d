"""Behaviours in files and of Choregraphe: what they become, and what is refused."""

from __future__ import annotations

import math
import zipfile

import pytest

from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.behaviors.packages import read_package, renamed
from nao_sim_bridge.behaviors.reader import behaviors_of
from nao_sim_bridge.behaviors.steps import (
    GoToPosture,
    InTurn,
    Joints,
    Lights,
    Repeat,
    Say,
    Together,
    Wait,
    joints_of,
    length_of,
)
from nao_sim_bridge.behaviors.xar import xar_step

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


HEADER = '<?xml version="1.0" encoding="UTF-8" ?>'
SPACE = "http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd"


def project(boxes, links):
    return f"""{HEADER}<ChoregrapheProject xmlns="{SPACE}" xar_version="3">
    <Box name="root" id="-1"><Timeline enable="0"><BehaviorLayer name="l"><BehaviorKeyframe name="k" index="1">
    <Diagram>{boxes}{links}</Diagram></BehaviorKeyframe></BehaviorLayer></Timeline></Box></ChoregrapheProject>
    """.encode()


def box(number, name, inside, script="", text_input=False):
    kind = 3 if text_input else 1
    return f"""<Box name="{name}" id="{number}"><script language="4"><content><![CDATA[{script}]]></content></script>
    <Input name="onLoad" type="1" id="1"/><Input name="onStart" type="{kind}" id="2"/><Input name="onStop" id="3"/>
    <Output name="onStopped" id="4"/><Output name="onError" id="5"/>{inside}</Box>"""


def link(source, target, entry=2, end=4):
    return f'<Link inputowner="{target}" indexofinput="{entry}" outputowner="{source}" indexofoutput="{end}"/>'


def curve(joint, *keys, unit=0):
    listed = "".join(f'<Key frame="{frame}" value="{value}">{"".join(rest)}</Key>' for frame, value, *rest in keys)
    return f'<ActuatorCurve name="value" actuator="{joint}" mute="0" unit="{unit}">{listed}</ActuatorCurve>'


def timeline(*curves, diagram=""):
    layer = f'<BehaviorLayer><BehaviorKeyframe index="11">{diagram}</BehaviorKeyframe></BehaviorLayer>'
    return f'<Timeline enable="1" fps="10">{layer}<ActuatorList>{"".join(curves)}</ActuatorList></Timeline>'


def parameters(**values):
    return "".join(f'<Parameter name="{name}" value="{value}"/>' for name, value in values.items())


SAYS = "self.tts = self.session().service('ALTextToSpeech')"
NOD = timeline(curve("HeadPitch", (5, 10.0), (10, 0.0)), curve("LHand", (10, 0.5), unit=1))


def played(boxes, *links):
    return xar_step(project(boxes, "".join(link(*one) for one in ((0, 1), *links))), "file")


def flat(step):
    """The single steps of a sequence, in order."""
    return [single for inner in step.steps for single in flat(inner)] if isinstance(step, InTurn) else [step]


def test_a_timeline_becomes_joints_in_radians_and_seconds_shaped_by_tangents():
    step = played(box(1, "Nod", NOD))
    assert isinstance(step, Joints) and step.ways["LHand"].points[0].angle == 0.5
    found = [(point.time, point.angle) for point in step.ways["HeadPitch"].points]
    assert found == [(0.5, pytest.approx(math.radians(10.0))), (1.0, 0.0)]
    tangent = '<Tangent side="right" interpType="bezier" abscissaParam="2" ordinateParam="5"/>'
    way = played(box(1, "Look", timeline(curve("HeadYaw", (5, 10.0, tangent), (10, 0.0))))).ways["HeadYaw"]
    after = way.points[0].after
    assert way.curved and (after.time, after.angle) == (0.2, pytest.approx(math.radians(5.0)))


def test_boxes_follow_their_links_whatever_their_order_in_the_file():
    text = box(1, "Text Edit", "<pluginContent><text>Good day</text></pluginContent>", "send()")
    says = box(2, "Say Text", "", SAYS, text_input=True)
    stands = box(3, "Goto Posture", parameters(**{"Posture name": "Stand"}), "ALRobotPosture")
    waits = box(4, "Wait", parameters(**{"Timeout (s)": "1.5"}), "qi.async()")
    links = link(2, 4) + link(3, 1) + link(0, 3) + link(1, 2) + link(4, 0)
    found = flat(xar_step(project(says + waits + text + stands, links), "file"))
    assert found == [GoToPosture("Stand", 0.8), Say("Good day"), Wait(1.5)]
    both = played(box(1, "A", NOD) + box(2, "B", NOD), (0, 2))
    assert isinstance(both, Together) and length_of(both) == 1.0, "what begins together runs together"
    boxes = box(1, "A", NOD) + box(2, "B", NOD) + box(3, "C", NOD)
    assert isinstance(played(boxes, (1, 2, 3), (1, 3, 2, 5)), Joints), "links to stop and from errors begin nothing"


def test_a_box_speaks_as_fast_as_it_says_and_on_a_timeline_at_its_frame():
    fast = box(1, "Say", parameters(**{"Text": "Hi", "Speed (%)": "80"}), SAYS)
    assert flat(played(fast)) == [Say("\\rspd=80\\ Hi")]
    diagram = f"<Diagram>{box(1, 'Say', parameters(Text='Hi'), SAYS)}{link(0, 1)}</Diagram>"
    step = played(box(1, "Move", timeline(curve("HeadYaw", (20, 1.0)), diagram=diagram)))
    assert isinstance(step, Together) and flat(step.steps[1]) == [Wait(1.0), Say("Hi")]


def test_a_chain_of_boxes_may_be_long():
    boxes = "".join(box(number, "Wait", parameters(Timeout=number)) for number in range(1, 1001))
    step = played(boxes, *((number, number + 1) for number in range(1, 1000)))
    assert length_of(step) == sum(range(1, 1001))


def layers(count, width, inside):
    """Boxes in layers, each linked to all of the next layer: there are width ** count ways through."""
    numbers = [[1 + layer * width + place for place in range(width)] for layer in range(count)]
    boxes = "".join(box(number, "Text", inside) for layer in numbers for number in layer)
    links = [(a, b) for layer, after in zip([[0], *numbers], numbers) for a in layer for b in after]
    return project(boxes, "".join(link(*each) for each in links))


def moves(*keys, fps=10):
    moving = timeline(curve("HeadYaw", *keys)).replace('fps="10"', f'fps="{fps}"')
    return project(box(1, "Move", moving), link(0, 1))


@pytest.mark.parametrize(
    "content, told",
    [
        (layers(12, 4, "<pluginContent><text>Good day</text></pluginContent>"), "too many boxes"),
        (layers(12, 4, ""), "too many boxes"),
        (layers(60, 2, ""), "nested too deep"),
        (moves((5, 1.0), fps="1e-310"), "frames a second is 1e-310, allowed is 1 to 100"),
        (moves((5, 1.0), fps="0"), "frames a second is 0"),
        (moves(("1e308", 1.0)), "frame of a key of HeadYaw is 1e308, allowed is -36000 to 36000"),
        (moves((5, "inf")), "a key of HeadYaw is inf"),
        (moves((5, 1.0, '<Tangent ordinateParam="1e308"/>')), "the tangent of a key of HeadYaw is 1e308"),
        (project(box(1, "Wait", parameters(Timeout="1e9")), link(0, 1)), "the time of box 'Wait' is 1e9"),
        (project(box(1, "Say", parameters(Text="x" * 10001), SAYS), link(0, 1)), "a text of 10001 characters"),
        (project(box(1, "Mine", "", "os.remove('x')"), link(0, 1)), "box 'Mine' runs a script"),
        (project(box(1, "A", NOD) + box(2, "B", NOD), link(0, 1) + link(1, 2) + link(2, 1)), "circles"),
        (project(box(1, "A", timeline(curve("WheelB", (5, 1.0)))), link(0, 1)), "no joint of a NAO"),
        (b"<html/>", "no behaviour of Choregraphe"),
        (b'<!DOCTYPE a [<!ENTITY x "x">]><a/>', "document type"),
    ],
)
def test_what_cannot_be_played_is_told(content, told):
    with pytest.raises(ConfigError, match=told):
        xar_step(content, "file")


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

"""Behaviours of Choregraphe: which boxes are played, in which order, and which are refused."""

from __future__ import annotations

import math
import zipfile

import pytest

from nao_sim_bridge.sim.behaviors.packages import read_package, renamed
from nao_sim_bridge.sim.behaviors.steps import (
    GoToPosture,
    InTurn,
    Joints,
    Repeat,
    Say,
    Together,
    Wait,
    length_of,
)
from nao_sim_bridge.sim.behaviors.xar import xar_step
from nao_sim_bridge.sim.errors import ConfigError

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


def curve(joint, keys, unit=0):
    listed = "".join(f'<Key frame="{frame}" value="{value}">{rest}</Key>' for frame, value, rest in keys)
    return f'<ActuatorCurve name="value" actuator="{joint}" mute="0" unit="{unit}">{listed}</ActuatorCurve>'


def timeline(*curves, fps=10, diagram=""):
    layer = f'<BehaviorLayer><BehaviorKeyframe index="11">{diagram}</BehaviorKeyframe></BehaviorLayer>'
    return f'<Timeline enable="1" fps="{fps}">{layer}<ActuatorList>{"".join(curves)}</ActuatorList></Timeline>'


SAYS = "self.tts = self.session().service('ALTextToSpeech')"
NOD = timeline(curve("HeadPitch", [(5, 10.0, ""), (10, 0.0, "")]), curve("LHand", [(10, 0.5, "")], unit=1))


def flat(step):
    """The single steps of a sequence, in order."""
    if isinstance(step, InTurn):
        return [single for inner in step.steps for single in flat(inner)]
    return [step]


def test_a_timeline_becomes_joints_in_radians_and_seconds():
    step = xar_step(project(box(1, "Nod", NOD), link(0, 1)), "file")
    assert isinstance(step, Joints)
    first, last = step.ways["HeadPitch"].points
    assert (first.time, first.angle) == (0.5, pytest.approx(math.radians(10.0)))
    assert (last.time, last.angle) == (1.0, 0.0)
    assert step.ways["LHand"].points[0].angle == 0.5


def test_tangents_shape_the_way():
    tangent = '<Tangent side="right" interpType="bezier" abscissaParam="2" ordinateParam="5"/>'
    curved = timeline(curve("HeadYaw", [(5, 10.0, tangent), (10, 0.0, "")]))
    way = xar_step(project(box(1, "Look", curved), link(0, 1)), "file").ways["HeadYaw"]
    assert way.curved
    assert (way.points[0].after.time, way.points[0].after.angle) == (0.2, pytest.approx(math.radians(5.0)))


def test_boxes_follow_their_links_whatever_their_order_in_the_file():
    text = box(1, "Text Edit", "<pluginContent><text>Good day</text></pluginContent>", "send()")
    says = box(2, "Say Text", "", SAYS, text_input=True)
    stands = box(3, "Goto Posture", '<Parameter name="Posture name" value="Stand"/>', "ALRobotPosture")
    waits = box(4, "Wait", '<Parameter name="Timeout (s)" value="1.5"/>', "qi.async()")
    links = link(2, 4) + link(3, 1) + link(0, 3) + link(1, 2) + link(4, 0)
    assert flat(xar_step(project(says + waits + text + stands, links), "file")) == [
        GoToPosture("Stand", 0.8),
        Say("Good day"),
        Wait(1.5),
    ]


def test_boxes_that_begin_together_run_together():
    step = xar_step(project(box(1, "A", NOD) + box(2, "B", NOD), link(0, 1) + link(0, 2)), "file")
    assert isinstance(step, Together)
    assert length_of(step) == 1.0


def test_a_box_with_its_text_speaks_as_fast_as_it_says():
    says = box(1, "Say", '<Parameter name="Text" value="Hi"/><Parameter name="Speed (%)" value="80"/>', SAYS)
    assert flat(xar_step(project(says, link(0, 1)), "file")) == [Say("\\rspd=80\\ Hi")]


def test_boxes_on_the_layer_of_a_timeline_begin_at_their_frame():
    says = box(1, "Say", '<Parameter name="Text" value="Hi"/>', SAYS)
    whole = timeline(curve("HeadYaw", [(20, 1.0, "")]), diagram=f"<Diagram>{says}{link(0, 1)}</Diagram>")
    step = xar_step(project(box(1, "Move", whole), link(0, 1)), "file")
    assert isinstance(step, Together)
    assert flat(step.steps[1]) == [Wait(1.0), Say("Hi")]


def test_links_to_stop_and_from_errors_begin_nothing():
    boxes = box(1, "A", NOD) + box(2, "B", NOD) + box(3, "C", NOD)
    links = link(0, 1) + link(1, 2, entry=3) + link(1, 3, end=5)
    assert isinstance(xar_step(project(boxes, links), "file"), Joints)


@pytest.mark.parametrize(
    "content, told",
    [
        (project(box(1, "Mine", "", "os.remove('x')"), link(0, 1)), "box 'Mine' runs a script"),
        (project(box(1, "A", NOD) + box(2, "B", NOD), link(0, 1) + link(1, 2) + link(2, 1)), "circles"),
        (project(box(1, "A", timeline(curve("WheelB", [(5, 1.0, "")]))), link(0, 1)), "no joint of a NAO"),
        (project(box(1, "A", timeline(curve("HeadYaw", [(5, 300.0, "")]))), link(0, 1)), "beyond what it can"),
        (b"<html/>", "no behaviour of Choregraphe"),
        (b"no xml", "is no XML"),
        (b'<!DOCTYPE a [<!ENTITY x "x">]><a/>', "document type"),
        ('<!DOCTYPE a [<!ENTITY x "x">]><a/>'.encode("utf-16"), "document type"),
    ],
)
def test_what_cannot_be_played_is_told(content, told):
    with pytest.raises(ConfigError, match=told):
        xar_step(content, "file")


MANIFEST = f"""{HEADER}<package uuid="greeter" version="1.0.0"><contents><behaviorContent path="behavior_1">
<nature>interactive</nature><tags><tag>hello</tag></tags></behaviorContent></contents></package>"""


def test_a_package_is_read_from_its_folder_and_from_its_archive(tmp_path):
    folder = tmp_path / "project"
    (folder / "behavior_1").mkdir(parents=True)
    (folder / "manifest.xml").write_text(MANIFEST)
    (folder / "behavior_1" / "behavior.xar").write_bytes(project(box(1, "Nod", NOD), link(0, 1)))
    with zipfile.ZipFile(tmp_path / "greeter.pkg", "w") as archive:
        for path in folder.rglob("*.*"):
            archive.write(path, path.relative_to(folder))
    for path in (folder / "manifest.xml", tmp_path / "greeter.pkg"):
        (behavior,) = read_package(path)
        assert behavior.name == "greeter/behavior_1"
        assert behavior.nature == "interactive"
        assert behavior.tags == ("hello",)
        assert length_of(behavior.step) == 1.0
    assert renamed([behavior], "mine")[0].name == "mine"


def test_a_package_does_not_read_beside_its_folder(tmp_path):
    (tmp_path / "secret.xar").write_bytes(project(box(1, "Nod", NOD), link(0, 1)))
    folder = tmp_path / "project"
    folder.mkdir()
    (folder / "manifest.xml").write_text(MANIFEST.replace("behavior_1", "../.."))
    with pytest.raises(ConfigError, match="not in the package"):
        read_package(folder / "manifest.xml")


def test_other_files_are_no_packages(tmp_path):
    path = tmp_path / "song.mp3"
    path.write_bytes(b"")
    with pytest.raises(ConfigError, match="known are .yaml"):
        read_package(path)


def test_what_repeats_counts_so_often():
    assert length_of(Repeat(Wait(2.0), 3)) == 6.0

"""What pages see of a robot: its model, frames on the wire, events of its senses, its body, traces for plots."""

from __future__ import annotations

import asyncio
import json
import math
import struct
import threading
from pathlib import Path
from types import SimpleNamespace

import pytest

from nao_library_modules.console.view import live_view
from nao_library_modules.console.view.background import Subscriptions, in_background
from nao_library_modules.console.view.live_view import (
    CLOSEST,
    MOST_QUEUED,
    SPAN,
    Broadcast,
    FrameInbox,
    Trace,
    listed_value,
    split_trace,
    watched_traces,
)
from nao_library_modules.console.view.robot_model import mesh_path, read_model
from nao_library_modules.console.view.robot_state import BodyStatus, read_status
from nao_library_modules.console.view.senses import AGAIN, Sightings, clicked, felt, heard, said, touched
from nao_library_modules.core.nao_facts import SENSORS
from nao_library_modules.studies.robot_events import EventStream
from naoqi.errors import NaoError

PACKAGE = Path(__file__).resolve().parents[3] / "nao_sim_bridge"
URDF = (PACKAGE / "urdf" / "nao_h25.urdf").read_text(encoding="utf-8")
ARM = (
    '<robot name="a"><material name="red"><color rgba="1 0 0 1"/></material><link name="base"/>'
    '<link name="arm"><visual><geometry>{}</geometry><material name="red"/></visual></link>'
    '<joint name="j" type="revolute"><parent link="base"/><child link="{}"/><axis xyz="0 0 1"/></joint></robot>'
)


# --- the model --------------------------------------------------------------------------------------------------------


def test_the_shipped_robot_has_shapes_lights_and_all_touch_sensors():
    model = read_model(URDF).to_json()
    assert model["root"] == "base_link" and not model["left_out"]
    assert model["lights"]["LeftFaceLed1_led"] == "LeftFaceLed1" and len(model["lights"]) == 51
    assert set(model["touch"].values()) == {device for sensor in SENSORS for device in sensor.devices}
    json.dumps(model)


def test_each_mesh_of_the_shipped_robot_is_a_file_of_its_package():
    meshes = read_model(URDF).meshes
    assert meshes and all(mesh_path(mesh, meshes, lambda _: str(PACKAGE)) for mesh in meshes)


@pytest.mark.parametrize(
    "name", ["p/../../etc/passwd", "p/a.urdf", "p/none.stl", "q/a.stl", "", "/etc/passwd", "p/link.stl"]
)
def test_no_other_file_is_a_mesh(tmp_path, name):
    (tmp_path / "a.urdf").write_text("")
    outside = tmp_path.parent / f"{tmp_path.name}.stl"
    outside.write_text("")
    (tmp_path / "link.stl").symlink_to(outside)
    allowed = frozenset({"p/../../etc/passwd", "p/a.urdf", "p/none.stl", "", "/etc/passwd", "p/link.stl"})
    with pytest.raises(FileNotFoundError):
        mesh_path(name, allowed, lambda _: str(tmp_path))


def test_a_shape_has_size_and_colour():
    (visual,) = read_model(ARM.format('<cylinder radius="0.1" length="0.2"/>', "arm")).links["arm"]
    assert (visual.kind, visual.size, visual.color) == ("cylinder", (0.1, 0.2), (1.0, 0.0, 0.0, 1.0))


def test_meshes_of_other_kinds_and_places_are_left_out():
    for mesh in ("package://a/b.dae", "file:///etc/passwd.stl"):
        assert read_model(ARM.format(f'<mesh filename="{mesh}"/>', "arm")).left_out == (mesh,)


@pytest.mark.parametrize(
    "text, words",
    [
        ("<robot", "cannot be read"),
        ("<!DOCTYPE a><robot/>", "DOCTYPE"),
        (ARM.format('<box size="1 2"/>', "arm"), "2 numbers, not 3"),
        (ARM.format('<box size="1 2 3"/>', "leg"), "links that it has not: leg"),
    ],
)
def test_a_description_that_will_not_do(text, words):
    with pytest.raises(NaoError, match=words):
        read_model(text)


# --- frames -----------------------------------------------------------------------------------------------------------


def test_a_pose_is_144_bytes_for_26_joints():
    frame = live_view.pose_frame(12.5, (1, 2, 3, 0, 0, 0, 1), [0.25] * 26)
    assert len(frame) == 144 and frame[:4] == bytes([live_view.POSE_FRAME, live_view.PLACED, 26, 0])
    assert struct.unpack_from("<7fd2f", frame, 4) == (1, 2, 3, 0, 0, 0, 1, 12.5, 0.25, 0.25)


def test_poses_are_the_same_whatever_their_stamps():
    first, later, other = (live_view.pose_frame(stamp, None, [angle]) for stamp, angle in ((1, 0), (2, 0), (1, 0.1)))
    assert live_view.same_pose(first, later) and not live_view.same_pose(first, other)


def test_a_light_is_three_bytes():
    assert live_view.lights_frame([(1.0, 0.5, 0.0), (2.0, -1.0, 0.0)]) == bytes([2, 0, 2, 0, 255, 128, 0, 255, 0, 0])


def test_a_picture_begins_after_16_bytes():
    frame = live_view.picture_frame(1.5, b"jpeg")
    assert frame[16:] == b"jpeg" and struct.unpack_from("<d", frame, 8) == (1.5,)


def test_a_slow_page_gets_the_newest_of_each_kind_and_texts_first():
    async def take():
        inbox = FrameInbox()
        for frame in (b"1", b"2"):
            inbox.put("pose", frame)
        inbox.put("layout", "text")
        return await inbox.take()

    assert asyncio.run(take()) == ["text", b"2"]


def test_what_must_not_be_lost_is_queued_up_to_a_limit():
    async def take():
        inbox = FrameInbox()
        for number in range(MOST_QUEUED + 1):
            inbox.add(str(number))
        return await inbox.take()

    assert asyncio.run(take()) == [str(number) for number in range(1, MOST_QUEUED + 1)]


def test_who_comes_later_sees_what_was_shown_and_nothing_old_when_all_had_left():
    async def look():
        pages = Broadcast()
        first = pages.attach()
        pages.put("pose", b"1")
        second = pages.attach()
        taken = await first.take(), await second.take()
        for page in (first, second):
            pages.detach(page)
        pages.attach()
        return taken, pages.last("pose")

    assert asyncio.run(look()) == (([b"1"], [b"1"]), None)


# --- senses -----------------------------------------------------------------------------------------------------------


def test_words_are_heard_the_best_first():
    perception = heard(["yes", "", "no"], [0.62, 0.1, 0.3])
    assert perception.text == "'yes' (62 % sure)" and perception.values["words"] == ["yes", "no"]
    assert heard(["", " "], [0.0, 0.0]) is None


def test_a_touch_names_its_sensor():
    perception = touched("front head", True)
    assert (perception.kind, perception.text) == ("touched", "front head pressed")
    assert perception.values == {"sensor": "front head", "touched": True, "devices": ["Head/Touch/Front"]}
    assert clicked(2).text == "chest button clicked twice"


def test_a_sentence_is_said_without_its_marks():
    assert said("\\rspd=90\\ Hello ^start(animations/Stand/Hey_1) there").text == "Hello there"
    assert said("  ") is None


def test_what_stays_in_sight_is_seen_once():
    seen = Sightings().seen
    assert seen("face", "Ann", 1.0).text == "face Ann"
    assert seen("face", "Ann", 2.0) is None
    assert seen("face", "Ann", 2.0 + AGAIN) is not None


# --- body -------------------------------------------------------------------------------------------------------------


def status(name, level, message="", **values):
    pairs = [SimpleNamespace(key=key.replace("_", " "), value=value) for key, value in values.items()]
    return SimpleNamespace(name=name, level=level, message=message, values=pairs)


def test_a_body_is_what_the_diagnostics_say_of_this_robot():
    body = read_status(
        [
            status("/nao1/nao_joint: HeadYaw", 1, Temperature="70.5", Stiffness="1"),
            status("/nao1/nao_joint: RHipYawPitch", 0, Temperature="None", Stiffness="0"),
            status("/nao2/nao_joint: HeadYaw", 0, Temperature="20", Stiffness="0"),
            status("/nao1/nao_power: Battery", 0, "OK (80 % left)", Percentage="80"),
            status("/nao1/nao_cpu: Head Temperature", 0, CPU_Temperature="55"),
        ],
        "/nao1/",
        BodyStatus(),
    )
    assert (body.battery, body.battery_text, body.head, body.heat_level) == (80.0, "OK (80 % left)", 55.0, 1)
    assert body.hottest == [("HeadYaw", 70.5)] and body.stiffness_text == "partly stiff (50 %)" and not body.stale


def test_other_diagnostics_change_nothing():
    before = BodyStatus(battery=50.0)
    assert read_status([status("nao_sim: Simulation", 0)], "/", before) is before
    assert BodyStatus().stiffness_text == "unknown" and math.isnan(BodyStatus().battery)


# --- traces -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name, words",
    [
        ("sonar", "no trace"),
        ("sonra:left", "did you mean 'sonar'"),
        ("sonar:up", "there are sonar:left, sonar:right"),
        ("memory:" + "k" * 300, "no trace"),
    ],
)
def test_a_trace_that_there_is_not(name, words):
    with pytest.raises(NaoError, match=words):
        split_trace(name)


def test_a_trace_keeps_a_minute_and_leaves_out_what_comes_too_soon():
    trace = Trace()
    for stamp in (0.0, CLOSEST / 2, 30.0, SPAN + 1.0):
        trace.add(stamp, stamp)
    assert [stamp for stamp, _ in trace.kept()] == [30.0, SPAN + 1.0]
    assert [stamp for stamp, _ in trace.fresh()] == [0.0, 30.0, SPAN + 1.0] and trace.fresh() == []


def test_time_that_begins_anew_begins_a_trace_anew():
    trace = Trace()
    trace.add(100.0, 1.0)
    trace.add(1.0, 2.0)
    assert trace.kept() == [(1.0, 2.0)]


def test_a_value_that_is_not_listed_is_no_number():
    assert listed_value(["a", "b"], [1.0, 2.0], "b") == 2.0 and math.isnan(listed_value(["a"], [], "a"))


@pytest.mark.parametrize("message", [None, [], {"watch": "sonar:left"}, {"watch": [1]}])
def test_a_page_asks_for_traces_by_a_list_of_names(message):
    with pytest.raises(NaoError):
        watched_traces(message)


def test_what_senses_tell_can_be_added_to_the_events():
    events = EventStream("/", lambda: 1.0)
    for perception in (heard(["a"], [1.0]), touched("chest", True), clicked(1), said("a"), felt("b", ground=True)):
        added = events.add(perception.kind, perception.text, stamp=2.0, **perception.values)
        assert added.stamp == 2.0 and added.data == perception.values


# --- what waits for the ROS master ------------------------------------------------------------------------------------


def test_what_waits_is_not_waited_for_and_ends_when_it_has_begun():
    goes_on, ended = threading.Event(), threading.Event()
    subscriptions = Subscriptions("test")
    subscriptions.begin(lambda: goes_on.wait(60) and ended.set)
    subscriptions.end()
    assert not ended.is_set()
    goes_on.set()
    assert ended.wait(60)


def test_a_task_in_the_background_returns_or_raises():
    async def both():
        with pytest.raises(ZeroDivisionError):
            await in_background(lambda: 1 / 0)
        return await in_background(max, 1, 2)

    assert asyncio.run(both()) == 2

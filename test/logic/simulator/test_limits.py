"""Bounds of the numbers in requests of ROS services, world files and options of the simulator; what has failed."""

from __future__ import annotations

import math

import pytest
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Vector3

from nao_library_msgs.srv import (
    MoveObjectRequest,
    PlaceObjectRequest,
    PlaceSoundRequest,
    PressSensorsRequest,
    PushRobotRequest,
)
from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.guard import Failure
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.ros.services import checked
from nao_sim_bridge.ros.side import status_of
from nao_sim_bridge.world.objects import read_object
from nao_sim_bridge.world.reader import read_world
from nao_sim_bridge.world.world import WorldError

HUGE = 1.7e308


def request(kind, field, value):
    """A request with a number somewhere: "pose.position.x"."""
    made = kind()
    holder, *path = made, *field.split(".")
    for part in path[:-1]:
        holder = getattr(holder, part)
    setattr(holder, path[-1], value)
    return made


@pytest.mark.parametrize("bad", [HUGE, -HUGE, 1e9, math.nan, math.inf])
@pytest.mark.parametrize(
    "kind, field",
    [
        (PushRobotRequest, "force.y"),
        (MoveObjectRequest, "pose.orientation.w"),
        (MoveObjectRequest, "pose.position.z"),
        (PlaceObjectRequest, "mass"),
        (PlaceSoundRequest, "level_db"),
    ],
)
def test_a_number_of_a_request_out_of_bounds_is_told_with_its_field(kind, field, bad):
    with pytest.raises(BadValue, match=rf"^{field.partition('.')[0]}[\[\]\d]* is .*, allowed is a finite number"):
        checked(request(kind, field, bad))


def test_lists_and_durations_of_requests_have_bounds_and_usual_ones_are_taken():
    with pytest.raises(BadValue, match=r"^size\[1\] is"):
        checked(PlaceObjectRequest(size=[0.1, HUGE]))
    with pytest.raises(BadValue, match="^time is"):
        checked(PushRobotRequest(time=rospy.Duration(100000)))
    with pytest.raises(BadValue, match="a text of the arguments is '1000001 characters', allowed is 1000000"):
        checked(PressSensorsRequest(sensors=["Head", "x" * 1000001]))
    push = PushRobotRequest("torso", Vector3(60.0, 0.0, -5.0), rospy.Duration(1, 5))
    assert checked(push) is push


def world(**sections):
    return {"floor": {"friction": 1.0}, **sections}


@pytest.mark.parametrize(
    "content, where",
    [
        ({"floor": {"friction": HUGE}}, "floor.friction"),
        ({"floor": {"friction": 1e6}}, "floor.friction"),
        ({"floor": {"friction": 1.0, "rugs": [{"center": [1e9, 0.0]}]}}, r"floor.rugs\[0\].center\[0\]"),
        (world(light={"direction": [1e300, 0.0, 1.0]}), r"light.direction\[0\]"),
        (world(background={"haze": math.inf}), "background.haze"),
        (world(robots=[{"position": [0.0, 0.0], "yaw": 1e9}]), r"robots\[0\].yaw"),
        (world(sounds=[{"name": "a", "sound": "a.wav", "start": 1e9}]), r"sounds\[0\].start"),
    ],
)
def test_a_number_of_a_world_file_out_of_bounds_is_told_with_its_place(content, where):
    with pytest.raises(WorldError, match=rf"^a.yaml.*{where}: is .*, allowed is a finite number"):
        read_world(content, "a", "a.yaml")


@pytest.mark.parametrize(
    "entry",
    [
        {"box": [HUGE, 1, 1]},
        {"sphere": 1e-320},
        {"sphere": 0.1, "mass": HUGE},
        {"sphere": 0.1, "rpy": [0, 0, HUGE]},
        {"parts": [{"sphere": 0.1, "xyz": [HUGE, 0, 0]}]},
        {"sphere": 0.1, "friction": HUGE},
    ],
)
def test_a_thing_of_impossible_size_mass_or_place_is_refused(entry):
    with pytest.raises(WorldError, match="allowed is"):
        read_object({"name": "a", "position": [0, 0, 1], **entry}, "object", lambda name: name)


@pytest.mark.parametrize("option", ["friction", "payload", "sensor_noise", "sensor_delay"])
@pytest.mark.parametrize("bad", [HUGE, 1e9, math.nan, math.inf, -1.0])
def test_an_option_out_of_bounds_is_refused(option, bad):
    with pytest.raises(BadValue, match=f"{option} is .*, allowed is 0 to "):
        Scene(**{option: bad})


def test_the_report_names_who_has_failed_how_often_and_why():
    fine = status_of([])
    assert (fine.level, fine.message, fine.values) == (DiagnosticStatus.OK, "runs", [])
    bad = status_of([Failure("sim.a.Look", "ValueError: no", 7), Failure("task glide", "KeyError: 1", 1)])
    assert bad.level == DiagnosticStatus.WARN and "sim.a.Look, task glide" in bad.message
    assert [(one.key, one.value) for one in bad.values] == [
        ("sim.a.Look", "7 times: ValueError: no"),
        ("task glide", "once: KeyError: 1"),
    ]

"""Function messages written as calls, as the paper writes them."""

from __future__ import annotations

import subprocess
import sys

import pytest
from genpy import Duration
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

import nao_library_msgs.msg
import nao_library_msgs.srv
from nao_library_actions import msg as actions
from nao_library_modules.core import new_functions as new
from nao_library_msgs.msg import AudioOutFunction, LedFunction, MotionFunction


def test_values_go_to_the_next_fields_of_their_kind():
    for made, message in (
        (new.newMotionFunction("getAngles", ["RArm"]), MotionFunction(function="getAngles", names=["RArm"])),
        (
            new.newLedFunction("setIntensity", ["Brain0"], [1, 0.5], True),
            LedFunction(function="setIntensity", lights=["Brain0"], i_values=[1, 0.5], revert=True),
        ),
        (
            new.newAudioOutFunction("say", Duration(2), "Hello", volume=0.5),
            AudioOutFunction(function="say", time=Duration(2), str_param="Hello", volume=0.5),
        ),
    ):
        assert made == message
    for values, fields, text in (
        (({},), {}, "no field left for {}"),
        (("a", "b"), {}, "no field left for 'b'"),
        ((), {"light": "x"}, "no field 'light', it has function, time"),
    ):
        with pytest.raises(TypeError, match=text):
            new.newLedFunction("on", *values, **fields)


def test_a_point_or_several_are_a_trajectory_for_the_joints_of_names():
    first, second = (JointTrajectoryPoint(positions=[angle]) for angle in (0.5, 1.0))
    pose = MotionFunction(function="setPose", names=["RArm"], trajectory=JointTrajectory(points=[first]))
    assert new.newMotionFunction("setPose", ["RArm"], first) == pose
    assert new.newMotionFunction("setPose", names=["RArm"], trajectory=first) == pose
    assert new.newMotionFunction("setTrajectory", ["RArm"], [first, second]).trajectory.points == [first, second]
    with pytest.raises(TypeError, match="no field left for"):
        new.newMotionFunction("setTrajectory", [first, "second"])


def test_a_point_of_a_trajectory_has_its_time_first():
    message = JointTrajectoryPoint(positions=[0.5, 1.0], time_from_start=Duration(1))
    assert new.JointTrajectoryPoint(Duration(1), (0.5, 1)) == message == new.JointTrajectoryPoint(1.0, [0.5, 1.0])
    message.velocities, message.accelerations = [0.1, 0.2], [0.3, 0.4]
    assert new.JointTrajectoryPoint(1.0, [0.5, 1.0], (0.1, 0.2), (0.3, 0.4)) == message


def test_goals_have_the_short_names_of_the_paper_as_well():
    assert actions.LedGoal is actions.NaoLedGoal and actions.MotionAction is actions.NaoMotionAction


def test_a_message_is_loaded_when_it_is_asked_for():
    program = "import sys; from nao_library_actions.msg import NaoLedGoal; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    loaded = {name for name in run.stdout.split() if name.startswith("nao_library_") and "._" in name}
    assert loaded == {"nao_library_actions.msg._NaoLedGoal"}


def test_all_messages_and_services_are_there_by_the_names_of_genpy_and_no_others():
    for module in (actions, nao_library_msgs.msg, nao_library_msgs.srv):
        assert module.__all__ == dir(module) != []
        for name in module.__all__:
            assert getattr(module, name).__name__ in (name, f"Nao{name}")
    service = nao_library_msgs.srv.SetTransform
    assert service._request_class is nao_library_msgs.srv.SetTransformRequest
    with pytest.raises(ImportError, match="cannot import name 'Bumpers'"):
        from nao_library_msgs.msg import Bumpers  # noqa: F401
    with pytest.raises(ImportError, match="build nao_library_msgs with catkin"):
        nao_library_msgs.load_when_asked("nao_library_msgs", "action")

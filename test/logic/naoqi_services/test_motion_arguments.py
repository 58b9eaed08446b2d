"""Arguments of ALMotion: joints and chains, key frames in all the shapes NAOqi takes, gait configurations."""

from __future__ import annotations

import struct

import pytest

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.robot_model import joint_names
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.body.dcm import timed_points
from nao_sim_bridge.naoqi.motion.arguments import (
    bezier_key_points,
    joint_indices,
    key_frames,
    paths_of,
    pose_of_position,
)
from nao_sim_bridge.naoqi.motion.move_config import gait_list, gait_of, gait_of_feet
from nao_sim_bridge.naoqi.motion.walking import _destination as destination
from nao_sim_bridge.naoqi.motion.walking import _placed as placed
from nao_sim_bridge.walk.gait import FeetGait

MODEL = load_model()
GAIT = ["MaxStepX", "MaxStepY", "MaxStepTheta", "MaxStepFrequency", "StepHeight", "TorsoWx", "TorsoWy"]


def test_joints_and_chains_become_joints_in_their_order():
    for names, found in (
        ("HeadYaw", ["HeadYaw"]),
        ("Head", ["HeadYaw", "HeadPitch"]),
        (["HeadPitch", "HeadYaw"], ["HeadPitch", "HeadYaw"]),
        (["LHand", "Head"], ["LHand", "HeadYaw", "HeadPitch"]),
        (("HeadYaw",), ["HeadYaw"]),
    ):
        assert joint_names(names, MODEL) == found
        assert joint_indices(names, MODEL) == [MODEL.joint_index[name] for name in found]
    for name, count in (("Body", 26), ("LArm", 6), ("RLeg", 6), ("Arms", 12), ("Legs", 12)):
        assert len(set(joint_indices(name, MODEL))) == count
    assert joint_indices("Body", MODEL) == list(range(26))


@pytest.mark.parametrize("names, told", [
    *((names, "names is .*, allowed is a joint, a chain, or a list of them") for names in ([], {}, 3, None)),
    *((n, "names is .*, allowed is the name of a joint or of a chain") for n in ([["HeadYaw"]], ["HeadYaw", {}], [3])),
    (["HeadPitch", "HeadYow"], "unknown joint or chain 'HeadYow': did you mean 'HeadYaw'"),
    (["HeadYaw", "Head"], "named twice: HeadYaw"),
])  # fmt: skip
def test_what_is_no_name_is_refused(names, told):
    with pytest.raises((BadValue, UnknownName, NaoqiError), match=told):
        joint_indices(names, MODEL)


def test_key_frames_come_in_many_shapes():
    for count, values, times, frames in (
        (1, 0.5, 1.0, [([1.0], [0.5])]),
        (1, [0.5, 0.1], [1.0, 2.0], [([1.0, 2.0], [0.5, 0.1])]),
        (2, 0.5, 1.0, [([1.0], [0.5]), ([1.0], [0.5])]),
        (2, [0.5, 0.1], 1.0, [([1.0], [0.5]), ([1.0], [0.1])]),
        (2, [0.5, 0.1], [1.0, 2.0], [([1.0], [0.5]), ([2.0], [0.1])]),
        (2, [[1, 2], [3, 4]], [5, 6], [([5.0, 6.0], [1.0, 2.0]), ([5.0, 6.0], [3.0, 4.0])]),
        (2, [[1, 2], [3]], [[5, 6], [7]], [([5.0, 6.0], [1.0, 2.0]), ([7.0], [3.0])]),
        (2, [[1, 2], 3], [[5, 6], 7], [([5.0, 6.0], [1.0, 2.0]), ([7.0], [3.0])]),
    ):
        assert key_frames(count, values, times, "angleLists") == frames


@pytest.mark.parametrize("count, values, times, message", [
    (2, [0.5], 1.0, "angleLists is .*, allowed is 2 entries, one for each joint; there are 1"),
    (2, [], 1.0, "angleLists is .*, allowed is at least one value"),
    (2, [[], [1]], 1.0, "angleLists is .*, allowed is at least one value for each joint"),
    (1, [0.5], [], "timeLists is .*, allowed is at least one time"),
    (1, [0.5, 0.1], [1.0], "timeLists is .*, allowed is as many times as values for each joint: 2 here"),
    (2, [[1, 2], [3, 4]], [[5, 6], [7]], "as many times as values for each joint: 2 here"),
    (1, [0.5], [0.0], "timeLists is .*, allowed is times that rise, the first above 0 s"),
    (1, [0.5, 0.1], [1.0, 1.0], "times that rise"),
    (1, [0.5], ["soon"], r"timeLists\[0\] is 'soon', allowed is a finite number"),
    (1, [float("nan")], [1.0], "a finite number"),
])  # fmt: skip
def test_impossible_key_frames_name_what_is_allowed(count, values, times, message):
    with pytest.raises(BadValue, match=message):
        key_frames(count, values, times, "angleLists")


HALF = [0.0] * 50_001
POSES = [[0.0] * 6] * 10_001


@pytest.mark.parametrize(
    "call, field, told",
    [
        (lambda: key_frames(2, [HALF, HALF], 1.0, "angleLists"), "angleLists", "100002 key frames"),
        (lambda: key_frames(1, HALF * 2, 1.0, "angleLists"), "angleLists", "100002 key frames"),
        (lambda: bezier_key_points(2, [HALF, HALF], [HALF, HALF]), "controlPoints", "100002 key frames"),
        (lambda: paths_of([POSES, POSES], 1.0, 2, pose_of_position), "paths", "20002 poses"),
        (lambda: paths_of(POSES * 2, 1.0, 1, pose_of_position), "paths", "20002 poses"),
        (lambda: placed(["LLeg"] * 1001, [[0.0, 0.1, 0.0]] * 1001), "footSteps", "1001 steps"),
        (lambda: destination([[[0.1, 0.0, 0.0]] * 10_001]), "controlPoint", "10001 places"),
        (lambda: timed_points([[0.0, 0]] * 10_001, "commands[2]"), r"commands\[2\]", "10001 commands"),
    ],
    ids=range(8),
)
def test_lists_that_take_too_long_in_a_tick_are_refused_with_what_is_allowed(call, field, told):
    most = told.replace("2 ", "0 ").replace("1 ", "0 ")
    with pytest.raises(BadValue, match=f"{field} is '{told}', allowed is {most} at most"):
        call()


def test_the_lists_name_all_that_can_be_set_and_can_be_asked_for_also_in_single_precision():
    for which, values in (
        ("Default", [0.04, 0.14, 0.349, 1.0, 0.02, 0.0, 0.0]),
        ("Min", [0.001, 0.101, 0.001, 0.0, 0.005, -0.122, -0.122]),
        ("Max", [0.08, 0.16, 0.524, 1.0, 0.035, 0.122, 0.122]),
    ):
        assert gait_list(which) == [[name, value] for name, value in zip(GAIT, values)]
        single = [[name, struct.unpack("f", struct.pack("f", value))[0]] for name, value in gait_list(which)]
        assert gait_of(single) == gait_of(gait_list(which))
    with pytest.raises(BadValue, match="config is 'default', allowed is Default, Min, Max"):
        gait_list("default")
    assert gait_of() == gait_of([]) == gait_of(gait_list("Default")) == FeetGait()


def test_a_gait_is_for_both_feet_or_for_each():
    gait = gait_of([["MaxStepX", 0.06], ["RightStepHeight", 0.03], ("LeftMaxStepFrequency", 0), ["Frequency", 0.5]])
    assert gait.left.max_step_x == gait.right.max_step_x == 0.06 and gait.frequency == 0.5
    assert (gait.left.step_height, gait.right.step_height) == (0.02, 0.03)
    assert (gait.left.max_step_frequency, gait.right.max_step_frequency) == (0.0, 1.0)
    assert gait_of([["MaxStepX", 0.06]], frequency=0.25).frequency == 0.25
    gait = gait_of_feet([["MaxStepX", 0.06]], [["StepHeight", 0.03]], 0.5)
    assert (gait.left.max_step_x, gait.right.max_step_x, gait.frequency) == (0.06, 0.04, 0.5)
    assert (gait.left.step_height, gait.right.step_height) == (0.02, 0.03)
    with pytest.raises(UnknownName, match="unknown gait parameter of a foot 'LeftMaxStepX': did you mean 'MaxStepX'"):
        gait_of_feet([["LeftMaxStepX", 0.06]], [], 1.0)


@pytest.mark.parametrize("name, value, limit", [("MaxStepX", 0.081, 0.08), ("RightTorsoWx", -0.2, -0.122),
                                               ("StepHeight", 0.04, 0.035)])  # fmt: skip
def test_a_parameter_beyond_its_limits_is_taken_for_the_limit_and_the_log_says_so(name, value, limit, caplog):
    assert gait_of([[name, value]]) == gait_of([[name, limit]])
    assert f"{name} is {value}, and taken for {limit}" in caplog.text


@pytest.mark.parametrize("config, message", [
    *((config, r"moveConfig is .*, allowed is pairs such as \[\[\"MaxStepX\", 0.03\]")
      for config in (None, "MaxStepX", ["MaxStepX", 0.04], [["MaxStepX"]], [[0.04, "MaxStepX"]], 0.5)),
    ([["MaxStepY", "wide"]], "MaxStepY is 'wide', allowed is 0.101 to 0.16"),
    ([["FootSeparation", 0.1]], "FootSeparation is 0.1, allowed is nothing: it is fixed at 0.1"),
    ([["StepHigh", 0.02]], "unknown gait parameter 'StepHigh': did you mean 'StepHeight'"),
])  # fmt: skip
def test_what_a_gait_cannot_be_is_refused(config, message):
    with pytest.raises((BadValue, UnknownName), match=message):
        gait_of(config)

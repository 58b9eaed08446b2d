"""Arguments of ALMotion: names of joints and chains, key frames in all the shapes NAOqi takes."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.motion.arguments import joint_indices, joint_names, key_frames
from nao_sim_bridge.sim.errors import BadValue, UnknownName
from nao_sim_bridge.sim.model import load_model

MODEL = load_model()


@pytest.mark.parametrize(
    "names, found",
    [
        ("HeadYaw", ["HeadYaw"]),
        ("Head", ["HeadYaw", "HeadPitch"]),
        (["HeadPitch", "HeadYaw"], ["HeadPitch", "HeadYaw"]),
        (["LHand", "Head"], ["LHand", "HeadYaw", "HeadPitch"]),
        (("HeadYaw",), ["HeadYaw"]),
    ],
)
def test_joints_and_chains_become_joints_in_their_order(names, found):
    assert joint_names(names, MODEL) == found
    assert joint_indices(names, MODEL) == [MODEL.joint_index[name] for name in found]


@pytest.mark.parametrize("name, count", [("Body", 26), ("LArm", 6), ("RLeg", 6), ("Arms", 12), ("Legs", 12)])
def test_chains_have_all_their_joints(name, count):
    assert len(set(joint_indices(name, MODEL))) == count


def test_body_is_the_order_of_the_model():
    assert joint_indices("Body", MODEL) == list(range(26))


@pytest.mark.parametrize("names", [[], {}, 3, None])
def test_what_is_no_name_is_refused(names):
    with pytest.raises(BadValue, match="names is .*, allowed is a joint, a chain, or a list of them"):
        joint_names(names, MODEL)


@pytest.mark.parametrize("names", [[["HeadYaw"]], ["HeadYaw", {}], [3]])
def test_what_is_no_name_in_a_list_is_refused(names):
    with pytest.raises(BadValue, match="names is .*, allowed is the name of a joint or of a chain"):
        joint_names(names, MODEL)


def test_an_unknown_name_offers_the_closest():
    with pytest.raises(UnknownName, match="unknown joint or chain 'HeadYow': did you mean 'HeadYaw'"):
        joint_names(["HeadPitch", "HeadYow"], MODEL)


def test_a_joint_named_twice_is_refused_when_it_is_to_move():
    with pytest.raises(NaoqiError, match="named twice: HeadYaw"):
        joint_indices(["HeadYaw", "Head"], MODEL)


@pytest.mark.parametrize(
    "count, values, times, frames",
    [
        (1, 0.5, 1.0, [([1.0], [0.5])]),
        (1, [0.5, 0.1], [1.0, 2.0], [([1.0, 2.0], [0.5, 0.1])]),
        (1, [[0.5, 0.1]], [[1.0, 2.0]], [([1.0, 2.0], [0.5, 0.1])]),
        (1, [0.5], 1, [([1.0], [0.5])]),
        (2, 0.5, 1.0, [([1.0], [0.5]), ([1.0], [0.5])]),
        (2, [0.5, 0.1], 1.0, [([1.0], [0.5]), ([1.0], [0.1])]),
        (2, [0.5, 0.1], [1.0], [([1.0], [0.5]), ([1.0], [0.1])]),
        (2, [0.5, 0.1], [1.0, 2.0], [([1.0], [0.5]), ([2.0], [0.1])]),
        (2, [[0.5], [0.1]], [[1.0], [2.0]], [([1.0], [0.5]), ([2.0], [0.1])]),
        (2, [[1, 2], [3, 4]], [5, 6], [([5.0, 6.0], [1.0, 2.0]), ([5.0, 6.0], [3.0, 4.0])]),
        (2, [[1, 2], [3]], [[5, 6], [7]], [([5.0, 6.0], [1.0, 2.0]), ([7.0], [3.0])]),
        (2, [[1, 2], 3], [[5, 6], 7], [([5.0, 6.0], [1.0, 2.0]), ([7.0], [3.0])]),
    ],
)
def test_key_frames_come_in_many_shapes(count, values, times, frames):
    assert key_frames(count, values, times, "angleLists") == frames


@pytest.mark.parametrize(
    "count, values, times, message",
    [
        (2, [0.5], 1.0, "angleLists is .*, allowed is 2 entries, one for each joint; there are 1"),
        (2, [], 1.0, "angleLists is .*, allowed is at least one value"),
        (2, [[], [1]], 1.0, "angleLists is .*, allowed is at least one value for each joint"),
        (1, [0.5], [], "timeLists is .*, allowed is at least one time"),
        (1, [0.5, 0.1], [1.0], "timeLists is .*, allowed is as many times as values for each joint: 2 here"),
        (1, [0.5, 0.1], 1.0, "as many times as values"),
        (2, [[1, 2], [3, 4]], [[5, 6], [7]], "as many times as values for each joint: 2 here"),
        (1, [0.5], [0.0], "timeLists is .*, allowed is times that rise, the first above 0 s"),
        (1, [0.5, 0.1], [2.0, 1.0], "times that rise"),
        (1, [0.5, 0.1], [1.0, 1.0], "times that rise"),
        (2, "much", 1.0, "angleLists is 'much', allowed is a finite number"),
        (1, ["much"], [1.0], r"angleLists\[0\] is 'much', allowed is a finite number"),
        (1, [0.5], ["soon"], r"timeLists\[0\] is 'soon', allowed is a finite number"),
        (1, [float("nan")], [1.0], "a finite number"),
    ],
)
def test_impossible_key_frames_name_what_is_allowed(count, values, times, message):
    with pytest.raises(BadValue, match=message):
        key_frames(count, values, times, "angleLists")

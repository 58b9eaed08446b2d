"""Facts of the robot model, and that wrong tables are refused."""

from __future__ import annotations

import copy

import numpy as np
import pytest

from nao_sim_bridge.paths import config_file
from nao_sim_bridge.sim.config import read_json
from nao_sim_bridge.sim.errors import ConfigError, UnknownName
from nao_sim_bridge.sim.model import VERSIONS, load_model
from nao_sim_bridge.sim.model_reader import ModelReader
from nao_sim_bridge.sim.postures import load_postures, posture

TABLES = read_json(config_file("nao_h25.json"))


@pytest.mark.parametrize("version, mass, head", [("V6", 5.35975, 0.65973), ("V5", 5.30535, 0.60533)])
def test_versions_differ_in_the_head_alone(version, mass, head):
    model = load_model(version)
    assert model.total_mass == pytest.approx(mass, abs=1e-9)
    assert model.link("HeadPitch").mass == pytest.approx(head)
    others = [link.mass for link in model.links if link.name != "HeadPitch"]
    assert others == [link.mass for link in load_model("V6").links if link.name != "HeadPitch"]


def test_unknown_version_names_the_known_ones():
    with pytest.raises(ConfigError, match="V7.*V6, V5"):
        load_model("V7")


def test_joints_are_in_body_order_with_hands_in_place():
    model = load_model()
    names = [joint.name for joint in model.joints]
    assert len(names) == 26
    assert names[:8] == [
        "HeadYaw",
        "HeadPitch",
        "LShoulderPitch",
        "LShoulderRoll",
        "LElbowYaw",
        "LElbowRoll",
        "LWristYaw",
        "LHand",
    ]
    assert names[8] == "LHipYawPitch" and names[14] == "RHipYawPitch" and names[25] == "RHand"
    assert [model.joint_index[name] for name in names] == list(range(26))


@pytest.mark.parametrize(
    "name, lower, upper, velocity, torque",
    [
        ("HeadYaw", -2.08567, 2.08567, 8.26797, 1.547),
        ("RKneePitch", -0.0923279, 2.11255, 6.40239, 3.0226),
        ("LElbowRoll", -1.54462, -0.0349066, 7.19407, 1.532),
        ("LHand", 0.0, 1.0, 8.33, 0.292),
    ],
)
def test_limits_of_some_joints(name, lower, upper, velocity, torque):
    joint = load_model().joint(name)
    values = (joint.lower, joint.upper, joint.max_velocity, joint.max_torque)
    assert values == pytest.approx((lower, upper, velocity, torque))
    assert joint.is_hand == name.endswith("Hand")


def test_limits_array_agrees_with_the_joints_and_cannot_be_written():
    model = load_model()
    limits = model.limits_array()
    assert limits.shape == (26, 2)
    assert tuple(limits[model.joint_index["LKneePitch"]]) == pytest.approx((-0.0923279, 2.11255))
    with pytest.raises(ValueError, match="read-only"):
        limits[0, 0] = 0.0


def test_chains_make_up_the_body():
    chains = load_model().chains
    five = ("Head", "LArm", "LLeg", "RLeg", "RArm")
    assert load_model().chain_names == tuple(TABLES["chains"])
    assert set(load_model().chain_names) == set(five)
    assert sum((chains[name] for name in five), ()) == chains["Body"]
    assert chains["Actuators"] == ("LHand", "RHand")
    assert len(chains["Joints"]) == 24 and "LHand" not in chains["Joints"]
    assert set(chains["Legs"]) == set(chains["LLeg"]) | set(chains["RLeg"])


def test_coupled_limits_interpolate_between_rows():
    limit = load_model().coupled_limits["HeadPitch"]
    assert limit.by_joint == "HeadYaw"
    assert limit.limits_at(0.0) == pytest.approx((-0.671951, 0.515047))
    halfway = (0.486074 + 0.756077) / 2.0
    assert limit.limits_at(halfway) == pytest.approx(((-0.671951 - 0.548033) / 2, (0.422021 + 0.37001) / 2))
    assert limit.limits_at(9.0) == pytest.approx((-0.449073, 0.330041))


def test_inertias_obey_the_triangle_rule():
    for version in VERSIONS:
        for link in load_model(version).links:
            smallest, middle, largest = np.linalg.eigvalsh(link.inertia)
            assert smallest > 0.0 and smallest + middle >= largest * 0.999, link.name


def test_right_sole_is_the_mirror_image_and_counter_clockwise():
    model = load_model()
    left, right = model.sole_polygon("L"), model.sole_polygon("R")
    assert sorted(map(tuple, right)) == sorted((x, -y) for x, y in left)
    for polygon in (left, right):
        x, y = polygon.T
        assert np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)) > 0.0


@pytest.mark.parametrize(
    "spoil, message",
    [
        (lambda t: t["joints"][3].pop("axis"), r"joints\[3\]: missing 'axis'"),
        (lambda t: t["links"][2].update(mas=1.0), r"links\[2\]: unknown key 'mas', did you mean 'mass_kg'"),
        (lambda t: t.update(colour="red"), "unknown key 'colour'"),
        (lambda t: t["links"][1].update(com_xyz_m=[0, 0]), r"links\[1\]\.com_xyz_m.*not 3 finite numbers"),
        (lambda t: t["links"][1]["inertia_kg_m2"][0].__setitem__(0, -1.0), "not symmetric and positive"),
        (lambda t: t["joints"][0].update(lower_rad=3.0), "lower limit 3.0 is not below upper"),
        (lambda t: t["almotion_body_order"].pop(), "does not name the same joints"),
    ],
)
def test_wrong_tables_are_refused_with_the_place(spoil, message):
    tables = copy.deepcopy(TABLES)
    spoil(tables)
    with pytest.raises(ConfigError, match=message):
        ModelReader(tables, "V6").read()


def test_all_postures_lie_within_the_limits():
    model = load_model()
    lower, upper = model.limits_array().T
    assert len(load_postures().by_name) == 8
    for name, entry in load_postures().by_name.items():
        assert np.all(entry.angles >= lower - 5e-3) and np.all(entry.angles <= upper + 5e-3), name
        clipped = np.array(posture(model, name))
        assert np.all((clipped >= lower) & (clipped <= upper))


def test_unknown_posture_offers_the_closest():
    with pytest.raises(UnknownName, match="'Stan'.*did you mean 'Stand'"):
        posture(load_model(), "Stan")

"""The tables of the robot: joints, links, chains, masses, postures and looks, and that wrong tables are refused."""

from __future__ import annotations

import copy
import math

import numpy as np
import pytest

from nao_sim_bridge.base.config import config_file, read_json
from nao_sim_bridge.base.errors import ConfigError, UnknownName
from nao_sim_bridge.model.appearance import load_appearance
from nao_sim_bridge.model.body_mass import convex_hull, outside
from nao_sim_bridge.model.kinematics import rpy_matrix
from nao_sim_bridge.model.meshes import tessellate
from nao_sim_bridge.model.model_reader import ModelReader, load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.model.shapes import SEEN_KINDS, Shape, read_shape

TABLES = read_json(config_file("nao_h25.json"))
MODEL = load_model()


@pytest.mark.parametrize("version, mass, head", [("V6", 5.35975, 0.65973), ("V5", 5.30535, 0.60533)])
def test_versions_differ_in_the_head_alone(version, mass, head):
    model = load_model(version)
    assert model.total_mass == pytest.approx(mass, abs=1e-9)
    assert model.link("HeadPitch").mass == pytest.approx(head)
    masses = [[link.mass for link in one.links if link.name != "HeadPitch"] for one in (model, MODEL)]
    assert masses[0] == masses[1]
    for link in model.links:
        smallest, middle, largest = np.linalg.eigvalsh(link.inertia)
        assert smallest > 0.0 and smallest + middle >= largest * 0.999, link.name


def test_an_unknown_version_or_posture_offers_the_known_ones():
    with pytest.raises(ConfigError, match="V7.*V6, V5"):
        load_model("V7")
    with pytest.raises(UnknownName, match="'Stan'.*did you mean 'Stand'"):
        posture(MODEL, "Stan")


def test_joints_are_in_body_order_with_hands_in_place_and_chains_make_up_the_body():
    names = [joint.name for joint in MODEL.joints]
    arm = ["ShoulderPitch", "ShoulderRoll", "ElbowYaw", "ElbowRoll", "WristYaw", "Hand"]
    assert names[:8] == ["HeadYaw", "HeadPitch", *("L" + name for name in arm)]
    assert (names[8], names[14], names[25]) == ("LHipYawPitch", "RHipYawPitch", "RHand")
    assert [MODEL.joint_index[name] for name in names] == list(range(26))
    five, chains = ("Head", "LArm", "LLeg", "RLeg", "RArm"), MODEL.chains
    assert set(five) == set(MODEL.chain_names) and MODEL.chain_names == tuple(TABLES["chains"])
    assert sum((chains[name] for name in five), ()) == chains["Body"] == tuple(names)
    assert chains["Actuators"] == ("LHand", "RHand")
    assert len(chains["Joints"]) == 24 and "LHand" not in chains["Joints"]
    assert set(chains["Legs"]) == set(chains["LLeg"]) | set(chains["RLeg"])


def test_coupled_limits_interpolate_between_rows():
    limit = MODEL.coupled_limits["HeadPitch"]
    assert limit.by == MODEL.joint_index["HeadYaw"]
    assert limit.limits_at(0.0) == pytest.approx((-0.671951, 0.515047))
    halfway = (0.486074 + 0.756077) / 2.0
    assert limit.limits_at(halfway) == pytest.approx(((-0.671951 - 0.548033) / 2, (0.422021 + 0.37001) / 2))
    assert limit.limits_at(9.0) == pytest.approx((-0.449073, 0.330041))


@pytest.mark.parametrize(
    "spoil, message",
    [
        (lambda t: t["links"][2].update(mas=1.0), r"links\[2\]: unknown key 'mas': did you mean 'mass_kg'"),
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


@pytest.mark.parametrize(
    "point, distance, way",
    [
        ((1.5, 1.0), -0.5, (1, 0)),
        ((1.0, 0.1), -0.1, (0, -1)),
        ((3.0, 1.0), 1.0, (1, 0)),
        ((1.0, -0.5), 0.5, (0, -1)),
        ((-1.0, 3.0), math.sqrt(2.0), (-math.sqrt(0.5), math.sqrt(0.5))),
        ((2.0, 0.5), 0.0, (1, 0)),
    ],
)
def test_how_far_outside_a_hull_a_point_is_and_the_shortest_way_out(point, distance, way):
    hull = convex_hull([(0, 0), (1, 0), (2, 0), (2, 2), (0, 2), (1, 1), (2, 1)])
    assert hull == [(0, 0), (2, 0), (2, 2), (0, 2)], "without inner points and points on edges"
    assert outside(hull, point) == (pytest.approx(distance), pytest.approx(way))


SHAPES = {
    "box": ((1.0, 2.0, 3.0), 6.0),
    "sphere": ((1.0,), 4.0 / 3.0 * math.pi),
    "cylinder": ((1.0, 2.0), 2.0 * math.pi),
    "capsule": ((1.0, 2.0), 2.0 * math.pi + 4.0 / 3.0 * math.pi),
    "ellipsoid": ((1.0, 2.0, 3.0), 8.0 * math.pi),
    "arc": ((0.5, 1.0, 0.2, 40.0), 0.75 * math.pi * 0.2 * 40.0 / 360.0),
}


def corners(mesh):
    return (mesh.vertices[mesh.faces[:, i]] for i in range(3))


def volume(mesh):
    a, b, c = corners(mesh)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


@pytest.mark.parametrize("kind", SEEN_KINDS)
def test_meshes_are_closed_with_the_volume_of_their_shape_and_normals_point_out(kind):
    size, expected = SHAPES.get(kind, ((1.0, 1.0, 1.0), None))
    shape = Shape(kind, size, (0.1, 0.2, 0.3), (0.4, -0.5, 0.6))
    mesh = tessellate(shape)
    if expected is None:
        assert kind == "pillow" and math.pi / 6.0 < volume(mesh) < 1.0, "between ellipsoid and box"
    else:
        assert volume(mesh) == pytest.approx(expected, rel=0.04)
    a, b, c = corners(mesh)
    outwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), mesh.normals[mesh.faces].mean(axis=1))
    assert outwards.min() > -1e-9
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)
    directions = np.random.default_rng(1).normal(size=(3, 50))
    original = mesh.placed(shape).vertices * (1.0, -1.0, 1.0)
    mirrored = tessellate(shape.mirrored()).placed(shape.mirrored()).vertices
    assert (mirrored @ directions).max(axis=0) == pytest.approx((original @ directions).max(axis=0), abs=1e-9)


def test_a_rod_runs_from_end_to_end():
    shape = read_shape({"capsule": 0.1, "from": [0, 0, 0], "to": [0.3, 0.4, 0.0]}, "here")
    assert shape.size == pytest.approx((0.1, 0.5)) and shape.xyz == pytest.approx((0.15, 0.2, 0.0))
    assert rpy_matrix(shape.rpy) @ (0, 0, 1) == pytest.approx((0.6, 0.8, 0.0))


def test_lamps_sit_on_their_side_at_their_angle_and_both_sides_look_alike():
    lamps, shapes = load_appearance().lamps, load_appearance().shapes
    at = {one.lamp.name: tessellate(one.shape).placed(one.shape).vertices.mean(axis=0) for one in lamps}
    top, nose, bottom, outer = (at[f"LeftFaceLed{n}"] for n in (1, 3, 5, 7))
    assert top[2] > nose[2] > bottom[2] and 0.0 < nose[1] < top[1] < outer[1]
    assert at["LeftEarLed3"][0] > 0.015 and at["LeftEarLed8"][0] < -0.015
    assert at["Brain0"][0] > 0.02 > at["Brain5"][0]
    for lamp in (figure.lamp for figure in lamps):
        if lamp.side and lamp.part != "foot":
            assert (at[lamp.name][1] > 0.0) == (lamp.side == "Left"), lamp.name
    left = [name for name in shapes if name.startswith("L")]
    assert left and all(len(shapes["R" + name[1:]]) == len(shapes[name]) for name in left)


def test_the_right_sole_is_the_mirror_image_and_counter_clockwise():
    left, right = MODEL.sole_polygon("L"), MODEL.sole_polygon("R")
    assert sorted(map(tuple, right)) == sorted((x, -y) for x, y in left)
    for x, y in (left.T, right.T):
        assert np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)) > 0.0

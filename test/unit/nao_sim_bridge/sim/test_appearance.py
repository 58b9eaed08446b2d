"""Looks: shapes, meshes and lamps."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.appearance import load_appearance
from nao_sim_bridge.sim.errors import ConfigError
from nao_sim_bridge.sim.kinematics import rpy_matrix
from nao_sim_bridge.sim.leds_layout import load_leds
from nao_sim_bridge.sim.meshes import stl_bytes, tessellate
from nao_sim_bridge.sim.model import VERSIONS, load_model
from nao_sim_bridge.sim.shapes import SEEN_KINDS, Shape, read_shape

HERE = (0.0, 0.0, 0.0)
SHAPES = {
    "box": ((1.0, 2.0, 3.0), 6.0),
    "sphere": ((1.0,), 4.0 / 3.0 * math.pi),
    "cylinder": ((1.0, 2.0), 2.0 * math.pi),
    "capsule": ((1.0, 2.0), 2.0 * math.pi + 4.0 / 3.0 * math.pi),
    "ellipsoid": ((1.0, 2.0, 3.0), 8.0 * math.pi),
    "arc": ((0.5, 1.0, 0.2, 40.0), 0.75 * math.pi * 0.2 * 40.0 / 360.0),
}


def volume(mesh):
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6.0)


@pytest.mark.parametrize("kind", SHAPES)
def test_meshes_are_closed_and_have_the_volume_of_their_shape(kind):
    size, expected = SHAPES[kind]
    assert volume(tessellate(Shape(kind, size, HERE))) == pytest.approx(expected, rel=0.04)


@pytest.mark.parametrize("kind", SEEN_KINDS)
def test_normals_point_out_of_the_faces(kind):
    size = SHAPES[kind][0] if kind in SHAPES else (1.0, 2.0, 3.0)
    mesh = tessellate(Shape(kind, size, HERE))
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    outwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), mesh.normals[mesh.faces].mean(axis=1))
    assert outwards.min() > -1e-9
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1.0)


def test_a_pillow_lies_between_ellipsoid_and_box():
    ellipsoid = volume(tessellate(Shape("ellipsoid", (0.5, 0.5, 0.5), HERE)))
    pillow = volume(tessellate(Shape("pillow", (1.0, 1.0, 1.0), HERE)))
    assert ellipsoid < pillow < 1.0


def test_stl_has_one_record_a_triangle():
    content = stl_bytes(tessellate(Shape("box", (1.0, 1.0, 1.0), HERE)))
    assert len(content) == 84 + 12 * 50


@pytest.mark.parametrize("kind", ["box", "cylinder", "arc"])
def test_a_mirrored_shape_is_the_mirror_image(kind):
    shape = Shape(kind, SHAPES[kind][0], (0.1, 0.2, 0.3), (0.4, -0.5, 0.6))
    mirror = np.array((1.0, -1.0, 1.0))
    original = tessellate(shape).placed(shape).vertices * mirror
    mirrored = tessellate(shape.mirrored()).placed(shape.mirrored()).vertices

    def reach(points):
        directions = np.random.default_rng(1).normal(size=(3, 50))
        return (points @ directions).max(axis=0)

    assert reach(mirrored) == pytest.approx(reach(original), abs=1e-9)


def test_a_rod_runs_from_end_to_end():
    shape = read_shape({"capsule": 0.1, "from": [0, 0, 0], "to": [0.3, 0.4, 0.0]}, "here")
    assert shape.size == pytest.approx((0.1, 0.5))
    assert shape.xyz == pytest.approx((0.15, 0.2, 0.0))
    assert rpy_matrix(shape.rpy) @ (0, 0, 1) == pytest.approx((0.6, 0.8, 0.0))


@pytest.mark.parametrize(
    "entry, message",
    [
        ({"xyz": [0, 0, 0]}, "exactly one of .*has none"),
        ({"sphere": 1, "box": [1, 1, 1]}, "has box, sphere"),
        ({"sphere": -1}, "must be above 0"),
        ({"sphere": 1, "from": [0, 0, 0], "to": [0, 0, 1]}, "from and to go together"),
        ({"capsule": 0.1, "from": [0, 0, 0]}, "from and to go together"),
        ({"cube": 1}, "unknown key 'cube'"),
        ({"ellipsoid": [1, 1, 1]}, "unknown key 'ellipsoid'"),
    ],
)
def test_wrong_shapes_are_refused(entry, message):
    with pytest.raises(ConfigError, match=message):
        read_shape(entry, "here")


@pytest.mark.parametrize("version", VERSIONS)
def test_every_lamp_has_a_figure_on_a_link_of_the_robot(version):
    figures = load_appearance(version).lamps
    links = {link.name for link in load_model(version).links}
    assert [figure.lamp for figure in figures] == list(load_leds(version).lamps)
    assert {figure.link for figure in figures} == {"HeadPitch", "Torso", "LAnkleRoll", "RAnkleRoll"} & links


def center(figure):
    return tessellate(figure.shape).placed(figure.shape).vertices.mean(axis=0)


def test_lamps_sit_on_their_side_at_their_angle():
    figures = {figure.lamp.name: figure for figure in load_appearance().lamps}
    top, nose, bottom, outer = (center(figures[f"LeftFaceLed{n}"]) for n in (1, 3, 5, 7))
    assert top[2] > nose[2] > bottom[2]
    assert 0.0 < nose[1] < top[1] < outer[1]
    front, rear = center(figures["LeftEarLed3"]), center(figures["LeftEarLed8"])
    assert front[0] > 0.015 and rear[0] < -0.015
    assert center(figures["Brain0"])[0] > 0.02 > center(figures["Brain5"])[0]
    for name, figure in figures.items():
        if figure.lamp.side and figure.lamp.part != "foot":
            assert math.copysign(1.0, center(figure)[1]) == (1.0 if figure.lamp.side == "Left" else -1.0), name


def test_both_sides_look_alike():
    shapes = load_appearance().shapes
    left = [name for name in shapes if name.startswith("L")]
    assert left
    for name in left:
        assert len(shapes["R" + name[1:]]) == len(shapes[name])

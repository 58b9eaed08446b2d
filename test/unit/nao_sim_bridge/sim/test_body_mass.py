"""Masses, centres of mass, convex hulls."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.body_mass import center_of_links, convex_hull, links_of, mass_of
from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.kinematics import center_of_mass
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture

MODEL = load_model()


def test_the_parts_weigh_as_much_as_the_whole():
    parts = sum(mass_of(links_of(MODEL, name)) for name in ("Torso", *MODEL.chain_names))
    assert parts == pytest.approx(MODEL.total_mass)
    assert mass_of(links_of(MODEL, "Joints")) + mass_of(links_of(MODEL, "Torso")) == pytest.approx(parts)


def test_the_whole_body_has_the_centre_of_all_links():
    angles = posture(MODEL, "Stand")
    assert center_of_links(MODEL, links_of(MODEL, "Body"), angles) == pytest.approx(center_of_mass(MODEL, angles))


def test_an_unknown_body_is_refused():
    with pytest.raises(UnknownName, match="did you mean 'LArm'"):
        links_of(MODEL, "LArn")


def test_a_hull_leaves_out_inner_points_and_points_on_edges():
    points = [(0, 0), (1, 0), (2, 0), (2, 2), (0, 2), (1, 1), (2, 1)]
    assert convex_hull(points) == [(0, 0), (2, 0), (2, 2), (0, 2)]

"""Contacts in the frames of their links."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.readings import Contact, Pose
from nao_sim_bridge.sim.rotations import from_roll_pitch_yaw
from nao_sim_bridge.sim.sensors.contacts import in_link_frames, not_from_below

UPRIGHT = Pose((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
TURNED = Pose((0.0, 0.0, 1.0), from_roll_pitch_yaw(0.0, 0.0, math.pi / 2))
OVER = Pose((0.0, 0.0, 0.0), from_roll_pitch_yaw(math.pi, 0.0, 0.0))


def press_of(pose, position, normal, force=5.0):
    (press,) = in_link_frames([Contact(4, position, normal, force)], {4: pose})[4]
    return press


def test_a_contact_is_moved_into_the_frame_of_its_link():
    assert press_of(UPRIGHT, (1.1, 2.2, 2.9), (0, 0, 1)) == pytest.approx((0.1, 0.2, -0.1, 1.0, 5.0))


def test_and_turned_into_it():
    assert press_of(TURNED, (0.0, 0.3, 1.0), (0, 0, 1)) == pytest.approx((0.3, 0.0, 0.0, 1.0, 5.0), abs=1e-12)
    assert press_of(TURNED, (-0.3, 0.0, 1.0), (1, 0, 0)) == pytest.approx((0.0, 0.3, 0.0, 0.0, 5.0), abs=1e-12)


def test_on_a_link_upside_down_a_push_from_the_floor_goes_downwards():
    assert press_of(OVER, (0.1, 0.2, 0.3), (0, 0, 1)).upward == pytest.approx(-1.0)
    assert press_of(OVER, (0.1, 0.2, 0.3), (0, 0, 1))[:3] == pytest.approx((0.1, -0.2, -0.3))


def test_contacts_are_sorted_by_link():
    contacts = [Contact(link, (0, 0, 0), (0, 0, 1), float(n)) for n, link in enumerate((4, -1, 4))]
    presses = in_link_frames(contacts, {4: UPRIGHT, -1: TURNED})
    assert [press.force for press in presses[4]] == [0.0, 2.0]
    assert [press.force for press in presses[-1]] == [1.0]
    assert in_link_frames([], {}) == {}


@pytest.mark.parametrize("roll, kept", [(0.0, False), (0.9, False), (1.2, True), (math.pi, True)])
def test_what_pushes_along_the_z_axis_of_a_link_comes_from_below(roll, kept):
    """The floor under a foot that is tilted by `roll`, rad; at a right angle it is at its side."""
    pose = Pose((0.0, 0.0, 0.1), from_roll_pitch_yaw(roll, 0.0, 0.3))
    contact = Contact(3, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 5.0)
    assert not_from_below([contact], {3: pose}) == ([contact] if kept else [])

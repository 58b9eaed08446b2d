"""Motor currents follow torques, and every joint has a motor."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sensors.body import BodySensors
from nao_sim_bridge.sim.settings import load_settings

MODEL = load_model()
LINKS = {link.alt_name: number for number, link in enumerate(MODEL.links) if link.alt_name != "torso"}


@pytest.fixture
def sensors():
    return BodySensors(MODEL, load_settings(), LINKS)


def test_current_is_the_size_of_the_torque_whatever_its_direction(sensors):
    forth, back = sensors.currents([0.5] * 26), sensors.currents([-0.5] * 26)
    assert forth == back
    assert sensors.currents([1.0] * 26) == pytest.approx([2 * amps for amps in forth])
    assert sensors.currents([0.0] * 26) == (0.0,) * 26


def test_the_full_torque_of_every_joint_draws_a_current_such_motors_stand(sensors):
    currents = sensors.currents([joint.max_torque for joint in MODEL.joints])
    for joint, amps in zip(MODEL.joints, currents):
        assert 0.02 < amps < 6.0, joint.name


def test_left_and_right_draw_the_same(sensors):
    currents = sensors.currents([0.5] * 26)
    for joint, index in MODEL.joint_index.items():
        if joint.startswith("L"):
            assert currents[index] == pytest.approx(currents[MODEL.joint_index[f"R{joint[1:]}"]])


def test_nothing_presses_when_there_is_no_contact(sensors):
    assert sensors.touched({}) == frozenset()
    assert sensors.foot_forces("L", {}).total == 0.0

"""What a simulation starts with: friction and payload are physical, wrong numbers are refused."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.scene import Scene

G = 9.81


@pytest.mark.parametrize("name", ["friction", "payload", "sensor_noise", "sensor_delay"])
@pytest.mark.parametrize("value", [-0.1, math.inf, math.nan])
def test_amounts_below_zero_or_without_end_are_refused(name, value):
    with pytest.raises(BadValue, match=f"{name} is {value}, allowed is 0 "):
        Scene(**{name: value})


def test_a_delay_of_more_than_a_second_is_refused():
    with pytest.raises(BadValue, match="sensor_delay is 1.5, allowed is 0 to 1 s"):
        Scene(sensor_delay=1.5)


def test_the_friction_is_that_between_sole_and_floor(bench):
    """The engine multiplies the coefficients of the two that touch."""
    one = bench(friction=0.4)
    sole = one.simulation.settings.contact.sole_friction
    assert one.simulation.scene.load_world(sole).floor.friction * sole == pytest.approx(0.4)


def slide(one, force, seconds=0.25):
    """How far the left foot slides when both are pushed forward with `force` N together, m."""
    weight = one.model.total_mass * G
    one.run(1.0)
    before = one.now.link_poses[foot_of(one)].position[0]
    for ankle in ("l_ankle", "r_ankle"):
        one.push((force * weight / 2, 0.0, 0.0), seconds, ankle)
    one.run(seconds)
    return one.now.link_poses[foot_of(one)].position[0] - before


def foot_of(one):
    return min(contact.link for contact in one.now.contacts)


def test_feet_hold_below_the_friction_and_slide_above(bench):
    assert abs(slide(bench(friction=0.4), 0.25)) < 2e-3
    assert slide(bench(friction=0.4), 0.55) > 5e-3
    assert abs(slide(bench(), 0.55)) < 2e-3


def test_feet_press_on_the_floor_with_the_payload_too(bench):
    one = bench(payload=1.0)
    one.run(1.0)
    load = one.now.left_foot.total + one.now.right_foot.total
    assert load == pytest.approx((one.model.total_mass + 1.0) * G, rel=0.01)


def test_friction_and_payload_outlive_a_reset(bench):
    one = bench(payload=0.5)
    one.simulation.reset()
    one.stiffen(1.0)
    one.run(1.0)
    load = one.now.left_foot.total + one.now.right_foot.total
    assert load == pytest.approx((one.model.total_mass + 0.5) * G, rel=0.01)

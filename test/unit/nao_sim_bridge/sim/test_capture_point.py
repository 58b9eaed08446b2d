"""The body's motion from encoders and inertial unit against the truth that the simulation knows."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.capture_point import BodyTracker
from nao_sim_bridge.sim.kinematics import center_of_mass, quaternion_matrix

GRAVITY = 9.81


def true_center(one):
    torso = one.now.torso
    inside = center_of_mass(one.model, one.now.positions)
    return quaternion_matrix(torso.orientation) @ inside + np.array(torso.position)


def tracked(one, seconds, left_share=0.5):
    """(body motion, true velocity of the centre of mass in world) of each tick."""
    tracker = BodyTracker(one.model, GRAVITY, smoothing=0.3)
    dt = one.simulation.settings.tick_s
    seen, before = [], true_center(one)
    for _ in range(round(seconds / dt)):
        one.simulation.tick()
        now = true_center(one)
        seen.append((tracker.follow(one.now, left_share, dt), (now - before) / dt))
        before = now
    return seen


def test_at_rest_the_capture_point_is_the_centre_of_mass(bench):
    one = bench("StandInit")
    one.run(1.0)
    body, _ = tracked(one, 0.1)[-1]
    assert body.capture_point == pytest.approx(body.stance.com[:2], abs=1e-5)
    assert body.frequency == pytest.approx(math.sqrt(GRAVITY / true_center(one)[2]), rel=0.01)


@pytest.mark.parametrize("force", [(12.0, 0.0, 0.0), (-8.0, 0.0, 0.0), (0.0, 15.0, 0.0)])
def test_a_pushed_body_moves_as_fast_as_it_really_does(bench, force):
    one = bench("StandInit")
    one.robot.stability.balance.enabled = False
    one.run(1.0)
    one.push(force, 0.1)
    seen = tracked(one, 0.12)
    axis = 0 if force[0] else 1
    fastest = max(seen, key=lambda pair: abs(pair[1][axis]))[1][axis]
    assert math.copysign(1.0, fastest) == math.copysign(1.0, force[axis])
    assert max((body.velocity[axis] for body, _ in seen), key=abs) == pytest.approx(fastest, rel=0.25)


def test_the_first_reading_after_forgetting_has_no_velocity(bench):
    one = bench()
    one.run(0.5)
    one.push((15.0, 0.0, 0.0), 0.1)
    one.run(0.1)
    tracker = BodyTracker(one.model, GRAVITY, smoothing=0.3)
    dt = one.simulation.settings.tick_s
    assert tracker.follow(one.now, 0.5, dt).velocity == (0.0, 0.0)
    one.simulation.tick()
    assert tracker.follow(one.now, 0.5, dt).velocity[0] > 0.01
    tracker.forget()
    assert tracker.follow(one.now, 0.5, dt).velocity == (0.0, 0.0)

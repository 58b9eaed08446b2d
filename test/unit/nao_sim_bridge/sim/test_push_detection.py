"""Pushes that a standing robot notices."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.push_detection import PushDetector


@pytest.fixture
def pushes(bench):
    """Pushes that a standing robot has noticed."""
    one = bench()
    detector, found = PushDetector(one.model.total_mass), []

    def still():
        return not any(one.robot.joints.velocities)

    def look(snapshot):
        push = detector.look(snapshot, still)
        if push is not None:
            found.append(push)

    one.simulation.after_tick.append(look)
    one.run(1.5)
    return one, found


@pytest.mark.parametrize("angle", [0.0, 90.0, -90.0, 180.0])
def test_a_push_is_noticed_once_with_where_it_went(pushes, angle):
    one, found = pushes
    turn = math.radians(angle)
    one.push((15.0 * math.cos(turn), 15.0 * math.sin(turn), 0.0), 0.1)
    one.run(1.0)
    (push,) = found
    off = math.remainder(push.angle - turn, 2.0 * math.pi)
    assert abs(off) < 0.4
    assert 0.003 < push.energy < 1.0


def test_a_harder_push_has_more_energy(pushes):
    one, found = pushes
    for force in (12.0, 18.0):
        one.push((force, 0.0, 0.0), 0.1)
        one.run(3.0)
    assert len(found) == 2
    assert found[1].energy > 1.4 * found[0].energy


def test_a_robot_that_nobody_touches_notices_nothing(pushes):
    one, found = pushes
    one.run(2.0)
    one.aim(3.0, LShoulderPitch=0.0, HeadYaw=1.0)
    one.run(2.0)
    assert found == []


def test_a_slight_touch_is_no_push(pushes):
    one, found = pushes
    one.push((2.0, 0.0, 0.0), 0.1)
    one.run(1.0)
    assert found == []

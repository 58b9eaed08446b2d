"""What keeps a robot on its feet: who corrects the legs, and when the robot counts as standing."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.motion import sequences


@pytest.fixture
def standing(bench):
    """A simulation whose robot has stood for a while."""
    one = bench("StandInit")
    one.run(0.8)
    return one


def test_a_walk_takes_the_place_of_balance(standing):
    stability = standing.robot.stability
    standing.push((25.0, 0.0, 0.0), 0.1)
    standing.run(0.1)
    assert stability.balance.acting
    stability.walk = lambda: (0.0, 0.0)
    standing.run(0.3)
    assert not stability.balance.acting
    assert standing.robot.joints.corrections == {}
    assert not stability.falls.falling


def test_a_body_that_a_walk_has_lost_falls_where_it_heads(standing):
    stability = standing.robot.stability
    stability.walk = lambda: (-0.05, 0.0)
    standing.run(0.1)
    assert not stability.falls.falling
    stability.walk = lambda: (-0.3, 0.0)
    standing.simulation.tick()
    assert stability.falls.falling
    assert stability.falls.direction == (-1.0, 0.0)


def test_a_robot_on_its_feet_stands_stiff_or_limp(bench):
    for one in (bench("Stand"), bench("Crouch", 0.0)):
        assert not one.robot.stability.on_feet
        one.run(0.5)
        assert one.robot.stability.on_feet


def test_a_robot_on_its_back_does_not_stand(standing):
    standing.push((-80.0, 0.0, 0.0), 0.1)
    standing.run(3.0)
    assert not standing.robot.stability.on_feet


def test_a_robot_stands_all_the_time_while_it_gets_up_and_goes_to_rest(bench):
    one = bench("Crouch", 0.0)
    one.run(0.5)
    for change in (sequences.wake_up, sequences.rest):
        change(one.robot, lambda: one.now, lambda: None)
        for _ in range(300):
            one.simulation.tick()
            assert one.robot.stability.on_feet


def test_a_robot_that_sits_does_not_stand_and_is_not_corrected(bench):
    one = bench("Sit")
    one.run(1.0)
    one.push((5.0, 0.0, 0.0), 0.1)
    for _ in range(120):
        one.simulation.tick()
        assert one.robot.joints.corrections == {}
    assert not one.robot.stability.on_feet

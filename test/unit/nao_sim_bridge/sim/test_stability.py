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


def test_a_corrector_takes_the_place_of_balance(standing):
    stability, ankles = standing.robot.stability, [standing.model.joint_index[f"{s}AnklePitch"] for s in "LR"]
    seen = []

    def correct(body, snapshot):
        seen.append((body, snapshot))
        return dict.fromkeys(ankles, 0.02)

    stability.corrector = correct
    standing.push((25.0, 0.0, 0.0), 0.1)
    before = standing.now
    standing.run(0.25)
    assert seen[0][1] is before
    assert len(seen) == round(0.25 / standing.simulation.settings.tick_s)
    assert max(body.velocity[0] for body, _ in seen) > 0.02
    assert standing.robot.joints.corrections == dict.fromkeys(ankles, 0.02)
    stability.corrector = None
    standing.run(1.0)
    assert standing.robot.joints.corrections == {}


def test_a_falling_robot_is_not_corrected(standing):
    stability = standing.robot.stability
    stability.corrector = lambda body, snapshot: {standing.model.joint_index["LAnklePitch"]: 0.01}
    standing.push((80.0, 0.0, 0.0), 0.1)
    while not stability.falls.falling:
        standing.simulation.tick()
    standing.simulation.tick()
    assert standing.robot.joints.corrections == {}


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

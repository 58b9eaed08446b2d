"""Walking where it is not level, with a load, and with sensors like a real robot's: short, one way each."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.walk.gait import feet_gait

REAL = {"sensor_noise": 1.0, "sensor_delay": 0.016}


@pytest.mark.parametrize(
    "scene",
    [
        {"world": "slope_3deg"},
        {"world": "uneven"},
        {"friction": 0.4},
        {"friction": 1.2},
        {"payload": 0.54},
        {},
    ],
    ids=["slope", "plates", "slippery", "rough", "loaded", "level"],
)
def test_it_walks_on(bench, scene):
    one = bench("StandInit", **scene, **REAL)
    one.run(0.3)
    one.robot.locomotion.move(0.09, 0.0, 0.0, feet_gait({}))
    one.run(6.0)
    assert one.robot.locomotion.active
    assert not one.robot.stability.falls.falling
    assert one.now.torso.position[0] > 0.2
    assert one.now.torso.position[2] > 0.28


def test_it_stands_still_on_a_slope(bench):
    one = bench("StandInit", world="slope_3deg")
    one.run(0.5)
    before = one.now.torso.position
    one.run(2.0)
    assert one.now.torso.position == pytest.approx(before, abs=1e-3)


def test_an_obstacle_ahead_ends_the_walk_on_two_feet(bench):
    one = bench("StandInit", world="lab")
    one.run(0.3)
    failures = []
    one.robot.locomotion.failures.append(lambda cause, started, place: failures.append((cause, started, place)))
    one.robot.locomotion.move(0.09, 0.0, 0.0, feet_gait({}))
    for _ in range(20):
        one.run(0.5)
        if not one.robot.locomotion.active:
            break
    assert not one.robot.locomotion.active
    ((cause, started, place),) = failures
    assert started and "obstacle" in cause
    assert 0.2 < place[0] - one.now.odometry.position[0] < 0.6

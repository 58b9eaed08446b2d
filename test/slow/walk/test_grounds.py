"""Walking where it is not level, with a load, and with sensors like a real robot's."""

from __future__ import annotations

import pytest

from nao_sim_bridge.walk.gait import feet_gait

REAL = {"sensor_noise": 1.0, "sensor_delay": 0.016}


@pytest.mark.parametrize(
    "scene, ahead",
    [({"world": "slope_3deg"}, 0.368), ({"world": "uneven"}, 0.347), ({"payload": 0.54}, 0.382), ({}, 0.373)]
    + [({"friction": 0.4}, 0.377), ({"friction": 1.2}, 0.381)],
)
def test_it_walks_on(bench, scene, ahead):
    one = bench("StandInit", **scene, **REAL)
    one.run(0.3)
    one.robot.locomotion.move(0.09, 0.0, 0.0, feet_gait({}))
    one.run(6.0)
    assert one.robot.locomotion.active and not one.robot.stability.falls.falling
    assert one.now.torso.position[:2] == pytest.approx((ahead, 0.024), abs=0.02)
    assert 0.295 < one.now.torso.position[2] < 0.325


def test_it_stands_still_on_a_slope(bench):
    one = bench("StandInit", world="slope_3deg")
    one.run(0.5)
    before = one.now.torso.position
    one.run(2.0)
    assert one.now.torso.position == pytest.approx(before, abs=1e-3)

"""Force sensors of the feet: what presses is shared out, and nothing gets lost."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.sensors.contacts import Press
from nao_sim_bridge.sim.sensors.feet import UNLOADED, FootSensors

MODEL = load_model()
CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
SOLE = -0.045


def place(side, corner):
    return next(p.position for p in MODEL.fsr if p.name == f"{side}Foot/FSR/{corner}")


def foot(side, *presses):
    """Reads a foot under presses of (x, y, force) from straight below."""
    return FootSensors(MODEL, side).read([Press(x, y, SOLE, 1.0, force) for x, y, force in presses])


@pytest.mark.parametrize("side", "LR")
@pytest.mark.parametrize("index, corner", enumerate(CORNERS))
def test_a_force_on_a_sensor_is_felt_by_that_sensor(side, index, corner):
    x, y, _ = place(side, corner)
    forces = foot(side, (x, y, 8.0)).forces
    assert forces[index] == pytest.approx(8.0, rel=0.02)


@pytest.mark.parametrize("side", "LR")
def test_a_force_amid_the_sensors_is_shared_evenly(side):
    corners = [place(side, corner) for corner in CORNERS]
    middle = [sum(corner[axis] for corner in corners) / 4 for axis in (0, 1)]
    assert foot(side, (*middle, 8.0)).forces == pytest.approx((2.0,) * 4, rel=0.1)


@pytest.mark.parametrize("x, y", [(0.02, 0.01), (0.09, 0.04), (-0.04, -0.03), (0.05, -0.08)])
def test_shares_add_up_wherever_the_force_is(x, y):
    reading = foot("L", (x, y, 8.0), (0.0, 0.0, 3.0))
    assert sum(reading.forces) == pytest.approx(reading.total) == pytest.approx(11.0)
    assert min(reading.forces) >= 0.0


def test_a_force_beyond_the_toes_loads_the_front_only():
    front_left, front_right, rear_left, rear_right = foot("L", (0.09, 0.0, 8.0)).forces
    assert rear_left == rear_right == 0.0
    assert front_left + front_right == pytest.approx(8.0)


def test_the_center_of_pressure_is_the_weighted_middle():
    assert foot("R", (0.06, 0.02, 1.0), (-0.02, -0.02, 3.0)).center_of_pressure == pytest.approx((0.0, -0.01))


def test_without_load_everything_is_zero():
    assert foot("L") == UNLOADED
    assert foot("L", (0.0, 0.0, 0.0)) == UNLOADED


def test_only_what_pushes_upwards_counts():
    sensors = FootSensors(MODEL, "L")
    assert sensors.read([Press(0.0, 0.0, 0.03, -1.0, 9.0)]) == UNLOADED
    assert sensors.read([Press(0.09, 0.0, -0.03, 0.0, 9.0)]) == UNLOADED
    assert sensors.read([Press(0.0, 0.0, SOLE, 0.5, 8.0)]).total == pytest.approx(4.0)

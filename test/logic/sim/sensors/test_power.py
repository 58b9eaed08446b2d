"""What motors draw and lose as heat, what is hot, and the battery."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from nao_sim_bridge.base.settings import load_settings
from nao_sim_bridge.body.sensors.battery import Battery, Status
from nao_sim_bridge.body.sensors.power import Motors, PowerSystem, Work, motor_of
from nao_sim_bridge.body.temperatures import HOT, NOTHING_HOT, heat_shares, heat_status, hot_devices
from nao_sim_bridge.model.model_reader import load_model

MODEL, SETTINGS = load_model(), load_settings()
STILL, STIFF = [0.0] * 26, [1.0] * 26
KNEE = MODEL.joint_index["LKneePitch"]


@pytest.fixture
def motors():
    return Motors(MODEL, SETTINGS)


def knee(value):
    return [value if index == KNEE else 0.0 for index in range(26)]


def test_a_stalled_motor_takes_battery_voltage_times_its_current(motors):
    motor, ratio = motor_of(MODEL, "LKneePitch")
    torque = motor.stall_torque * ratio * SETTINGS.motor.gear_efficiency
    work = motors.work(knee(torque), STILL, STIFF)
    assert work.losses[KNEE] == pytest.approx(SETTINGS.battery.voltage_v * motors.currents(knee(torque))[KNEE])
    assert work.drawn == pytest.approx(sum(work.losses))
    single, double = (motors.work(knee(t), STILL, STIFF).losses[KNEE] for t in (0.5, 1.0))
    assert double == pytest.approx(4.0 * single)
    big = {joint.name for joint, heat in zip(MODEL.joints, motors.heat_capacities) if heat > 20.0}
    assert big == {joint for leg in ("LLeg", "RLeg") for joint in MODEL.chains[leg]}
    with pytest.raises(KeyError, match="Tail"):
        motor_of(MODEL, "Tail")


def test_lifting_draws_more_than_holding_lowering_and_limp_motors_nothing(motors):
    lifting, holding, lowering = (motors.work(knee(1.0), knee(v), STIFF).drawn for v in (2.0, 0.0, -2.0))
    assert lifting == pytest.approx(holding + 2.0 / SETTINGS.motor.gear_efficiency) and lowering == 0.0
    limp = motors.work([1.0] * 26, [1.0] * 26, STILL)
    assert (limp.drawn, limp.stiff, set(limp.losses)) == (0.0, 0, {0.0})
    assert motors.work(STILL, STILL, STIFF).stiff == 26


def test_hot_motors_have_a_status_and_less_torque():
    assert [heat_status(celsius) for celsius in (20.0, 67.9, 68.0, 74.0, 80.0, 200.0)] == [0, 0, 1, 2, 3, 3]
    assert heat_shares([30.0, HOT[1] - 0.1]) == () != heat_shares([30.0, HOT[1]])
    *cold, very_hot, critical = heat_shares([30.0, *HOT])
    assert cold == [1.0, 1.0] and 0.0 < very_hot < 0.7 and critical == 0.0


def hot(head=50.0, battery=False, **joints):
    temperatures = tuple(joints.get(joint.name, 30.0) for joint in MODEL.joints)
    felt = SimpleNamespace(temperatures=temperatures, head_temperature=head, battery=SimpleNamespace(hot=battery))
    return hot_devices(MODEL, SETTINGS.head, felt)


def test_the_worst_devices_decide_on_the_status():
    assert hot() is NOTHING_HOT and NOTHING_HOT.status == (0, ())
    found = hot(HeadYaw=69.0, LKneePitch=76.0, RKneePitch=75.0)
    assert found.devices == {"HeadYaw": 1, "LKneePitch": 2, "RKneePitch": 2}
    assert found.status == (2, ("LKneePitch", "RKneePitch"))
    assert (found.severity, found.chains) == (1, ("LLeg", "RLeg"))
    assert [hot(RElbowRoll=celsius).severity for celsius in (68.0, 74.0, 80.0)] == [0, 1, 2]
    assert hot(RElbowRoll=67.9) is NOTHING_HOT and hot(RElbowRoll=68.0).devices == {"RElbowRoll": 1}
    heads = [hot(head=celsius) for celsius in (94.9, 95.0, 105.0)]
    assert [found.status[0] for found in heads] == [0, 1, 3]
    assert all(found.chains == found.joints == () for found in heads), "no failure of a chain"
    assert hot(battery=True).devices == {"Battery": 1}


AMBIENT, CAPACITIES, IDLE = SETTINGS.motor.ambient_c, (32.0, 16.0), Work((0.0, 0.0), 0.0, 0)


@pytest.fixture
def power():
    return PowerSystem(CAPACITIES, SETTINGS)


def let_pass(power, seconds, work, dt=0.1):
    for _ in range(round(seconds / dt)):
        power.advance(lambda: work, dt)


def test_motors_warm_up_at_work_to_where_cooling_equals_it_and_cool_down(power):
    assert power.temperatures == (AMBIENT, AMBIENT) and (power.head, power.battery.reading.charge) == (AMBIENT, 1.0)
    power.advance(lambda: Work((2.0, 2.0), 4.0, 2), 0.1)
    big, small = (temperature - AMBIENT for temperature in power.temperatures)
    assert small == pytest.approx(2.0 * big) and big > 0.0
    let_pass(power, 60.0, Work((4.0, 0.0), 4.0, 1))
    assert power.temperatures[0] > AMBIENT + 5.0 and power.temperatures[1] < AMBIENT + small
    let_pass(power, 3000.0, Work((4.0, 0.0), 4.0, 1), dt=1.0)
    expected = AMBIENT + 4.0 / CAPACITIES[0] / SETTINGS.motor.cooling_per_s
    assert power.temperatures[0] == pytest.approx(expected, rel=0.01)
    power.warm_up(0, 70.0)
    let_pass(power, 60.0, IDLE)
    assert AMBIENT < power.temperatures[0] < 70.0


STEP = 10.0


@pytest.fixture
def battery():
    return Battery(SETTINGS.battery, 27.0, tells_plugged=True)


def use(battery, hours, watts):
    for _ in range(round(3600.0 * hours / STEP)):
        battery.advance(watts, STEP)


def test_it_empties_and_fills_in_the_published_times(battery):
    use(battery, 1.0, 31.25)
    # Half of 62.5 Wh; the voltage is above the nominal one in the upper half.
    assert 0.48 < battery.reading.charge < 0.58 and battery.reading.current > 0.0 and battery.reading.discharging
    use(battery, 1.1, 31.25)
    assert battery.reading.charge < 0.02
    use(battery, 0.2, 100.0)
    empty = battery.reading
    assert empty.charge == 0.0 and empty.empty and empty.nearly_empty and empty.low
    assert empty.status & Status.END_OF_DISCHARGE and not empty.status & Status.DISCHARGE_FET_ON
    battery.plug(True)
    use(battery, 1.4, 15.0)
    assert battery.reading.charging and battery.reading.current < 0.0
    assert 0.9 < battery.reading.charge < SETTINGS.battery.full_charge
    use(battery, 0.2, 15.0)
    assert battery.reading.full and not battery.reading.charging and not battery.reading.discharging


def test_the_charger_gives_less_and_less_from_a_charge_on():
    changes = {"charge_current_a": 2.0, "full_charge": 0.9, "taper_from_charge": 0.5, "least_taper": 0.25}
    battery, currents = Battery(replace(SETTINGS.battery, **changes), 27.0, tells_plugged=True), []
    battery.plug(True)
    for charge in (0.3, 0.5, 0.75, 0.89, 0.95):
        battery.put(charge)
        battery.advance(20.0, 1e-6)
        currents.append(battery.reading.current)
    assert currents == pytest.approx([-2.0, -2.0, -1.0, -0.5, 0.0], abs=1e-4) and battery.reading.full


@pytest.mark.parametrize("limit", ["low", "nearly_empty", "empty"])
def test_limits_of_the_charge(battery, limit):
    for off, reached in ((0.001, False), (0.0, True), (-0.001, True)):
        battery.put(getattr(SETTINGS.battery, f"{limit}_charge") + off)
        assert getattr(battery.reading, limit) is reached

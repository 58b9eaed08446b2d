"""The battery drains, charges, warms up and tells about it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from nao_sim_bridge.sim.battery import Battery, Status, interpolated
from nao_sim_bridge.sim.settings import load_settings

SETTINGS = load_settings().battery
AMBIENT = 27.0
STEP = 10.0


@pytest.fixture
def battery():
    return Battery(SETTINGS, AMBIENT, tells_plugged=True)


def let_pass(battery, hours, watts):
    for _ in range(round(3600.0 * hours / STEP)):
        battery.advance(watts, STEP)


def test_it_is_full_at_the_start(battery):
    assert battery.reading.charge == 1.0
    assert battery.reading.full


def test_its_flags_are_right_before_any_time_has_passed(battery):
    flags = Status.FULL | Status.CHARGING | Status.DISCHARGING
    assert battery.reading.status & flags == Status.FULL | Status.DISCHARGING
    battery.put(0.2)
    assert battery.reading.status & flags == Status.DISCHARGING
    battery.plug(True)
    assert battery.reading.status & flags == Status.CHARGING
    battery.put(1.0)
    assert battery.reading.status & flags == Status.FULL
    battery.plug(False)
    assert battery.reading.status & flags == Status.FULL | Status.DISCHARGING


def test_its_energy_is_about_that_of_the_published_pack(battery):
    let_pass(battery, 1.0, 31.25)
    # Half of 62.5 Wh; the voltage is above the nominal one in the upper half.
    assert 0.48 < battery.reading.charge < 0.58
    let_pass(battery, 1.1, 31.25)
    assert battery.reading.charge < 0.02


def test_an_empty_battery_stays_empty(battery):
    let_pass(battery, 10.0, 100.0)
    assert battery.reading.charge == 0.0
    assert battery.reading.empty and battery.reading.nearly_empty and battery.reading.low
    assert battery.reading.status & Status.END_OF_DISCHARGE
    assert not battery.reading.status & Status.DISCHARGE_FET_ON


def test_it_is_full_again_after_the_published_time(battery):
    battery.put(0.0)
    battery.plug(True)
    let_pass(battery, 1.4, 15.0)
    assert battery.reading.charging and 0.9 < battery.reading.charge < SETTINGS.full_charge
    let_pass(battery, 0.2, 15.0)
    assert battery.reading.full and not battery.reading.charging and not battery.reading.discharging


def test_charger_and_load_have_different_signs(battery):
    battery.put(0.5)
    battery.advance(20.0, STEP)
    assert battery.reading.current > 0.0 and battery.reading.discharging
    battery.plug(True)
    battery.advance(20.0, STEP)
    assert battery.reading.current < 0.0 and battery.reading.charging


def test_only_a_board_that_can_tells_the_plug(battery):
    battery.plug(True)
    assert battery.reading.status & Status.POWER_SUPPLY_PRESENT
    silent = Battery(SETTINGS, AMBIENT, tells_plugged=False)
    silent.plug(True)
    assert not silent.reading.status & Status.POWER_SUPPLY_PRESENT


def test_the_voltage_falls_with_the_charge_and_under_load(battery):
    rest = battery.reading.voltage
    voltages = []
    for charge in range(21):
        battery.put(charge / 20.0)
        voltages.append(battery.reading.voltage)
    assert voltages == sorted(set(voltages))
    assert 15.0 < voltages[0] and voltages[-1] == rest < 26.0
    battery.advance(80.0, 0.1)
    assert battery.reading.voltage < rest - 0.5
    weakest, strongest = battery.reading.cell_voltages
    assert strongest - weakest == pytest.approx(SETTINGS.cell_spread_v)


@pytest.mark.parametrize("x, y", [(0.0, 1.0), (0.5, 1.5), (1.0, 2.0), (2.0, 6.0), (3.0, 10.0), (9.0, 10.0)])
def test_a_curve_has_straight_lines_between_its_points(x, y):
    assert interpolated(((0.0, 1.0), (1.0, 2.0), (3.0, 10.0)), x) == pytest.approx(y)


def test_a_heavy_load_warms_it_and_rest_cools_it(battery):
    let_pass(battery, 0.4, 60.0)
    warm = battery.reading.temperature
    assert AMBIENT + 1.0 < warm < AMBIENT + 30.0
    let_pass(battery, 0.4, 1.0)
    assert AMBIENT <= battery.reading.temperature < warm


@pytest.mark.parametrize("celsius, hot", [(59.9, False), (60.0, True)])
def test_it_raises_an_alarm_when_it_is_hot(battery, celsius, hot):
    battery.warm_up(celsius)
    assert battery.reading.hot is hot
    assert bool(battery.reading.status & Status.DISCHARGE_TEMPERATURE_ALARM) is hot


def test_the_charger_gives_less_and_less_from_a_charge_on():
    settings = replace(SETTINGS, charge_current_a=2.0, full_charge=0.9, taper_from_charge=0.5, least_taper=0.25)
    battery = Battery(settings, AMBIENT, tells_plugged=True)
    battery.plug(True)
    currents = []
    for charge in (0.3, 0.5, 0.75, 0.89, 0.95):
        battery.put(charge)
        battery.advance(20.0, 1e-6)
        currents.append(battery.reading.current)
    assert currents == pytest.approx([-2.0, -2.0, -1.0, -0.5, 0.0], abs=1e-4)
    assert battery.reading.full


@pytest.mark.parametrize("charge", [0.5, 0.11, 0.06, 0.01])
def test_limits(battery, charge):
    battery.put(charge)
    reading = battery.reading
    assert reading.low == (charge <= SETTINGS.low_charge)
    assert reading.nearly_empty == (charge <= SETTINGS.nearly_empty_charge)
    assert reading.empty == (charge <= SETTINGS.empty_charge)

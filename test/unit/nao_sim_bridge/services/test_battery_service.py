"""ALBattery and its events over the network."""

from __future__ import annotations

import pytest

from nao_sim_bridge.services.battery import BatteryEvents
from nao_sim_bridge.services.memory_store import MemoryStore

PREFIX = "Device/SubDeviceList/Battery/"
DISCHARGING, FULL, CHARGING, SUPPLY, END, NEAR_END = 1 << 5, 1 << 6, 1 << 7, 1 << 15, 1, 2
SOON = 0.25


@pytest.fixture
def power(robot):
    """The control of the battery: what it does is told at the next look of the board."""

    class Power:
        @staticmethod
        def charge(share):
            robot.NaoSimulation.setBatteryCharge(share)
            robot.advance(SOON)

        @staticmethod
        def plug(plugged):
            robot.NaoSimulation.plugCharger(plugged)
            robot.advance(SOON)

    return Power


@pytest.fixture
def read(robot):
    return lambda key: robot.ALMemory.getData(PREFIX + key)


def heard(listener, patience, count):
    return [listener.heard.get(timeout=patience)[1] for _ in range(count)]


def test_the_charge_in_percent(robot, power):
    robot.advance(SOON)
    assert robot.ALBattery.getBatteryCharge() == 100
    power.charge(0.426)
    assert robot.ALBattery.getBatteryCharge() == 43
    assert robot.ALMemory.getData("BatteryChargeChanged") == 43


def test_it_drains_by_itself(robot, power, read):
    power.charge(0.5)
    before = read("Charge/Sensor/Value")
    robot.advance(2.0)
    assert 0.0 < before - read("Charge/Sensor/Value") < 0.001
    assert read("Current/Sensor/Value") < 0.0
    assert read("Charge/Sensor/Status") & DISCHARGING
    assert robot.ALMemory.getData("BatteryDisChargingFlagChanged") is True


def test_a_charger_charges_it_until_it_is_full(robot, power, read):
    power.charge(0.5)
    power.plug(True)
    before = read("Charge/Sensor/Value")
    robot.advance(1.0)
    assert read("Charge/Sensor/Value") > before
    assert read("Current/Sensor/Value") > 0.0
    assert read("Charge/Sensor/Status") & (CHARGING | DISCHARGING | FULL) == CHARGING
    assert robot.ALMemory.getData("BatteryChargingFlagChanged") is True
    power.charge(0.9999)
    assert read("Charge/Sensor/Status") & (CHARGING | DISCHARGING | FULL) == FULL
    assert robot.ALMemory.getData("BatteryFullChargedFlagChanged") is True
    power.plug(False)
    assert robot.ALMemory.getData("BatteryChargingFlagChanged") is False


def test_a_v6_does_not_tell_the_plug(robot, power, read):
    power.plug(True)
    assert not read("Charge/Sensor/Status") & SUPPLY
    with pytest.raises(RuntimeError, match="BatteryPowerPluggedChanged"):
        robot.ALMemory.getData("BatteryPowerPluggedChanged")


def test_voltages_follow_the_charge(power, read):
    power.charge(0.9)
    high = read("Charge/Sensor/CellVoltageMin")
    assert 3900 < high <= read("Charge/Sensor/CellVoltageMax") < 4200
    assert read("Charge/Sensor/TotalVoltage") == pytest.approx(6 * high, rel=0.01)
    power.charge(0.1)
    assert 3300 < read("Charge/Sensor/CellVoltageMin") < 3500
    assert read("Charge/Sensor/RemainingCapacity") == pytest.approx(290, abs=1)


def test_changes_are_events(robot, power, listener, patience):
    robot.advance(SOON)
    robot.ALMemory.subscribeToEvent("BatteryChargeChanged", "Listener", "onEvent")
    power.charge(0.8)
    power.charge(0.3)
    assert heard(listener, patience, 2) == [80, 30]
    robot.ALMemory.unsubscribeToEvent("BatteryChargeChanged", "Listener")


def test_low_nearly_empty_and_empty_are_told_once_each(robot, power, read, listener, patience):
    for event in ("ALBattery/BatteryLow", "BatteryLowDetected", "BatteryNearlyEmpty", "BatteryEmpty"):
        robot.ALMemory.subscribeToEvent(event, "Listener", "onEvent")
    power.charge(0.11)
    assert heard(listener, patience, 2) == [True, True]
    assert not read("Charge/Sensor/Status") & (END | NEAR_END)
    power.charge(0.06)
    assert "nearly empty" in heard(listener, patience, 1)[0]
    assert read("Charge/Sensor/Status") & (END | NEAR_END) == NEAR_END
    power.charge(0.01)
    assert "is empty" in heard(listener, patience, 1)[0]
    assert read("Charge/Sensor/Status") & (END | NEAR_END) == END | NEAR_END
    power.charge(0.9)
    assert heard(listener, patience, 1) == [False]
    for event in ("ALBattery/BatteryLow", "BatteryLowDetected", "BatteryNearlyEmpty", "BatteryEmpty"):
        robot.ALMemory.unsubscribeToEvent(event, "Listener")


def test_without_monitoring_there_are_no_events(robot, power):
    power.charge(0.7)
    robot.ALBattery.enablePowerMonitoring(False)
    power.charge(0.4)
    assert robot.ALMemory.getData("BatteryChargeChanged") == 70
    robot.ALBattery.enablePowerMonitoring(True)
    robot.advance(SOON)
    assert robot.ALMemory.getData("BatteryChargeChanged") == 40


def test_an_empty_battery_puts_the_robot_to_rest_and_keeps_it_there(stiff_robot, power):
    stiff_robot.finish("ALMotion", "wakeUp", after=3.0)
    assert stiff_robot.ALMotion.robotIsWakeUp() is True
    power.charge(0.015)
    stiff_robot.advance(3.5)
    assert stiff_robot.ALMotion.robotIsWakeUp() is False
    assert stiff_robot.ALRobotPosture.getPosture() == "Crouch"
    assert set(stiff_robot.ALMotion.getStiffnesses("Body")) == {0.0}
    with pytest.raises(RuntimeError, match="the battery is empty, the robot wakes up when it is charged"):
        stiff_robot.ALMotion.wakeUp()
    power.plug(True)
    power.charge(0.05)
    with pytest.raises(RuntimeError, match="the battery is empty"):
        stiff_robot.ALMotion.wakeUp()
    power.charge(0.08)
    stiff_robot.finish("ALMotion", "wakeUp", after=3.0)
    assert stiff_robot.ALRobotPosture.getPosture() == "Stand"


@pytest.mark.parametrize("charge", [-0.1, 1.5, float("nan")])
def test_a_charge_that_cannot_be_is_refused(robot, charge):
    with pytest.raises(RuntimeError, match="NaoSimulation::setBatteryCharge charge is .*, allowed is"):
        robot.NaoSimulation.setBatteryCharge(charge)


# --- without a network ------------------------------------------------------------------------------------------------


def test_a_robot_that_is_plugged_in_from_the_start_is_so_after_a_reset(bench):
    one = bench(charger=True)
    assert one.now.battery.plugged
    one.simulation.reset()
    assert one.run(0.2).battery.plugged
    assert not bench().now.battery.plugged


def test_a_v5_tells_the_plug(bench):
    one, memory = bench(version="V5"), MemoryStore(lambda: 0.0)
    one.simulation.after_tick.append(BatteryEvents(memory))
    one.run(SOON)
    assert memory.get("BatteryPowerPluggedChanged") is False
    one.robot.power.battery.plug(True)
    one.run(SOON)
    assert memory.get("BatteryPowerPluggedChanged") is True
    assert one.now.battery.status & SUPPLY

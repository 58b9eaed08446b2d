"""ALBattery, ALBodyTemperature, ALDiagnosis: how the robot is, what it tells of it, and what it does then."""

import pytest

from nao_sim_bridge.naoqi.body.battery import ALBattery
from nao_sim_bridge.naoqi.memory.store import MemoryStore

DISCHARGING, FULL, CHARGING, SUPPLY, END, NEAR_END = 1 << 5, 1 << 6, 1 << 7, 1 << 15, 1, 2
CHARGE, CURRENT = "Battery/Charge/Sensor/Value", "Battery/Current/Sensor/Value"
SOON = 0.25
"""The boards tell something new ten times a second."""


@pytest.fixture
def health(robot):
    """What is done to the robot, and the boards have told it."""

    def change(method, *arguments):
        robot.NaoSimulation.call(method, *arguments)
        robot.advance(SOON)

    return change


@pytest.fixture
def told(robot, listener):
    """Listens to events; a function for what they have told since, by name."""

    def listen(*events):
        for event in (*events, "Test/Last"):
            robot.ALMemory.subscribeToEvent(event, "Listener", "onEvent")

        def since():
            robot.ALMemory.raiseEvent("Test/Last", 0)
            return listener.until("Test/Last")

        return since

    return listen


def test_it_drains_by_itself_and_is_charged_until_it_is_full(robot, health, read):
    robot.advance(SOON)
    assert robot.ALBattery.getBatteryCharge() == 100
    health("setBatteryCharge", 0.426)
    assert robot.ALBattery.getBatteryCharge() == 43 == read("BatteryChargeChanged")
    before = read(CHARGE)
    robot.advance(2.0)
    assert 0.0 < before - read(CHARGE) < 0.001 and read(CURRENT) < 0.0
    assert read("Battery/Charge/Sensor/Status") & DISCHARGING and read("BatteryDisChargingFlagChanged") is True
    health("plugCharger", True)
    before = read(CHARGE)
    robot.advance(1.0)
    assert read(CHARGE) > before and read(CURRENT) > 0.0
    assert read("Battery/Charge/Sensor/Status") & (CHARGING | DISCHARGING | FULL | SUPPLY) == CHARGING
    assert read("BatteryChargingFlagChanged") is True
    with pytest.raises(RuntimeError, match="BatteryPowerPluggedChanged"):  # a V6 does not tell the plug
        read("BatteryPowerPluggedChanged")
    health("setBatteryCharge", 0.9999)
    assert read("Battery/Charge/Sensor/Status") & (CHARGING | DISCHARGING | FULL) == FULL
    assert read("BatteryFullChargedFlagChanged") is True
    health("plugCharger", False)
    assert read("BatteryChargingFlagChanged") is False


def test_voltages_follow_the_charge(robot, health):
    cell = "Device/SubDeviceList/Battery/Charge/Sensor/CellVoltageMin"
    for charge, low, high in ((0.9, 3900, 4200), (0.1, 3300, 3500)):
        health("setBatteryCharge", charge)
        assert low < robot.value(cell) < high


def test_low_nearly_empty_and_empty_are_told_once_each(health, read, told):
    since = told("ALBattery/BatteryLow", "BatteryLowDetected", "BatteryNearlyEmpty", "BatteryEmpty")
    health("setBatteryCharge", 0.11)
    assert since() == {"ALBattery/BatteryLow": True, "BatteryLowDetected": True}
    assert not read("Battery/Charge/Sensor/Status") & (END | NEAR_END)
    health("setBatteryCharge", 0.06)
    assert "nearly empty" in since().pop("BatteryNearlyEmpty")
    assert read("Battery/Charge/Sensor/Status") & (END | NEAR_END) == NEAR_END
    health("setBatteryCharge", 0.01)
    assert "is empty" in since().pop("BatteryEmpty")
    assert read("Battery/Charge/Sensor/Status") & (END | NEAR_END) == END | NEAR_END
    health("setBatteryCharge", 0.9)
    assert since() == {"BatteryLowDetected": False}


def test_an_empty_battery_puts_the_robot_to_rest_and_keeps_it_there(stiff_robot, health):
    motion = stiff_robot.ALMotion
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    health("setBatteryCharge", 0.015)
    stiff_robot.advance(3.0)
    assert not motion.robotIsWakeUp() and stiff_robot.ALRobotPosture.getPosture() == "Crouch"
    assert set(motion.getStiffnesses("Body")) == {0.0}
    with pytest.raises(RuntimeError, match="the battery is empty, the robot wakes up when it is charged"):
        motion.wakeUp()
    health("plugCharger", True)
    health("setBatteryCharge", 0.08)
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    assert motion.robotIsWakeUp()


def test_a_charger_from_the_start_stays_and_a_v5_tells_its_plug(bench):
    one = bench(charger=True)
    assert one.now.battery.plugged
    one.simulation.reset()
    assert one.run(0.2).battery.plugged
    old, memory = bench(version="V5"), MemoryStore(lambda: 0.0)
    old.simulation.after_tick.append(ALBattery(None, memory))
    assert not old.run(SOON).battery.plugged and memory.get("BatteryPowerPluggedChanged") is False
    old.robot.power.battery.plug(True)
    assert old.run(SOON).battery.status & SUPPLY and memory.get("BatteryPowerPluggedChanged") is True


TEMPERATURE_EVENTS = (
    *("HotDeviceDetected", "DeviceNoLongerHotDetected", "HotJointDetected", "TemperatureStatusChanged"),
    *("TemperatureDiagnosisErrorChanged", "HeadProcessorIsHot", "HeadProcessorIsCriticallyHot"),
)


def test_a_hot_joint_is_told_with_its_severity_until_it_has_cooled_down(robot, health, told):
    robot.advance(SOON)
    diagnosis = robot.ALBodyTemperature.getTemperatureDiagnosis
    assert diagnosis() == [0, []] == robot.value("TemperatureStatusChanged")
    since = told(*TEMPERATURE_EVENTS)
    health("setTemperature", "LKneePitch", 70.0)
    assert diagnosis() == [0, ["LLeg"]]
    assert since() == {
        "HotDeviceDetected": ["LKneePitch"],
        "HotJointDetected": ["LKneePitch"],
        "TemperatureStatusChanged": [1, ["LKneePitch"]],
        "TemperatureDiagnosisErrorChanged": [0, ["LLeg"]],
    }
    health("setTemperature", "HeadYaw", 76.0)
    assert diagnosis() == [1, ["Head"]] and since()["TemperatureStatusChanged"] == [2, ["HeadYaw"]]
    health("setTemperature", "LKneePitch", 40.0)
    assert since() == {"DeviceNoLongerHotDetected": ["LKneePitch"]}


def test_head_and_battery_can_be_hot_and_nothing_is_told_without_notifications(robot, health, told):
    robot.advance(SOON)
    since = told(*TEMPERATURE_EVENTS)
    health("setTemperature", "Head", 100.0)
    found = since()
    assert found["HotDeviceDetected"] == ["Head"] and "TemperatureDiagnosisErrorChanged" not in found
    assert found["HeadProcessorIsHot"] == pytest.approx(100.0, abs=0.5)
    robot.NaoSimulation.setTemperature("Battery", 65.0)
    health("setTemperature", "Head", 108.0)
    found = since()
    assert found["HotDeviceDetected"] == ["Head", "Battery"]
    assert found["HeadProcessorIsCriticallyHot"] == pytest.approx(108.0, abs=0.5)
    assert robot.ALBodyTemperature.areNotificationsEnabled() is True
    robot.ALBodyTemperature.setEnableNotifications(False)
    assert robot.ALBodyTemperature.areNotificationsEnabled() is False
    health("setTemperature", "HeadPitch", 72.0)
    assert since() == {}


def test_sensors_that_do_not_answer_are_found_at_once(robot, health):
    diagnosis = robot.ALDiagnosis
    robot.advance(SOON)
    assert diagnosis.getDiagnosisStatus() == [0, []] and robot.value("ALDiagnosis/RobotIsReady") is True
    health("breakDevice", "US/Left")
    assert diagnosis.getPassiveDiagnosis() == [0, ["US/Left"]]
    health("breakDevice", "InertialSensor")
    both = [1, ["US/Left", "InertialSensor"]]
    assert diagnosis.getPassiveDiagnosis() == diagnosis.getDiagnosisStatus() == both
    assert robot.value("PassiveDiagnosisErrorChanged") == both and diagnosis.getActiveDiagnosis() == [0, []]
    for device in ("InertialSensor", "US/Left"):
        health("repairDevice", device)
    assert diagnosis.getPassiveDiagnosis() == [0, []] == robot.value("ALDiagnosis/DiagnosisErrorChanged")


def test_a_broken_motor_is_found_when_the_robot_wakes_up_and_its_chain_stays_limp(stiff_robot, health):
    motion, diagnosis = stiff_robot.ALMotion, stiff_robot.ALDiagnosis
    stiff_robot.finish("ALMotion", "rest", after=3.0)
    health("breakDevice", "HeadYaw")
    assert diagnosis.getDiagnosisStatus() == [0, []]  # nobody has tried it
    stiff_robot.finish("ALMotion", "wakeUp", after=3.0)
    assert diagnosis.getActiveDiagnosis() == [1, ["HeadYaw"]] == stiff_robot.value("ActiveDiagnosisErrorChanged")
    assert stiff_robot.value("ALDiagnosis/ActiveDiagnosisFinished") == "wakeUp"
    stiff_robot.advance(3.0)
    motion.setStiffnesses("Body", 1.0)
    stiff_robot.advance(SOON)
    assert motion.getStiffnesses("Head") == [0.0, 0.0] and stiff_robot.ALRobotPosture.getPosture() == "Stand"
    assert stiff_robot.value("ALMotion/Protection/DisabledDevicesChanged") == [["Head", True]]
    health("repairDevice", "HeadYaw")
    motion.setStiffnesses("Head", 1.0)
    assert motion.getStiffnesses("Head") == [1.0, 1.0] and diagnosis.getDiagnosisStatus() == [0, []]


def test_with_a_broken_leg_the_robot_does_not_wake_up(robot, begin, health):
    health("breakDevice", "LHipRoll")
    begin("ALMotion", "wakeUp", after=3.5)
    assert robot.ALDiagnosis.getDiagnosisStatus() == [2, ["LHipRoll"]]
    assert set(robot.ALMotion.getStiffnesses("Body")) == {0.0}
    with pytest.raises(RuntimeError, match="a motor of the legs is broken, the robot wakes up when it is repaired"):
        robot.ALMotion.wakeUp()


def test_a_health_that_cannot_be_is_refused(robot, refuses):
    refuses("NaoSimulation", """
        setBatteryCharge(-0.5) -> charge is -0.5, allowed is 0 to 1
        setTemperature('LKneepitch', 30.0) -> did you mean 'LKneePitch'
        setTemperature('Head', 1000.0) -> temperature is 1000.0, allowed is -40 to 200
        breakDevice('LKnee') -> unknown device 'LKnee'.*'LKneePitch'
    """)  # fmt: skip
    assert {"LKneePitch", "US/Left", "InertialSensor"} <= set(robot.NaoSimulation.devices())

"""Awake or at rest, falls and pushes, switches of the reflexes: what ALMotion does by itself and tells."""

import pytest

FALLING, FALLEN, STANDS = "ALMotion/RobotIsFalling", "robotHasFallen", "ALMotion/RobotIsStand"
STATES = ("wakeUpStarted", "wakeUpFinished", "restStarted", "restFinished")
PERMISSION = [["ENABLE_DEACTIVATION_OF_FALL_MANAGER", True]]
"""That of the owner to do without the fall manager."""


@pytest.fixture
def raised(robot):
    """How often events have been raised since the last call."""
    counts = {}

    def since(*events):
        before = {event: counts.get(event, 0) for event in events}
        counts.update((event, len(robot.ALMemory.getEventHistory(event))) for event in events)
        return [counts[event] - before[event] for event in events]

    return since


def states():
    return [f"ALMotion/Stiffness/{state}" for state in STATES]


def test_waking_up_stiffens_and_stands_resting_crouches_and_lets_go(robot, motion, begin, read, raised):
    assert motion.robotIsWakeUp() is False is read("robotIsWakeUp") and motion.getStiffnesses("Body") == [0.0] * 26
    raised(*states())
    wake = begin("ALMotion", "wakeUp")
    assert motion.robotIsWakeUp() is True and raised(*states()) == [1, 0, 0, 0]
    robot.advance(2.5)
    assert robot.answer(wake) is None and raised(*states()) == [0, 1, 0, 0]
    assert motion.getStiffnesses("Body") == [1.0] * 26 and read("robotIsWakeUp") is True
    assert robot.now.torso.position[2] == pytest.approx(0.331, abs=0.005)
    robot.finish("ALMotion", "rest", "Head", after=0.5)  # a chain leaves it awake
    assert motion.getStiffnesses("Head") == [0.0, 0.0] and motion.getStiffnesses("LArm") == [1.0] * 6
    assert motion.robotIsWakeUp() is True and raised(*states()) == [0, 0, 0, 0]
    motion.setStiffnesses("Head", 1.0)
    rest = begin("ALMotion", "rest")
    assert raised(*states()) == [0, 0, 1, 0] and motion.robotIsWakeUp() is True
    robot.advance(2.5)
    assert robot.answer(rest) is None and raised(*states()) == [0, 0, 0, 1]
    assert motion.robotIsWakeUp() is False and motion.getStiffnesses("Body") == [0.0] * 26
    assert robot.now.torso.position[2] == pytest.approx(0.228, abs=0.01)


def test_a_fall_is_told_ends_calls_and_leaves_the_robot_limp(stiff_robot, motion, begin, read, raised):
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    stiff_robot.advance(1.0)
    future = begin("ALMotion", "angleInterpolation", "HeadYaw", 1.0, 30.0, True, after=0.1)
    assert read(STANDS) is True and motion.robotIsWakeUp() is True
    raised(FALLING, FALLEN, STANDS)
    stiff_robot.NaoSimulation.push([60.0, 0.0, 0.0], 0.1, "torso")
    stiff_robot.advance(0.5)
    assert raised(FALLING, FALLEN) == [1, 0] and read(FALLING) is True
    stiff_robot.advance(3.5)
    assert raised(FALLING, FALLEN, STANDS) == [0, 1, 1] and read(FALLEN) is True and read(STANDS) is False
    stiff_robot.answer(future)
    assert motion.getTaskList() == [] and motion.getStiffnesses("Body") == [0.0] * 26
    assert motion.robotIsWakeUp() is False is read("robotIsWakeUp")


def test_the_fall_manager_is_switched_off_with_permission_only_and_then_does_nothing(stiff_robot, motion, raised):
    stiff_robot.advance(1.0)
    for what in ("FallManager", "PushRecovery"):
        assert motion.call(f"get{what}Enabled") is True
    with pytest.raises(RuntimeError, match="ENABLE_DEACTIVATION_OF_FALL_MANAGER"):
        motion.setFallManagerEnabled(False)
    assert motion.getFallManagerEnabled() is True
    motion.setMotionConfig(PERMISSION)
    for what in ("FallManager", "PushRecovery"):
        motion.call(f"set{what}Enabled", False)
        assert motion.call(f"get{what}Enabled") is False
    raised(FALLING, FALLEN)
    stiff_robot.NaoSimulation.push([60.0, 0.0, 0.0], 0.1, "torso")
    stiff_robot.advance(3.0)
    assert raised(FALLING, FALLEN) == [0, 0] and stiff_robot.now.torso.position[2] < 0.15
    assert motion.getStiffnesses("Body") == [1.0] * 26
    stiff_robot.NaoSimulation.reset()  # switches them on
    assert motion.getFallManagerEnabled() is motion.getPushRecoveryEnabled() is True


def test_smart_stiffness_saves_effort_and_can_be_switched_off(stiff_robot, motion):
    def least():
        return min(stiff_robot.server.simulation.robot.joints.efforts)

    assert motion.getSmartStiffnessEnabled()
    stiff_robot.advance(2.0)
    assert least() < 0.5 and motion.getStiffnesses("Body") == [1.0] * 26
    motion.setSmartStiffnessEnabled(False)
    stiff_robot.advance(0.1)
    assert not motion.getSmartStiffnessEnabled() and least() == 1.0


def test_a_hot_knee_puts_the_robot_to_rest_and_keeps_it_there(stiff_robot, motion, read):
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    stiff_robot.NaoSimulation.setTemperature("LKneePitch", 79.0)
    stiff_robot.advance(3.0)
    assert read("LKneePitch/Temperature/Sensor/Status") >= 2
    assert motion.getStiffnesses("Body") == [0.0] * 26 and not motion.robotIsWakeUp()
    assert read("ALMotion/Protection/DisabledDevicesChanged") == [["Body", True]]
    assert read("ALMotion/Protection/DisabledFeaturesChanged") == [["LegsStiffness", True], ["Move", True]]
    with pytest.raises(RuntimeError, match="too hot"):
        motion.wakeUp()
    stiff_robot.NaoSimulation.setTemperature("LKneePitch", 40.0)
    stiff_robot.advance(0.2)
    assert read("ALMotion/Protection/DisabledDevicesChanged") == [["Body", False]]
    stiff_robot.finish("ALMotion", "wakeUp", after=2.5)
    assert motion.robotIsWakeUp()


def test_other_switches(stiff_robot, motion, refuses):
    assert motion.getDiagnosisEffectEnabled() and motion.areNotificationsEnabled()
    motion.setDiagnosisEffectEnabled(False)
    motion.setEnableNotifications(False)
    stiff_robot.NaoSimulation.setTemperature("HeadYaw", 79.0)
    stiff_robot.advance(2.0)
    assert motion.getStiffnesses("Head") == [1.0, 1.0]  # nobody rests
    assert not motion.getDiagnosisEffectEnabled() and not motion.areNotificationsEnabled()
    refuses("ALMotion", """
        setMotionConfig([['ENABLE_STIFNESS_PROTECTION', True]]) -> did you mean 'ENABLE_STIFFNESS_PROTECTION'
    """)  # fmt: skip
    motion.setMotionConfig([["ENABLE_FALL_MANAGER_PROTECTION", False], ["ENABLE_STIFFNESS_PROTECTION", False]])
    switches = stiff_robot.server.simulation.robot.reflexes.switches
    assert not motion.getFallManagerEnabled() and not switches["ENABLE_STIFFNESS_PROTECTION"]
    assert switches["ENABLE_FOOT_CONTACT_PROTECTION"]

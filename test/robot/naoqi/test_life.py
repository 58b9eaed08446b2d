"""ALAutonomousLife, ALAutonomousMoves, ALBasicAwareness. Stimuli are raised as the extractors raise them."""

import math

import pytest
from simulator import PATIENCE

HELLO, BREATHE = "nao_library/hello", "nao_library/breathe"
WAKES_UP = 2.4
ABILITIES = ["AutonomousBlinking", "BackgroundMovement", "BasicAwareness", "ListeningMovement", "SpeakingMovement"]


@pytest.fixture
def life(robot):
    """Life of a limp robot that stands, without eyes and ears, which cost time."""
    robot.ALAutonomousLife.setAutonomousAbilityEnabled("BasicAwareness", False)
    return robot.ALAutonomousLife


@pytest.fixture
def alive(life, robot):
    """The same, awake and solitary."""
    robot.finish("ALAutonomousLife", "setState", "solitary", after=WAKES_UP)
    return life


def states(robot, life, seconds):
    """States that it goes through in the next seconds."""
    seen = [life.getState()]
    for _ in range(round(seconds / 0.25)):
        robot.advance(0.25)
        if life.getState() != seen[-1]:
            seen.append(life.getState())
    return seen


def test_it_begins_disabled_wakes_up_first_and_breathes_until_it_ends(life, robot, begin):
    assert life.getState() == "disabled" == robot.value("AutonomousLife/State")
    assert [(name, running) for name, _, running in life.getAutonomousAbilitiesStatus()] == [
        (name, False) for name in ABILITIES
    ]
    told = robot.heard("AutonomousLife/State")
    future = begin("ALAutonomousLife", "setState", "solitary")
    assert life.getState() == "disabled"
    robot.advance(WAKES_UP)
    robot.answer(future)
    assert life.getState() == "solitary" == told.get(timeout=PATIENCE)
    assert robot.ALMotion.robotIsWakeUp() and robot.ALMotion.getBreathEnabled("Body")
    life.switchFocus(BREATHE)
    life.setState("disabled")
    assert not robot.ALMotion.getBreathEnabled("Body") and robot.ALBehaviorManager.getRunningBehaviors() == []
    assert [state for state, _ in life.getStateHistory(2)] == ["disabled", "solitary"]


def test_an_activity_gets_the_focus_and_gives_it_back(alive, robot):
    focused, completed = (robot.heard(f"AutonomousLife/{what}Activity") for what in ("Focused", "Completed"))
    alive.switchFocus(HELLO)
    assert alive.focusedActivity() == HELLO and alive.getState() == "interactive"
    assert alive.getFocusContext("Launchpad/State") == "solitary"
    robot.advance(3.0)
    assert alive.focusedActivity() == "" and alive.getState() == "solitary"
    assert [focused.get(timeout=PATIENCE) for _ in range(2)] == [HELLO, ""]
    assert completed.get(timeout=PATIENCE) == HELLO
    statistics = alive.getActivityStatistics()[HELLO]
    assert statistics["focusCount"] == statistics["completionCount"] == 1
    assert 2 <= statistics["prevFocusDuration"] <= 4 and alive.getFocusHistory(1)[0][0] == HELLO


def test_an_activity_that_is_stacked_goes_on_afterwards_and_one_that_is_not_does_not(alive, robot):
    alive.switchFocus(BREATHE)
    alive.switchFocus(HELLO, 1)
    assert robot.ALBehaviorManager.getRunningBehaviors() == [HELLO]
    robot.advance(2.8)
    assert alive.focusedActivity() == BREATHE
    alive.switchFocus(HELLO)
    robot.advance(2.8)
    assert alive.focusedActivity() == "" == "".join(robot.ALBehaviorManager.getRunningBehaviors())
    alive.switchFocus(BREATHE)
    alive.stopAll()
    assert alive.focusedActivity() == "" and robot.ALBehaviorManager.getRunningBehaviors() == []


def test_the_eyes_blink_now_and_then_and_only_the_eyes(alive, robot):
    layout, bank = robot.server.simulation.led_layout, robot.server.simulation.robot.leds
    eyes, before, seen = layout.devices_of("FaceLeds"), bank.values, []
    robot.server.simulation.after_tick.append(lambda _: seen.append(bank.values))
    robot.advance(7.0)
    closed = [a[eyes[0]] >= 0.1 > b[eyes[0]] for a, b in zip(seen, seen[1:])]
    assert 1 <= sum(closed) <= 4
    assert all(values[i] == before[i] for values in seen[::20] for i in range(len(before)) if i not in eyes)


def test_it_falls_gets_up_and_lives_on_unless_that_safeguard_is_off(alive, robot):
    robot.server.push([60.0, 0.0, 0.0], 0.2, "torso")
    robot.advance_until(lambda: alive.getState() == "safeguard", 3.0, 0.25)
    robot.advance_until(lambda: alive.getState() == "solitary", 14.0, 0.5)
    assert robot.ALRobotPosture.getPostureFamily() == "Standing"
    for safeguard in ("RobotFell", "RobotPushed"):
        alive.setSafeguardEnabled(safeguard, False)
    robot.server.push([60.0, 0.0, 0.0], 0.2, "torso")
    assert states(robot, alive, 3.0) == ["solitary"]


def test_two_clicks_on_the_chest_button_begin_and_end_life(life, robot):
    for wanted in ("solitary", "disabled"):
        for sensors in (["ChestBoard/Button"], [], ["ChestBoard/Button"], []):
            robot.NaoSimulation.press(sensors)
            robot.advance(0.1)
        assert states(robot, life, WAKES_UP + 1.0)[-1] == wanted
    assert not robot.ALMotion.robotIsWakeUp()


def test_what_is_wrong_is_told_and_only_activities_get_the_focus(life, robot, refuses):
    refuses("ALAutonomousLife", f"""
        setState('asleep') -> disabled, solitary, interactive, safeguard
        switchFocus('{HELLO}') -> the state is disabled
        switchFocus('{HELLO}', 7) -> 0 to 1
        getFocusContext('Weather') -> unknown condition
    """)  # fmt: skip
    robot.finish("ALAutonomousLife", "setState", "solitary", after=WAKES_UP)
    with pytest.raises(RuntimeError, match="activities are solitary or interactive"):
        life.switchFocus("animations/Stand/Gestures/Hey_1")
    assert life.getActivityContextPermissionViolations("Hey_1") == "nature: no nature"
    assert life.getActivityContextPermissionViolations(HELLO) == ""


def test_somebody_who_speaks_gets_a_nod(alive, robot):
    def nod():
        """How far the head goes down when somebody speaks, rad."""
        begin = robot.ALMotion.getAngles("HeadPitch", False)[0]
        robot.ALMemory.raiseEvent("SpeechDetected", True)
        robot.settled()
        pitches = []
        for _ in range(12):
            robot.advance(0.1)
            pitches.append(robot.ALMotion.getAngles("HeadPitch", False)[0])
        return max(pitches) - begin

    alive.setAutonomousAbilityEnabled("BackgroundMovement", False)
    robot.advance(1.0)
    assert nod() == pytest.approx(0.1, abs=0.02)
    robot.ALAutonomousMoves.setExpressiveListeningEnabled(False)
    robot.advance(3.0)
    assert nod() == pytest.approx(0.0, abs=0.005)


CAMERA = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]
FACE, SOUND = "FaceDetected", "ALSoundLocalization/SoundLocated"
MOVEMENT = "MovementDetection/MovementDetected"


def face(number, alpha):
    """`FaceDetected` with one face, 0.15 rad wide, `alpha` rad to the left of the robot."""
    info = [[0, alpha, 0.0, 0.15, 0.15], [number, 0.0, "", [], [], [], [], [], []]]
    return [[1, 0], [info, []], CAMERA, CAMERA, 0]


def sound(azimuth, confidence=0.9):
    return [[1, 0], [azimuth, 0.0, confidence, 0.0], CAMERA, CAMERA]


@pytest.fixture
def aware(stiff_robot):
    """Awareness of a robot on stiff legs; its extractors find nothing by themselves in an empty world."""
    awareness = stiff_robot.ALBasicAwareness
    awareness.setStimulusDetectionEnabled("Movement", False)  # a camera more takes its time
    awareness.setEnabled(True)
    stiff_robot.settled()
    return awareness


@pytest.fixture
def tell(robot):
    """Raises a stimulus and lets time pass; HeadYaw and HeadPitch afterwards, rad."""

    def tell(event, value, seconds):
        robot.ALMemory.raiseEvent(event, value)
        robot.settled()
        robot.advance(seconds)
        return robot.ALMotion.getAngles("Head", True)

    return tell


def test_it_listens_to_eyes_and_ears_while_it_is_on(aware, robot):
    def listens(module):
        robot.advance(0.1)
        return [name for name, *_ in getattr(robot, module).getSubscribersInfo()]

    aware.setStimulusDetectionEnabled("Movement", True)
    modules = ("ALFaceDetection", "ALSoundLocalization", "ALMovementDetection")
    assert [listens(module) for module in modules] == [["ALBasicAwareness"]] * 3
    aware.setStimulusDetectionEnabled("Sound", False)
    assert listens("ALSoundLocalization") == []
    aware.pauseAwareness()
    assert not aware.isAwarenessRunning() and listens("ALFaceDetection") == []
    aware.resumeAwareness()
    assert listens("ALFaceDetection") == ["ALBasicAwareness"]


def test_a_face_is_told_and_followed_until_it_is_lost(aware, robot, tell):
    stimuli, tracked = (robot.heard(f"ALBasicAwareness/{what}") for what in ("StimulusDetected", "HumanTracked"))
    for alpha in (0.4, -0.3):
        assert tell(FACE, face(3, alpha), 1.0)[0] == pytest.approx(alpha, abs=0.05)
    assert (aware.engagePerson(3), aware.engagePerson(4)) == (True, False)
    robot.advance(2.5)
    assert stimuli.get(timeout=PATIENCE) == "People"
    assert [tracked.get(timeout=PATIENCE) for _ in range(2)] == [3, -1]


@pytest.mark.parametrize(
    "mode, stimulus, turns",
    [
        ("FullyEngaged", SOUND, False),
        ("SemiEngaged", SOUND, True),
        ("SemiEngaged", MOVEMENT, False),
        ("Unengaged", MOVEMENT, True),
    ],
)
def test_who_is_engaged_is_not_distracted(aware, robot, tell, mode, stimulus, turns):
    aware.setStimulusDetectionEnabled("Movement", stimulus == MOVEMENT)
    aware.setEngagementMode(mode)
    aware.setParameter("MinTimeTracking", 0.5)
    tell(FACE, face(5, 0.0), 0.8)
    robot.ALMemory.insertData("MovementDetection/MovementInfo", [[1, 0], [[[0.7, 0.0]]], CAMERA, CAMERA, 0])
    assert (tell(stimulus, sound(0.7), 0.6)[0] > 0.4) is turns


def test_a_place_may_be_a_stimulus_the_body_turns_and_the_tracker_has_the_head_for_itself(aware, robot, tell):
    first = aware.triggerStimulus([1.0, 0.5, 0.5])
    robot.advance(1.0)
    assert robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(math.atan2(0.5, 1.0), abs=0.05)
    assert aware.triggerStimulus([1.0, 0.0, 0.5]) == first + 1
    robot.advance(1.0)
    robot.ALTracker.registerTarget("Sound", [1.0, 0.5])
    robot.ALTracker.trackEvent("Test/Place")
    before = robot.ALMotion.getAngles("HeadYaw", True)[0]
    assert tell(FACE, face(7, 0.5), 0.8)[0] == pytest.approx(before, abs=0.03)
    robot.ALTracker.stopTracker()
    aware.setTrackingMode("BodyRotation")
    tell(FACE, face(6, 0.9), 0.5)
    assert robot.ALMotion.moveIsActive()
    robot.advance(2.5)
    assert robot.ALMotion.getRobotPosition(False)[2] > 0.3


def test_parameters_are_kept_and_reset_and_what_is_wrong_is_told(aware, refuses):
    aware.setParameter("LookStimulusSpeed", 0.25)
    assert aware.getParameter("LookStimulusSpeed") == 0.25
    with pytest.raises(RuntimeError, match="setStimulusDetectionEnabled TabletTouch: a NAO has no tablet"):
        aware.setStimulusDetectionEnabled("TabletTouch", True)
    aware.resetAllParameters()
    assert aware.getParameter("LookStimulusSpeed") == 0.5
    assert [aware.isStimulusDetectionEnabled(stimulus) for stimulus in ("TabletTouch", "Touch")] == [False, True]
    aware.setEnabled(False)
    refuses("ALBasicAwareness", """
        setEngagementMode('Married') -> Unengaged, SemiEngaged, FullyEngaged
        setParameter('LookStimulusSpeed', 3.0) -> 0.01 to 1
        triggerStimulus([1.0]) -> FRAME_WORLD
    """)  # fmt: skip

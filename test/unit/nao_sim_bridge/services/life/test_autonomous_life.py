"""ALAutonomousLife over the network: states, activities, abilities, safeguards."""

from __future__ import annotations

import pytest

HELLO, BREATHE = "nao_library/hello", "nao_library/breathe"
WAKES_UP = 2.4
ABILITIES = ["AutonomousBlinking", "BackgroundMovement", "BasicAwareness", "ListeningMovement", "SpeakingMovement"]


@pytest.fixture
def life(robot):
    """Life of a limp robot that stands, without eyes and ears, which cost time."""
    robot.ALAutonomousLife.setAutonomousAbilityEnabled("BasicAwareness", False)
    yield robot.ALAutonomousLife
    robot.ALAutonomousLife.setState("disabled")
    robot.ALAutonomousLife.setAutonomousAbilityEnabled("All", True)
    robot.settled()


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


def test_it_begins_disabled_and_nothing_moves(life, robot):
    assert life.getState() == "disabled" == robot.ALMemory.getData("AutonomousLife/State")
    assert [name for name, _, running in life.getAutonomousAbilitiesStatus() if running] == []
    assert [name for name, _, _ in life.getAutonomousAbilitiesStatus()] == ABILITIES


def test_who_comes_to_life_wakes_up_first_and_breathes(life, robot, heard):
    told = heard("AutonomousLife/State")
    future = robot.post("ALAutonomousLife", "setState", "solitary")
    robot.handed_over("ALAutonomousLife")
    assert life.getState() == "disabled"
    robot.advance(WAKES_UP)
    robot.answer(future)
    assert life.getState() == "solitary" == told.get(timeout=robot.patience)
    assert robot.ALMotion.robotIsWakeUp()
    assert robot.ALMotion.getBreathEnabled("Body")
    life.setState("disabled")
    assert not robot.ALMotion.getBreathEnabled("Body")
    assert [state for state, _ in life.getStateHistory(2)] == ["disabled", "solitary"]


def test_an_activity_gets_the_focus_and_gives_it_back(alive, robot, heard):
    focused, completed, following = (
        heard(f"AutonomousLife/{what}") for what in ("FocusedActivity", "CompletedActivity", "NextActivity")
    )
    alive.switchFocus(HELLO)
    assert alive.focusedActivity() == HELLO
    assert alive.getState() == "interactive"
    assert alive.getFocusContext("Launchpad/State") == "solitary"
    robot.advance(3.0)
    assert alive.focusedActivity() == ""
    assert alive.getState() == "solitary"
    assert [focused.get(timeout=robot.patience) for _ in range(2)] == [HELLO, ""]
    assert completed.get(timeout=robot.patience) == following.get(timeout=robot.patience) == HELLO
    statistics = alive.getActivityStatistics()[HELLO]
    assert statistics["focusCount"] == statistics["completionCount"] >= 1
    assert 2 <= statistics["prevFocusDuration"] <= 4
    assert alive.getFocusHistory(1)[0][0] == HELLO


def test_an_activity_that_is_stacked_goes_on_afterwards(alive, robot):
    alive.switchFocus(BREATHE)
    alive.switchFocus(HELLO, 1)
    assert robot.ALBehaviorManager.getRunningBehaviors() == [HELLO]
    robot.advance(2.8)
    assert alive.focusedActivity() == BREATHE
    alive.stopAll()
    assert alive.focusedActivity() == ""
    assert robot.ALBehaviorManager.getRunningBehaviors() == []


def test_one_that_is_not_stacked_does_not(alive, robot):
    alive.switchFocus(BREATHE)
    alive.switchFocus(HELLO)
    robot.advance(2.8)
    assert alive.focusedActivity() == ""


def test_life_that_ends_stops_its_activity(alive, robot):
    alive.switchFocus(BREATHE)
    alive.setState("disabled")
    assert robot.ALBehaviorManager.getRunningBehaviors() == []


def test_the_eyes_blink_now_and_then_and_only_the_eyes(alive, robot):
    layout, bank = robot.server.simulation.led_layout, robot.server.simulation.robot.leds
    eyes = layout.devices_of("FaceLeds")
    before, seen = bank.values, []
    robot.server.simulation.after_tick.append(lambda _: seen.append(bank.values))
    robot.advance(7.0)
    robot.server.simulation.after_tick.pop()
    closed = [a[eyes[0]] >= 0.1 > b[eyes[0]] for a, b in zip(seen, seen[1:])]
    assert 1 <= sum(closed) <= 4
    others = [i for i in range(len(before)) if i not in eyes]
    assert all(values[i] == before[i] for values in seen[::20] for i in others)


def test_abilities_work_while_they_are_enabled(alive):
    alive.setAutonomousAbilityEnabled("AutonomousBlinking", False)
    assert ["AutonomousBlinking", False, False] in [list(entry) for entry in alive.getAutonomousAbilitiesStatus()]
    assert not alive.getAutonomousAbilityEnabled("All")
    alive.setAutonomousAbilityEnabled("AutonomousBlinking", True)
    assert ["AutonomousBlinking", True, True] in [list(entry) for entry in alive.getAutonomousAbilitiesStatus()]


def test_without_that_safeguard_it_stays_on_the_floor(alive, robot):
    for safeguard in ("RobotFell", "RobotPushed"):
        alive.setSafeguardEnabled(safeguard, False)
    robot.server.push([60.0, 0.0, 0.0], 0.2, "torso")
    assert states(robot, alive, 3.0) == ["solitary"]
    for safeguard in ("RobotFell", "RobotPushed"):
        alive.setSafeguardEnabled(safeguard, True)


def test_a_critical_diagnosis_keeps_it_in_safeguard_until_it_is_over(alive, robot):
    robot.ALMemory.raiseEvent("PassiveDiagnosisErrorChanged", [2, ["LArm"]])
    robot.settled()
    assert alive.getState() == "safeguard"
    robot.ALMemory.raiseEvent("PassiveDiagnosisErrorChanged", [0, []])
    assert states(robot, alive, WAKES_UP)[-1] == "solitary"


def test_two_clicks_on_the_chest_button_begin_and_end_life(life, robot):
    for wanted in ("solitary", "disabled"):
        robot.ALMemory.raiseEvent("ALChestButton/DoubleClickOccurred", None)
        robot.settled()
        assert states(robot, life, WAKES_UP)[-1] == wanted
    assert not robot.ALMotion.robotIsWakeUp()


def test_a_reset_ends_life(alive, robot):
    robot.NaoSimulation.reset()
    assert alive.getState() == "disabled"


def test_plugins_of_the_launch_pad_are_switched(alive, robot):
    assert "Posture" in alive.getEnabledLaunchpadPlugins() == alive.getLaunchpadPluginsForGroup("All")
    alive.setLaunchpadPluginEnabled("Posture", False)
    assert "Posture" not in alive.getEnabledLaunchpadPlugins()
    alive.setLaunchpadPluginEnabled("Posture", True)
    robot.advance(1.1)
    assert robot.ALMemory.getData("Launchpad/PostureFamily") == "Standing"


@pytest.mark.parametrize(
    "method, arguments, told",
    [
        ("setState", ["asleep"], "disabled, solitary, interactive, safeguard"),
        ("switchFocus", [HELLO], "the state is disabled"),
        ("switchFocus", ["nothing"], "unknown behavior"),
        ("switchFocus", [HELLO, 7], "0 to 1"),
        ("setAutonomousAbilityEnabled", ["Dreaming", True], "unknown autonomous ability"),
        ("setSafeguardEnabled", ["RobotBored", True], "unknown safeguard"),
        ("setLaunchpadPluginEnabled", ["Weather", True], "unknown launch pad plugin"),
        ("getFocusContext", ["Weather"], "unknown condition"),
    ],
)
def test_what_is_wrong_is_told(life, robot, method, arguments, told):
    with pytest.raises(RuntimeError, match=told):
        life.call(method, *arguments)


def test_only_activities_get_the_focus(alive):
    with pytest.raises(RuntimeError, match="activities are solitary or interactive"):
        alive.switchFocus("animations/Stand/Gestures/Hey_1")
    assert alive.getActivityContextPermissionViolations("Hey_1") == "nature: no nature"
    assert alive.getActivityContextPermissionViolations(HELLO) == ""


# --- ALAutonomousMoves ------------------------------------------------------------------------------------------------


def test_what_nobody_moves_goes_back_to_neutral(stiff_robot):
    moves = stiff_robot.ALAutonomousMoves
    assert moves.getBackgroundStrategy() == "none"
    moves.setBackgroundStrategy("backToNeutral")
    stiff_robot.settled()
    assert stiff_robot.ALMotion.getIdlePostureEnabled("Body")
    moves.setBackgroundStrategy("none")
    stiff_robot.settled()
    assert not stiff_robot.ALMotion.getIdlePostureEnabled("Body")
    with pytest.raises(RuntimeError, match="none or backToNeutral"):
        moves.setBackgroundStrategy("elsewhere")


def test_somebody_who_speaks_gets_a_nod(alive, robot):
    def lowest_head(seconds):
        """How far the head goes down, rad."""
        begin = robot.ALMotion.getAngles("HeadPitch", False)[0]
        pitches = []
        for _ in range(round(seconds / 0.1)):
            robot.advance(0.1)
            pitches.append(robot.ALMotion.getAngles("HeadPitch", False)[0])
        return max(pitches) - begin

    alive.setAutonomousAbilityEnabled("BackgroundMovement", False)
    robot.advance(1.0)
    robot.ALMemory.raiseEvent("SpeechDetected", True)
    robot.settled()
    assert lowest_head(1.2) == pytest.approx(0.1, abs=0.02)
    robot.ALAutonomousMoves.setExpressiveListeningEnabled(False)
    robot.advance(3.0)
    robot.ALMemory.raiseEvent("SpeechDetected", True)
    robot.settled()
    assert lowest_head(1.2) == pytest.approx(0.0, abs=0.005)
    robot.ALAutonomousMoves.setExpressiveListeningEnabled(True)


def test_who_speaks_moves_its_arms(alive, robot):
    alive.setAutonomousAbilityEnabled("BackgroundMovement", False)
    robot.advance(1.0)

    def way(text):
        """How far the arms move while it speaks, rad."""
        before = robot.ALMotion.getAngles("Arms", False)
        future, furthest = robot.post("ALTextToSpeech", "say", text), 0.0
        robot.handed_over("ALTextToSpeech")
        while future.isRunning():
            robot.advance(0.1)
            now = robot.ALMotion.getAngles("Arms", False)
            furthest = max(furthest, *(abs(a - b) for a, b in zip(before, now)))
        return furthest

    assert way("I am explaining something rather long to everybody here.") > 0.2
    robot.advance(2.0)
    alive.setAutonomousAbilityEnabled("SpeakingMovement", False)
    assert way("I am explaining something rather long to everybody here.") < 0.01

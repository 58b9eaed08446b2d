"""ALTracker over the network: a red ball that is really seen, places of events, looking and pointing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import frame_of
from nao_sim_bridge.sim.kinematics import link_transforms, quaternion_matrix, transform

ROBOT = 2
DIAMETER = 0.06
BALL = "{name: ball, ball: 0.03, position: [1.0, 0.0, 0.45], mass: 0.0}"
EVENT = "Test/Place"


@pytest.fixture
def tracker(stiff_robot):
    stiff_robot.ALTracker.initialize()
    yield stiff_robot.ALTracker
    stiff_robot.ALTracker.stopTracker()
    stiff_robot.settled()


def off(robot, place):
    """Angle between the line of sight of the top camera and the way to a place of the world, deg."""
    now, model = robot.now, robot.server.simulation.model
    torso = transform(quaternion_matrix(now.torso.orientation), now.torso.position)
    frame = frame_of(model, "CameraTop")
    camera = torso @ link_transforms(model, now.positions)[frame.link] @ frame.offset
    way = np.linalg.inv(camera) @ np.array((*place, 1.0))
    return math.degrees(math.acos(way[0] / np.linalg.norm(way[:3])))


def tell(robot, place, seconds):
    robot.ALMemory.raiseEvent(EVENT, place)
    robot.settled()
    robot.advance(seconds)


def test_the_head_follows_a_ball_that_moves(tracker, stiff_robot, heard):
    detected, lost, active = (
        heard(f"ALTracker/{what}") for what in ("TargetDetected", "TargetLost", "ActiveTargetChanged")
    )
    simulation = stiff_robot.NaoSimulation
    simulation.placeObject(BALL)
    tracker.registerTarget("RedBall", DIAMETER)
    tracker.track("RedBall")
    stiff_robot.advance(0.6)
    assert tracker.isActive()
    assert not tracker.isTargetLost()
    assert tracker.isNewTargetDetected()
    true = simulation.objects()["ball"][:3]
    assert tracker.getTargetPosition(ROBOT) == pytest.approx(true, abs=0.06)
    assert not tracker.isNewTargetDetected()
    simulation.moveObject("ball", [1.0, 0.35, 0.45], [], 1.0, _async=True)
    worst = 0.0
    for _ in range(12):
        stiff_robot.advance(0.1)
        worst = max(worst, off(stiff_robot, simulation.objects()["ball"][:3]))
    assert worst < 5.0
    simulation.removeObject("ball")
    stiff_robot.advance(2.5)
    assert tracker.isTargetLost()
    assert tracker.getTargetPosition(ROBOT) == []
    assert detected.get(timeout=stiff_robot.patience) == "RedBall"
    assert lost.get(timeout=stiff_robot.patience) == "RedBall"
    tracker.stopTracker()
    stiff_robot.advance(0.1)
    assert [active.get(timeout=stiff_robot.patience) for _ in range(2)] == ["RedBall", ""]
    assert stiff_robot.ALRedBallDetection.getSubscribersInfo() == []


def test_it_follows_the_places_of_an_event(tracker, stiff_robot):
    tracker.trackEvent(EVENT)
    for place in ([1.0, 0.4, 0.4], [[1.0, -0.4, 0.5], ROBOT]):
        tell(stiff_robot, place, 1.0)
        assert off(stiff_robot, place[0] if len(place) == 2 else place) < 2.0
    assert tracker.getActiveTarget() == EVENT
    tell(stiff_robot, "nonsense", 0.1)
    assert not tracker.isTargetLost()


def test_what_is_too_far_does_not_count(tracker, stiff_robot):
    tracker.registerTarget("Sound", [3.0, 0.5])
    tracker.setMaximumDistanceDetection(2.0)
    tracker.track("Sound")
    pose = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]
    value = [[1, 0], [0.5, 0.0, 0.9, 0.0], pose, pose]
    stiff_robot.ALMemory.raiseEvent("ALSoundLocalization/SoundLocated", value)
    stiff_robot.advance(0.3)
    assert tracker.isTargetLost()
    tracker.setMaximumDistanceDetection(4.0)
    stiff_robot.ALMemory.raiseEvent("ALSoundLocalization/SoundLocated", value)
    stiff_robot.advance(1.0)
    assert stiff_robot.ALMotion.getAngles("HeadYaw", True)[0] == pytest.approx(0.5, abs=0.05)


def test_it_walks_to_the_place_beside_the_target(tracker, stiff_robot, heard):
    reached = heard("ALTracker/TargetReached")
    tracker.setMode("Move")
    tracker.setTimeOut(60000)
    tracker.setRelativePosition([-0.5, 0.0, 0.0, 0.06, 0.06, 0.2])
    tracker.trackEvent(EVENT)
    stiff_robot.advance(0.3)
    tell(stiff_robot, [0.6, 0.0, 0.4], 5.5)
    assert reached.get(timeout=stiff_robot.patience) == EVENT
    assert stiff_robot.now.torso.position[0] == pytest.approx(0.1, abs=0.07)
    assert stiff_robot.ALMotion.moveIsActive() is False


def test_it_looks_around_for_what_is_lost(tracker, stiff_robot):
    tracker.setTimeOut(0)
    tracker.toggleSearch(True)
    tracker.setSearchFractionMaxSpeed(1.0)
    tracker.trackEvent(EVENT)
    assert tracker.isSearchEnabled()
    yaws = []
    for _ in range(20):
        stiff_robot.advance(0.1)
        yaws += stiff_robot.ALMotion.getAngles("HeadYaw", True)
    assert max(yaws) > 0.6


def test_looking_and_pointing_end_when_the_robot_does(tracker, stiff_robot):
    place = [1.0, -0.5, 0.4]
    stiff_robot.finish("ALTracker", "lookAt", place, ROBOT, 0.5, False, after=1.5)
    assert off(stiff_robot, place) < 2.0
    stiff_robot.finish("ALTracker", "pointAt", "Arms", place, ROBOT, 0.3, after=2.0)
    pitch, roll = stiff_robot.ALMotion.getAngles(["RShoulderPitch", "RShoulderRoll"], True)
    assert pitch == pytest.approx(0.05, abs=0.15)
    assert roll < -0.2


def test_registered_targets(tracker):
    tracker.registerTarget("RedBall", 0.06)
    tracker.registerTarget("LandMark", [0.1, [64]])
    assert tracker.getRegisteredTargets() == ["RedBall", "LandMark"] == tracker.getManagedTargets()
    tracker.track("RedBall")
    with pytest.raises(RuntimeError, match="is being tracked"):
        tracker.unregisterTarget("RedBall")
    tracker.unregisterAllTargets()
    assert tracker.getRegisteredTargets() == ["RedBall"]
    tracker.stopTracker()
    tracker.unregisterTargets(["RedBall"])
    assert tracker.getRegisteredTargets() == []


SETTINGS = [
    ("Mode", "WholeBody"),
    ("Effector", "LArm"),
    ("TimeOut", 500),
    ("MaximumDistanceDetection", 1.5),
    ("MaximumVelocity", 1.0),
    ("MaximumAcceleration", 2.0),
    ("SearchFractionMaxSpeed", 0.5),
    ("RelativePosition", [-0.5, 0.0, 0.5, 0.25, 0.25, 0.5]),
]


@pytest.mark.parametrize("name, value", SETTINGS)
def test_settings_are_kept_and_initialised(tracker, name, value):
    before = tracker.call(f"get{name}")
    tracker.call(f"set{name}", value)
    assert tracker.call(f"get{name}") == pytest.approx(value) != before
    tracker.initialize()
    assert tracker.call(f"get{name}") == before


@pytest.mark.parametrize(
    "method, arguments, told",
    [
        ("track", ["RedBall"], "is not registered"),
        ("track", ["Unicorn"], "unknown target"),
        ("addTarget", ["Unicorn", 0.1], "unknown target"),
        ("registerTarget", ["RedBall", -1.0], "diameter"),
        ("setMode", ["Navigate"], "one of Head, WholeBody, Move"),
        ("setEffector", ["Legs"], "one of None, LArm"),
        ("setRelativePosition", [[1.0]], "tolerance"),
        ("lookAt", [[1.0, 0.0], 2, 0.5, False], r"\[x, y, z\]"),
        ("lookAt", [[1.0, 0.0, 0.0], 7, 0.5, False], "FRAME_TORSO"),
        ("pointAt", ["None", [1.0, 0.0, 0.0], 2, 0.5], "one of LArm, RArm, Arms"),
        ("setExtractorPeriod", ["RedBall", 0], "1 to"),
        ("setMoveConfig", [[["MaxStepX", 9.0]]], "MaxStepX"),
        ("setTargetCoordinates", [[["64", 1.0]]], "pCoord"),
        ("trackEvent", [""], "name of an event"),
    ],
)
def test_what_is_wrong_is_told(tracker, method, arguments, told):
    with pytest.raises(RuntimeError, match=told):
        tracker.call(method, *arguments)


def test_a_limp_robot_cannot_look(robot):
    with pytest.raises(RuntimeError, match="HeadYaw, HeadPitch is limp"):
        robot.ALTracker.lookAt([1.0, 0.0, 0.4], ROBOT, 0.5, False)

"""ALTracker over the network: a red ball that is really seen, places of events, looking and pointing."""

import math

import numpy as np
import pytest

from nao_sim_bridge.model.frames import frame_of
from nao_sim_bridge.model.kinematics import link_transforms, quaternion_matrix, transform
from nao_sim_bridge.naoqi.tracker.looking import robot_position
from nao_sim_bridge.naoqi.tracker.targets import TARGETS, Parameters

WORLD, ROBOT = 1, 2
EVENT = "Test/Place"
CAMERA = [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]
METRE = 2.0 * math.atan(0.05)
"""Angle under which 0.1 m are seen a metre away, rad."""


def read(target, value, *parameters):
    return TARGETS[target].read(value, Parameters(*parameters))


def test_balls_faces_and_marks_are_as_far_as_their_size_says_the_nearest_first():
    (ball,) = read("RedBall", [[1, 0], [0.0, 0.0, METRE / 2.0, METRE / 2.0], CAMERA, CAMERA, 0], 0.1)
    assert ball.place == pytest.approx((1.0, 0.0, 0.5), abs=1e-6)
    faces = [[[0, 0.0, 0.0, w, w], [n, 0.0, "", [], [], [], [], [], []]] for n, w in ((1, 0.1), (2, 0.2))]
    value = [[1, 0], [*faces, []], CAMERA, CAMERA, 0]
    assert [f.number for f in read("Face", value, 0.15)] == [2, 1]
    assert [f.number for f in read("People", value, 0.15, (1,))] == [1]
    marks = [[[1, 0.0, 0.0, width, METRE, 0.0], [64]] for width in (METRE, METRE / 2.0)]
    value = [[1, 0], marks, CAMERA, CAMERA, "CameraTop"]
    front, side = read("LandMark", value, 0.1)
    assert front.distance == side.distance == pytest.approx(1.0), "from the side it is as far as from the front"
    assert read("LandMarks", value, 0.1, (80,)) == []
    assert [read(target, [], 0.1) for target in TARGETS] == [[]] * 6


def test_two_known_marks_tell_where_the_robot_is():
    # It is at (1, 2) and looks to the left.
    seen, known = [(1.0, 0.5, 0.4), (2.0, -0.5, 0.3)], [(0.5, 3.0, 0.4), (1.5, 4.0, 0.3)]
    assert robot_position(seen, known) == pytest.approx([1.0, 2.0, math.pi / 2.0])
    assert robot_position(seen[:1], known[:1]) == []


@pytest.fixture
def tracker(stiff_robot):
    return stiff_robot.ALTracker


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


def test_the_head_follows_a_ball_that_moves_and_tells_when_it_is_lost(tracker, stiff_robot):
    events = ("TargetDetected", "TargetLost", "ActiveTargetChanged")
    detected, lost, active = (stiff_robot.heard(f"ALTracker/{event}") for event in events)
    simulation = stiff_robot.NaoSimulation
    simulation.placeObject("{name: ball, ball: 0.03, position: [1.0, 0.0, 0.45], mass: 0.0}")
    tracker.registerTarget("RedBall", 0.06)
    tracker.track("RedBall")
    stiff_robot.advance(0.6)
    assert tracker.isActive() and not tracker.isTargetLost() and tracker.isNewTargetDetected()
    true = simulation.objects()["ball"][:3]
    assert tracker.getTargetPosition(ROBOT) == pytest.approx(true, abs=0.03)
    assert not tracker.isNewTargetDetected()
    simulation.moveObject("ball", [1.0, 0.35, 0.45], [], 1.0, _async=True)
    worst = 0.0
    for _ in range(12):
        stiff_robot.advance(0.1)
        worst = max(worst, off(stiff_robot, simulation.objects()["ball"][:3]))
    assert worst < 5.0
    simulation.removeObject("ball")
    stiff_robot.advance(2.1)
    assert tracker.isTargetLost() and tracker.getTargetPosition(ROBOT) == []
    assert detected.get(timeout=stiff_robot.patience) == "RedBall" == lost.get(timeout=stiff_robot.patience)
    tracker.stopTracker()
    stiff_robot.advance(0.1)
    assert [active.get(timeout=stiff_robot.patience) for _ in range(2)] == ["RedBall", ""]
    assert stiff_robot.ALRedBallDetection.getSubscribersInfo() == []


def test_it_follows_the_places_of_an_event(tracker, stiff_robot):
    tracker.trackEvent(EVENT)
    left, right = [1.0, 0.4, 0.4], [1.0, -0.4, 0.5]
    turned, stamp = [0.0] * 3, [12, 500000]
    for value, place in (
        (left, left),
        ([right, ROBOT], right),
        ([[*left, *turned], stamp, 1], left),  # it stands where the world begins
        ([[9.0, 9.0, 9.0, *turned], [*right, *turned], stamp, 1, 0.05], right),
    ):
        tell(stiff_robot, value, 0.7)
        assert off(stiff_robot, place) < 2.5, value
    assert tracker.getActiveTarget() == EVENT


def test_it_walks_to_the_place_beside_the_target(tracker, stiff_robot):
    reached = stiff_robot.heard("ALTracker/TargetReached")
    tracker.setMode("Move")
    tracker.setTimeOut(60000)
    tracker.setRelativePosition([-0.5, 0.0, 0.0, 0.06, 0.06, 0.2])
    tracker.trackEvent(EVENT)
    stiff_robot.advance(0.3)
    tell(stiff_robot, [0.6, 0.0, 0.4], 5.5)
    assert reached.get(timeout=stiff_robot.patience) == EVENT
    assert stiff_robot.now.torso.position[0] == pytest.approx(0.1, abs=0.06)
    assert stiff_robot.ALMotion.moveIsActive() is False
    tracker.setMode("Head")
    tell(stiff_robot, [[0.6, 0.3, 0.45], WORLD], 0.7)
    assert off(stiff_robot, [0.6, 0.3, 0.45]) < 2.0, "the world stays where it is"


def test_looking_and_pointing_end_when_the_robot_does(tracker, stiff_robot):
    place = [1.0, -0.5, 0.4]
    stiff_robot.finish("ALTracker", "lookAt", place, ROBOT, 0.5, False, after=1.0)
    assert off(stiff_robot, place) < 2.0
    stiff_robot.finish("ALTracker", "pointAt", "Arms", place, ROBOT, 0.3, after=2.0)
    arm = stiff_robot.ALMotion.getAngles(["RShoulderPitch", "RShoulderRoll"], True)
    assert arm == pytest.approx([0.08, -0.35], abs=0.12)
    stiff_robot.ALMotion.setStiffnesses("Body", 0.0)
    with pytest.raises(RuntimeError, match="HeadYaw, HeadPitch is limp"):
        stiff_robot.ALTracker.lookAt([1.0, 0.0, 0.4], ROBOT, 0.5, False)


def test_targets_are_registered_tracked_and_unregistered(tracker):
    tracker.registerTarget("RedBall", 0.06)
    tracker.registerTarget("LandMark", [0.1, [64]])
    assert tracker.getRegisteredTargets() == ["RedBall", "LandMark"] == tracker.getManagedTargets()
    tracker.track("RedBall")
    with pytest.raises(RuntimeError, match="is being tracked"):
        tracker.unregisterTarget("RedBall")
    tracker.unregisterAllTargets()
    assert tracker.getRegisteredTargets() == ["RedBall"]
    tracker.setTargetCoordinates([[64, [1.0, 2.0, 0.5]]])
    assert tracker.getTargetCoordinates() == [[64, [1.0, 2.0, 0.5]]] and tracker.getRobotPosition() == []


SETTINGS = {"Mode": "WholeBody", "Effector": "LArm", "TimeOut": 500, "MaximumDistanceDetection": 1.5}
SETTINGS.update(MaximumVelocity=1.0, MaximumAcceleration=2.0, SearchFractionMaxSpeed=0.5)
SETTINGS.update(RelativePosition=[-0.5, 0.0, 0.5, 0.25, 0.25, 0.5])


def test_settings_are_kept_and_initialised(tracker):
    before = {name: tracker.call(f"get{name}") for name in SETTINGS}
    for name, value in SETTINGS.items():
        tracker.call(f"set{name}", value)
    tracker.setExtractorPeriod("Face", 77)
    for name, value in SETTINGS.items():
        assert tracker.call(f"get{name}") == pytest.approx(value) != before[name]
    assert tracker.getExtractorPeriod("Face") == 77
    tracker.initialize()
    assert {name: tracker.call(f"get{name}") for name in SETTINGS} == before
    assert tracker.getExtractorPeriod("Face") == 100


def test_what_is_wrong_is_told(tracker):
    for method, arguments, told in [
        ("track", ["RedBall"], "is not registered"),
        ("addTarget", ["Unicorn", 0.1], "unknown target"),
        ("registerTarget", ["RedBall", -1.0], "diameter"),
        ("setMode", ["Navigate"], "one of Head, WholeBody, Move"),
        ("lookAt", [[1.0, 0.0], 2, 0.5, False], r"\[x, y, z\]"),
        ("pointAt", ["None", [1.0, 0.0, 0.0], 2, 0.5], "one of LArm, RArm, Arms"),
        ("setExtractorPeriod", ["RedBall", 0], "1 to"),
    ]:
        with pytest.raises(RuntimeError, match=f"ALTracker::{method}.*{told}"):
            tracker.call(method, *arguments)
    assert not tracker.isActive()

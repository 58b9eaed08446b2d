"""The process modules of a NAO on a stand-in: what is sent, what is checked, what fails how."""

from __future__ import annotations

import math
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.clock import WallClock
from nao_library_modules.places import Place
from nao_library_modules.process_modules import action_rules  # noqa: F401
from nao_library_modules.process_modules.action_client import ActionEnd
from nao_library_modules.process_modules.chains import Chain
from nao_library_modules.process_modules.control import do, par, top_level
from nao_library_modules.process_modules.designators.designator import a, action, an, designator, location, motion
from nao_library_modules.process_modules.designators.objects import BELIEFS
from nao_library_modules.process_modules.failures import (
    DesignatorError,
    GripperClosedCompletely,
    GripperGoalNotReached,
    LightsLowLevelFailure,
    ManipulationGoalNotReached,
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    NavigationPoseUnreachable,
    PerceptionLowLevelFailure,
    PerceptionObjectNotFound,
    PlanError,
    PtuGoalUnreachable,
    SpeechLowLevelFailure,
)
from nao_library_modules.process_modules.modules.lights import Lights
from nao_library_modules.process_modules.modules.manipulation import Manipulation
from nao_library_modules.process_modules.modules.navigation import Navigation
from nao_library_modules.process_modules.modules.speech import Speech
from nao_library_modules.process_modules.modules.vision import Vision
from nao_library_modules.process_modules.perception import go_to, perceive
from nao_library_modules.process_modules.registry import perform, with_process_modules_running
from nao_library_modules.process_modules.settings import load_settings
from nao_library_modules.process_modules.space import Point3, head_angles
from naoqi.errors import NaoError

from .test_chains import URDF

REST = {
    "HeadYaw": 0.0,
    "HeadPitch": 0.0,
    "LShoulderPitch": 1.4,
    "LShoulderRoll": 0.2,
    "LElbowYaw": -1.0,
    "LElbowRoll": -1.0,
    "LWristYaw": 0.0,
    "RShoulderPitch": 1.4,
    "RShoulderRoll": -0.2,
    "RElbowYaw": 1.0,
    "RElbowRoll": 1.0,
    "RWristYaw": 0.0,
    "LHand": 0.3,
    "RHand": 0.3,
}


class FakeLink:
    """A robot whose joints get where they are sent at once, unless they are stuck, and which walks at once."""

    def __init__(self):
        self.settings = load_settings()
        self.clock = WallClock()
        self.positions = dict(REST)
        self.stuck = {}
        self.here = Place(0.0, 0.0, 0.0)
        self.slip = Place(0.0, 0.0, 0.0)
        self.answers = {}
        self.goals = []
        self.seen = []

    def angles(self):
        return dict(self.positions)

    def learn(self, state):
        """The stand-in knows at once where its joints are."""

    def chain(self, base, tip):
        return Chain(URDF, base, tip)

    def place(self, frame):
        return self.here if frame == "odom" else Place(0.0, 0.0, 0.0)

    def point_in(self, point, frame):
        return point._replace(frame=frame)

    def action(self, name, kind):
        return SimpleNamespace(call=lambda goal, *_: self._call(name, goal))

    def _call(self, name, goal):
        self.goals.append((name, goal))
        if name in self.answers:
            return self.answers[name]
        if name == "joint_trajectory":
            joints, point = goal.trajectory.joint_names, goal.trajectory.points[0]
            self.positions.update(dict(zip(joints, point.positions)), **self.stuck)
            state = SimpleNamespace(name=joints, position=[self.positions[joint] for joint in joints])
            return ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(goal_position=state))
        if name == "walk_target":
            pose = goal.target_pose.pose
            target = Place(pose.position.x, pose.position.y, 2.0 * math.atan2(pose.orientation.z, pose.orientation.w))
            start = self.here if goal.target_pose.header.frame_id == "base_footprint" else Place(0.0, 0.0, 0.0)
            self.here = start.then(target).then(self.slip)
        return ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(objects=self.seen))


@pytest.fixture
def robot():
    return FakeLink()


@pytest.fixture
def run(robot):
    """Performs designators with all modules; what they answer."""

    def act(*designators):
        modules = [kind(robot) for kind in (Manipulation, Navigation, Speech, Lights, Vision)]
        with with_process_modules_running(*modules):
            answers = top_level(lambda: par(*(do(perform, each) for each in designators)))
        return answers if len(designators) > 1 else answers[0]

    return act


def sent(robot, name="joint_trajectory"):
    return [goal for action_name, goal in robot.goals if action_name == name]


# --- hands ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        an(action, type="opening", gripper="left"),
        an(motion, type="opening", gripper="Left"),
        designator("{type: action, name: to open, side: left}"),
        designator({"type": "trajectory", "to": "open", "side": "left"}),
        an(motion, type="moving-gripper-joint", gripper="left", joint_angle=1.0),
    ],
    ids=str,
)
def test_all_forms_of_opening_a_hand(run, robot, given):
    assert run(given) == 1.0
    goal = sent(robot)[0].trajectory
    assert goal.joint_names == ["LHand"] and list(goal.points[0].positions) == [1.0]
    assert goal.points[0].time_from_start.to_sec() == robot.settings.gripper_time


def test_a_hand_that_does_not_open_fails(run, robot):
    robot.stuck = {"RHand": 0.4}
    with pytest.raises(GripperGoalNotReached, match="the right hand is 0.40 open instead of 1.00"):
        run(an(action, type="opening", gripper="right"))


def test_gripping_needs_something_in_the_hand(run, robot):
    with pytest.raises(GripperClosedCompletely, match="the left hand closed, and there is nothing in it"):
        run(an(action, type="gripping", gripper="left"))
    robot.stuck = {"LHand": 0.3}
    assert run(an(action, type="gripping", gripper="left")) == 0.3
    with pytest.raises(GripperGoalNotReached):
        run(an(action, type="closing", gripper="left"))


def test_the_abstract_plan_is_three_goals_at_once(run, robot):
    run(
        an(action, type="opening", gripper="left"),
        an(action, type="opening", gripper="right"),
        an(action, type="looking", target=[2.0, 3.0]),
    )
    moved = sorted(tuple(goal.trajectory.joint_names) for goal in sent(robot))
    assert moved == [("HeadYaw", "HeadPitch"), ("LHand",), ("RHand",)]
    assert robot.positions["HeadYaw"] == pytest.approx(math.atan2(3.0, 2.0))


# --- head -------------------------------------------------------------------------------------------------------------


def test_the_camera_looks_at_the_point():
    """The ray of the camera, by forward kinematics, goes through the point that was asked for."""
    chain = Chain(URDF, "torso", "CameraTop_frame")
    camera = [load_settings().camera[key] for key in ("forward", "up", "neck", "tilt")]
    for point in ((1.0, 0.0, 0.2), (0.5, 0.4, -0.2), (2.0, -1.0, 0.6), (0.3, 0.1, 0.0)):
        frame = chain.tip(head_angles(*point, camera))
        ray = [a - b for a, b in zip(point, frame[:3, 3])]
        length = math.hypot(*ray)
        ahead = sum(a * b for a, b in zip(ray, frame[:3, 0])) / length
        assert math.acos(min(1.0, ahead)) < 1e-3


def test_words_turn_the_head(run, robot):
    assert run(an(action, type="looking", direction="left")) == (1.0, 0.0)
    with pytest.raises(DesignatorError, match="it looks at 'somewhere': not one of forward, left, right"):
        run(an(action, type="looking", target="somewhere"))


def test_the_head_does_not_look_backwards(run, robot):
    with pytest.raises(PtuGoalUnreachable, match="the head cannot turn to yaw 3.14") as caught:
        run(an(action, type="looking", target=[-1.0, 0.0]))
    assert caught.value.nearest[0] == pytest.approx(2.0857, abs=1e-3)
    assert not sent(robot)


# --- arms -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("side, sign", [("left", 1.0), ("right", -1.0)])
def test_a_hand_gets_to_a_point(run, robot, side, sign):
    hand = run(an(action, type="reaching", side=side, target=[0.15, sign * 0.12, 0.1]))
    assert hand.distance_to((0.15, sign * 0.12, 0.1)) < 0.002
    assert all(name[0] == side[0].upper() for name in sent(robot)[0].trajectory.joint_names)


def test_a_point_out_of_reach_tells_the_nearest_one(run, robot):
    with pytest.raises(ManipulationPoseUnreachable, match="the nearest point is") as caught:
        run(an(action, type="reaching", side="left", target=[0.6, 0.12, 0.1]))
    failure = caught.value
    assert failure.distance == pytest.approx(failure.nearest.distance_to((0.6, 0.12, 0.1)), abs=1e-3)
    assert failure.nearest.x > 0.2 and failure.side == "left"
    assert not sent(robot)


def test_an_arm_that_does_not_get_there_fails(run, robot):
    robot.stuck = {"LElbowRoll": -1.5}
    with pytest.raises(ManipulationGoalNotReached, match="the left hand is at"):
        run(an(action, type="reaching", side="left", target=[0.18, 0.12, 0.1]))


def test_words_and_sides_of_arm_targets(run, robot):
    left = run(an(motion, type="moving-tcp", left_target="forward"))
    right = run(an(motion, type="moving-tcp", right_target="forward"))
    assert left.y == pytest.approx(-right.y, abs=2e-3) and left.x == pytest.approx(right.x, abs=2e-3)


def test_pointing_takes_the_nearer_arm(run, robot):
    hand = run(an(action, type="pointing", at=[1.0, -1.0, 0.1]))
    assert hand.y < -0.2 and {joint[0] for joint in sent(robot)[0].trajectory.joint_names} == {"R"}


def test_joints_and_the_stable_pose(run, robot):
    run(an(action, type="moving-joints", angles={"HeadYaw": 0.5}))
    assert robot.positions["HeadYaw"] == 0.5
    run(designator("{name: go stable}"))
    assert len(sent(robot)[-1].trajectory.joint_names) == 26
    with pytest.raises(PlanError, match="no joint Tail"):
        run(an(action, type="moving-joints", angles={"Tail": 0.5}))


def test_a_motion_that_the_robot_refuses_fails_with_its_text(run, robot):
    robot.answers["joint_trajectory"] = ActionEnd(GoalStatus.ABORTED, "the motors are off", None)
    with pytest.raises(GripperGoalNotReached, match="LHand: the motors are off"):
        run(an(action, type="opening", gripper="left"))


# --- walking ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        an(action, type="going", target=[0.5, 0.2, 0.3]),
        an(action, type="going", target=a(location, pose=[0.5, 0.2, 0.3])),
        designator("{type: navigation, goal: {location: {pose: [0.5, 0.2, 0.3]}}}"),
        designator("{name: to walk, target: {x: 0.5, y: 0.2, yaw: 0.3}}"),
    ],
    ids=str,
)
def test_all_forms_of_walking(run, robot, given):
    assert run(given) == pytest.approx((0.5, 0.2, 0.3))
    assert sent(robot, "walk_target")[0].target_pose.header.frame_id == "odom"


def test_a_walk_seen_from_the_robot_is_checked_where_it_began(run, robot):
    robot.here = Place(1.0, 1.0, math.pi / 2.0)
    reached = run(an(action, type="going", target=[0.5, 0.0, 0.0, "base_footprint"]))
    assert reached == pytest.approx((1.0, 1.5, math.pi / 2.0))


def test_a_walk_that_misses_its_target_fails(run, robot):
    robot.slip = Place(-0.2, 0.0, 0.0)
    with pytest.raises(NavigationGoalNotReached, match="it is 0.200 m and 0.00 rad off") as caught:
        run(an(action, type="going", target=[0.5, 0.0]))
    assert caught.value.reached.x == pytest.approx(0.3) and caught.value.wanted == Place(0.5, 0.0, 0.0)


def test_walks_that_end_otherwise_fail_with_the_text(run, robot):
    robot.answers["walk_target"] = ActionEnd(GoalStatus.ABORTED, "stuck for 10 s", None)
    with pytest.raises(NavigationGoalNotReached, match="the robot did not get to .*: stuck for 10 s"):
        run(an(action, type="going", target=[0.5, 0.0]))
    robot.answers["walk_target"] = ActionEnd(GoalStatus.REJECTED, "frame mars is unknown", None)
    with pytest.raises(NavigationPoseUnreachable, match="frame mars is unknown"):
        run(an(action, type="going", target=[0.5, 0.0, 0.0, "mars"]))


def test_the_next_place_is_tried_when_one_cannot_be_reached(robot):
    BELIEFS.clear()
    table = BELIEFS.know("table", position=Point3(1.0, 0.0, 0.15, "odom"), size=(0.4, 0.4, 0.3))
    tries = []
    walk = robot._call

    def twice(name, goal):
        tries.append(goal.target_pose.pose.position.x)
        if len(tries) < 3:
            return ActionEnd(GoalStatus.ABORTED, "blocked", None)
        return walk(name, goal)

    robot._call = twice
    with with_process_modules_running(Navigation(robot)):
        top_level(lambda: go_to(a(location, near=table, distance=0.2)))
    assert len(tries) == 3 and len(set(tries)) >= 2
    BELIEFS.clear()


# --- speech, lights, eyes ---------------------------------------------------------------------------------------------


def test_saying_waits_for_the_end_of_the_text(run, robot):
    run(an(action, type="saying", text="Hello."))
    assert sent(robot, "speech_action")[0].say == "Hello."
    robot.answers["speech_action"] = ActionEnd(GoalStatus.ABORTED, "no voice", None)
    with pytest.raises(SpeechLowLevelFailure, match="'Hello.' was not said: no voice"):
        run(designator("{name: to say, text: Hello.}"))


def test_lights_have_a_colour(run, robot):
    run(an(action, type="lighting", color="green", lights="ChestLeds"))
    function = sent(robot, "NaoLights")[0].functions[0]
    assert (function.function, function.str_param, function.lights) == ("setColor", "green", ["ChestLeds"])
    robot.answers["NaoLights"] = ActionEnd(GoalStatus.ABORTED, "no colour grene", None)
    with pytest.raises(LightsLowLevelFailure, match="setColor: no colour grene"):
        run(an(action, type="lighting", color="grene"))


def seen(kind, x, confidence=0.5, located=True, name=""):
    where = SimpleNamespace(x=x, y=0.0, z=0.05)
    stamp = SimpleNamespace(to_sec=lambda: 12.0)
    return SimpleNamespace(
        kind=kind,
        name=name,
        position=where,
        base_frame="base_footprint",
        located=located,
        confidence=confidence,
        alpha=0.0,
        beta=0.0,
        header=SimpleNamespace(stamp=stamp),
    )


def test_what_is_perceived_is_known_and_newer_than_what_was_asked_for(robot):
    BELIEFS.clear()
    robot.seen = [seen("ball", 1.0, 0.4), seen("ball", 2.0, 0.9), seen("ball", 3.0, 0.95, located=False)]
    ball = a("object", type="ball", colour="red")
    with with_process_modules_running(Vision(robot)):
        found = top_level(lambda: perceive(ball))
        both = top_level(lambda: perceive(ball, "all"))
    assert found.reference().position == Point3(2.0, 0.0, 0.05, "odom") and found.reference().seen == 12.0
    assert found.reference().value("colour") == "red"
    assert len(both) == 2
    assert sent(robot, "NaoVision")[0].functions[0].function == "detectBall"
    BELIEFS.clear()


def test_what_is_not_seen_is_a_failure(robot):
    with with_process_modules_running(Vision(robot)):
        with pytest.raises(PerceptionObjectNotFound, match="no face Anna was seen in 2 s"):
            top_level(lambda: perceive(a("object", type="face", name="Anna")))
        with pytest.raises(PerceptionLowLevelFailure, match="nobody detects 'cup'"):
            top_level(lambda: perceive(a("object", type="cup")))
        with pytest.raises(PlanError, match="is no object with a type"):
            top_level(lambda: perceive(a("object", name="Anna")))


@pytest.mark.parametrize("size, wanted", [(0.05, 0.05), ([0.1, 0.1, 0.1], 0.0)])
def test_a_detector_is_told_one_length_and_no_box(robot, size, wanted):
    robot.seen = [seen("ball", 1.0)]
    with with_process_modules_running(Vision(robot)):
        top_level(lambda: perform(an(action, type="detecting", object=a("object", type="ball", size=size))))
    assert sent(robot, "NaoVision")[0].functions[0].size == wanted


# --- numbers ----------------------------------------------------------------------------------------------------------


def test_numbers_that_are_wrong_are_told(tmp_path):
    file = tmp_path / "numbers.yaml"
    file.write_text("gripper: {open: 1.0}\nhands: 3\n")
    with pytest.raises(NaoError, match="numbers.yaml: unknown hands; missing gripper_tolerance"):
        load_settings(file)
    file.write_text("[1, 2]")
    with pytest.raises(NaoError, match="not keys and values"):
        load_settings(file)

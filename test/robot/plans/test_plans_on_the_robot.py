"""Plans on the robot: process modules, the driver's code for joints, libqi, physics. No ROS between them."""

from __future__ import annotations

import math
from pathlib import Path
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from module_goals import WatchedRobot
from move_base_msgs.msg import MoveBaseFeedback
from plan_clients import PlanClient, client_of
from plan_tools import Beside

import nao_library_modules.process_modules as p
from nao_library_modules.core.geometry import Place
from nao_library_modules.driver.joints.joint_controller import JointController
from nao_library_modules.process_modules import low_level
from nao_library_modules.process_modules import low_level as goals
from nao_library_modules.process_modules.designators.rules import load_settings
from nao_library_modules.process_modules.failures import (
    DesignatorError,
    GripperClosedCompletely,
    GripperGoalNotReached,
    LightsLowLevelFailure,
    ManipulationGoalNotReached,
    ManipulationPoseUnreachable,
    NavigationGoalNotReached,
    NavigationPoseUnreachable,
    PerceptionObjectNotFound,
    PtuGoalNotReached,
    PtuGoalUnreachable,
    SpeechLowLevelFailure,
    TaskEvaporatedFailure,
)
from nao_library_modules.process_modules.plan_action_client import ActionEnd
from nao_library_modules.process_modules.process_module import get_process_module
from nao_library_modules.process_modules.robot_link import Chain

FRAME_TORSO, STANDING = 0, 0.28
URDF = (Path(__file__).parents[3] / "nao_sim_bridge/urdf/nao_h25.urdf").read_text(encoding="utf-8")


class Link:
    """Stands for RobotLink: what the driver's nodes do for it, by their code or by a call of the robot.

    Attributes:
        answers: Name of an action -> how every goal of it ends.
        goals: Name of an action -> goals that were sent.
    """

    def __init__(self, simulator, lights):
        robot = WatchedRobot(*simulator.address, simulator.lockstep)
        self.settings = load_settings()
        self.clock = lights.node.clock
        self.answers, self.goals, self.held = {}, {}, {}
        self._motion = robot.proxy("ALMotion")
        self._joints = JointController(robot)
        self._now = lambda: simulator.lockstep.time()
        self._actions = {
            "joint_trajectory": PlanClient(self._trajectory),
            "walk_target": PlanClient(self._walk),
            "NaoLights": client_of(lights, simulator),
        }

    def angles(self):
        names = self._motion.getBodyNames("Body")
        return dict(zip(names, self._motion.getAngles("Body", True)))

    def learn(self, state):
        """What is asked is always new."""

    def chain(self, base, tip):
        return Chain(URDF, base, tip)

    def place(self, frame):
        return Place(*self._motion.getRobotPosition(True)) if frame == "odom" else Place(0.0, 0.0, 0.0)

    def point_in(self, point, frame):
        return point._replace(frame=frame)

    def action(self, name, kind):
        def call(goal, *arguments):
            self.goals.setdefault(name, []).append(goal)
            if name in self.answers:
                return self.answers[name]
            return self._actions[name].call(goal, *arguments)

        return SimpleNamespace(call=call)

    def topic(self, name, kind):
        return SimpleNamespace(tell=lambda message, limit: self.goals.setdefault(name, []).append(message) or True)

    def _trajectory(self, goal, interrupt, on_feedback):
        frames = self._joints.trajectory(goal.trajectory, relative=False)
        reached = self._joints.follow(frames, interrupt)
        state = SimpleNamespace(name=goal.trajectory.joint_names, position=reached.values)
        return ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(goal_position=state))

    def _walk(self, goal, interrupt, on_feedback):
        position, turn = goal.target_pose.pose.position, goal.target_pose.pose.orientation
        way = Place(position.x, position.y, 2.0 * math.atan2(turn.z, turn.w))
        frame = goal.target_pose.header.frame_id
        call = self._motion.call_async("moveTo", *way.seen_from(self.place(frame)))
        feedback = MoveBaseFeedback()
        feedback.base_position.header.frame_id = "odom"
        feedback.base_position.pose.position.x, feedback.base_position.pose.orientation.w = 0.5, 1.0
        on_feedback(feedback)
        with interrupt.waking(lambda: self._motion.call_async("stopMove")):
            call.result(timeout=60.0)
        if interrupt.is_set():  # the walk has ended before the call that stopped it has
            self._motion.call_async("stopMove").result(timeout=60.0)
        return ActionEnd(GoalStatus.PREEMPTED if interrupt.is_set() else GoalStatus.SUCCEEDED, "", None)


@pytest.fixture
def link(robot, lights):
    robot.ALMotion.setStiffnesses("Body", 1.0)
    return low_level.use_robot(Link(robot, lights))


class OnTheRobot(Beside):
    """A plan that has begun; let time pass with `robot.advance`, or until its end."""

    def __init__(self, robot, body, clock):
        self._robot = robot
        robot.lockstep.goal_begins()
        super().__init__(body, limit=60.0, clock=clock)

    def ended(self):
        self._robot.server.runner.resume()
        try:
            return super().ended()
        finally:
            self._robot.server.runner.pause()
            self._robot.lockstep.goal_is_over()


@pytest.fixture
def begin(robot, link):
    """Begins a plan with all process modules."""
    with p.with_process_modules_running(*low_level.make_process_modules()):
        yield lambda body: OnTheRobot(robot, body, link.clock)


@pytest.fixture
def perform(begin):
    """Performs designators at once; what they answer."""

    def run(*designators):
        answers = begin(lambda: p.par(*(p.do(p.perform, each) for each in designators))).ended()
        return answers if len(designators) > 1 else answers[0]

    return run


def to(**description):
    return p.an(p.action, **description)


@pytest.fixture
def angle(robot):
    return lambda name: robot.ALMotion.getAngles(name, True)[0]


def limp(robot, *joints):
    robot.ALMotion.setStiffnesses(list(joints), 0.0)


def hand_at(robot, side):
    return robot.ALMotion.getPosition(f"{side[0].upper()}Arm", FRAME_TORSO, True)[:3]


def stands(robot):
    return robot.now.torso.position[2] > STANDING and not robot.ALMotion.moveIsActive()


def test_the_abstract_plan_moves_hands_and_head_at_once(perform, robot, link, angle):
    begun = robot.now.time
    openings = [to(type="opening", gripper=side) for side in ("left", "right")]
    *opened, (yaw, _) = perform(*openings, to(type="looking", target=[2.0, 3.0]))
    took = robot.now.time - begun
    assert opened == pytest.approx([1.0, 1.0], abs=0.05) and min(angle("LHand"), angle("RHand")) > 0.9
    assert yaw == pytest.approx(math.atan2(3.0, 2.0), abs=0.03) and yaw == pytest.approx(angle("HeadYaw"), abs=0.01)
    motions = [goal.trajectory for goal in link.goals["joint_trajectory"]]
    assert sorted(each.joint_names for each in motions) == [["HeadYaw", "HeadPitch"], ["LHand"], ["RHand"]]
    times = [each.points[0].time_from_start.to_sec() for each in motions]
    assert times.count(link.settings.gripper_time) == 2 and max(times) <= took < max(times) + 0.2


def test_one_call_starts_the_process_modules(robot, link, angle):
    modules = p.StartProcessModules(link)
    try:
        kinds = {p.ManipulationProcessModule, p.NavigationProcessModule, p.SpeechProcessModule}
        assert kinds < set(map(type, modules)) and p.StartProcessModules is p.start_process_modules
        OnTheRobot(robot, lambda: p.perform(to(type="opening", gripper="left")), link.clock).ended()
        assert angle("LHand") > 0.9
    finally:
        p.stop_process_modules()


def test_goals_have_the_names_of_the_thesis(begin, robot, link, angle):
    def abstract_plan():
        p.par(
            p.do(p.achieve, goals.openGripper, "left"),
            p.do(p.achieve, low_level.open_gripper, "right"),
            p.do(p.achieve, goals.moveHead, p.Position(2, 3)),
        )

    begin(abstract_plan).ended()
    assert min(angle("LHand"), angle("RHand")) > 0.9 and angle("HeadYaw") == pytest.approx(math.atan2(3, 2), abs=0.03)
    sent = len(link.goals["joint_trajectory"])
    begin(lambda: p.achieve(goals.opened_gripper("left"))).ended()  # it is
    assert len(link.goals["joint_trajectory"]) == sent == 3
    assert begin(lambda: p.achieve(goals.closeGripper, "left")).ended() == pytest.approx(0.0, abs=0.05)


def test_each_action_of_the_three_process_modules_has_a_goal(begin, robot, link, angle, on_its_feet):
    def achieve(*goal):
        return begin(lambda: p.achieve(*goal)).ended()

    target = (0.16, 0.13, 0.08)
    achieve(goals.moveArm, target, "left")
    assert math.dist(hand_at(robot, "left"), target) < 0.02
    achieve(goals.goStable)
    assert angle("LShoulderPitch") == pytest.approx(1.4, abs=0.05)
    achieve(goals.walkTo, p.Position(0.2, 0.0))
    assert robot.now.torso.position[0] == pytest.approx(0.2, abs=0.08)
    link.answers["speech_action"] = ActionEnd(GoalStatus.SUCCEEDED, "", None)
    achieve(goals.textToSpeech, "Hello.")
    assert [goal.say for goal in link.goals["speech_action"]] == ["Hello."]


def test_procedures_of_the_thesis_act_when_they_are_called(begin, robot, link, angle):
    begin(lambda: p.openGripper("left")).ended()
    assert angle("LHand") > 0.9
    begin(lambda: p.moveHead(p.Position(2, 3))).ended()
    assert angle("HeadYaw") == pytest.approx(math.atan2(3, 2), abs=0.03)
    begin(lambda: p.moveHead("right")).ended()
    assert angle("HeadYaw") < -0.5


def test_hands_close_around_what_is_there_and_tell_what_did_not_move(perform, robot, link):
    with pytest.raises(GripperClosedCompletely, match="the left hand closed, and there is nothing in it"):
        perform(to(type="gripping", gripper="left"))
    empty = perform(to(type="closing", gripper="left"))
    assert not empty.holds and empty == pytest.approx(0.0, abs=0.05)
    assert perform(to(type="opening", gripper="left")) == pytest.approx(1.0, abs=0.05)
    cup = SimpleNamespace(name=["LHand"], position=[0.4])
    link.answers["joint_trajectory"] = ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(goal_position=cup))
    for kind in ("closing", "gripping"):
        grip = perform(to(type=kind, gripper="left"))
        assert grip.holds and grip == pytest.approx(0.4) and str(grip) == "0.40 open, holds something"
    assert low_level_call(perform, low_level.close_gripper, "left").holds
    del link.answers["joint_trajectory"]
    assert perform(to(type="moving-gripper-joint", gripper="left", joint_angle=0.5)) == pytest.approx(0.5, abs=0.05)
    limp(robot, "LHand", "RHand")
    with pytest.raises(GripperGoalNotReached, match="the left hand is 0.5. open instead of 0.00"):
        perform(to(type="closing", gripper="left"))
    with pytest.raises(GripperGoalNotReached, match=r"the right hand is 0.\d\d open instead of 1.00") as caught:
        perform(to(type="opening", gripper="right"))
    assert (caught.value.side, caught.value.wanted) == ("right", 1.0)


def test_the_head_turns_by_words_but_not_backwards(perform, robot, link, angle):
    yaw, pitch = link.settings.head["left"]
    assert perform(to(type="looking", direction="left")) == pytest.approx((yaw, pitch), abs=0.03)
    before = angle("HeadYaw")
    with pytest.raises(PtuGoalUnreachable, match="the head cannot turn to yaw 3.14") as caught:
        perform(to(type="looking", target=[-1.0, 0.0]))
    assert caught.value.nearest[0] == pytest.approx(2.0857, abs=1e-3)
    assert angle("HeadYaw") == pytest.approx(before, abs=0.02)
    limp(robot, "HeadYaw")
    with pytest.raises(PtuGoalNotReached, match="the head is at yaw .* instead of yaw 0.00"):
        perform(to(type="looking", direction="forward"))
    with pytest.raises(ManipulationGoalNotReached, match="HeadYaw is at .* instead of 0.00 rad: a limp robot moves"):
        perform(to(type="standing"))


@pytest.mark.parametrize("side, sign", [("left", 1.0), ("right", -1.0)])
def test_a_hand_gets_to_a_point_or_to_the_nearest_one(perform, robot, link, side, sign):
    target = (0.16, sign * 0.13, 0.08)
    hand = perform(to(type="reaching", side=side, target=target))
    assert hand.distance_to(target) < 0.02 and math.dist(hand_at(robot, side), target) < 0.02
    assert {name[0] for name in link.goals["joint_trajectory"][0].trajectory.joint_names} == {side[0].upper()}
    far = (0.6, sign * 0.12, 0.1)
    with pytest.raises(ManipulationPoseUnreachable, match=f"the {side} hand cannot .*: the nearest point") as caught:
        perform(to(type="reaching", side=side, target=far))
    failure = caught.value
    assert failure.distance == pytest.approx(failure.nearest.distance_to(far), abs=1e-3)
    assert failure.nearest.x > 0.2 and failure.side == side and len(link.goals["joint_trajectory"]) == 1
    assert low_level_call(perform, low_level.move_arm, failure.nearest, side).distance_to(failure.nearest) < 0.02


def low_level_call(perform, function, *arguments):
    action = p.Designator(p.action, {"type": "calling"}, resolve=lambda _: [lambda: function(*arguments)])
    return perform(action)


def test_arms_go_by_words_and_point_with_the_nearer_one(perform, link):
    forward = {"left_target": "forward"}, {"right_target": "forward"}
    left, right = perform(*(p.an(p.motion, type="moving-tcp", **each) for each in forward))
    assert (left.x, left.y) == pytest.approx((right.x, -right.y), abs=0.01)
    with pytest.raises(DesignatorError, match=r"left hand is to get to Position.*: not .*a point"):  # how high?
        perform(to(type="reaching", side="left", target=p.Position(0.2, 0.1)))
    hand = perform(to(type="pointing", at=[1.0, -1.0, 0.1]))
    assert hand.y < -0.2 and link.goals["joint_trajectory"][-1].trajectory.joint_names[0] == "RShoulderPitch"


@pytest.fixture
def on_its_feet(robot, link):
    robot.advance(0.5)


@pytest.fixture
def walking(begin, robot, on_its_feet):
    """A plan that walks 2 m; it is on its way when the test goes on."""

    def make(*beside):
        plan = begin(lambda: p.par(p.do(p.perform, to(type="going", target=[2.0, 0.0])), *beside))
        robot.advance_until(robot.ALMotion.moveIsActive, 3.0)
        robot.advance(3.0)
        return plan

    return make


def test_the_robot_walks_to_its_target_seen_from_odom_and_from_itself(perform, robot, on_its_feet):
    perform(to(type="standing"))  # everything can begin from there
    reached = perform(to(type="going", target=[0.2, 0.05, 0.3]))
    assert reached.distance_to(Place(0.2, 0.05, 0.3)) < 0.05 and abs(reached.yaw - 0.3) < 0.1
    assert get_process_module("navigation").position.value == (Place(0.5, 0.0, 0.0), "odom")
    robot.advance(0.5)
    assert stands(robot)
    then = perform(to(type="going", target=[0.1, 0.0, 0.0, "base_footprint"]))
    assert then.distance_to(reached.then(Place(0.1, 0.0, 0.0))) < 0.05
    x, y, _ = robot.now.torso.position
    assert math.hypot(x - then.x, y - then.y) < 0.1 and stands(robot)
    point = p.Position(then.x + 0.15, then.y + 0.1, 0.4)  # of a point on a table, the place below is meant, and no yaw
    there = perform(to(name="walkTo", target=point))
    assert math.hypot(there.x - point.x, there.y - point.y) < 0.05


def test_a_walk_that_misses_its_target_or_is_refused_fails(perform, walking, robot, link):
    plan = walking()
    robot.post("ALMotion", "stopMove")
    with pytest.raises(NavigationGoalNotReached, match=r"it is 1\.\d* m and \d.\d* rad off") as caught:
        plan.ended()
    assert caught.value.wanted.x == pytest.approx(2.0, abs=0.01) and 0.02 < caught.value.reached.x < 1.0
    link.answers["walk_target"] = ActionEnd(GoalStatus.SUCCEEDED, "", None)
    robot.advance(2.0)  # until it stands
    here = link.place("odom")
    with pytest.raises(NavigationGoalNotReached, match=r"it is 0\.00\d m and 0\.50 rad off"):
        perform(to(type="going", target=[here.x, here.y, here.yaw + 0.5, "odom"]))
    link.answers["walk_target"] = ActionEnd(GoalStatus.ABORTED, "stuck for 10 s", None)
    with pytest.raises(NavigationGoalNotReached, match="the robot did not get to .*: stuck for 10 s"):
        perform(to(type="going", target=[0.5, 0.0]))
    link.answers["walk_target"] = ActionEnd(GoalStatus.REJECTED, "frame mars is unknown", None)
    with pytest.raises(NavigationPoseUnreachable, match="in mars: frame mars is unknown"):
        perform(to(type="going", target=[0.5, 0.0, 0.0, "mars"]))


def test_a_plan_that_ends_leaves_the_robot_standing(walking, robot):
    plan = walking(p.do(p.perform, to(type="looking", target="left")))
    plan.root.evaporate("enough")
    plan.fails(TaskEvaporatedFailure, "enough")
    assert stands(robot)
    robot.advance(1.0)
    assert stands(robot) and robot.now.torso.position[0] < 1.0


def test_lights_have_a_colour_and_an_intensity_and_are_told_wrong_names(perform, robot, link):
    perform(to(type="lighting", color="green", lights="ChestLeds"))
    function = link.goals["NaoLights"][0].functions[0]
    assert (function.function, function.str_param, function.lights) == ("setColor", "green", ["ChestLeds"])
    state = robot.ALMemory.getListData(
        [f"Device/SubDeviceList/ChestBoard/Led/{each}/Actuator/Value" for each in ("Red", "Green")]
    )
    assert state == [0.0, 1.0]
    lights = get_process_module("lights")
    low_level_call(perform, lights.set_intensity, 0.5, ("Brain0",))
    assert robot.ALMemory.getData("Device/SubDeviceList/Head/Led/Front/Right/1/Actuator/Value") == 0.5
    with pytest.raises(LightsLowLevelFailure, match="setColor: .*grene"):
        perform(to(type="lighting", color="grene"))


def test_a_text_goes_to_the_topic_or_is_waited_for(begin, perform, link):
    perform(to(type="saying", text="Hi."))
    begin(lambda: goals.textToSpeech("There.")).ended()
    assert [message.data for message in link.goals.pop("speech")] == ["Hi.", "There."] and not link.goals
    link.answers["speech_action"] = ActionEnd(GoalStatus.SUCCEEDED, "", None)
    perform(to(type="saying", text="Hello.", wait=True))
    begin(lambda: p.achieve(goals.textToSpeech, "I said it.")).ended()
    assert [goal.say for goal in link.goals["speech_action"]] == ["Hello.", "I said it."]
    link.answers["speech_action"] = ActionEnd(GoalStatus.ABORTED, "no voice", None)
    with pytest.raises(SpeechLowLevelFailure, match="'Hello.' was not said: no voice"):
        perform(to(type="saying", text="Hello.", wait=True))


def found(kind, x, confidence=0.5, located=True):
    where, stamp = SimpleNamespace(x=x, y=0.0, z=0.05), SimpleNamespace(stamp=SimpleNamespace(to_sec=lambda: 12.0))
    return SimpleNamespace(kind=kind, name="", position=where, base_frame="base_footprint", located=located,
                           confidence=confidence, alpha=0.1, beta=0.2, header=stamp)  # fmt: skip


def test_what_is_seen_is_perceived_where_it_is(begin, link):
    objects = [found("ball", 1.0, 0.4), found("ball", 2.0, 0.9), found("ball", 3.0, 0.95, located=False)]
    link.answers["NaoVision"] = ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(objects=objects))
    thing = begin(lambda: p.perceive(p.a(p.object_, type="ball", size=0.05), camera="bottom")).ended().reference()
    assert thing.position == p.Point3(2.0, 0.0, 0.05, "odom") and thing.seen == 12.0
    assert len(begin(lambda: p.perceive(p.a(p.object_, type="ball", size=[0.1] * 3), "all", search=True)).ended()) == 2
    asked = [goal.functions[0] for goal in link.goals["NaoVision"]]
    assert [(f.function, f.str_param, f.camera, f.size) for f in asked] == [
        ("detectBall", "", "bottom", 0.05), ("lookFor", "ball", "", 0.0),
    ]  # fmt: skip


@pytest.mark.parametrize("search, hint", [(False, "; with `search` the head turns$"), (True, "$")])
def test_what_no_camera_sees_is_not_found_and_both_have_looked(begin, link, search, hint):
    link.answers["NaoVision"] = ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(objects=[]))
    text = f"no ball was seen in 2 s by the active camera, nor in 2 s by the bottom camera{hint}"
    with pytest.raises(PerceptionObjectNotFound, match=text):
        begin(lambda: p.perceive(p.a(p.object_, type="ball"), search=search)).ended()
    assert [goal.functions[0].camera for goal in link.goals["NaoVision"]] == ["", "bottom"]

"""Whole body control by kinematics alone: feet, balance, limits and what joints do when nothing is against it."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.body_kinematics import body_kinematics
from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.motion.engine import MotionEngine
from nao_sim_bridge.sim.motion.footholds import Footholds, FootState
from nao_sim_bridge.sim.motion.grounded_pose import GroundedPose
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.motion.whole_body import WholeBody
from nao_sim_bridge.sim.motion.whole_body_aims import PathAim, TargetAim
from nao_sim_bridge.sim.motion.whole_body_tasks import go_to_balance
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.tasks import TaskIds

MODEL = load_model()
BODY = body_kinematics(MODEL)
TICK = 1.0 / 120.0
LEFT, RIGHT, ARM = (frame_of(MODEL, name) for name in (*FEET, "LArm"))
SPEED = (0.2, 1.0)


class Body:
    """A robot without physics: commands are where the joints are."""

    def __init__(self, name):
        self.joints = JointCommands(MODEL, posture(MODEL, name))
        self.joints.set_stiffness(dict.fromkeys(range(26), 1.0))
        self.motion = MotionEngine(self.joints, TaskIds())
        self.control = WholeBody(MODEL, self.joints, self.motion)
        self.feet = Footholds(BODY)
        self.feet.put_down(BODY.at(self.joints.commands))
        self._ticks = 0

    @property
    def now(self):
        """The body on its left foot."""
        return GroundedPose(BODY.at(self.joints.commands), self.feet.footing)

    def run(self, seconds, watch=lambda: None):
        for _ in range(round(seconds / TICK)):
            self._ticks += 1
            self.motion.tick(self._ticks * TICK, TICK)
            watch()

    def move(self, seconds, **joints):
        """Start a task that moves joints to angles (rad)."""
        targets = {MODEL.joint_index[name]: angle for name, angle in joints.items()}

        def curves(commands):
            return {i: SmoothCurve((0.0, seconds), (commands[i], angle)) for i, angle in targets.items()}

        return self.motion.follow("move", targets, curves)

    def angle(self, name):
        return self.joints.commands[MODEL.joint_index[name]]

    def outside(self, feet=FEET):
        """How far the centre of mass is outside its region, m."""
        return self.feet.region(self.now, feet).excess(self.now.center_of_mass()[:2]).max()


@pytest.fixture
def body():
    """Makes bodies under whole body control."""

    def make(name="StandInit"):
        one = Body(name)
        one.control.enable(True)
        return one

    return make


def foot_error(one):
    goal = one.feet.kept[0]
    return np.abs(goal.rows(one.now)[1]).max()


def test_a_robot_that_is_left_alone_stays_and_costs_nothing(body, monkeypatch):
    one = body()
    before = one.joints.commands
    one.run(0.5)
    assert one.joints.commands == pytest.approx(before, abs=1e-5)
    monkeypatch.setattr(one.control, "_demands", lambda *_: pytest.fail("solved again"))
    one.run(0.5)


def test_joints_go_where_a_task_wants_them_when_nothing_is_against_it(body):
    one = body()
    task = one.move(0.5, LShoulderPitch=1.0, HeadYaw=0.4, LHand=0.9)
    one.run(0.6)
    assert task.finished
    assert [one.angle(name) for name in ("LShoulderPitch", "HeadYaw", "LHand")] == pytest.approx([1.0, 0.4, 0.9])


def test_feet_stay_when_a_task_moves_the_joints_of_one_leg(body):
    one = body()
    errors = []
    one.move(1.0, LHipPitch=-0.9, LKneePitch=1.2, LAnklePitch=-0.6)
    one.run(1.2, lambda: errors.append(foot_error(one)))
    assert max(errors) < 1e-3
    assert one.angle("LKneePitch") > 0.9
    assert one.angle("LHipYawPitch") == one.angle("RHipYawPitch")


def test_the_centre_of_mass_stays_in_its_region_when_legs_would_take_it_out(body):
    one = body()
    places = []
    # Both hips and ankles lean the whole robot ahead, far over its toes.
    one.move(1.0, LAnklePitch=-0.8, RAnklePitch=-0.8)
    one.run(1.2, lambda: places.append(one.outside()))
    assert max(places) < 1e-3
    assert foot_error(one) < 1e-3


def test_without_the_constraint_it_would_have_left(body):
    one = body()
    one.control.set_balance(())
    one.move(1.0, LAnklePitch=-0.8, RAnklePitch=-0.8)
    one.run(1.2)
    assert one.outside() > 0.02


@pytest.mark.parametrize("name", ["StandInit", "StandZero", "Crouch"])
@pytest.mark.parametrize("foot", FEET)
def test_the_centre_of_mass_goes_over_one_foot(body, name, foot):
    one = body(name)
    one.run(0.5)
    task = go_to_balance(one.control, one.motion, one.joints, "go", [foot], 1.0)
    errors = []
    one.run(2.5, lambda: errors.append(foot_error(one)))
    assert task.value is True
    assert one.outside([foot]) < 0.0
    assert max(errors) < 2e-3


def test_it_takes_the_time_it_needs(body):
    one = body()
    task = go_to_balance(one.control, one.motion, one.joints, "go", ["LLeg"], 0.0)
    one.run(0.4)
    assert not task.finished
    one.run(1.0)
    assert task.value is True


def test_a_place_out_of_reach_is_refused_and_nothing_moves(body):
    one = body("Stand")
    one.run(3.0)
    before = one.joints.commands
    task = go_to_balance(one.control, one.motion, one.joints, "go", ["LLeg"], 1.0)
    one.run(0.5)
    assert task.value is False
    assert one.joints.commands == pytest.approx(before, abs=1e-4)


def test_a_robot_does_not_balance_over_a_foot_in_the_air(body):
    one = body()
    go_to_balance(one.control, one.motion, one.joints, "go", ["LLeg"], 1.0)
    one.run(2.0)
    lift(one, 0.04)
    task = go_to_balance(one.control, one.motion, one.joints, "go", ["RLeg"], 1.0)
    one.run(0.5)
    assert task.value is False


def lift(one, height):
    """Raise the right foot."""
    one.control.set_foot_states(["RLeg"], FootState.FREE)
    goal = one.control.goal_here("RLeg")
    target = goal.pose.copy()
    target[2, 3] += height
    one.control.lead("RLeg", TargetAim(goal, target, SPEED))
    one.run(2.0)


def test_a_way_that_is_killed_ends_where_it_is(body):
    one = body()
    task = go_to_balance(one.control, one.motion, one.joints, "go", ["LLeg"], 2.0)
    one.run(1.0)
    task.request_kill()
    one.motion.kill_all()
    one.run(0.1)
    stopped = one.now.center_of_mass()
    one.run(1.0)
    assert one.now.center_of_mass() == pytest.approx(stopped, abs=2e-3)
    assert one.outside(["LLeg"]) > 0.0


def test_balance_over_one_foot_is_kept_while_the_other_is_raised_and_an_arm_moves(body):
    one = body()
    go_to_balance(one.control, one.motion, one.joints, "go", ["LLeg"], 1.0)
    one.run(1.5)
    before = one.now.pose(RIGHT)
    lift(one, 0.05)
    places = []
    one.move(1.0, LShoulderRoll=1.2, RShoulderRoll=0.2, RShoulderPitch=0.0)
    one.run(1.5, lambda: places.append(one.outside(["LLeg"])))
    assert max(places) < 1e-3
    assert one.now.pose(RIGHT)[2, 3] - before[2, 3] == pytest.approx(0.05, abs=1e-3)
    assert one.angle("LShoulderRoll") == pytest.approx(1.2, abs=0.02)


def test_an_arm_that_reaches_takes_the_body_with_it(body):
    one = body()
    goal = one.control.goal_here("LArm", 7)
    target = goal.pose.copy()
    target[:3, 3] += (0.15, 0.0, -0.03)
    one.control.lead("LArm", TargetAim(goal, target, SPEED))
    places = []
    one.run(3.0, lambda: places.append(one.outside()))
    assert one.now.pose(ARM)[:3, 3] == pytest.approx(target[:3, 3], abs=1e-3)
    assert np.abs(one.now.torso - Body("StandInit").now.torso).max() > 0.05
    assert max(places) < 1e-3
    assert foot_error(one) < 1e-3


def test_an_arm_stops_before_it_would_tip_the_robot_over(body):
    one = body()
    goal = one.control.goal_here("LArm", 7)
    target = goal.pose.copy()
    target[0, 3] += 0.4
    one.control.lead("LArm", TargetAim(goal, target, SPEED))
    places = []
    one.run(4.0, lambda: places.append(one.outside()))
    assert max(places) < 1e-3
    assert places[-1] == pytest.approx(0.0, abs=1e-3)
    assert one.now.pose(ARM)[0, 3] - goal.pose[0, 3] > 0.1
    assert foot_error(one) < 1e-3


def test_joint_motion_of_an_effector_ends_its_goal(body):
    one = body()
    goal = one.control.goal_here("LArm", 7)
    one.control.lead("LArm", PathAim(goal, lambda _: goal.pose, 1.0))
    one.move(0.5, LElbowRoll=-0.1)
    one.run(0.6)
    assert one.control.aim_of("LArm") is None
    assert one.angle("LElbowRoll") == pytest.approx(-0.1)


def test_killing_what_moves_an_arm_ends_its_goal_where_it_is(body):
    one = body()
    goal = one.control.goal_here("LArm", 7)
    target = goal.pose.copy()
    target[:3, 3] += (0.1, 0.0, 0.1)
    one.control.lead("LArm", TargetAim(goal, target, SPEED))
    one.run(0.5)
    one.motion.kill_using([MODEL.joint_index["LElbowRoll"]])
    stopped = one.now.pose(ARM)[:3, 3]
    one.run(1.0)
    assert one.now.pose(ARM)[:3, 3] == pytest.approx(stopped, abs=5e-3)


def test_a_foot_in_its_plane_slides_but_does_not_leave_the_ground(body):
    one = body()
    one.control.set_foot_states(["RLeg"], FootState.PLANE)
    one.move(1.0, RHipRoll=-0.15, RAnkleRoll=0.15)
    one.run(1.2)
    foot = one.now.pose(RIGHT)
    assert foot[1, 3] < -0.11
    assert foot[2, 3] == pytest.approx(0.0, abs=1e-3)
    assert foot[:3, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-2)


def test_limits_of_joints_hold(body):
    one = body()
    lower, upper = MODEL.limits_array().T
    goal = one.control.goal_here("RArm", 63)
    far = goal.pose.copy()
    far[:3, 3] += (1.0, -1.0, 1.0)
    one.control.lead("RArm", TargetAim(goal, far, (0.5, 3.0)))

    def within():
        assert np.all(np.array(one.joints.commands) >= lower - 1e-9)
        assert np.all(np.array(one.joints.commands) <= upper + 1e-9)

    one.run(3.0, within)
    assert one.outside() < 1e-3


def test_limp_legs_and_a_suspended_robot_pass_unchanged(body):
    one = body("Stand")
    one.control.suspended = True
    one.move(0.5, LHipRoll=0.4)
    one.run(0.6)
    assert one.angle("LHipRoll") == pytest.approx(0.4)
    one.control.suspended = False
    one.joints.set_stiffness({MODEL.joint_index["LHipRoll"]: 0.0})
    one.move(0.5, LHipRoll=0.3)
    one.run(0.6)
    assert one.angle("LHipRoll") == pytest.approx(0.3)


def test_switched_off_it_changes_nothing(body):
    one = body()
    one.control.enable(False)
    assert not one.control.active
    one.move(0.5, LHipRoll=0.4)
    one.run(0.6)
    assert one.angle("LHipRoll") == pytest.approx(0.4)
    assert one.angle("RHipRoll") == pytest.approx(0.0)


def test_controlled_effectors_switch_it_on_by_themselves(body):
    one = Body("StandInit")
    one.control.enable_effector("LArm", True)
    one.control.enable_effector("Head", True)
    one.control.enable_effector("LArm", False)
    assert one.control.active
    one.control.enable_effector("Head", False)
    assert not one.control.active

"""Whole body control by kinematics alone: feet, balance, limits and what joints do when nothing is against it."""

from __future__ import annotations

import numpy as np
import pytest

from nao_sim_bridge.sim.frames import FEET, frame_of
from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.balance_region import CORE, FRONT, MARGIN, balance_region, sole_corners
from nao_sim_bridge.sim.motion.body_kinematics import body_kinematics
from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.motion.engine import MotionEngine
from nao_sim_bridge.sim.motion.footholds import Footholds, FootState
from nao_sim_bridge.sim.motion.grounded_pose import GroundedPose
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.motion.whole_body import WholeBody
from nao_sim_bridge.sim.motion.whole_body_aims import TargetAim
from nao_sim_bridge.sim.motion.whole_body_tasks import go_to_balance
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.tasks import TaskIds

MODEL = load_model()
BODY = body_kinematics(MODEL)
TICK = 1.0 / 120.0
LEFT, RIGHT, ARM = (frame_of(MODEL, name) for name in (*FEET, "LArm"))


class Body:
    """A robot without physics under whole body control: commands are where the joints are."""

    def __init__(self, name="StandInit", enabled=True):
        self.joints = JointCommands(MODEL, posture(MODEL, name))
        self.joints.set_stiffness(dict.fromkeys(range(26), 1.0))
        self.motion = MotionEngine(self.joints, TaskIds())
        self.control = WholeBody(MODEL, self.joints, self.motion)
        self.feet = Footholds(BODY)
        self.feet.put_down(BODY.at(self.joints.commands))
        self.ticks, self.worst, self.slip = 0, -1.0, 0.0
        self.control.enable(enabled)

    @property
    def now(self):
        """The body on its left foot."""
        return GroundedPose(BODY.at(self.joints.commands), self.feet.footing)

    def outside(self, feet=FEET):
        """How far the centre of mass is outside its region, m."""
        return self.feet.region(self.now, feet).excess(self.now.center_of_mass()[:2]).max()

    def run(self, seconds, feet=FEET):
        """Let time pass; the largest excess over the region of `feet` and the largest error of the right foot stay."""
        self.worst, self.slip = -1.0, 0.0
        for _ in range(round(seconds / TICK)):
            self.ticks += 1
            self.motion.tick(self.ticks * TICK, TICK)
            self.worst = max(self.worst, self.outside(feet))
            self.slip = max(self.slip, np.abs(self.feet.kept[0].rows(self.now)[1]).max())

    def move(self, seconds, **joints):
        """Start a task that moves joints to angles (rad)."""
        targets = {MODEL.joint_index[name]: angle for name, angle in joints.items()}
        build = lambda now: {i: SmoothCurve((0.0, seconds), (now[i], angle)) for i, angle in targets.items()}  # noqa: E731
        return self.motion.follow("move", targets, build)

    def lead(self, effector, *by, mask=7, speed=(0.2, 1.0)):
        """Lead an effector by so many m from where it is; its target."""
        goal = self.control.goal_here(effector, mask)
        target = goal.pose.copy()
        target[:3, 3] += by
        self.control.lead(effector, TargetAim(goal, target, speed))
        return target[:3, 3]

    def go(self, foot, seconds):
        return go_to_balance(self.control, self.motion, self.joints, "go", [foot], seconds)

    def angles(self, *names):
        return [self.joints.commands[MODEL.joint_index[name]] for name in names]


# --- the region and the feet


def test_the_region_of_balance_is_the_support_without_its_rim():
    square = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.0, 0.2)]
    region = balance_region([*square, (0.1, 0.1), (0.2, 0.05)])
    assert region.center == pytest.approx([0.2, 0.1]) and len(region.limits) == 4
    assert region.excess(region.center).max() == pytest.approx(MARGIN - 0.1)
    assert [region.excess(np.array(corner)).max() for corner in square] == pytest.approx([MARGIN] * 4)
    narrow = balance_region([(0.0, 0.0), (0.4, 0.0), (0.4, 0.04), (0.0, 0.04)])
    assert -narrow.excess(narrow.center).max() == pytest.approx(CORE * 0.02), "of a narrow support a core is left"
    pose = np.eye(4)
    pose[:2, 3] = (1.0, 2.0)
    for foot, side in zip(FEET, (1.0, -1.0)):
        expected = np.minimum(MODEL.sole_contour, (FRONT, 1.0)) * (1.0, side) + (1.0, 2.0)
        found = sole_corners(MODEL, foot, pose)
        assert sorted(map(tuple, found.round(6))) == sorted(map(tuple, expected.round(6)))


def standing(name="StandInit", **joints):
    """Feet put down in a posture with some joints (rad) elsewhere."""
    angles = np.array(posture(MODEL, name))
    for joint, angle in joints.items():
        angles[MODEL.joint_index[joint]] += angle
    feet = Footholds(BODY)
    feet.put_down(BODY.at(angles))
    return feet, GroundedPose(BODY.at(angles), feet.footing)


def test_the_left_foot_stands_and_the_right_one_is_kept_flat_or_in_the_air():
    feet, now = standing()
    assert feet.footing.foot.link == LEFT.link and [goal.mask for goal in feet.kept] == [63]
    assert feet.kept[0].pose[:3, 3] == pytest.approx([0.0, -0.1, 0.0], abs=1e-3)
    both, one = feet.region(now, FEET), feet.region(now, ["LLeg"])
    between = (now.pose(LEFT)[:2, 3] + now.pose(RIGHT)[:2, 3]) / 2.0
    assert both.excess(between).max() < 0.0 < one.excess(between).max()
    assert one.center[1] == pytest.approx(0.0, abs=0.01)
    for tilted, now in (standing("Crouch"), standing(RAnklePitch=0.03)):
        assert abs(now.pose(RIGHT)[2, 2]) < 1.0 - 1e-6
        assert tilted.kept[0].pose[:3, 2] == pytest.approx([0.0, 0.0, 1.0])
    feet, now = standing(RHipPitch=-0.4, RKneePitch=0.8, RAnklePitch=-0.4)
    assert feet.kept[0].pose == pytest.approx(now.pose(RIGHT), abs=1e-6) and feet.on_ground(now, FEET) == ["LLeg"]


def test_a_foot_in_its_plane_keeps_height_roll_and_pitch_and_a_free_one_nothing():
    feet, now = standing()
    feet.set_state("LLeg", FootState.PLANE, now)
    assert feet.footing.foot.link == RIGHT.link
    assert [(goal.frame.link, goal.mask) for goal in feet.kept] == [(LEFT.link, 4 | 8 | 16)]
    feet.set_state("LLeg", FootState.FREE, now)
    assert feet.footing.foot.link == RIGHT.link and feet.kept == []
    assert (feet.on_ground(now, FEET), feet.carrying(now, FEET)) == (list(FEET), ["RLeg"])
    feet.set_state("RLeg", FootState.FREE, now)
    assert feet.footing is None


# --- control


def test_joints_go_where_a_task_wants_them_when_nothing_is_against_it():
    one = Body()
    before = one.joints.commands
    one.run(0.5)
    assert one.joints.commands == pytest.approx(before, abs=1e-5), "left alone it stays"
    task = one.move(0.5, LShoulderPitch=1.0, HeadYaw=0.4, LHand=0.9)
    one.run(0.6)
    assert task.finished and one.angles("LShoulderPitch", "HeadYaw", "LHand") == pytest.approx([1.0, 0.4, 0.9])
    one.move(1.0, LHipPitch=-0.9, LKneePitch=1.2, LAnklePitch=-0.6)
    one.run(1.2)
    knee, left, right = one.angles("LKneePitch", "LHipYawPitch", "RHipYawPitch")
    assert one.slip < 1e-3 and knee > 0.9 and left == right, "feet stay"


def test_the_centre_of_mass_stays_in_its_region_when_legs_would_take_it_out():
    free, kept = Body(), Body()
    free.control.set_balance(())
    for one in (free, kept):
        one.move(1.0, LAnklePitch=-0.8, RAnklePitch=-0.8)
        one.run(1.2)
    assert free.outside() > 0.02 and kept.worst < 1e-3 and kept.slip < 1e-3


@pytest.mark.parametrize("name, foot", [("StandInit", "LLeg"), ("StandZero", "RLeg"), ("Crouch", "LLeg")])
def test_the_centre_of_mass_goes_over_one_foot(name, foot):
    one = Body(name)
    one.run(0.5)
    task = one.go(foot, 1.0)
    one.run(2.5)
    assert task.value is True and one.outside([foot]) < 0.0 and one.slip < 2e-3


def test_an_arm_takes_the_body_with_it_and_stops_before_it_would_tip_the_robot_over():
    one = Body()
    target = one.lead("LArm", 0.15, 0.0, -0.03)
    one.run(3.0)
    assert one.now.pose(ARM)[:3, 3] == pytest.approx(target, abs=1e-3)
    assert np.abs(one.now.torso - Body().now.torso).max() > 0.05 and one.worst < 1e-3 and one.slip < 1e-3
    one = Body()
    before, _ = one.now.pose(ARM)[0, 3], one.lead("LArm", 0.4, 0.0, 0.0)
    one.run(4.0)
    assert one.worst < 1e-3 and one.slip < 1e-3 and one.outside() == pytest.approx(0.0, abs=1e-3)
    assert one.now.pose(ARM)[0, 3] - before > 0.1


def test_a_foot_in_its_plane_slides_but_does_not_leave_the_ground():
    one = Body()
    one.control.set_foot_states(["RLeg"], FootState.PLANE)
    one.move(1.0, RHipRoll=-0.15, RAnkleRoll=0.15)
    one.run(1.2)
    foot = one.now.pose(RIGHT)
    assert foot[1, 3] < -0.11 and foot[2, 3] == pytest.approx(0.0, abs=1e-3)
    assert foot[:3, 2] == pytest.approx([0.0, 0.0, 1.0], abs=1e-2)


def test_limits_of_joints_hold():
    one, (lower, upper) = Body(), MODEL.limits_array().T
    one.lead("RArm", 1.0, -1.0, 1.0, mask=63, speed=(0.5, 3.0))
    for _ in range(15):
        one.run(0.2)
        commands = np.array(one.joints.commands)
        assert np.all(commands >= lower - 1e-9) and np.all(commands <= upper + 1e-9) and one.worst < 1e-3


def test_switched_off_suspended_or_limp_it_changes_nothing():
    off, limp = Body(enabled=False), Body("Stand")
    limp.control.suspended = True
    for one in (off, limp):
        one.move(0.5, LHipRoll=0.4)
        one.run(0.6)
        assert one.angles("LHipRoll", "RHipRoll") == pytest.approx([0.4, posture(MODEL, "Stand")[15] * (one is limp)])
    limp.control.suspended = False
    limp.joints.set_stiffness({MODEL.joint_index["LHipRoll"]: 0.0})
    limp.move(0.5, LHipRoll=0.3)
    limp.run(0.6)
    assert limp.angles("LHipRoll") == pytest.approx([0.3])

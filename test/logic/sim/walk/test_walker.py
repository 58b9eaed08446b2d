"""Walker, feedback and arm swing, of a robot whose joints are at once where they are told, on level ground."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.walk.arm_swing import ArmSwing
from nao_sim_bridge.sim.walk.body import WalkingBody
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.gait import FeetGait, feet_gait
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.matrices import about_x, about_y, product, turned
from nao_sim_bridge.sim.walk.plan import Phase
from nao_sim_bridge.sim.walk.settings import load_walk_settings
from nao_sim_bridge.sim.walk.steps_course import Placement, StepsCourse
from nao_sim_bridge.sim.walk.velocity_course import VelocityCourse
from nao_sim_bridge.sim.walk.walker import Readings, Walker

MODEL = load_model()
BODY = WalkingBody(MODEL)
SETTINGS = load_walk_settings()
DT = 1.0 / 120.0


class Ideal:
    """A robot that does what it is told; its soles stay flat on the ground."""

    def __init__(self, name="StandInit", course=None):
        self.commands = list(posture(MODEL, name))
        self.walker = Walker(BODY, SETTINGS, 9.81, tuple(self.commands))
        self.plan = self.walker.plan
        # What the inertial unit says besides, roll and pitch: rad and rad/s.
        self.leaning, self.turning = (0.0, 0.0), (0.0, 0.0)
        self.loads = (26.0, 26.0)
        if course is not None:
            self.until(lambda: self.plan.phase is Phase.STAND)
            self.plan.begin(course)
            self.until(lambda: self.plan.phase is Phase.STEP)

    def legs(self):
        """Centre of mass in the torso frame, and ankle and foot of both legs."""
        return BODY.center_of_mass(BODY.upper_moment(self.commands), BODY.leg_pose(self.commands))

    def tilt(self):
        """Roll and pitch of a torso over a sole that is flat: that of the foot which carries."""
        foot = self.legs()[1][0 if self.plan.support == LEFT else 1][1]
        up = (foot[2], foot[5], foot[8])
        return math.atan2(up[1], up[2]), math.atan2(-up[0], math.hypot(up[1], up[2]))

    def tick(self):
        roll, pitch = self.tilt()
        tilt = (roll + self.leaning[0], pitch + self.leaning[1])
        readings = Readings(tuple(self.commands), tilt, self.turning, self.loads)
        made = self.walker.tick(readings, tuple(self.commands), DT)
        for index, angle in made.items():
            self.commands[index] = angle
        return made

    def ticks(self, count):
        for _ in range(count):
            self.tick()

    def until(self, condition):
        for _ in range(2000):
            if condition():
                return
            self.tick()
        raise AssertionError("it never comes to that")

    def seen_from_the_carrying_foot(self):
        """Other sole and centre of mass over the ground as the foot that carries points, and their heights, m."""
        com, feet = self.legs()
        level = product(about_y(self.tilt()[1]), about_x(self.tilt()[0]))
        soles = []
        for ankle, foot in feet:
            x, y, z = turned(level, ankle)
            down = product(level, foot)
            h = BODY.legs.sole_height
            soles.append((FootPose(x - h * down[2], y - h * down[5], math.atan2(down[3], down[0])), z - h * down[8]))
        mine, other = (soles[0], soles[1]) if self.plan.support == LEFT else (soles[1], soles[0])
        x, y, z = turned(level, com)
        return other[0].seen_from(mine[0]), other[1] - mine[1], FootPose(x, y, 0.0).seen_from(mine[0]), z - mine[1]


def velocity(*rate, gait=None):
    return VelocityCourse(SETTINGS, gait or FeetGait(), rate)


@pytest.mark.parametrize("name", ["StandInit", "Stand", "StandZero", "Crouch"])
def test_the_stance_of_walks_is_the_same_from_everywhere_and_taken_without_a_jerk(name):
    robot = Ideal(name)
    while robot.plan.phase is Phase.STANCE:
        before = list(robot.commands)
        for index, angle in robot.tick().items():
            assert abs(angle - before[index]) < 0.5 * MODEL.joints[index].max_velocity * DT, MODEL.joints[index].name
    other, height, com, com_height = robot.seen_from_the_carrying_foot()
    assert com_height == pytest.approx(SETTINGS.com_height, abs=1e-3)
    assert robot.tilt() == pytest.approx((0.0, SETTINGS.lean), abs=2e-3)
    assert height == pytest.approx(0.0, abs=1e-3)
    feet = robot.plan.feet
    assert other[:2] == pytest.approx(feet[-robot.plan.support].seen_from(feet[robot.plan.support])[:2], abs=2e-3)
    rest = FootPose(*robot.plan.rest(), 0.0).seen_from(feet[robot.plan.support])
    assert com[:2] == pytest.approx(rest[:2], abs=3e-3)


@pytest.mark.parametrize("rate", [(0.04, 0.0, 0.0), (-0.02, 0.02, 0.0), (0.01, 0.0, 0.25)])
def test_feet_and_body_go_where_the_plan_has_them_with_little_feedback(rate):
    robot = Ideal(course=velocity(*rate))
    for _ in range(200):
        made = robot.tick()
        plan, shift = robot.plan, robot.walker.feedback.shift
        carries, moving = plan.feet[plan.support], plan.foot(-plan.support)
        other, height, com, _ = robot.seen_from_the_carrying_foot()
        # Both hips turn by one motor: what it cannot do, feet are turned off by.
        assert other[:2] == pytest.approx(moving.pose.seen_from(carries)[:2], abs=4e-3)
        assert other.yaw == pytest.approx(moving.pose.seen_from(carries).yaw, abs=0.06)
        assert height == pytest.approx(moving.height, abs=2e-3)
        wanted = FootPose(plan.com[0] + shift[0], plan.com[1] + shift[1], 0.0).seen_from(carries)
        assert com[:2] == pytest.approx(wanted[:2], abs=5e-3)
        assert math.hypot(*robot.walker.feedback.error) < 0.02 and robot.walker.feedback.ankle == (0.0, 0.0)
    legs = {MODEL.joint_index[name] for leg in ("LLeg", "RLeg") for name in MODEL.chains[leg]}
    assert set(made) == legs
    yaws = [made[MODEL.joint_index[f"{side}HipYawPitch"]] for side in "LR"]
    assert yaws[0] == yaws[1], "one motor turns both"


def test_the_torso_rolls_and_pitches_as_the_gait_says():
    robot = Ideal(course=velocity(0.02, 0.0, 0.0, gait=feet_gait({"TorsoWx": 0.1, "TorsoWy": -0.05})))
    robot.until(lambda: robot.plan.swing_share > 0.48)
    assert robot.tilt() == pytest.approx((0.1, SETTINGS.lean - 0.05), abs=0.01)
    robot.until(lambda: robot.plan.swing_share == 0.0)
    assert robot.tilt() == pytest.approx((0.0, SETTINGS.lean), abs=0.01)


@pytest.mark.parametrize("felt, waits", [(0.0, True), (SETTINGS.loaded + 1.0, False)])
def test_a_step_ends_when_the_foot_feels_the_ground(felt, waits):
    robot = Ideal(course=StepsCourse(SETTINGS, FeetGait(), [Placement(LEFT, FootPose(0.0, 0.1, 0.0), 0.5)]))
    robot.loads, ticks = (felt, 50.0), 0
    while robot.plan.phase is Phase.STEP:
        robot.tick()
        ticks += 1
    assert ticks * DT - 0.5 == pytest.approx(SETTINGS.latest if waits else 0.0, abs=2.5 * DT)


@pytest.mark.parametrize("leaning, axis, sign", [((0, 0.05), 0, 1.0), ((0, -0.05), 0, -1.0), ((0.05, 0), 1, -1.0)])
def test_a_body_that_leans_is_shifted_back_until_that_is_a_habit_and_far_off_it_is_none(leaning, axis, sign):
    robot = Ideal()
    robot.until(lambda: robot.plan.phase is Phase.STAND)
    robot.leaning, feedback = leaning, robot.walker.feedback
    robot.ticks(60)
    first = sign * feedback.error[axis]
    assert first > 0.005 and sign * feedback.shift[axis] < -0.001
    robot.ticks(round(4.0 * SETTINGS.habit_time / DT))
    assert abs(feedback.error[axis]) < 0.2 * first
    robot.leaning = (6.0 * leaning[0], 6.0 * leaning[1])
    robot.ticks(60)
    early = feedback.error
    robot.ticks(400)
    assert SETTINGS.habit_within < sign * early[axis] and feedback.error[axis] == pytest.approx(early[axis], rel=0.1)
    assert feedback.shift[axis] == pytest.approx(-SETTINGS.shift_gain * early[axis], rel=0.05)
    robot.leaning = (12.0 * leaning[0], 12.0 * leaning[1])
    robot.ticks(60)
    assert -sign * feedback.shift[axis] == pytest.approx(SETTINGS.shift_limit, rel=0.01)


def test_a_body_that_turns_is_held_by_the_ankles_that_carry():
    robot, still = Ideal(course=velocity(0.03, 0.0, 0.0)), Ideal(course=velocity(0.03, 0.0, 0.0))
    for one in (robot, still):
        one.until(lambda one=one: one.plan.swing_share > 0.4)
    robot.turning = (0.2, 0.5)
    made, other = robot.tick(), still.tick()
    for side, letter in ((LEFT, "L"), (RIGHT, "R")):
        for name, rate in (("AnkleRoll", 0.2), ("AnklePitch", 0.5)):
            index = MODEL.joint_index[f"{letter}{name}"]
            held = SETTINGS.ankle_damping * rate if side == robot.plan.support else 0.0
            assert made[index] - other[index] == pytest.approx(held, abs=1e-6)


def test_a_walk_slows_down_as_the_body_comes_off_and_stops_when_it_is_far_off():
    walker = Ideal().walker
    for off, haste in ((0.0, 1.0), (0.5, 0.5), (-2.0, 0.0)):
        from_here = math.copysign(SETTINGS.calm_from, off) if off else 0.0
        walker.feedback.error = (0.0, from_here + off * SETTINGS.calm_range)
        assert walker.haste == pytest.approx(haste)


HOME = posture(MODEL, "StandInit")
LEFT_ARM, RIGHT_ARM = (MODEL.joint_index[f"{side}ShoulderPitch"] for side in "LR")
ARM = {
    side: {MODEL.joint_index[name] for name in MODEL.chains[f"{side}Arm"] if not name.endswith("Hand")} for side in "LR"
}
NOBODY = frozenset()


class Arms:
    """Arms that go at once where they are wanted, of a robot whose legs stride as told."""

    def __init__(self, at="StandInit", stride=0.0, settings=SETTINGS):
        self.stride = stride
        self.joints = JointCommands(MODEL, posture(MODEL, at))
        self.joints.set_stiffness(dict.fromkeys(range(26), 1.0))
        self.swing = ArmSwing(MODEL, self.joints, settings, lambda: self.stride)

    def after(self, seconds=1.0, busy=NOBODY):
        """What the arms are wanted to do at the last tick."""
        for _ in range(round(seconds / DT)):
            wanted = self.swing.wishes(busy, DT)
        return wanted


@pytest.mark.parametrize("stride", [-0.04, 0.02])
def test_arms_without_hands_swing_against_the_legs_and_not_while_it_stands(stride):
    assert Arms(stride=None).after(DT) == {}
    wanted = Arms(stride=stride).after(2 * SETTINGS.arm_ease)
    by_stride = SETTINGS.arm_swing * stride / 0.04
    expected = {index: HOME[index] for index in ARM["L"] | ARM["R"]}
    # A larger shoulder pitch points the arm further back.
    expected[LEFT_ARM] += by_stride
    expected[RIGHT_ARM] -= by_stride
    assert wanted == pytest.approx(expected)


def test_an_arm_that_is_busy_limp_or_may_not_swing_does_not():
    arms = Arms(stride=0.04)
    arms.after()
    assert set(arms.after(busy=frozenset({MODEL.joint_index["LElbowRoll"]}))) == ARM["R"]
    again = arms.after(DT)
    assert again[LEFT_ARM] == pytest.approx(arms.joints.commands[LEFT_ARM], abs=0.01), "it joins in from where it is"
    arms.joints.set_stiffness({MODEL.joint_index["RElbowYaw"]: 0.0})
    assert set(arms.after()) == ARM["L"] and not arms.swing.alone
    for arm, other in (("LArm", "R"), ("RArm", "L")):
        one = Arms()
        one.swing.enabled[arm] = False
        assert set(one.after()) == ARM[other]

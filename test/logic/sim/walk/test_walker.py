"""Walker, feedback and arm swing, of a robot whose joints are at once where they are told, on level ground."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.walk.arm_swing import ArmSwing
from nao_sim_bridge.walk.body import WalkingBody
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.plan import Phase
from nao_sim_bridge.walk.settings import load_walk_settings
from nao_sim_bridge.walk.velocity_course import VelocityCourse
from nao_sim_bridge.walk.walker import Readings, Walker

MODEL = load_model()
BODY = WalkingBody(MODEL)
SETTINGS = load_walk_settings()
DT = 1.0 / 120.0


class Ideal:
    """A robot that does what it is told; its soles stay flat on the ground."""

    def __init__(self):
        self.commands = list(posture(MODEL, "StandInit"))
        self.walker = Walker(BODY, SETTINGS, 9.81, tuple(self.commands))
        self.plan = self.walker.plan
        # What the inertial unit says besides, roll and pitch: rad and rad/s.
        self.leaning, self.turning = (0.0, 0.0), (0.0, 0.0)

    def tilt(self):
        """Roll and pitch of a torso over a sole that is flat: that of the foot which carries."""
        _, legs = BODY.center_of_mass(BODY.upper_moment(self.commands), BODY.leg_pose(self.commands))
        foot = legs[0 if self.plan.support == LEFT else 1][1]
        up = (foot[2], foot[5], foot[8])
        return math.atan2(up[1], up[2]), math.atan2(-up[0], math.hypot(up[1], up[2]))

    def tick(self):
        roll, pitch = self.tilt()
        tilt = (roll + self.leaning[0], pitch + self.leaning[1])
        readings = Readings(tuple(self.commands), tilt, self.turning, (26.0, 26.0))
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
    robot, still = Ideal(), Ideal()
    for one in (robot, still):
        one.until(lambda one=one: one.plan.phase is Phase.STAND)
        one.plan.begin(VelocityCourse(SETTINGS, FeetGait(), (0.03, 0.0, 0.0)))
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
SHOULDERS = [MODEL.joint_index[f"{side}ShoulderPitch"] for side in "LR"]
ARMS = [
    [MODEL.joint_index[name] for name in MODEL.chains[arm] if not name.endswith("Hand")] for arm in ("LArm", "RArm")
]


@pytest.fixture
def swing():
    """Arms of a robot whose left leg strides 2 cm ahead; what they are wanted to do in the end."""
    joints = JointCommands(MODEL, HOME)
    joints.set_stiffness(dict.fromkeys(range(26), 1.0))
    made = ArmSwing(MODEL, joints, SETTINGS, lambda: 0.02)
    after = lambda busy=(): [made.wishes(frozenset(busy), DT) for _ in range(round(2 * SETTINGS.arm_ease / DT))][-1]  # noqa: E731
    return made, after


def test_arms_without_hands_swing_against_the_legs_unless_they_are_busy_or_may_not(swing):
    made, after = swing
    expected = {index: HOME[index] for arm in ARMS for index in arm}
    # A larger shoulder pitch points the arm further back.
    for shoulder, sign in zip(SHOULDERS, (1.0, -1.0)):
        expected[shoulder] += sign * SETTINGS.arm_swing * 0.02 / 0.04
    assert after() == pytest.approx(expected) and made.alone
    assert set(after(busy=[MODEL.joint_index["LElbowRoll"]])) == set(ARMS[1])
    made.enabled["RArm"] = False
    assert set(after()) == set(ARMS[0])

"""The walker as a table of joint angles: a robot whose joints are at once where they are told, on level ground."""

from __future__ import annotations

import math

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
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
NOTHING = 0.0


class Ideal:
    """A robot that does what it is told; its soles stay flat on the ground."""

    def __init__(self, name="StandInit"):
        self.commands = list(posture(MODEL, name))
        self.walker = Walker(BODY, SETTINGS, 9.81, tuple(self.commands))
        self.plan = self.walker.plan
        # What the inertial unit says besides, roll and pitch: rad and rad/s.
        self.leaning, self.turning = (0.0, 0.0), (0.0, 0.0)
        self.loads = None

    def legs(self):
        """Centre of mass in the torso frame, and ankle and foot of both legs."""
        return BODY.center_of_mass(BODY.upper_moment(self.commands), BODY.leg_pose(self.commands))

    def tilt(self):
        """Roll and pitch of a torso over a sole that is flat: that of the foot which carries."""
        _, feet = self.legs()
        foot = feet[0 if self.plan.support == LEFT else 1][1]
        up = (foot[2], foot[5], foot[8])
        return math.atan2(up[1], up[2]), math.atan2(-up[0], math.hypot(up[1], up[2]))

    def tick(self):
        roll, pitch = self.tilt()
        tilt = (roll + self.leaning[0], pitch + self.leaning[1])
        loads = self.loads if self.loads else (26.0, 26.0)
        readings = Readings(tuple(self.commands), tilt, self.turning, loads)
        made = self.walker.tick(readings, tuple(self.commands), DT)
        for index, angle in made.items():
            self.commands[index] = angle
        return made

    def until(self, condition):
        for _ in range(2000):
            if condition():
                return
            self.tick()
        raise AssertionError("it never comes to that")

    def begin(self, course):
        self.until(lambda: self.plan.phase is Phase.STAND)
        self.plan.begin(course)

    def seen_from_the_carrying_foot(self):
        """Other sole and centre of mass over the ground as the foot that carries points, and their heights, m."""
        com, feet = self.legs()
        level = product(about_y(self.tilt()[1]), about_x(self.tilt()[0]))
        soles = []
        for ankle, foot in feet:
            x, y, z = turned(level, ankle)
            down = product(level, foot)
            h = BODY.legs.sole_height
            pose = FootPose(x - h * down[2], y - h * down[5], math.atan2(down[3], down[0]))
            soles.append((pose, z - h * down[8]))
        mine, other = (soles[0], soles[1]) if self.plan.support == LEFT else (soles[1], soles[0])
        x, y, z = turned(level, com)
        return other[0].seen_from(mine[0]), other[1] - mine[1], FootPose(x, y, 0.0).seen_from(mine[0]), z - mine[1]


@pytest.mark.parametrize("name", ["StandInit", "Stand", "StandZero", "Crouch"])
def test_it_takes_the_stance_of_walks_without_a_jerk(name):
    robot = Ideal(name)
    while robot.plan.phase is Phase.STANCE:
        before = list(robot.commands)
        for index, angle in robot.tick().items():
            assert abs(angle - before[index]) < 0.5 * MODEL.joints[index].max_velocity * DT, MODEL.joints[index].name


@pytest.mark.parametrize("name", ["StandInit", "Stand", "StandZero", "Crouch"])
def test_the_stance_of_walks_is_the_same_from_everywhere(name):
    robot = Ideal(name)
    robot.until(lambda: robot.plan.phase is not Phase.STANCE)
    other, height, com, com_height = robot.seen_from_the_carrying_foot()
    assert com_height == pytest.approx(SETTINGS.com_height, abs=1e-3)
    assert robot.tilt() == pytest.approx((0.0, SETTINGS.lean), abs=2e-3)
    assert height == pytest.approx(0.0, abs=1e-3)
    feet = robot.plan.feet
    assert other[:2] == pytest.approx(feet[-robot.plan.support].seen_from(feet[robot.plan.support])[:2], abs=2e-3)
    rest = FootPose(*robot.plan.rest(), 0.0).seen_from(feet[robot.plan.support])
    assert com[:2] == pytest.approx(rest[:2], abs=3e-3)


@pytest.mark.parametrize("rate", [(0.04, 0.0, 0.0), (-0.02, 0.02, 0.0), (0.01, 0.0, 0.25)])
def test_feet_and_body_go_where_the_plan_has_them(rate):
    robot = Ideal()
    robot.begin(VelocityCourse(SETTINGS, FeetGait(), rate))
    robot.until(lambda: robot.plan.phase is Phase.STEP)
    for _ in range(300):
        robot.tick()
        plan, shift = robot.plan, robot.walker.feedback.shift
        carries = plan.feet[plan.support]
        moving = plan.foot(-plan.support)
        other, height, com, _ = robot.seen_from_the_carrying_foot()
        # Both hips turn by one motor: what it cannot do, feet are turned off by.
        assert other[:2] == pytest.approx(moving.pose.seen_from(carries)[:2], abs=4e-3)
        assert other.yaw == pytest.approx(moving.pose.seen_from(carries).yaw, abs=0.06)
        assert height == pytest.approx(moving.height, abs=2e-3)
        wanted = FootPose(plan.com[0] + shift[0], plan.com[1] + shift[1], 0.0).seen_from(carries)
        assert com[:2] == pytest.approx(wanted[:2], abs=5e-3)


def test_a_body_that_does_what_it_is_told_needs_little_feedback():
    robot = Ideal()
    robot.begin(VelocityCourse(SETTINGS, FeetGait(), (0.03, 0.0, 0.0)))
    robot.until(lambda: robot.plan.phase is Phase.STEP)
    for _ in range(300):
        robot.tick()
        assert math.hypot(*robot.walker.feedback.error) < 0.02
        assert robot.walker.feedback.ankle == (0.0, 0.0)


@pytest.mark.parametrize(
    "leaning, axis, sign", [((0.0, 0.05), 0, 1.0), ((0.0, -0.05), 0, -1.0), ((0.05, 0.0), 1, -1.0)]
)
def test_a_body_that_leans_is_off_that_way_and_shifted_back(leaning, axis, sign):
    robot = Ideal()
    robot.until(lambda: robot.plan.phase is Phase.STAND)
    robot.leaning = leaning
    for _ in range(60):
        robot.tick()
    assert sign * robot.walker.feedback.error[axis] > 0.005
    assert sign * robot.walker.feedback.shift[axis] < -0.001
    assert math.hypot(*robot.walker.feedback.shift) <= math.sqrt(2.0) * SETTINGS.shift_limit


def test_a_body_that_turns_is_held_by_the_ankles_that_carry():
    robot, still = Ideal(), Ideal()
    for one in (robot, still):
        one.begin(VelocityCourse(SETTINGS, FeetGait(), (0.03, 0.0, 0.0)))
        one.until(lambda one=one: one.plan.swing_share > 0.4)
    robot.turning = (0.2, 0.5)
    made, other = robot.tick(), still.tick()
    for side, letter in ((LEFT, "L"), (RIGHT, "R")):
        carries = side == robot.plan.support
        for name, rate in (("AnkleRoll", 0.2), ("AnklePitch", 0.5)):
            index = MODEL.joint_index[f"{letter}{name}"]
            held = SETTINGS.ankle_damping * rate if carries else 0.0
            assert made[index] - other[index] == pytest.approx(held, abs=1e-6)


def test_it_moves_both_legs_and_nothing_else():
    legs = {MODEL.joint_index[name] for leg in ("LLeg", "RLeg") for name in MODEL.chains[leg]}
    robot = Ideal()
    made = robot.tick()
    assert set(made) == legs
    yaws = [made[MODEL.joint_index[f"{side}HipYawPitch"]] for side in "LR"]
    assert yaws[0] == yaws[1], "one motor turns both"


def test_the_torso_rolls_and_pitches_as_the_gait_says():
    robot = Ideal()
    gait = feet_gait({"TorsoWx": 0.1, "TorsoWy": -0.05})
    robot.begin(VelocityCourse(SETTINGS, gait, (0.02, 0.0, 0.0)))
    robot.until(lambda: robot.plan.swing_share > 0.48)
    assert robot.tilt() == pytest.approx((0.1, SETTINGS.lean - 0.05), abs=0.01)
    robot.until(lambda: robot.plan.swing_share == 0.0)
    assert robot.tilt() == pytest.approx((0.0, SETTINGS.lean), abs=0.01)


@pytest.mark.parametrize("felt, waits", [(NOTHING, True), (SETTINGS.loaded + 1.0, False)])
def test_a_step_ends_when_the_foot_feels_the_ground(felt, waits):
    robot = Ideal()
    robot.begin(StepsCourse(SETTINGS, FeetGait(), [Placement(LEFT, FootPose(0.0, 0.1, 0.0), 0.5)]))
    robot.until(lambda: robot.plan.phase is Phase.STEP)
    robot.loads = (felt, 50.0)
    ticks = 0
    while robot.plan.phase is Phase.STEP:
        robot.tick()
        ticks += 1
    late = ticks * DT - 0.5
    assert late == pytest.approx(SETTINGS.latest if waits else 0.0, abs=2.5 * DT)

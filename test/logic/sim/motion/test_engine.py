"""The motion engine: tasks that own joints, targets that give way, their ends, and what is said of what cannot be."""

from __future__ import annotations

import logging

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.curves import Ramp, SmoothCurve
from nao_sim_bridge.sim.motion.engine import MotionEngine
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.tasks import TaskIds

MODEL = load_model()
DT = 0.01
YAW, PITCH, LEFT, RIGHT, ELBOW = (
    MODEL.joint_index[name] for name in ("HeadYaw", "HeadPitch", "LHipYawPitch", "RHipYawPitch", "LElbowRoll")
)


class Motion:
    """An engine with joints at zero, and a clock."""

    def __init__(self):
        self.joints = JointCommands(MODEL, [0.0] * 26)
        self.engine = MotionEngine(self.joints, TaskIds())
        self.ticks = 0

    def run(self, seconds):
        for _ in range(round(seconds / DT)):
            self.ticks += 1
            self.engine.tick(self.ticks * DT, DT)

    def glide(self, *joints, to, duration=1.0, name="glide"):
        """A task that takes joints to one angle, or to those of a mapping, along smooth curves."""
        ends = to if isinstance(to, dict) else dict.fromkeys(joints, to)

        def build(now):
            return {i: SmoothCurve((0.0, duration), (now[i], end)) for i, end in ends.items()}

        return self.engine.follow(name, list(ends), build)

    def aim(self, joint, angle, speed):
        self.engine.set_targets({joint: angle}, {joint: speed})

    def angle(self, joint):
        return self.joints.commands[joint]


@pytest.fixture
def motion():
    return Motion()


# --- tasks


def test_a_task_follows_its_curve_and_ends_with_it(motion):
    task = motion.glide(YAW, to=1.0)
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(0.49)
    assert not task.finished
    motion.run(0.01)
    assert task.finished and not task.killed and motion.angle(YAW) == 1.0 and motion.engine.tasks() == []
    ramp = motion.engine.follow("ramp", [YAW], lambda now: {YAW: Ramp(now[YAW], 0.5, 1.0)})
    motion.run(0.49)
    assert not ramp.finished
    motion.run(0.02)
    assert ramp.finished and motion.angle(YAW) == 0.5


def test_a_task_that_asks_too_much_ends_late_or_at_the_limit(motion):
    task = motion.glide(YAW, to=2.0, duration=0.05)
    motion.run(0.1)
    assert not task.finished and motion.angle(YAW) <= 0.1 * MODEL.joints[YAW].max_velocity + 1e-9
    motion.run(0.2)
    assert task.finished and motion.angle(YAW) == 2.0
    motion = Motion()
    task = motion.glide(PITCH, to=3.0)
    motion.run(1.0)
    assert task.finished and motion.angle(PITCH) == MODEL.joints[PITCH].upper


def test_the_left_hip_has_the_say_over_the_common_motor(motion):
    task = motion.glide(to={LEFT: -0.2, RIGHT: -0.1})
    motion.run(1.0)
    assert task.finished and motion.angle(LEFT) == motion.angle(RIGHT) == -0.2
    left, right = motion.glide(LEFT, to=-0.4), motion.glide(RIGHT, to=0.1, duration=0.5)
    motion.run(1.0)
    assert left.finished and not right.finished and motion.angle(LEFT) == motion.angle(RIGHT) == -0.4
    motion.run(0.2)
    assert right.finished and motion.angle(LEFT) == motion.angle(RIGHT) == 0.1


# --- targets


def test_a_target_gives_way_to_a_task_and_is_taken_up_afterwards_when_it_is_newer(motion):
    motion.aim(YAW, -1.0, 1.0)
    motion.run(0.1)
    motion.glide(YAW, to=1.0)
    motion.run(2.0)
    assert motion.angle(YAW) == 1.0
    motion.glide(YAW, to=0.5)
    motion.run(0.5)
    motion.aim(YAW, 0.0, 0.5)
    motion.run(0.5)
    assert motion.angle(YAW) == 0.5
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.25)


# --- what keeps commands from their goals


@pytest.mark.parametrize(
    "ask, told",
    [
        (lambda m: (m.glide(to={YAW: 0.5, PITCH: 0.2}), m.aim(2, 0.1, 1.0)), []),
        (lambda m: m.aim(YAW, 3.0, 9.0), ["setAngles: HeadYaw 3.000 is above 2.086"]),
        (
            lambda m: m.glide(to={YAW: -3.0, ELBOW: 0.5}),
            ["glide: HeadYaw -3.000 is below -2.086; LElbowRoll 0.500 is above -0.035"],
        ),
        (
            lambda m: m.glide(to={YAW: 1.5, PITCH: 0.5}),
            [f"glide: HeadPitch 0.500 is above {MODEL.coupled_limits['HeadPitch'].limits_at(1.5)[1]:.3f}"],
        ),
    ],
)
def test_what_cannot_be_done_as_asked_is_told_once_with_joint_wish_and_limit(motion, caplog, ask, told):
    for enabled, level in ((True, "WARNING"), (False, "INFO")):
        caplog.clear()
        caplog.set_level(logging.INFO, "nao_sim.motion")
        motion.engine.notices.enabled = enabled
        ask(motion)
        motion.run(1.1)
        assert [(one.levelname, one.getMessage()) for one in caplog.records] == [(level, text) for text in told]
        motion = Motion()

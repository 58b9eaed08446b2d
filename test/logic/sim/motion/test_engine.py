"""The motion engine: a target that gives way to tasks, and the one motor of both hips."""

from __future__ import annotations

import pytest

from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.model.model_reader import load_model

MODEL = load_model()
DT = 0.01
YAW, PITCH, LEFT, RIGHT = (MODEL.joint_index[n] for n in ("HeadYaw", "HeadPitch", "LHipYawPitch", "RHipYawPitch"))


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

    def glide(self, joint, to, seconds=1.0):
        return self.engine.follow("glide", [joint], lambda now: {joint: SmoothCurve((0.0, seconds), (now[joint], to))})

    def angle(self, joint):
        return self.joints.commands[joint]


def test_a_target_gives_way_to_a_task_and_is_taken_up_afterwards_when_it_is_newer():
    motion = Motion()
    motion.engine.set_targets({YAW: -1.0}, {YAW: 1.0})
    motion.run(0.1)
    motion.glide(YAW, 1.0)
    motion.run(2.0)
    assert motion.angle(YAW) == 1.0
    motion.glide(YAW, 0.5)
    motion.run(0.5)
    motion.engine.set_targets({YAW: 0.0}, {YAW: 0.5})
    motion.run(0.5)
    assert motion.angle(YAW) == 0.5
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.25)


def test_what_is_killed_with_its_tasks_moves_no_more_and_nothing_else_is():
    motion = Motion()
    task, other = motion.glide(YAW, 1.0), motion.glide(PITCH, 0.4)
    motion.run(0.5)
    motion.engine.set_targets({YAW: -1.0}, {YAW: 1.0})
    motion.engine.kill_using([YAW])
    motion.run(1.0)
    assert task.killed and not other.killed
    assert motion.angle(YAW) == pytest.approx(0.5) and motion.angle(PITCH) == 0.4


def test_the_left_hip_has_the_say_over_the_common_motor():
    motion = Motion()
    left, right = motion.glide(LEFT, -0.4), motion.glide(RIGHT, 0.1, seconds=0.5)
    motion.run(1.0)
    assert left.finished and not right.finished and motion.angle(LEFT) == motion.angle(RIGHT) == -0.4
    motion.run(0.2)
    assert right.finished and motion.angle(LEFT) == motion.angle(RIGHT) == 0.1

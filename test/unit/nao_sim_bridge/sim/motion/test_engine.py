"""The motion engine: tasks that own joints, targets that give way, and their ends."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.motion.curves import Ramp, SmoothCurve
from nao_sim_bridge.sim.motion.engine import MotionEngine
from nao_sim_bridge.sim.motion.joints import JointCommands
from nao_sim_bridge.sim.tasks import TaskIds

MODEL = load_model()
DT = 0.01
YAW, PITCH = MODEL.joint_index["HeadYaw"], MODEL.joint_index["HeadPitch"]
LEFT, RIGHT = MODEL.joint_index["LHipYawPitch"], MODEL.joint_index["RHipYawPitch"]


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
        """A task that takes joints to an angle along smooth curves."""

        def build(commands):
            return {i: SmoothCurve((0.0, duration), (commands[i], to)) for i in joints}

        return self.engine.follow(name, joints, build)

    def stiffen(self, joint, to, duration=1.0):
        def build(now):
            return {joint: SmoothCurve((0.0, duration), (now[joint], to))}

        return self.engine.stiffen("stiffen", [joint], build)

    def angle(self, joint):
        return self.joints.commands[joint]


@pytest.fixture
def motion():
    return Motion()


# --- tasks ------------------------------------------------------------------------------------------------------------


def test_a_task_follows_its_curve_and_ends_with_it(motion):
    task = motion.glide(YAW, to=1.0)
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(0.49)
    assert not task.finished
    motion.run(0.01)
    assert task.finished and not task.killed
    assert motion.angle(YAW) == 1.0
    assert motion.engine.tasks() == []


def test_tasks_are_numbered_and_listed_oldest_first(motion):
    tasks = [motion.glide(YAW, to=1.0, name="a"), motion.glide(PITCH, to=0.1, name="b")]
    assert motion.engine.tasks() == tasks
    assert [(t.name, t.task_id) for t in tasks] == [("a", 1), ("b", 2)]


def test_a_second_task_on_a_joint_waits_and_starts_from_where_the_joint_is_then(motion):
    first = motion.glide(YAW, to=1.0)
    second = motion.glide(YAW, to=0.0, duration=2.0)
    motion.run(1.0)
    assert first.finished
    motion.run(1.0)
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(1.0)
    assert second.finished
    assert motion.angle(YAW) == 0.0


def test_tasks_on_other_joints_run_beside_each_other(motion):
    motion.glide(YAW, to=1.0)
    motion.glide(PITCH, to=0.4)
    motion.run(0.5)
    assert (motion.angle(YAW), motion.angle(PITCH)) == pytest.approx((0.5, 0.2))


def test_nobody_overtakes_a_task_that_waits(motion):
    motion.glide(YAW, to=1.0)
    motion.glide(YAW, PITCH, to=0.2)
    late = motion.glide(PITCH, to=0.4)
    motion.run(1.5)
    assert not late.finished
    assert motion.angle(PITCH) == pytest.approx(0.1)
    motion.run(1.5)
    assert late.finished
    assert motion.angle(PITCH) == 0.4


def test_a_killed_task_leaves_its_joints_there_and_lets_the_next_one_start(motion):
    first = motion.glide(YAW, to=1.0)
    second = motion.glide(YAW, to=0.0)
    motion.run(0.5)
    assert first.kill()
    assert first.killed and first.finished
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(1.0)
    assert second.finished
    assert motion.angle(YAW) == 0.0


def test_a_task_that_still_waits_can_be_killed(motion):
    motion.glide(YAW, to=1.0)
    waiting = motion.glide(YAW, to=0.0)
    motion.run(0.1)
    assert waiting.kill()
    motion.run(5.0)
    assert motion.angle(YAW) == 1.0


def test_a_task_that_asks_too_much_speed_ends_late_but_where_it_should(motion):
    top_speed = MODEL.joints[YAW].max_velocity
    task = motion.glide(YAW, to=2.0, duration=0.05)
    motion.run(0.1)
    assert not task.finished
    assert motion.angle(YAW) <= 0.1 * top_speed + 1e-9
    motion.run(0.2)
    assert task.finished
    assert motion.angle(YAW) == 2.0


def test_a_task_beyond_a_limit_ends_at_the_limit(motion):
    task = motion.glide(PITCH, to=3.0)
    motion.run(1.0)
    assert task.finished
    assert motion.angle(PITCH) == MODEL.joints[PITCH].upper


def test_different_wishes_for_the_two_hips_end_where_the_left_one_asks(motion):
    def build(commands):
        return {i: SmoothCurve((0.0, 1.0), (commands[i], to)) for i, to in ((LEFT, -0.2), (RIGHT, -0.1))}

    task = motion.engine.follow("glide", [LEFT, RIGHT], build)
    motion.run(1.0)
    assert task.finished
    assert motion.angle(LEFT) == motion.angle(RIGHT) == -0.2


def test_a_task_of_the_right_hip_ends_after_one_of_the_left_hip_has_let_go(motion):
    left, right = motion.glide(LEFT, to=-0.2), motion.glide(RIGHT, to=0.1, duration=0.5)
    motion.run(1.0)
    assert left.finished and not right.finished
    assert motion.angle(LEFT) == motion.angle(RIGHT) == -0.2
    motion.run(0.2)
    assert right.finished
    assert motion.angle(LEFT) == motion.angle(RIGHT) == 0.1


# --- targets ----------------------------------------------------------------------------------------------------------


def test_a_target_is_approached_at_its_speed(motion):
    motion.engine.set_targets({YAW: 1.0}, {YAW: 2.0})
    motion.run(0.25)
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(0.25)
    assert motion.angle(YAW) == pytest.approx(1.0)
    motion.run(1.0)
    assert motion.angle(YAW) == 1.0


def test_a_newer_target_replaces_an_older_one(motion):
    motion.engine.set_targets({YAW: 1.0}, {YAW: 1.0})
    motion.run(0.5)
    motion.engine.set_targets({YAW: 0.0}, {YAW: 0.5})
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.25)
    assert motion.engine.target_of(YAW) == 0.0


def test_a_target_beyond_a_limit_is_moved_into_it(motion):
    motion.engine.set_targets({PITCH: 3.0}, {PITCH: 5.0})
    assert motion.engine.target_of(PITCH) == MODEL.joints[PITCH].upper


def test_without_a_target_a_joint_heads_for_its_command(motion):
    motion.joints.hold([0.3] * 26, [YAW])
    assert motion.engine.target_of(YAW) == 0.3


def test_a_target_gives_way_to_a_task(motion):
    motion.engine.set_targets({YAW: -1.0}, {YAW: 1.0})
    motion.run(0.1)
    motion.glide(YAW, to=1.0)
    motion.run(2.0)
    assert motion.angle(YAW) == 1.0


def test_a_target_set_while_a_task_holds_the_joint_is_taken_up_afterwards(motion):
    motion.glide(YAW, to=1.0)
    motion.run(0.5)
    motion.engine.set_targets({YAW: 0.0}, {YAW: 1.0})
    motion.run(0.5)
    assert motion.angle(YAW) == 1.0
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.5)


# --- stiffness --------------------------------------------------------------------------------------------------------


def test_stiffness_changes_along_a_curve_beside_a_motion_of_the_same_joint(motion):
    moving, stiffening = motion.glide(YAW, to=1.0), motion.stiffen(YAW, to=0.8)
    motion.run(0.5)
    assert motion.joints.stiffnesses[YAW] == pytest.approx(0.4)
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(0.5)
    assert moving.finished and stiffening.finished
    assert motion.joints.stiffnesses[YAW] == 0.8


def test_stiffness_set_at_once_ends_stiffness_tasks_but_no_motion(motion):
    moving, stiffening, other = motion.glide(YAW, to=1.0), motion.stiffen(YAW, to=1.0), motion.stiffen(PITCH, to=1.0)
    motion.run(0.2)
    motion.engine.set_stiffness_now({YAW: 0.3})
    assert stiffening.killed and not other.finished and not moving.finished
    motion.run(0.2)
    assert motion.joints.stiffnesses[YAW] == 0.3


# --- looking and killing ----------------------------------------------------------------------------------------------


def test_a_joint_is_busy_from_the_call_to_the_end_of_the_last_motion_task(motion):
    motion.stiffen(PITCH, to=1.0)
    motion.glide(YAW, to=1.0)
    assert motion.engine.busy([PITCH, YAW]) and not motion.engine.busy([PITCH])
    motion.run(1.0)
    assert not motion.engine.busy([YAW])


def test_kill_using_stops_tasks_and_targets_of_these_joints_only(motion):
    task, other = motion.glide(YAW, to=1.0), motion.glide(PITCH, to=0.4)
    stiffening = motion.stiffen(YAW, to=1.0)
    motion.run(0.5)
    motion.engine.set_targets({YAW: -1.0}, {YAW: 1.0})
    motion.engine.kill_using([YAW])
    motion.run(1.0)
    assert task.killed and not other.killed and not stiffening.killed
    assert motion.angle(YAW) == pytest.approx(0.5)
    assert motion.angle(PITCH) == 0.4


def test_kill_all_ends_everything(motion):
    tasks = [motion.glide(YAW, to=1.0), motion.glide(YAW, to=0.5), motion.stiffen(YAW, to=1.0)]
    motion.engine.set_targets({PITCH: 0.4}, {PITCH: 1.0})
    motion.run(0.1)
    before = motion.joints.commands
    motion.engine.kill_all()
    motion.run(0.5)
    assert all(task.killed for task in tasks)
    assert motion.joints.commands == before


def test_a_ramp_as_curve_ends_when_it_arrives(motion):
    task = motion.engine.follow("ramp", [YAW], lambda commands: {YAW: Ramp(commands[YAW], 0.5, 1.0)})
    motion.run(0.49)
    assert not task.finished
    motion.run(0.02)
    assert task.finished
    assert motion.angle(YAW) == 0.5


# --- what keeps commands from their goals -----------------------------------------------------------------------------


def test_a_target_is_kept_up_while_the_joint_may_not_go_as_fast_as_asked(motion):
    motion.joints.speed_shares = {YAW: 0.1}
    motion.engine.set_targets({YAW: 1.0}, {YAW: 5.0})
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.05 * MODEL.joints[YAW].max_velocity)
    motion.run(1.5)
    assert motion.angle(YAW) == 1.0
    assert motion.engine.target_of(YAW) == 1.0


def test_motion_ends_where_a_guard_keeps_it_and_goes_on_when_it_lets_go(motion):
    """A guard as of the arms, at 0.3 rad."""
    motion.joints.guard = lambda before, after: {YAW} if after[YAW] > 0.3 else ()
    task = motion.glide(YAW, to=1.0)
    motion.run(1.0)
    assert task.finished and not task.killed
    assert 0.25 < motion.angle(YAW) <= 0.3
    motion.engine.set_targets({YAW: 0.6, PITCH: 0.2}, {YAW: 1.0, PITCH: 1.0})
    motion.run(2.0)
    assert motion.angle(YAW) <= 0.3 and motion.angle(PITCH) == 0.2
    motion.engine.set_targets({YAW: 0.0}, {YAW: 1.0})
    motion.run(1.0)
    assert motion.angle(YAW) == 0.0


def test_idle_joints_are_moved_by_whoever_minds_them_and_everybody_else_comes_first(motion):
    class Nodding:
        seen = []

        def wishes(self, busy, dt):
            self.seen.append(busy)
            return {} if PITCH in busy else {PITCH: 0.1}

    motion.engine.idle = Nodding()
    motion.run(0.1)
    assert motion.angle(PITCH) == 0.1
    motion.glide(PITCH, to=0.3, duration=0.5)
    motion.engine.set_targets({YAW: 0.5}, {YAW: 1.0})
    motion.run(0.45)
    assert motion.angle(PITCH) > 0.25
    assert {PITCH, YAW} == set(Nodding.seen[-1])
    motion.run(0.5)
    assert motion.angle(PITCH) == 0.1

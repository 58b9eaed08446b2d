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

    def stiffen(self, joint, to):
        return self.engine.stiffen("stiffen", [joint], lambda now: {joint: SmoothCurve((0.0, 1.0), (now[joint], to))})

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


def test_tasks_of_a_joint_wait_for_each_other_and_nobody_overtakes_one_that_waits(motion):
    first, both = motion.glide(YAW, to=1.0, name="a"), motion.glide(YAW, PITCH, to=0.2, name="b")
    late, beside = motion.glide(PITCH, to=0.4), motion.glide(ELBOW, to=-1.0)
    assert motion.engine.tasks() == [first, both, late, beside]
    assert [(t.name, t.task_id) for t in (first, both)] == [("a", 1), ("b", 2)]
    motion.run(0.5)
    assert (motion.angle(YAW), motion.angle(PITCH)) == pytest.approx((0.5, 0.0))
    assert motion.angle(ELBOW) < -0.4
    motion.run(1.0)
    assert first.finished and not late.finished
    assert (motion.angle(YAW), motion.angle(PITCH)) == pytest.approx((0.6, 0.1)), "from where the joints were then"
    motion.run(1.5)
    assert late.finished and motion.angle(PITCH) == 0.4


def test_a_killed_task_leaves_its_joints_there_and_lets_the_next_one_start(motion):
    first, waiting, last = (motion.glide(YAW, to=to) for to in (1.0, -1.0, 0.0))
    motion.run(0.5)
    assert waiting.kill() and first.kill() and first.killed and first.finished
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(1.0)
    assert last.finished and motion.angle(YAW) == 0.0


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


def test_a_target_is_approached_at_its_speed_until_a_newer_one_replaces_it(motion):
    motion.aim(YAW, 1.0, 2.0)
    motion.run(0.25)
    assert motion.angle(YAW) == pytest.approx(0.5)
    motion.run(1.0)
    assert motion.angle(YAW) == 1.0
    motion.aim(YAW, -1.0, 1.0)
    motion.run(0.5)
    motion.aim(YAW, 0.0, 0.5)
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.25) and motion.engine.target_of(YAW) == 0.0
    motion.aim(PITCH, 3.0, 5.0)
    assert motion.engine.target_of(PITCH) == MODEL.joints[PITCH].upper
    motion.joints.hold([0.3] * 26, [RIGHT])
    assert motion.engine.target_of(RIGHT) == 0.3, "without a target it heads for its command"


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


# --- stiffness, looking, killing


def test_stiffness_changes_beside_a_motion_and_set_at_once_ends_stiffness_tasks_only(motion):
    moving, stiffening, other = motion.glide(YAW, to=1.0), motion.stiffen(YAW, to=0.8), motion.stiffen(PITCH, to=1.0)
    motion.run(0.5)
    assert motion.joints.stiffnesses[YAW] == pytest.approx(0.4) and motion.angle(YAW) == pytest.approx(0.5)
    assert motion.engine.busy([PITCH, YAW]) and not motion.engine.busy([PITCH])
    motion.engine.set_stiffness_now({YAW: 0.3})
    assert stiffening.killed and not other.finished and not moving.finished
    motion.run(0.5)
    assert moving.finished and not moving.killed and motion.joints.stiffnesses[YAW] == 0.3
    assert other.finished and motion.joints.stiffnesses[PITCH] == 1.0 and not motion.engine.busy([YAW])


def test_kill_using_stops_tasks_and_targets_of_these_joints_only_and_kill_all_everything(motion):
    task, other, stiffening = motion.glide(YAW, to=1.0), motion.glide(PITCH, to=0.4), motion.stiffen(YAW, to=1.0)
    motion.run(0.5)
    motion.aim(YAW, -1.0, 1.0)
    motion.engine.kill_using([YAW])
    motion.run(1.0)
    assert task.killed and not other.killed and not stiffening.killed
    assert (motion.angle(YAW), motion.angle(PITCH)) == (pytest.approx(0.5), 0.4)
    tasks = [motion.glide(YAW, to=1.0), motion.glide(YAW, to=0.5), motion.stiffen(YAW, to=0.0)]
    motion.aim(PITCH, 0.0, 1.0)
    motion.run(0.1)
    before = motion.joints.commands
    motion.engine.kill_all()
    motion.run(0.5)
    assert all(task.killed for task in tasks) and motion.joints.commands == before


# --- what keeps commands from their goals


def test_a_target_is_kept_up_while_the_joint_may_not_go_as_fast_as_asked(motion):
    motion.joints.speed_shares = {YAW: 0.1}
    motion.aim(YAW, 1.0, 5.0)
    motion.run(0.5)
    assert motion.angle(YAW) == pytest.approx(0.05 * MODEL.joints[YAW].max_velocity)
    motion.run(1.5)
    assert motion.angle(YAW) == motion.engine.target_of(YAW) == 1.0


def test_motion_ends_where_a_guard_keeps_it_and_goes_on_when_it_lets_go(motion):
    motion.joints.guard = lambda before, after: {YAW} if after[YAW] > 0.3 else ()
    task = motion.glide(YAW, to=1.0)
    motion.run(1.0)
    assert task.finished and not task.killed and 0.25 < motion.angle(YAW) <= 0.3
    motion.engine.set_targets({YAW: 0.6, PITCH: 0.2}, {YAW: 1.0, PITCH: 1.0})
    motion.run(2.0)
    assert motion.angle(YAW) <= 0.3 and motion.angle(PITCH) == 0.2
    motion.aim(YAW, 0.0, 1.0)
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
    motion.aim(YAW, 0.5, 1.0)
    motion.run(0.45)
    assert motion.angle(PITCH) > 0.25 and {PITCH, YAW} == set(Nodding.seen[-1])
    motion.run(0.5)
    assert motion.angle(PITCH) == 0.1


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


def test_key_frames_that_are_too_fast_are_told_with_the_least_time(motion, caplog):
    class Still:
        duration = 0.1

        def value(self, elapsed):
            return 0.0

    motion.engine.follow("still", [PITCH], lambda now: {PITCH: Still()})  # says nothing about its range
    task, top = motion.glide(YAW, to=2.0, duration=0.1), MODEL.joints[YAW].max_velocity
    motion.run(1.0)
    (record,) = caplog.records
    assert record.levelname == "WARNING"
    assert record.getMessage().startswith(f"glide: HeadYaw would need 30.00 rad/s and has {top:.2f}")
    assert f"takes {3.0 / top:.2f} s at least" in record.getMessage()
    assert task.finished and motion.engine.target_of(YAW) == 2.0

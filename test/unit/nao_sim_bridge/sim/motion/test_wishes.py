"""What cannot be done as it was asked is said once, with joint, wish and limit."""

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
YAW, PITCH = MODEL.joint_index["HeadYaw"], MODEL.joint_index["HeadPitch"]


@pytest.fixture
def engine():
    return MotionEngine(JointCommands(MODEL, [0.0] * 26), TaskIds())


@pytest.fixture
def told(engine, caplog):
    """Lets commands run for a second; the levels and texts of the log."""
    caplog.set_level(logging.INFO, "nao_sim.motion")

    def run():
        for tick in range(1, 101):
            engine.tick(tick * DT, DT)
        return [(record.levelname, record.getMessage()) for record in caplog.records]

    return run


def follow(engine, **ends):
    def build(commands):
        return {MODEL.joint_index[n]: SmoothCurve((0.0, 0.9), (0.0, end)) for n, end in ends.items()}

    return engine.follow("angleInterpolation", [MODEL.joint_index[name] for name in ends], build)


def test_a_wish_within_the_limits_is_not_worth_a_word(engine, told):
    follow(engine, HeadYaw=0.5, HeadPitch=0.2)
    engine.set_targets({2: 0.1}, {2: 1.0})
    assert told() == []


def test_a_target_beyond_a_limit_is_told_once(engine, told):
    engine.set_targets({YAW: 3.0}, {YAW: 9.0})
    assert told() == [("WARNING", "setAngles: HeadYaw 3.000 is above 2.086")]


def test_all_joints_of_a_task_are_told_in_one_line(engine, told):
    follow(engine, HeadYaw=-3.0, LElbowRoll=0.5)
    (only,) = told()
    assert only == ("WARNING", "angleInterpolation: HeadYaw -3.000 is below -2.086; LElbowRoll 0.500 is above -0.035")


def test_a_limit_that_another_joint_of_the_same_task_sets_is_told(engine, told):
    follow(engine, HeadYaw=1.5, HeadPitch=0.5)
    upper = MODEL.coupled_limits["HeadPitch"].limits_at(1.5)[1]
    assert told() == [("WARNING", f"angleInterpolation: HeadPitch 0.500 is above {upper:.3f}")]


def test_key_frames_that_are_too_fast_are_told_with_the_least_time(engine, told):
    top = MODEL.joints[YAW].max_velocity
    task = engine.follow("glide", [YAW], lambda c: {YAW: SmoothCurve((0.0, 0.1), (0.0, 2.0))})
    ((level, text),) = told()
    assert level == "WARNING"
    assert text.startswith(f"glide: HeadYaw would need 30.00 rad/s and has {top:.2f}")
    assert f"takes {3.0 / top:.2f} s at least" in text
    assert task.finished
    assert engine.target_of(YAW) == 2.0


def test_without_notifications_it_is_mere_information(engine, told):
    engine.notices.enabled = False
    engine.set_targets({YAW: 3.0}, {YAW: 9.0})
    assert [level for level, _ in told()] == ["INFO"]


def test_curves_that_say_nothing_about_their_range_pass(engine, told):
    class Still:
        duration = 0.1

        def value(self, elapsed):
            return 0.0

    engine.follow("still", [YAW], lambda c: {YAW: Still()})
    engine.follow("ramp", [PITCH], lambda c: {PITCH: Ramp(0.0, 0.2, 1.0)})
    assert told() == []

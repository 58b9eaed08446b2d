"""What a walk answers to a body beside its plan: on a robot that stands still, tilted as one likes."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from nao_sim_bridge.sim.model import load_model
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.walk.body import WalkingBody
from nao_sim_bridge.sim.walk.feedback import WalkFeedback
from nao_sim_bridge.sim.walk.settings import load_walk_settings
from nao_sim_bridge.sim.walk.walker import Readings, Walker

MODEL = load_model()
BODY = WalkingBody(MODEL)
SETTINGS = load_walk_settings()
STANCE = posture(MODEL, "StandInit")
# Pitch of the torso with both soles flat, rad.
FLAT = 0.1
DT = 1.0 / 120.0
LOADS = (26.0, 26.0)


@pytest.fixture
def standing():
    """A walker that has its stance, and feedback of the same plan that has seen nothing yet."""
    walker = Walker(BODY, SETTINGS, 9.81, STANCE)
    return walker, WalkFeedback(SETTINGS, BODY, walker.plan.omega)


def look(walker, feedback, lean=0.0, roll=0.0, gyro=(0.0, 0.0), ticks=1, share=1.0):
    for _ in range(ticks):
        feedback.update(
            walker.plan, BODY.leg_pose(STANCE), BODY.upper_moment(STANCE), (roll, FLAT + lean), gyro, DT, share
        )


def test_a_body_that_leans_ahead_is_shifted_back(standing):
    walker, feedback = standing
    look(walker, feedback, lean=0.0)
    before = feedback.shift
    look(walker, feedback, lean=0.1, ticks=10)
    assert feedback.error[0] > 0.015
    assert feedback.shift[0] < before[0] - 0.003


def test_shifts_stay_within_their_limit(standing):
    walker, feedback = standing
    look(walker, feedback, lean=0.6, roll=0.4, ticks=60)
    assert math.hypot(*feedback.shift) <= math.sqrt(2.0) * SETTINGS.shift_limit + 1e-9
    assert abs(feedback.shift[0]) == pytest.approx(SETTINGS.shift_limit, rel=0.01)


def test_ankles_work_against_the_turn_as_far_as_the_walk_has_begun(standing):
    walker, feedback = standing
    look(walker, feedback, gyro=(0.5, -1.0), share=0.5)
    assert feedback.ankle == pytest.approx((0.25 * SETTINGS.ankle_damping, -0.5 * SETTINGS.ankle_damping))


def test_an_error_that_is_always_there_is_no_error_after_a_while(standing):
    walker, feedback = standing
    look(walker, feedback)
    look(walker, feedback, lean=0.05, ticks=30)
    first = feedback.error[0] - 0.0
    assert first > 0.005
    look(walker, feedback, lean=0.05, ticks=round(4.0 * SETTINGS.habit_time / DT))
    assert abs(feedback.error[0]) < 0.2 * first


def test_a_large_error_is_not_learned(standing):
    walker, feedback = standing
    look(walker, feedback)
    look(walker, feedback, lean=0.3, ticks=60)
    early = feedback.error[0]
    assert early > SETTINGS.habit_within
    look(walker, feedback, lean=0.3, ticks=600)
    assert feedback.error[0] == pytest.approx(early, rel=0.1)


def test_a_walk_slows_down_as_the_body_comes_off_and_stops_when_it_is_far_off():
    walker = Walker(BODY, replace(SETTINGS, stance_time=DT), 9.81, STANCE)
    walker.tick(Readings(STANCE, (0.0, FLAT), (0.0, 0.0), LOADS), STANCE, DT)
    walker.feedback.error = (0.0, 0.0)
    assert walker.haste == 1.0
    walker.feedback.error = (SETTINGS.calm_from + 0.5 * SETTINGS.calm_range, 0.0)
    assert walker.haste == pytest.approx(0.5)
    walker.feedback.error = (0.0, -SETTINGS.calm_from - 2.0 * SETTINGS.calm_range)
    assert walker.haste == 0.0

"""Recorded motions: faster, mirrored, thinned out, and read from files."""

from __future__ import annotations

import math

import pytest

from nao_library_modules.errors import BadGoal
from nao_library_modules.recorded_motion import RecordedMotion, motion_of, recorded

MOTION = RecordedMotion(("HeadYaw", "LElbowRoll", "RHand"), (0.0, 1.0), ((0.5, -1.0, 0.0), (0.0, -0.5, 1.0)))


def test_samples_begin_at_time_0():
    motion = recorded(["HeadYaw"], [(12.5, [0.1]), (13.0, [0.2])])
    assert (motion.times, motion.angles, motion.duration) == ((0.0, 0.5), ((0.1,), (0.2,)), 0.5)
    assert motion.start == {"HeadYaw": 0.1}


def test_twice_as_fast_takes_half_the_time():
    assert MOTION.faster(2.0).times == (0.0, 0.5)


def test_the_mirror_exchanges_sides_and_turns_roll_and_yaw_round():
    mirrored = MOTION.mirrored()
    assert mirrored.joints == ("HeadYaw", "RElbowRoll", "LHand")
    assert mirrored.angles == ((-0.5, 1.0, 0.0), (-0.0, 0.5, 1.0))
    assert mirrored.mirrored() == MOTION


@pytest.mark.parametrize("joint", ["LHipYawPitch", "LShoulderPitch", "LKneePitch", "LHand", "HeadPitch"])
def test_pitch_and_hands_keep_their_sign_in_the_mirror(joint):
    assert RecordedMotion((joint,), (0.0,), ((0.25,),)).mirrored().angles == ((0.25,),)


def test_a_straight_line_needs_two_key_frames():
    times = tuple(i / 10.0 for i in range(11))
    line = RecordedMotion(("a", "b"), times, tuple((t, -2.0 * t) for t in times))
    assert line.key_frames().times == (0.0, 1.0)


@pytest.mark.parametrize("tolerance", [math.radians(0.2), 0.05])
def test_between_key_frames_no_sample_is_farther_off_than_allowed(tolerance):
    times = tuple(i / 50.0 for i in range(151))
    wave = RecordedMotion(("a",), times, tuple((math.sin(3.0 * t),) for t in times))
    thin = wave.key_frames(tolerance)
    assert len(thin.times) < len(times) / 2
    for time, (angle,) in zip(wave.times, wave.angles):
        after = next(i for i, t in enumerate(thin.times) if t >= time)
        before = max(after - 1, 0)
        span = thin.times[after] - thin.times[before]
        share = 0.0 if span == 0.0 else (time - thin.times[before]) / span
        line = thin.angles[before][0] + share * (thin.angles[after][0] - thin.angles[before][0])
        assert abs(line - angle) <= tolerance + 1e-12


@pytest.mark.parametrize("angle, within", [(0.2, 0.2), (0.51, 0.5), (-1.02, -1.0), (0.6, 0.6), (-1.1, -1.1)])
def test_angles_a_little_beyond_a_limit_are_put_on_it(angle, within):
    motion = RecordedMotion(("a", "b"), (0.0,), ((angle, 9.0),))
    assert motion.within({"a": (-1.0, 0.5)}, slack=0.03).angles == ((within, 9.0),)


def test_one_sample_is_a_motion():
    motion = RecordedMotion(("a",), (0.0,), ((0.5,),))
    assert motion.key_frames() == motion


def test_what_is_written_is_read():
    assert motion_of(MOTION.to_content(), "wave") == MOTION


@pytest.mark.parametrize("version", [{}, {"version": 2}, {"version": "x"}])
def test_a_file_of_another_version_is_told(version):
    content = {"joints": ["a"], "samples": [[0.0, 1.0]], **version}
    with pytest.raises(BadGoal, match="motion 'wave': its version is .*; known: 1"):
        motion_of(content, "wave")


@pytest.mark.parametrize(
    "content, problem",
    [
        (None, "no joints or no samples"),
        ({"joints": ["a"]}, "no joints or no samples"),
        ({"joints": [], "samples": [[0.0]]}, "no list of names"),
        ({"joints": ["a", "a"], "samples": [[0.0, 1.0, 1.0]]}, "comes twice"),
        ({"joints": ["a"], "samples": []}, "samples is no list"),
        ({"joints": ["a"], "samples": [[0.0, 1.0], [0.5]]}, "sample 1"),
        ({"joints": ["a"], "samples": [[0.0, "x"]]}, "sample 0"),
        ({"joints": ["a"], "samples": [[0.0, math.nan]]}, "sample 0"),
        ({"joints": ["a"], "samples": [[0.1, 1.0]]}, "do not rise from 0"),
        ({"joints": ["a"], "samples": [[0.0, 1.0], [0.0, 1.0]]}, "do not rise from 0"),
    ],
)
def test_a_broken_file_is_told_with_what_is_wrong(content, problem):
    if content is not None:
        content = {"version": 1, **content}
    with pytest.raises(BadGoal, match=f"motion 'wave': .*{problem}"):
        motion_of(content, "wave")

"""Recorded motions: faster, mirrored, thinned out, read from files, kept in a folder."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_library_modules.core.errors import BadGoal
from nao_library_modules.motion.recorded_motion import MotionStore, RecordedMotion, motion_of, recorded

MOTION = RecordedMotion(("HeadYaw", "LElbowRoll", "RHand"), (0.0, 1.0), ((0.5, -1.0, 0.0), (0.0, -0.5, 1.0)))


def test_samples_begin_at_time_0_and_can_be_faster_and_within_limits():
    motion = recorded(["HeadYaw"], [(12.5, [0.1]), (13.0, [0.2])])
    assert (motion.times, motion.angles, motion.duration) == ((0.0, 0.5), ((0.1,), (0.2,)), 0.5)
    assert motion.start == {"HeadYaw": 0.1} and MOTION.faster(2.0).times == (0.0, 0.5)
    for angle, within in ((0.2, 0.2), (0.51, 0.5), (-1.02, -1.0), (0.6, 0.6), (-1.1, -1.1)):
        motion = RecordedMotion(("a", "b"), (0.0,), ((angle, 9.0),))
        assert motion.within({"a": (-1.0, 0.5)}, slack=0.03).angles == ((within, 9.0),)


def test_the_mirror_exchanges_sides_and_turns_roll_and_yaw_round():
    mirrored = MOTION.mirrored()
    assert mirrored.joints == ("HeadYaw", "RElbowRoll", "LHand")
    assert mirrored.angles == ((-0.5, 1.0, 0.0), (-0.0, 0.5, 1.0)) and mirrored.mirrored() == MOTION
    for joint in ("LHipYawPitch", "LShoulderPitch", "LKneePitch", "LHand", "HeadPitch"):
        assert RecordedMotion((joint,), (0.0,), ((0.25,),)).mirrored().angles == ((0.25,),)


@given(st.lists(st.floats(-2.0, 2.0), min_size=1, max_size=60), st.sampled_from([math.radians(0.2), 0.05, 0.5]))
@settings(max_examples=50)
def test_between_key_frames_no_sample_is_farther_off_than_allowed(angles, tolerance):
    wave = RecordedMotion(("a",), tuple(i / 50.0 for i in range(len(angles))), tuple((a,) for a in angles))
    thin = wave.key_frames(tolerance)
    assert set(thin.times) <= set(wave.times) and thin.times[-1] == wave.times[-1]
    line = RecordedMotion(("a", "b"), (0.0, 0.5, 1.0), ((0.0, 0.0), (0.5, -1.0), (1.0, -2.0)))
    assert line.key_frames().times == (0.0, 1.0)
    for time, (angle,) in zip(wave.times, wave.angles):
        after = next(i for i, t in enumerate(thin.times) if t >= time)
        before = max(after - 1, 0)
        span = thin.times[after] - thin.times[before]
        share = 0.0 if span == 0.0 else (time - thin.times[before]) / span
        line = thin.angles[before][0] + share * (thin.angles[after][0] - thin.angles[before][0])
        assert abs(line - angle) <= tolerance + 1e-9


def test_what_is_written_is_read_and_a_broken_file_is_told_with_what_is_wrong():
    assert motion_of(MOTION.to_content(), "wave") == MOTION
    with pytest.raises(BadGoal, match="motion 'wave': its version is .*; known: 1"):
        motion_of({"joints": ["a"], "samples": [[0.0, 1.0]], "version": 2}, "wave")
    for content, problem in (
        ({"joints": ["a"]}, "no joints or no samples"), ({"joints": [], "samples": [[0.0]]}, "no list of names"),
        ({"joints": ["a", "a"], "samples": [[0.0, 1.0, 1.0]]}, "comes twice"),
        ({"joints": ["a"], "samples": [[0.0, 1.0], [0.5]]}, "sample 1"),
        ({"joints": ["a"], "samples": [[0.0, math.nan]]}, "sample 0"),
        ({"joints": ["a"], "samples": [[0.1, 1.0]]}, "do not rise from 0"),
        ({"joints": ["a"], "samples": [[0.0, 1.0], [0.0, 1.0]]}, "do not rise from 0"),
    ):  # fmt: skip
        with pytest.raises(BadGoal, match=f"motion 'wave': .*{problem}"):
            motion_of(content and {"version": 1, **content}, "wave")


@pytest.fixture
def store(tmp_path):
    return MotionStore(tmp_path / "motions")


def test_motions_are_saved_listed_renamed_and_deleted(store):
    assert store.names() == []
    with pytest.raises(BadGoal, match="none is recorded"):
        store.load("wave")
    store.save("wave", MOTION.faster(2.0))
    store.save("wave", MOTION)
    store.save("Bow 2", MOTION)
    assert store.load("wave") == MOTION and store.names() == ["Bow 2", "wave"]
    assert sorted(path.name for path in store.folder.iterdir()) == ["Bow 2.yaml", "wave.yaml"], "no draft is left"
    with pytest.raises(BadGoal, match="no motion 'wafe': did you mean 'wave'"):
        store.load("wafe")
    with pytest.raises(BadGoal, match="there is a motion 'Bow 2' already"):
        store.rename("wave", "Bow 2")
    store.rename("wave", "greet")
    store.delete("Bow 2")
    assert store.names() == ["greet"]
    for name in ("", "../wave", ".hidden", "wave\n"):
        for action in (store.load, store.delete, lambda n: store.save(n, MOTION), lambda n: store.rename(n, "x")):
            with pytest.raises(BadGoal, match="is no name for a motion"):
                action(name)
    store.path("greet").write_text("joints: [a]\n")
    with pytest.raises(BadGoal, match="motion 'greet'"):
        store.load("greet")

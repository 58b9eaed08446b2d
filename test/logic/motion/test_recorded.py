"""Recorded motions: faster, mirrored, thinned out, read from files, kept in a folder; walks that were watched."""

from __future__ import annotations

import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from nao_library_modules.errors import BadGoal
from nao_library_modules.motion_store import MotionStore
from nao_library_modules.recorded_motion import RecordedMotion, motion_of, recorded
from nao_library_modules.walk_picture import FILLS, MASS, PRESSURE, SOLE, draw, outline
from nao_library_modules.walk_record import LEFT, RIGHT, Sample, WalkRecordError, footprints, load, save

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


# The folder


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


# Walks


def sample(left=0.0, right=0.0, loads=(2.5, 2.5), planned=("", (0.0, 0.0, 0.0)), turn=0.0):
    """Feet at these distances ahead, 0.1 m apart; the centre of mass between them."""
    centres = ((0.02, 0.0), (0.02, 0.0))
    return Sample((left, 0.05, turn), (right, -0.05, 0.0), ((left + right) / 2.0, 0.0), loads, centres, planned)


# The right foot swings 8 cm ahead, then the left one to its side.
WALK = [
    sample(), sample(right=0.04, loads=(5.0, 0.0), planned=(RIGHT, (0.081, -0.05, 0.0))),
    sample(right=0.08, loads=(4.5, 0.5)), sample(right=0.079), sample(right=0.08, loads=(0.1, 4.9)),
    sample(left=0.05, right=0.08, loads=(0.0, 5.0), planned=(LEFT, (0.082, 0.05, 0.0))), sample(left=0.08, right=0.08),
]  # fmt: skip


def test_feet_leave_prints_where_they_stand_and_pressure_by_what_they_carry():
    prints = footprints(WALK)
    assert [(each.foot, each.place[0]) for each in prints] == [(LEFT, 0.0), (RIGHT, 0.0), (RIGHT, 0.08), (LEFT, 0.08)]
    assert [each.planned and each.planned[0] for each in prints] == [None, None, 0.081, 0.082]
    assert [each.foot for each in footprints([sample(), sample(turn=0.3)])] == [LEFT, RIGHT, LEFT], "a turn is a step"
    for loads, place in (((5.0, 0.0), 0.05), ((2.5, 2.5), 0.0), ((1.0, 3.0), -0.025)):
        assert sample(loads=loads).pressure == pytest.approx((0.02, place))
    assert sample(loads=(0.0, 0.0)).pressure is None


def test_a_record_comes_back_as_it_was_and_another_file_is_refused(tmp_path):
    path = tmp_path / "walk.json"
    save(WALK, path)
    assert load(path) == WALK
    for text, problem in (("[]", "format"), (json.dumps({"format": "nao_walk_record"}), "samples")):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(WalkRecordError, match=f"walk.json.*{problem}"):
            load(path)


def test_the_picture_is_to_scale_and_shows_everything():
    picture = draw(WALK)
    pixels = list(picture.getdata())
    assert {*FILLS.values(), MASS, PRESSURE} <= set(pixels)
    # The soles cover what they cover on the ground, at equal scale in both directions.
    columns = [i % picture.width for i, pixel in enumerate(pixels[: picture.width * 300]) if pixel == FILLS[LEFT]]
    rows = [i // picture.width for i, pixel in enumerate(pixels) if pixel == FILLS[LEFT]]
    xs, ys = zip(*SOLE)
    wanted = (max(xs) - min(xs) + 0.08) / (max(ys) - min(ys))
    assert (max(columns) - min(columns)) / (max(rows) - min(rows)) == pytest.approx(wanted, rel=0.1)
    left, right = outline(LEFT, (0.0, 0.0, 0.0)), outline(RIGHT, (0.0, 0.0, 0.0))
    assert [(x, -y) for x, y in left] == right, "mirror images"
    assert outline(LEFT, (1.0, 2.0, math.pi / 2.0)) == [pytest.approx((1.0 - y, 2.0 + x)) for x, y in left]
    with pytest.raises(ValueError, match="without a sample"):
        draw([])

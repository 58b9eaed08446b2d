"""Motions recorded from the joints, replayed, mirrored, kept under names."""

import pytest
from goal_functions import motion as f

from nao_library_modules.motion.recorded_motion import RecordedMotion

NEAR = 0.03
WAVE = RecordedMotion(("RShoulderRoll",), (0.0, 1.0, 2.0), ((-0.5,), (-1.0,), (-0.6,)))


def record(name="turn", **fields):
    return f("recordMotion", str_param=name, **{"names": ["Head"], "duration": 60.0, **fields})


def play(name="turn", **fields):
    return f("playMotion", str_param=name, **fields)


@pytest.fixture
def store(motion):
    return motion.module.recordings.store


def test_what_somebody_else_moves_is_recorded_replayed_and_mirrored(stiff_robot, motion, store, angle):
    goal = motion.send(record(rate=20.0))
    stiff_robot.finish("ALMotion", "angleInterpolation", ["HeadYaw"], [0.6], [1.0], True, after=1.5)
    assert goal.cancel().state == "preempted"
    turn = store.load("turn")
    assert turn.joints == ("HeadYaw", "HeadPitch") and motion.succeed(f("listMotions")).memList == ["turn"]
    assert turn.duration == pytest.approx(1.5, abs=0.2) and 20 < len(turn.times) <= 36
    assert (turn.angles[0][0], turn.angles[-1][0]) == (pytest.approx(0.0, abs=NEAR), pytest.approx(0.6, abs=NEAR))
    motion.succeed(f("setAngles", 1.0, names=["HeadYaw"], angles=[0.0]))
    result = motion.succeed(play(speed=2.0))
    assert angle("HeadYaw") == pytest.approx(0.6, abs=0.06) and "HeadYaw" in result.name
    motion.succeed(play(mirror=True))
    assert angle("HeadYaw") == pytest.approx(-0.6, abs=0.06)


def test_joints_that_are_taught_by_hand_are_limp_meanwhile_and_stiff_again_where_they_are(robot, motion, store):
    robot.ALMotion.setStiffnesses(["HeadYaw", "HeadPitch"], [0.8, 0.0])
    robot.ALMotion.setAngles("HeadYaw", 1.5, 0.03)
    goal = motion.send(record(limp=True))
    robot.advance(0.5)
    assert robot.ALMotion.getStiffnesses("Head") == [0.0, 0.0]
    assert goal.cancel().state == "preempted"
    assert robot.ALMotion.getStiffnesses("Head") == pytest.approx([0.8, 0.0])
    told = robot.ALMotion.getAngles("HeadYaw", False)
    robot.advance(1.0)
    assert robot.ALMotion.getAngles("HeadYaw", True) == pytest.approx(told, abs=0.03), "it does not go on"
    assert store.names() == ["turn"]


def test_a_motion_replaces_no_other_one_unasked(motion, store):
    store.save("turn", WAVE)
    short = {"duration": 0.1}
    assert "there is a motion 'turn' already: " in motion.refused(record(**short))
    assert "the chain makes a motion 'new' before" in motion.refused(record("new", **short), record("new", **short))
    assert store.names() == ["turn"] and store.load("turn") == WAVE
    goal = motion.play(record(overwrite=True, **short))
    assert goal.text == f"written: {store.path('turn')}" and store.load("turn") != WAVE


def test_a_recording_whose_name_is_taken_meanwhile_gets_another_one_however_it_ends(robot, motion, store):
    for name, number, end in (("cut", 2, "cancel"), ("whole", 2, "finish"), ("cut", 3, "cancel")):
        store.path(name).unlink(missing_ok=True)
        goal = motion.send(record(name, duration=0.5))
        robot.advance(0.2)
        store.save(name, WAVE)
        getattr(goal, end)()
        path = store.folder / f"{name}-{number}.yaml"
        told = f"written: {path}, for {name}.yaml came meanwhile"
        assert store.load(name) == WAVE and store.load(path.stem).joints == ("HeadYaw", "HeadPitch")
        (result,) = goal.result.results
        assert f'"motion": "{path.stem}"' in result.values[0]
        assert (goal.text if end == "finish" else result.values[1]) == told
    goal = motion.play(f("renameMotion", str_param="whole", texts=["done"]))
    assert goal.text == f"written: {store.path('done')}"


def test_a_replay_goes_to_its_first_pose_and_stays_where_a_cancel_meets_it(stiff_robot, motion, store, angle):
    store.save("wave", WAVE)
    goal = motion.send(play("wave"))
    stiff_robot.advance_until(lambda: angle("RShoulderRoll") < -0.45, 5.0)
    stiff_robot.advance_until(lambda: angle("RShoulderRoll") < -0.95, 2.0)
    goal.finish()
    assert (goal.state, goal.result.name) == ("succeeded", ["RShoulderRoll"])
    assert angle("RShoulderRoll") == pytest.approx(-0.6, abs=NEAR)
    motion.succeed(play("wave", speed=2.0, mirror=True))
    assert angle("LShoulderRoll") == pytest.approx(0.6, abs=NEAR)
    goal = motion.send(play("wave", speed=0.2))
    stiff_robot.advance_until(lambda: angle("RShoulderRoll") < -0.65, 8.0)
    goal.cancel()
    stiff_robot.advance(0.2)
    at = angle("RShoulderRoll")
    stiff_robot.advance(1.0)
    assert goal.state == "preempted" and angle("RShoulderRoll") == pytest.approx(at, abs=0.02) and at > -0.9


def test_names_are_changed_deleted_and_used_within_a_chain(stiff_robot, motion, store):
    store.save("wave", WAVE)
    motion.succeed(f("renameMotion", str_param="wave", texts=["greet"]))
    assert motion.succeed(f("listMotions")).memList == store.names() == ["greet"]
    motion.succeed(
        record("new", duration=0.5), f("renameMotion", str_param="new", texts=["newer"]), play("newer"),
        f("deleteMotion", str_param="newer"), f("deleteMotion", str_param="greet"),
    )  # fmt: skip
    assert store.names() == []
    motion.succeed(play("wave"))  # that of the library


REFUSED = [
    (play("wafe"), "did you mean 'wave'"),
    (play("mine", speed=100.0), "RShoulderRoll cannot go"),
    (play("wide", mirror=True), "RShoulderRoll cannot go to -1.5000"),
    (record("../x"), "is no name for a motion"),
    (record("x", duration=0.0), "field duration"),
    (f("renameMotion", str_param="mine"), "field texts"),
    (f("renameMotion", str_param="mine", texts=["wide"]), "there is a motion 'wide' already"),
    (f("deleteMotion", str_param="nothing"), "there is no motion 'nothing'"),
]


def test_what_is_wrong_is_told_and_nothing_moves(stiff_robot, motion, store, angle):
    store.save("mine", WAVE)
    store.save("wide", RecordedMotion(("LShoulderRoll",), (0.0, 2.0), ((0.5,), (1.5,))))
    for function, text in REFUSED:
        refusal = motion.refused(f("angleInterpolation", names=["HeadYaw"], angles=[0.5], times=[1.0]), function)
        assert refusal.startswith("function 2") and text in refusal
    assert angle("HeadYaw") == pytest.approx(0.0, abs=NEAR) and store.names() == ["mine", "wide"]

"""Recording and replaying on a stand-in for ALMotion."""

from __future__ import annotations

import pytest
from fake_motion import CHAINS

from nao_library_actions.msg import NaoMotionGoal
from nao_library_modules.recorded_motion import RecordedMotion
from nao_library_msgs.msg import MotionFunction

LIMIT = 5.0
WAVE = RecordedMotion(("RShoulderRoll",), (0.0, 1.0, 2.0), ((-0.5,), (-1.0,), (-0.5,)))


class TickingClock:
    """Time that passes only while somebody waits; tells each wait."""

    def __init__(self):
        self.time = 100.0
        self.waits = []
        self.on_wait = lambda: None

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.waits.append(duration)
        self.time += duration
        self.on_wait()
        return not interrupt.is_set()


@pytest.fixture
def clock(edge):
    edge.clock = TickingClock()
    return edge.clock


@pytest.fixture
def motion(robot, edge, clock, fake, tmp_path):
    from nao_library_modules.motion import NaoMotion

    return NaoMotion("10.0.0.7", 9559, robot=robot, edge=edge, motion_dir=tmp_path)


def f(function, **fields):
    return MotionFunction(function=function, **fields)


def play(motion, *functions):
    return motion.server.play(NaoMotionGoal(list(functions)))


def interpolations(robot):
    return [call[1:] for call in robot.proxy("ALMotion").calls if call[0] == "angleInterpolation"]


def test_joints_are_sampled_at_the_rate_and_saved(motion, fake, clock):
    clock.on_wait = lambda: fake.angles.update(HeadYaw=fake.angles["HeadYaw"] + 0.1)
    server = play(motion, f("recordMotion", str_param="turn", names=["Head"], duration=1.0, rate=4.0))
    assert server.end == "succeeded", server.text
    recording = motion.store.load("turn")
    assert recording.joints == tuple(CHAINS["Head"])
    assert recording.times == pytest.approx((0.0, 0.25, 0.5, 0.75, 1.0))
    assert [row[0] for row in recording.angles] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])


def test_limp_joints_are_stiff_again_afterwards_where_the_hand_left_them(motion, fake, clock, robot):
    fake.stiffnesses.update(HeadYaw=0.7, HeadPitch=0.0)
    seen = []
    clock.on_wait = lambda: (seen.append(dict(fake.stiffnesses)), fake.angles.update(HeadYaw=0.9))
    play(motion, f("recordMotion", str_param="turn", names=["Head"], duration=0.5, limp=True))
    assert all(state["HeadYaw"] == 0.0 for state in seen) and seen
    assert (fake.stiffnesses["HeadYaw"], fake.stiffnesses["HeadPitch"]) == (0.7, 0.0)
    assert ("setAngles", CHAINS["Head"], [0.9, 0.0], 1.0) in robot.proxy("ALMotion").calls


def test_limp_joints_are_stiff_again_after_a_cancel(motion, fake, clock):
    fake.stiffnesses.update(HeadYaw=0.7, HeadPitch=0.4)
    clock.on_wait = lambda: motion.server.preempt()
    server = play(motion, f("recordMotion", str_param="turn", names=["Head"], duration=60.0, limp=True))
    assert server.end == "preempted"
    assert (fake.stiffnesses["HeadYaw"], fake.stiffnesses["HeadPitch"]) == (0.7, 0.4)


def test_what_was_recorded_until_a_cancel_is_kept(motion, clock):
    clock.on_wait = lambda: len(clock.waits) == 3 and motion.server.preempt()
    server = play(motion, f("recordMotion", str_param="turn", names=["Head"], duration=60.0, rate=10.0))
    assert server.end == "preempted"
    assert motion.store.load("turn").times == pytest.approx((0.0, 0.1, 0.2))


def test_a_motion_is_replayed_from_its_first_pose_on(motion, robot):
    motion.store.save("wave", WAVE)
    assert play(motion, f("playMotion", str_param="wave")).end == "succeeded"
    approach, path = interpolations(robot)
    assert approach[:2] == (["RShoulderRoll"], [[-0.5]])
    assert path == (["RShoulderRoll"], [[-1.0, -0.5]], [[1.0, 2.0]], True)


def test_speed_and_mirror(motion, robot):
    motion.store.save("wave", WAVE)
    server = play(motion, f("playMotion", str_param="wave", speed=2.0, mirror=True))
    assert server.end == "succeeded", server.text
    _, path = interpolations(robot)
    assert path == (["LShoulderRoll"], [[1.0, 0.5]], [[0.5, 1.0]], True)
    assert server.result.name == ["LShoulderRoll"]


@pytest.mark.parametrize(
    "function, text",
    [
        (f("playMotion", str_param="wafe"), "did you mean 'wave'"),
        (f("playMotion", str_param="wave", speed=100.0), "RShoulderRoll cannot go"),
        (f("playMotion", str_param="wave", speed=-1.0), "field speed"),
        (f("playMotion", str_param="wide", mirror=True), "LShoulderRoll cannot go to 1.9000"),
        (f("recordMotion", str_param="../x", duration=1.0), "is no name for a motion"),
        (f("recordMotion", str_param="x"), "field duration"),
        (f("recordMotion", str_param="x", duration=1.0, rate=1000.0), "field rate"),
        (f("renameMotion", str_param="wave"), "field texts"),
        (f("renameMotion", str_param="wave", texts=["wide"]), "there is a motion 'wide' already"),
        (f("renameMotion", str_param="wafe", texts=["greet"]), "did you mean 'wave'"),
        (f("deleteMotion", str_param="nothing"), "there is no motion 'nothing'"),
    ],
)
def test_what_is_wrong_is_told_and_nothing_moves(motion, robot, function, text):
    motion.store.save("wave", WAVE)
    motion.store.save("wide", RecordedMotion(("RShoulderRoll",), (0.0, 2.0), ((-0.5,), (-1.9,))))
    server = play(motion, f("angleInterpolation", names=["HeadYaw"], angles=[0.5], times=[1.0]), function)
    assert server.end == "aborted" and text in server.text
    assert interpolations(robot) == []


def test_motions_are_listed_renamed_and_deleted(motion):
    motion.store.save("wave", WAVE)
    play(motion, f("renameMotion", str_param="wave", texts=["greet"]))
    assert play(motion, f("listMotions")).result.memList == ["greet"]
    play(motion, f("deleteMotion", str_param="greet"))
    assert motion.store.names() == []


def test_a_chain_may_play_what_it_records(motion):
    record = f("recordMotion", str_param="new", names=["Head"], duration=0.5)
    assert play(motion, record, f("playMotion", str_param="new")).end == "succeeded"


def test_a_chain_may_rename_and_delete_what_it_records(motion):
    record = f("recordMotion", str_param="new", names=["Head"], duration=0.5)
    rename = f("renameMotion", str_param="new", texts=["newer"])
    server = play(motion, record, rename, f("playMotion", str_param="newer"), f("deleteMotion", str_param="newer"))
    assert server.end == "succeeded", server.text
    assert motion.store.names() == []


@pytest.mark.parametrize("mirror", [False, True])
def test_a_joint_that_leant_on_its_stop_is_replayed_to_the_limit(motion, robot, mirror):
    joint, limit = ("RShoulderRoll", -1.3) if mirror else ("LShoulderRoll", 1.3)
    motion.store.save("stop", RecordedMotion((joint,), (0.0, 1.0), ((0.0,), (limit * 1.004,))))
    server = play(motion, f("playMotion", str_param="stop", mirror=mirror))
    assert server.end == "succeeded", server.text
    assert interpolations(robot)[1] == (["LShoulderRoll"], [[1.3]], [[1.0]], True)

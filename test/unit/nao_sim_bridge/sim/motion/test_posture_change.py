"""Going to postures under physics: on the feet, limp, pushed over, killed, and where no move leads."""

from __future__ import annotations

import pytest

from nao_sim_bridge.sim.motion.posture_change import PostureChange
from nao_sim_bridge.sim.motion.sequences import posture_task, stiffness_task
from nao_sim_bridge.sim.posture_moves import KeyFrame, Move, load_moves
from nao_sim_bridge.sim.posture_recognition import Recognition, recognise
from nao_sim_bridge.sim.postures import posture

LONGEST = 60.0
FALLEN = {"LyingBelly": (60.0, 0.0, 0.0), "LyingBack": (-60.0, 0.0, 0.0)}
"""Pushes of 0.2 s that make a standing robot lie like this, N."""


@pytest.fixture
def change():
    def make(one, goal, speed=1.0, tries=3, moves=()):
        return PostureChange(one.robot, lambda: one.now, goal, speed, tries, moves)

    return make


@pytest.fixture
def fallen(bench):
    def make(family):
        one = bench("Stand")
        one.push(FALLEN[family], 0.2)
        one.run(1.5)
        assert recognise(one.model, one.now).family == family
        return one

    return make


def finish(one, task):
    """Let time pass until the task ends; how long that took, s."""
    begun = one.simulation.time
    while not task.finished and one.simulation.time < begun + LONGEST:
        one.simulation.tick()
    assert task.finished
    return one.simulation.time - begun


def nod(start, goal, duration=0.4):
    """A move that only shakes the head, whatever it says."""
    return Move(start, goal, (KeyFrame(duration, {0: 0.2}),))


@pytest.mark.parametrize("start, goal", [("Crouch", "StandZero"), ("StandZero", "Crouch"), ("StandInit", "Stand")])
def test_it_goes_there_and_knows_it(bench, change, start, goal):
    one = bench(start)
    way = change(one, goal)
    task = way.start()
    took = finish(one, task)
    assert task.value is True and way.reached and way.failure == ""
    assert recognise(one.model, one.now).posture == goal
    assert one.now.commands == pytest.approx(posture(one.model, goal))
    assert took < 3.0
    assert one.robot.motion.tasks() == []


def test_a_limp_robot_gets_stiff_first(bench, change):
    one = bench("Crouch", 0.0)
    one.run(0.3)
    task = change(one, "Stand").start()
    finish(one, task)
    assert task.value is True
    assert one.now.stiffnesses == (1.0,) * 26


def test_who_is_there_already_does_not_move(bench, change):
    one = bench("StandInit")
    one.run(0.3)
    before = one.now.commands
    assert finish(one, change(one, "StandInit").start()) < 0.5
    assert one.now.commands == before


def test_who_is_nearly_there_goes_there_exactly(bench, change):
    one = bench("StandInit")
    one.aim(LShoulderPitch=1.2, HeadYaw=0.5)
    one.run(1.0)
    assert recognise(one.model, one.now).posture == "StandInit"
    task = change(one, "StandInit").start()
    finish(one, task)
    assert one.now.commands == pytest.approx(posture(one.model, "StandInit"))


def test_slow_is_slower(bench, change):
    quick, slow = bench("Crouch"), bench("Crouch")
    times = [finish(one, change(one, "Stand", speed).start()) for one, speed in ((quick, 1.0), (slow, 0.25))]
    assert times[1] > 2.5 * times[0]


def test_what_moved_the_joints_before_ends(bench, change):
    one = bench("Crouch")
    older = [
        posture_task(one.robot, "angleInterpolation", "Crouch"),
        stiffness_task(one.robot, "stiffnessInterpolation", [3], 0.0, 5.0),
    ]
    one.aim(HeadYaw=1.0)
    task = change(one, "Stand").start()
    assert [done.killed for done in older] == [True, True]
    finish(one, task)
    assert task.value is True


def test_a_newer_one_ends_the_older(bench, change):
    one = bench("Crouch")
    first = change(one, "Stand").start()
    one.run(0.7)
    second = change(one, "Crouch").start()
    assert first.finished and first.value is False
    finish(one, second)
    assert second.value is True
    assert recognise(one.model, one.now).posture == "Crouch"


@pytest.mark.parametrize("seconds", [0.1, 0.7])
def test_killed_it_stops_where_it_is(bench, change, seconds):
    one = bench("Crouch")
    way = change(one, "Stand")
    task = way.start()
    one.run(seconds)
    assert task.kill()
    assert task.value is False and not way.reached
    before = one.now.commands
    one.run(0.5)
    assert one.now.commands == before
    assert one.robot.motion.tasks() == []


def test_who_lies_has_no_way_without_moves(fallen, change):
    one = fallen("LyingBelly")
    way = change(one, "Stand")
    task = way.start()
    finish(one, task)
    assert task.value is False
    assert way.failure == "no way leads there from LyingBelly"


def test_it_gives_up_after_as_many_misses_as_it_has_tries(fallen, change):
    one = fallen("LyingBack")
    way = change(one, "Stand", tries=2, moves=[nod("LyingBack", "Stand")])
    task = way.start()
    finish(one, task)
    assert task.value is False
    assert way.misses == 2
    assert way.failure == "LyingBack -> Stand ended in LyingBack, miss 2 of 2"


def test_off_the_feet_it_says_that_it_gets_up_as_long_as_it_does(fallen, change):
    one = fallen("LyingBack")
    task = change(one, "Stand", tries=1, moves=[nod("LyingBack", "Stand", 1.0)]).start()
    seen = []
    while not task.finished:
        one.simulation.tick()
        seen.append(one.robot.getting_up)
    assert 1.0 <= sum(seen) * one.simulation.settings.tick_s <= 3.2
    assert not one.robot.getting_up


def test_killed_it_gets_up_no_more(fallen, change):
    one = fallen("LyingBack")
    task = change(one, "Stand", moves=[nod("LyingBack", "Stand", 2.0)]).start()
    one.run(2.5)
    assert one.robot.getting_up
    task.kill()
    assert not one.robot.getting_up


def test_on_the_feet_nothing_says_that_it_gets_up(bench, change):
    one = bench("Crouch")
    task = change(one, "Stand").start()
    while not task.finished:
        one.simulation.tick()
        assert not one.robot.getting_up


def test_straight_it_asks_nobody_where_it_is(fallen, change):
    one = fallen("LyingBack")
    task = change(one, "StandZero").start_straight()
    finish(one, task)
    assert task.value is True
    assert one.now.commands == pytest.approx(posture(one.model, "StandZero"))
    assert recognise(one.model, one.now) == Recognition("Unknown", "LyingBack")


def test_straight_a_limp_robot_gets_nowhere(bench, change):
    one = bench("Crouch", 0.0)
    task = change(one, "Stand").start_straight()
    finish(one, task)
    assert task.value is False
    assert one.now.stiffnesses == (0.0,) * 26


@pytest.mark.parametrize("family", FALLEN)
def test_a_robot_that_fell_gets_up(fallen, change, family):
    one = fallen(family)
    task = change(one, "Stand", moves=load_moves()).start()
    finish(one, task)
    assert task.value is True
    one.run(1.0)
    assert recognise(one.model, one.now) == Recognition("Stand", "Standing")


@pytest.mark.parametrize("start, goal", [("Stand", "Sit"), ("SitRelax", "LyingBack"), ("Crouch", "LyingBelly")])
def test_it_leaves_its_feet_and_its_seat_without_a_crash(bench, change, start, goal):
    one = bench(start)
    one.run(1.0)
    task = change(one, goal, moves=load_moves()).start()
    hardest = 0.0
    while not task.finished:
        one.simulation.tick()
        hardest = max(hardest, max(map(abs, one.now.imu.accelerometer)))
    assert task.value is True
    assert recognise(one.model, one.now).posture == goal
    assert hardest < 10 * 9.81


@pytest.mark.parametrize("start, goal", [("Sit", "SitRelax"), ("SitRelax", "Sit")])
def test_the_arms_of_who_sits_make_way_for_the_legs(bench, change, start, goal):
    one = bench(start)
    one.run(1.0)
    task = change(one, goal).start()
    finish(one, task)
    assert task.value is True
    assert recognise(one.model, one.now) == Recognition(goal, "Sitting")

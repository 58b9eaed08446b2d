"""Sequences of footsteps: what the robot is told, and how many are made."""

from __future__ import annotations

import pytest

from nao_library_modules.driver.footsteps_walk import FootstepWalk, Step
from nao_library_modules.errors import BadGoal, RobotLost
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.places import Place
from naoqi.errors import NaoError, RobotError

FORWARD = [
    Step(leg, Place(0.04, side * 0.1, 0.0)) for leg, side in (("LLeg", 1), ("RLeg", -1), ("LLeg", 1), ("RLeg", -1))
]
TOO_LONG = Step("RLeg", Place(0.3, -0.088, 0.0))
MADE = Step("RLeg", Place(0.08, -0.088, 0.0))


class SteppingMotion:
    """ALMotion whose steps are made when the test says so; of those ahead, two can no longer be taken back."""

    def __init__(self, make_call):
        self._make_call = make_call
        self.ahead = []
        self.walk = None
        self.refuses = None

    def setFootSteps(self, legs, places, times, clear):
        if self.refuses:
            raise RobotError("ALMotion", "setFootSteps", self.refuses)
        self.ahead = ([] if clear else self.ahead) + list(zip(legs, times, places))
        self.walk = self.walk or self._make_call("ALMotion.waitUntilMoveIsFinished")

    def getFootSteps(self):
        rows = [list(step) for step in self.ahead]
        return [[[0.0, 0.05, 0.0], [0.0, -0.05, 0.0]], rows[:2], rows[2:]]

    def waitUntilMoveIsFinished(self):
        return self.walk

    def stopMove(self):
        self.ahead = []
        self.walk.end()


class SteppingClock:
    """Every wait is one step of the robot."""

    def __init__(self, motion):
        self.time = 0.0
        self.motion = motion
        self.on_wait = lambda: None

    def now(self):
        return self.time

    def wait(self, duration, interrupt):
        self.time += duration
        if self.motion.ahead:
            self.motion.ahead.pop(0)
        self.on_wait()
        if not self.motion.ahead and self.motion.walk is not None:
            self.motion.walk.end()
        return not interrupt.is_set()


@pytest.fixture
def motion(make_call):
    return SteppingMotion(make_call)


@pytest.fixture
def clock(motion):
    return SteppingClock(motion)


@pytest.fixture
def walk(robot, clock):
    return FootstepWalk(robot, clock)


def test_all_steps_are_made_and_told_of_on_the_way(walk, proxy):
    told = []
    walked = walk.walk(walk.prepared(FORWARD), 0.5, Interrupt(), lambda made: told.append(len(made)))
    assert walked.steps == tuple(FORWARD)
    assert not walked.preempted
    assert told == [1, 2, 3, 4]
    method, legs, places, times, clear = proxy.calls[0]
    assert (method, legs, clear) == ("setFootSteps", ["LLeg", "RLeg", "LLeg", "RLeg"], True)
    assert places[1] == [0.04, -0.1, 0.0]
    assert times == [0.5, 1.0, 1.5, 2.0]


def test_steps_that_are_too_long_are_told_as_they_are_made(walk):
    walked = walk.walk(walk.prepared([FORWARD[0], TOO_LONG]), 0.5, Interrupt(), lambda made: None)
    assert walked.steps[1].place == pytest.approx(MADE.place)


def test_an_interrupt_stops_it_and_steps_that_cannot_be_taken_back_are_made(walk, clock, proxy, motion):
    interrupt = Interrupt()
    steps = walk.prepared(FORWARD * 2)
    clock.on_wait = lambda: interrupt.trigger() if len(motion.ahead) == 5 else None
    walked = walk.walk(steps, 0.5, interrupt, lambda made: None)
    assert walked.preempted
    assert walked.steps == steps[:5]  # three behind, two in the air or planned for good
    assert proxy.calls[-2:] == [("stopMove",), ("waitUntilMoveIsFinished",)]


def test_a_lost_robot_is_the_reason_and_not_a_preemption(walk, clock):
    interrupt = Interrupt()
    clock.on_wait = lambda: interrupt.trigger(RobotLost("nao:9559", "silence"))
    with pytest.raises(RobotLost):
        walk.walk(FORWARD, 0.5, interrupt, lambda made: None)


def test_a_walk_that_ends_too_early_was_stopped(walk, clock, motion):
    clock.on_wait = motion.stopMove
    with pytest.raises(NaoError, match="ended after 0 of 4 steps"):
        walk.walk(FORWARD, 0.5, Interrupt(), lambda made: None)


def test_what_the_robot_refuses_is_told(walk, motion):
    motion.refuses = "the legs are limp"
    with pytest.raises(RobotError, match="limp"):
        walk.walk(FORWARD, 0.5, Interrupt(), lambda made: None)


def test_sequences_are_of_left_and_right_in_turn(walk, proxy):
    with pytest.raises(BadGoal, match="one step at least"):
        walk.prepared([])
    with pytest.raises(BadGoal, match=r"footsteps\[1\]\.leg"):
        walk.prepared([FORWARD[0], FORWARD[0]])
    assert proxy.calls == []


def test_single_steps_are_added_to_those_before(walk, proxy):
    walk.add(TOO_LONG)
    assert proxy.calls == [("setFootSteps", ["RLeg"], [pytest.approx([0.08, -0.088, 0.0])], [0.5], False)]


def test_a_single_step_may_be_waited_for(walk, motion, in_thread, eventually):
    thread, outcome = in_thread(walk.make, FORWARD[0])
    eventually(lambda: motion.walk is not None)
    assert outcome == []
    motion.walk.end()
    thread.join(5.0)
    assert outcome == [None]


def test_before_the_robot_has_planned_its_steps_none_is_made(walk, motion, clock):
    told, planned = [], []

    def plan():
        if clock.time == 1.0:
            motion.ahead, planned[:] = list(planned), []

    send = motion.setFootSteps

    def take_pose(legs, places, times, clear):
        send(legs, places, times, clear)
        planned[:], motion.ahead = motion.ahead, []
        motion.walk.end = lambda result=None, error=None: None if planned else type(motion.walk).end(motion.walk)

    motion.setFootSteps = take_pose
    clock.on_wait = plan
    walk.walk(FORWARD, 0.5, Interrupt(), lambda made: told.append(len(made)))
    assert told == [0, 0, 1, 2, 3, 4]

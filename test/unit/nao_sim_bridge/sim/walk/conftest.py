"""Walks without physics, whose steps are made exactly as they are planned, and robots that really walk."""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest

from nao_sim_bridge.sim.walk.body import WalkingBody
from nao_sim_bridge.sim.walk.courses import Step
from nao_sim_bridge.sim.walk.footsteps import FootPose, middle
from nao_sim_bridge.sim.walk.gait import FeetGait
from nao_sim_bridge.sim.walk.legs import LEFT, RIGHT
from nao_sim_bridge.sim.walk.whereabouts import foot_on_ground

HALF = 0.05
# No course of a test takes more steps.
MANY = 400


class Made(NamedTuple):
    """A step that was made: the step, the foot that carried meanwhile, and both feet after it."""

    step: Step
    support: FootPose
    feet: dict

    @property
    def placement(self):
        """Where the foot was put, in the frame of the other one."""
        return self.step.landing.seen_from(self.support)

    @property
    def robot(self):
        """Half way between the feet."""
        return middle(self.feet[LEFT], self.feet[RIGHT])


def standing_at(x=0.0, y=0.0, yaw=0.0):
    robot = FootPose(x, y, yaw)
    return {side: robot.moved(0.0, side * HALF) for side in (LEFT, RIGHT)}


@pytest.fixture
def feet_at():
    """Makes the feet of a robot that stands somewhere: x and y in m, yaw in rad."""
    return standing_at


@pytest.fixture
def walked():
    """Makes the next steps of a course perfectly; goes on from the `Made` that it ended with."""

    def walk(course, count=MANY, after=None, feet=None):
        feet = dict(after.feet if after else feet or standing_at())
        side = -after.step.side if after else course.first_side(feet)
        made = []
        for _ in range(count):
            support = feet[-side]
            steps = course.upcoming(support, side, 1)
            if not steps:
                break
            course.take(support, side)
            feet[side] = steps[0].landing
            made.append(Made(steps[0], support, dict(feet)))
            side = -side
        return made

    return walk


class Walking:
    """A robot that stands in physics and can walk, and what it really does."""

    # No walk of a test takes longer, s.
    LONGEST = 20.0
    GAIT = FeetGait()

    def __init__(self, bench):
        self.bench = bench
        self.robot = bench.robot
        self.locomotion = self.robot.locomotion
        self.failures = []
        self.locomotion.failures.append(lambda *failure: self.failures.append(failure))
        self._body = WalkingBody(bench.model)

    def __getattr__(self, name):
        return getattr(self.bench, name)

    def move_to(self, *points, time=None):
        return self.locomotion.move_to([FootPose(*point) for point in points], self.GAIT, time)

    def move(self, x=0.0, y=0.0, yaw=0.0):
        self.locomotion.move(x, y, yaw, self.GAIT)

    def until(self, task):
        """Let time pass until a task ends; its value."""
        begun = self.now.time
        while not task.finished and self.now.time < begun + self.LONGEST:
            self.simulation.tick()
        assert task.finished
        return task.value

    def until_it_stands(self):
        self.until(self.locomotion.until_finished())

    def feet(self):
        """Where the feet really are in the world, m and rad."""
        return {side: foot_on_ground(self._body, self.now.torso, self.now.positions, side) for side in (LEFT, RIGHT)}

    def place(self):
        """Where the robot really is in the world."""
        feet = self.feet()
        return middle(feet[LEFT], feet[RIGHT])

    @property
    def stands(self):
        """Whether both feet carry an upright body that hardly moves."""
        now = self.now
        loads = now.left_foot.total, now.right_foot.total
        still = math.hypot(*now.linear_velocity) < 0.05
        return min(loads) > 10.0 and now.torso.position[2] > 0.28 and still


@pytest.fixture
def walker_in(bench):
    """Makes robots in a posture, settled on the ground."""

    def make(posture, stiffness=1.0, **scene):
        made = Walking(bench(posture, stiffness, **scene))
        made.run(0.3)
        return made

    return make


@pytest.fixture
def walker(walker_in):
    """A robot that stands ready to walk."""
    return walker_in("StandInit")

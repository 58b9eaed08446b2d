"""Robots that really walk."""

import math

import pytest

from nao_sim_bridge.walk.body import WalkingBody, foot_on_ground
from nao_sim_bridge.walk.footsteps import FootPose, middle
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.legs import LEFT, RIGHT


class Walking:
    """A robot that stands in physics and can walk, and what it really does."""

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

    def until(self, task, longest=20.0):
        """Let time pass until a task ends; its value."""
        end = self.now.time + longest
        while not task.finished and self.now.time < end:
            self.simulation.tick()
        assert task.finished
        return task.value

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
        still = math.hypot(*now.linear_velocity) < 0.05
        return min(now.left_foot.total, now.right_foot.total) > 10.0 and now.torso.position[2] > 0.28 and still

    def stands_still(self):
        """Whether it stands, and goes on standing where it is."""
        self.run(0.3)
        begun = self.place()
        self.run(0.7)
        x, y, yaw = self.place().seen_from(begun)
        return self.stands and math.hypot(x, y) < 0.002 and abs(yaw) < 0.005


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

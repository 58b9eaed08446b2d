"""A robot that walks, and sees how it stands."""

import math

import pytest

MOTION, FAILED = "ALMotion", "ALMotion/MoveFailed"
LONGEST = 40.0
"""No walk of a test takes longer, s of simulated time."""


class Walker:
    """A robot on stiff legs that feels the floor, and a client of it, which has everything that is not here."""

    def __init__(self, client):
        self.client = client
        self.motion = client.ALMotion
        self.motion.setStiffnesses("Body", 1.0)
        client.advance(0.2)

    def __getattr__(self, name):
        return getattr(self.client, name)

    def begin(self, method, *arguments, module=MOTION, after=2.5):
        """Call a move and let it walk for a while; the future of its answer."""
        future = self.client.post(module, method, *arguments)
        self.client.handed_over(module)
        self.client.advance(after)
        return future

    def until_it_stands(self, step=0.5):
        """Let time pass until no walk runs."""
        self.client.advance_until(lambda: not self.motion.moveIsActive(), LONGEST, step, "the robot stands")

    def walk(self, method, *arguments):
        """Call a method that answers when the robot stands; its answer."""
        future = self.begin(method, *arguments, after=0.1)
        self.until_it_stands()
        return self.client.answer(future)

    @property
    def truth(self):
        """Where the torso really is on the ground, m, and how it is turned, rad."""
        (x, y, _), (a, b, c, d) = self.now.torso.position, self.now.torso.orientation
        return x, y, math.atan2(2.0 * (d * c + a * b), 1.0 - 2.0 * (b * b + c * c))

    @property
    def stands(self):
        """Whether both feet carry an upright robot that comes to rest."""
        self.client.advance(0.3)
        now = self.now
        loads = now.left_foot.total, now.right_foot.total
        return min(loads) > 8.0 and now.torso.position[2] > 0.28 and max(map(abs, now.linear_velocity)) < 0.03

    @property
    def failures(self):
        """Cause, status and obstacle of the moves that have failed."""
        history = self.ALMemory.getEventHistory(FAILED) if FAILED in self.ALMemory.getEventList() else []
        return [value for value, _, _ in history]


@pytest.fixture
def walker(robot):
    """The robot, ready to walk."""
    return Walker(robot)


@pytest.fixture
def motion(robot):
    return robot.ALMotion

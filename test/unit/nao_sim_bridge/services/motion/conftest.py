"""A client that makes a simulated robot walk, and sees how it stands."""

from __future__ import annotations

import math

import pytest

MOTION, FAILED = "ALMotion", "ALMotion/MoveFailed"
# No walk of a test takes longer, s of simulated time.
LONGEST = 40.0


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
        begun = self.now.time
        while self.motion.moveIsActive() and self.now.time < begun + LONGEST:
            self.client.advance(step)
        assert not self.motion.moveIsActive()

    def walk(self, method, *arguments):
        """Call a method that answers when the robot stands; its answer."""
        future = self.begin(method, *arguments, after=0.1)
        self.until_it_stands()
        return self.client.answer(future)

    @property
    def now(self):
        """The last snapshot."""
        return self.client.now

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
        """How often a move has failed."""
        return len(self.ALMemory.getEventHistory(FAILED))

    @property
    def last_failure(self):
        """Cause, status and obstacle of the last move that failed."""
        return self.ALMemory.getData(FAILED)


@pytest.fixture(scope="session")
def walker_of():
    """Makes a walker of a client."""
    return Walker


@pytest.fixture
def walker(robot, walker_of):
    """The robot of this file, ready to walk."""
    return walker_of(robot)

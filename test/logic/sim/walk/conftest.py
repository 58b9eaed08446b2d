"""Walks without physics, whose steps are made exactly as they are planned."""

from __future__ import annotations

from typing import NamedTuple

import pytest

from nao_sim_bridge.walk.courses import Step
from nao_sim_bridge.walk.footsteps import FootPose, middle
from nao_sim_bridge.walk.legs import LEFT, RIGHT


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


@pytest.fixture(scope="session")
def feet_at():
    """Makes the feet of a robot that stands somewhere: x and y in m, yaw in rad."""
    return lambda x=0.0, y=0.0, yaw=0.0: {s: FootPose(x, y, yaw).moved(0.0, s * 0.05) for s in (LEFT, RIGHT)}


@pytest.fixture(scope="session")
def walked(feet_at):
    """Makes the next steps of a course perfectly; goes on from the `Made` that it ended with."""

    def walk(course, count=400, after=None, feet=None):
        feet = dict(after.feet if after else feet or feet_at())
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

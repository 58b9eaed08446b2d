"""A walk at a velocity, until it is told to end."""

from __future__ import annotations

from math import sqrt
from typing import Mapping, NamedTuple

from nao_sim_bridge.walk.courses import ROUNDING, STANDSTILL, Course, Rate, Step, rate_limits
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.settings import WalkSettings

# Steps that bring the feet together at the end of a walk, and those of a walk that does nothing else.
CLOSING_STEPS, ALIGNING_STEPS = 1, 2
# A robot whose way in a step is not longer than so many changes from one step to the next may stop in the next one.
SLOW = 3.0
# A robot that walks at a velocity makes up for what it was pushed to the side, m, or turned, rad, up to this.
FURTHEST_ASIDE, FURTHEST_TURN = 0.05, 0.5


class _Going(NamedTuple):
    """How a walk at a velocity is going.

    Attributes:
        rate: Way of the robot in the last step.
        closing: Closing steps to go; None as long as it does not end.
        intended: Where the robot should be in the world by what it was told so far; None before the first step.
        first: Whether the next step is the first one, from feet that stand in any way.
    """

    rate: Rate
    closing: int | None
    intended: FootPose | None
    first: bool


class VelocityCourse(Course):
    """Goes on at `wanted`, the way in one step, until it is told to end; `rate`: at which the robot walks already.

    Attributes:
        ending: Whether it was told to.
    """

    def __init__(self, settings: WalkSettings, gait: FeetGait, wanted: Rate, rate: Rate = STANDSTILL) -> None:
        self._wanted = within(wanted, gait)
        self.ending = False
        super().__init__(settings, gait, rate)

    def begin_at(self, robot: FootPose) -> None:
        """Begin from where the robot is in the world, and how it is turned there: its feet may stand in any way."""
        self._state = self._state._replace(intended=robot, first=True)

    def follow(self, other: Course) -> None:
        """Go on where the robot should be by another course, if that one knows."""
        super().follow(other)
        if isinstance(other, VelocityCourse):
            self._state = self._state._replace(intended=other._state.intended)

    def end(self) -> None:
        """Slow down, bring the feet together, and be over."""
        self.ending = True
        self._wanted = STANDSTILL

    def first_side(self, _: Mapping[int, FootPose]) -> int:
        """The foot on the side where the robot goes or turns to; else the left one."""
        _, y, yaw = self._wanted
        return -1 if (y or yaw) < 0.0 else 1

    def _first_state(self, rate: Rate) -> _Going:
        return _Going(rate, None, None, False)

    def _next(self, state: _Going, support: FootPose, side: int) -> tuple[Step, _Going] | None:
        closing = state.closing
        if closing == 0:
            return None
        if self.ending and closing is None and _slow(state.rate, self._settings.change):
            closing = ALIGNING_STEPS if state.first else CLOSING_STEPS
        if closing is not None:
            rate, closing = STANDSTILL, closing - 1
        else:
            x, y, yaw = self._wanted
            rate = self._change(state.rate, (self.haste * x, self.haste * y, self.haste * yaw))
        centre = support.moved(0.0, side * self._half)
        beside = self._landing(support, side, rate).moved(0.0, -side * self._half)
        way = beside.seen_from(centre)
        here = self.frame.moved(*centre)
        intended = here if state.intended is None else state.intended
        off = intended.seen_from(here)
        if closing == 0:
            aside, turn = 0.0, 0.0  # this foot comes beside the other one
        else:
            aside, turn = (off.y, off.yaw) if state.first else self._hold(off)
        landing = centre.moved(way.x, way.y + aside, way.yaw + turn).moved(0.0, side * self._half)
        after = self._kept_near(intended, here).moved(*way)
        return self._step(side, landing), _Going(rate, closing, after, False)

    def _hold(self, off: FootPose) -> tuple[float, float]:
        """What a step does about having come off to the side, m, and about having turned, rad."""
        settings = self._settings
        aside = min(max(settings.aside_hold * off.y, -settings.aside_hold_limit), settings.aside_hold_limit)
        turn = min(max(settings.turn_hold * off.yaw, -settings.turn_hold_limit), settings.turn_hold_limit)
        return aside, turn

    def _kept_near(self, intended: FootPose, here: FootPose) -> FootPose:
        """`intended` beside the robot: what it was pushed along its way, or far to the side, is not walked again."""
        off = intended.seen_from(here)
        aside = min(max(off.y, -FURTHEST_ASIDE), FURTHEST_ASIDE)
        turn = min(max(off.yaw, -FURTHEST_TURN), FURTHEST_TURN)
        return here.moved(0.0, aside, turn)


def within(rate: Rate, gait: FeetGait) -> Rate:
    """`rate` made smaller, in all its parts alike, until the gait allows it.

    Each part has its largest value when the others are zero; together they are kept within an ellipsoid.
    """
    limits = rate_limits(gait, rate[0] >= 0.0)
    size = sqrt(sum((part / most) ** 2 for part, most in zip(rate, limits)))
    return rate if size <= 1.0 else (rate[0] / size, rate[1] / size, rate[2] / size)


def _slow(rate: Rate, change: Rate) -> bool:
    return all(abs(part) <= SLOW * most + ROUNDING for part, most in zip(rate, change))

"""Where a walk goes: each kind of course makes the next steps, as many as one wants to see ahead.

A course is a pure function of its state, the foot that carries and its side; `take` commits to the first of the steps
that it has shown. Poses are in the plan's frame; a course to somewhere in the world is told where that frame lies.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from math import copysign, sqrt
from typing import Any, NamedTuple, Sequence, Tuple

from nao_sim_bridge.sim.walk.clipping import clip_step, sidestep, spread, step_limits
from nao_sim_bridge.sim.walk.footsteps import FootPose
from nao_sim_bridge.sim.walk.gait import FeetGait, Gait, parameters
from nao_sim_bridge.sim.walk.settings import WalkSettings

# Way of the robot in one step: m, m, rad.
Rate = Tuple[float, float, float]
STANDSTILL: Rate = (0.0, 0.0, 0.0)
# Closer than this to its goal, m and rad, the robot has arrived.
ARRIVED, ARRIVED_TURN = 0.005, 0.01
# Steps that bring the feet together at the end of a walk.
CLOSING_STEPS = 2
# A robot that walks at a velocity makes up for what it was pushed to the side, m, or turned, rad, up to this.
FURTHEST_ASIDE, FURTHEST_TURN = 0.05, 0.5
ROUNDING = 1e-9


class Step(NamedTuple):
    """A step to be made.

    Attributes:
        side: Of the foot that moves, 1 left, -1 right.
        landing: Where it lands.
        period: From the landing of the other foot to this one, s.
        gait: How it moves.
    """

    side: int
    landing: FootPose
    period: float
    gait: Gait


class Course(ABC):
    """See the module.

    Attributes:
        frame: Where the plan's frame lies in the world.
        rate: Way of the robot in the step that it took last.
        reached: Whether it came to its end by itself.

    Args:
        settings: Of the walk.
        rate: At which the robot walks already.
    """

    def __init__(self, settings: WalkSettings, rate: Rate = STANDSTILL) -> None:
        self._settings = settings
        self._half = settings.foot_separation / 2.0
        self.frame = FootPose(0.0, 0.0, 0.0)
        self.reached = False
        self._state: Any = self._first_state(rate)

    @property
    @abstractmethod
    def rate(self) -> Rate:
        """Way of the robot in the step that it took last."""

    @abstractmethod
    def _first_state(self, rate: Rate) -> Any:
        """The state to begin with."""

    @abstractmethod
    def _next(self, state: Any, support: FootPose, side: int) -> tuple[Step, Any] | None:
        """The next step of the foot on the `side` while the other one, at `support`, carries; None: it is over."""

    @abstractmethod
    def first_side(self) -> int:
        """Which foot should move first."""

    def upcoming(self, support: FootPose, side: int, count: int) -> list[Step]:
        """The next steps, fewer than `count` when the course ends.

        Args:
            support: The foot that carries.
            side: Of the foot that moves next.
            count: How many are wanted.
        """
        steps: list[Step] = []
        state = self._state
        while len(steps) < count:
            made = self._next(state, support, side)
            if made is None:
                break
            step, state = made
            steps.append(step)
            support, side = step.landing, -side
        return steps

    def take(self, support: FootPose, side: int) -> None:
        """Commit to the first of the `upcoming` steps."""
        made = self._next(self._state, support, side)
        if made is not None:
            self._state = made[1]

    def _landing(self, support: FootPose, side: int, rate: Rate, gait: FeetGait) -> FootPose:
        """Where a foot lands when the robot goes on at a rate."""
        x, y, yaw = rate
        settings = self._settings
        mine, other = gait.of(side), gait.of(-side)
        x *= 2.0 * mine.max_step_x / (mine.max_step_x + other.max_step_x)
        aside = sidestep(y, y * side > 0.0, settings.foot_separation - settings.min_foot_separation)
        turn = spread(yaw, yaw * side > 0.0, settings.outer_turn)
        return support.moved(0.0, side * self._half).moved(x, aside, turn).moved(0.0, side * self._half)

    def _change(self, before: Rate, wanted: Rate) -> Rate:
        """The rate next to `before` on the way to `wanted`."""
        x, y, yaw = (b + min(max(w - b, -most), most) for b, w, most in zip(before, wanted, self._settings.change))
        return (x, y, yaw)


def rate_limits(gait: FeetGait, forward: bool) -> Rate:
    """Largest way of the robot in one step, m, m, rad: of a straight walk, a sidestep, a turn."""
    left, right = gait.left, gait.right
    fixed = parameters()
    separation, nearest = fixed["FootSeparation"].default, fixed["MinFootSeparation"].default
    x = (left.max_step_x + right.max_step_x) / 2.0 if forward else -step_limits().min_x
    outer = (left.max_step_y + right.max_step_y) / 2.0 - separation
    aside = (outer + min(outer, separation - nearest)) / 2.0
    return (x, aside, (left.max_step_theta + right.max_step_theta) / 2.0)


def within(rate: Rate, gait: FeetGait) -> Rate:
    """`rate` made smaller, in all its parts alike, until the gait allows it.

    Each part has its largest value when the others are zero; together they are kept within an ellipsoid.
    """
    limits = rate_limits(gait, rate[0] >= 0.0)
    size = sqrt(sum((part / most) ** 2 for part, most in zip(rate, limits)))
    return rate if size <= 1.0 else (rate[0] / size, rate[1] / size, rate[2] / size)


class _Going(NamedTuple):
    """Rate, closing steps to go, and where the robot should be in the world by what it was told so far."""

    rate: Rate
    closing: int | None
    intended: FootPose | None


class VelocityCourse(Course):
    """Goes on at a velocity until it is told to end.

    Args:
        settings: Of the walk.
        gait: How it steps.
        wanted: Way in one step.
        rate: At which the robot walks already.
    """

    def __init__(self, settings: WalkSettings, gait: FeetGait, wanted: Rate, rate: Rate = STANDSTILL) -> None:
        self._gait = gait
        self._wanted = within(wanted, gait)
        self._ending = False
        super().__init__(settings, rate)

    @property
    def wanted(self) -> Rate:
        """Way in one step that is asked for."""
        return self._wanted

    @property
    def rate(self) -> Rate:  # noqa: D102
        return self._state.rate

    def end(self) -> None:
        """Slow down, bring the feet together, and be over."""
        self._ending = True
        self._wanted = STANDSTILL

    def first_side(self) -> int:
        """The foot on the side where the robot goes or turns to; else the left one."""
        _, y, yaw = self._wanted
        return -1 if (y or yaw) < 0.0 else 1

    def _first_state(self, rate: Rate) -> _Going:
        return _Going(rate, None, None)

    def _next(self, state: _Going, support: FootPose, side: int) -> tuple[Step, _Going] | None:
        closing = state.closing
        if closing == 0:
            return None
        if self._ending and closing is None and _slow(state.rate, self._settings.change):
            closing = CLOSING_STEPS
        if closing is not None:
            rate, closing = STANDSTILL, closing - 1
        else:
            rate = self._change(state.rate, self._wanted)
        centre = support.moved(0.0, side * self._half)
        beside = self._landing(support, side, rate, self._gait).moved(0.0, -side * self._half)
        way = beside.seen_from(centre)
        here = self.frame.moved(*centre)
        intended = here if state.intended is None else state.intended
        aside, turn = self._hold(intended.seen_from(here))
        landing = centre.moved(way.x, way.y + aside, way.yaw + turn).moved(0.0, side * self._half)
        after = self._kept_near(intended, here).moved(*way)
        return self._step(side, landing), _Going(rate, closing, after)

    def _step(self, side: int, landing: FootPose) -> Step:
        return Step(side, landing, self._gait.period(side), self._gait.of(side))

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


class _Nearing(NamedTuple):
    rate: Rate
    goal: int
    closed: bool


class TargetCourse(Course):
    """Goes to a place in the world, through others.

    Args:
        settings: Of the walk.
        gait: How it steps.
        goals: Poses of the robot in the world, the last one is where it ends.
        steps: Take so many at least; fewer would be faster than asked for.
        rate: At which the robot walks already.
    """

    def __init__(
        self,
        settings: WalkSettings,
        gait: FeetGait,
        goals: Sequence[FootPose],
        steps: int = 1,
        rate: Rate = STANDSTILL,
    ) -> None:
        self._gait = gait
        self._goals = tuple(goals)
        self._steps = steps
        self._first = 1
        super().__init__(settings, rate)

    @property
    def rate(self) -> Rate:  # noqa: D102
        return self._state.rate

    def begin_towards(self, robot: FootPose) -> None:
        """Choose the foot that moves first, from where the robot is in the world."""
        way = self._goals[0].seen_from(robot)
        self._first = -1 if (way.y or way.yaw) < 0.0 else 1

    def first_side(self) -> int:  # noqa: D102
        return self._first

    def take(self, support: FootPose, side: int) -> None:  # noqa: D102
        super().take(support, side)
        self._steps -= 1
        self.reached = self.reached or self._state.closed

    def _first_state(self, rate: Rate) -> _Nearing:
        return _Nearing(rate, 0, False)

    def _next(self, state: _Nearing, support: FootPose, side: int) -> tuple[Step, _Nearing] | None:
        if state.closed:
            return None
        centre = support.moved(0.0, side * self._half)
        goal = state.goal
        way = self._way(goal, centre)
        while goal < len(self._goals) - 1 and self._steps_for(way, 0.0) <= 1.0:
            goal += 1
            way = self._way(goal, centre)
        if goal == len(self._goals) - 1 and max(abs(way.x), abs(way.y)) < ARRIVED and abs(way.yaw) < ARRIVED_TURN:
            landing = centre.moved(*way).moved(0.0, side * self._half)
            return self._step(side, landing), _Nearing(STANDSTILL, goal, True)
        rate = self._change(state.rate, self._towards(way, goal))
        landing = self._landing_towards(support, side, rate, way)
        return self._step(side, landing), _Nearing(rate, goal, False)

    def _step(self, side: int, landing: FootPose) -> Step:
        return Step(side, landing, self._gait.period(side), self._gait.of(side))

    def _way(self, goal: int, centre: FootPose) -> FootPose:
        """From the robot to a goal, in the frame of the robot."""
        return self._goals[goal].seen_from(self.frame.moved(*centre))

    def _steps_for(self, way: FootPose, ahead: float) -> float:
        """How many steps a way takes at full speed, braking to its end when nothing comes after it."""
        limits = rate_limits(self._gait, way.x >= 0.0)
        changes = self._settings.change
        counts = []
        for part, most, change in zip(way, limits, changes):
            distance = abs(part)
            fastest = most if ahead else min(most, braking(distance, change))
            counts.append(distance / max(fastest, ROUNDING))
        return sqrt(sum(count * count for count in counts))

    def _towards(self, way: FootPose, goal: int) -> Rate:
        last = goal == len(self._goals) - 1
        count = max(self._steps_for(way, 0.0 if last else 1.0), float(self._steps), 1.0)
        return (way.x / count, way.y / count, way.yaw / count)

    def _landing_towards(self, support: FootPose, side: int, rate: Rate, way: FootPose) -> FootPose:
        """As `_landing`, but not past the goal: of two steps, one goes further aside than the other."""
        centre = support.moved(0.0, side * self._half)
        beside = self._landing(support, side, rate, self._gait).moved(0.0, -side * self._half)
        made = beside.seen_from(centre)
        x, y, yaw = (copysign(min(abs(m), abs(w)), m) if m * w > 0.0 else m for m, w in zip(made, way))
        return centre.moved(x, y, yaw).moved(0.0, side * self._half)


class Placement(NamedTuple):
    """A step that somebody else has planned.

    Attributes:
        side: Of the foot that moves, 1 left, -1 right.
        beside: Where it lands, in the frame of the other foot.
        period: Time of the step, s.
    """

    side: int
    beside: FootPose
    period: float


class StepsCourse(Course):
    """Makes steps that somebody else has planned; more can be added.

    Args:
        settings: Of the walk.
        gait: Their height.
        placements: Where they go; clipped to what the legs can step.
    """

    def __init__(self, settings: WalkSettings, gait: FeetGait, placements: Sequence[Placement]) -> None:
        self._gait = gait
        self._queue = list(placements)
        super().__init__(settings)

    @property
    def rate(self) -> Rate:  # noqa: D102
        return STANDSTILL

    @property
    def left(self) -> Sequence[Placement]:
        """Steps that are not begun."""
        return tuple(self._queue[self._state :])

    def add(self, placements: Sequence[Placement], clear: bool) -> None:
        """More steps, after those that are not begun or instead of them."""
        del self._queue[self._state if clear else len(self._queue) :]
        self._queue.extend(placements)

    def first_side(self) -> int:  # noqa: D102
        return self._queue[0].side if self._queue else 1

    def take(self, support: FootPose, side: int) -> None:  # noqa: D102
        super().take(support, side)
        self.reached = self._state >= len(self._queue)

    def _first_state(self, rate: Rate) -> int:
        return 0

    def _next(self, state: int, support: FootPose, side: int) -> tuple[Step, int] | None:
        if state >= len(self._queue):
            return None
        placement = self._queue[state]
        if placement.side != side:  # the other foot is due: it stays where it is, beside this one
            landing = self._landing(support, side, STANDSTILL, self._gait)
            return Step(side, landing, self._gait.period(side), self._gait.of(side)), state
        beside = clip_step(placement.beside, side, step_limits())
        period = max(placement.period, self._gait.period(side))
        return Step(side, support.moved(*beside), period, self._gait.of(side)), state + 1


def braking(distance: float, change: float) -> float:
    """Way of a step from which the robot can still slow down, by `change` each step, to be at rest after `distance`."""
    return change * (sqrt(0.25 + 2.0 * distance / change) - 0.5) if distance > change else distance


def _slow(rate: Rate, change: Rate) -> bool:
    return all(abs(part) <= most + ROUNDING for part, most in zip(rate, change))

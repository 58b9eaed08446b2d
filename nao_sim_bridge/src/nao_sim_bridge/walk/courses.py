"""Where a walk goes: each kind of course makes the next steps, as many as one wants to see ahead, in a file of its own.

A course is a pure function of its state, the foot that carries and its side; `take` commits to the first of the steps
that it has shown. Poses are in the plan's frame; a course to somewhere in the world is told where that frame lies.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, Mapping, NamedTuple, Tuple

from nao_sim_bridge.walk.clipping import clip_step, sidestep, spread, step_limits
from nao_sim_bridge.walk.footsteps import FootPose
from nao_sim_bridge.walk.gait import FeetGait, Gait, parameters
from nao_sim_bridge.walk.settings import WalkSettings

# Way of the robot in one step: m, m, rad.
Rate = Tuple[float, float, float]
STANDSTILL: Rate = (0.0, 0.0, 0.0)
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
    """See the module; `rate` is that at which the robot walks already.

    Attributes:
        frame: Where the plan's frame lies in the world.
        reached: Whether it came to its end by itself.
        haste: Share of its speed that a course may use, 0..1: a body that is off its plan comes back best on the spot.
    """

    def __init__(self, settings: WalkSettings, gait: FeetGait, rate: Rate = STANDSTILL) -> None:
        self._settings = settings
        self._gait = gait
        self._half = settings.foot_separation / 2.0
        self.frame = FootPose(0.0, 0.0, 0.0)
        self.reached = False
        self.haste = 1.0
        self._state: Any = self._first_state(rate)

    @property
    def rate(self) -> Rate:
        """Way of the robot in the step that it took last."""
        return self._state.rate

    @abstractmethod
    def _first_state(self, rate: Rate) -> Any:
        """The state to begin with."""

    @abstractmethod
    def _next(self, state: Any, support: FootPose, side: int) -> tuple[Step, Any] | None:
        """The next step of the foot on the `side` while the other one, at `support`, carries; None: it is over."""

    @abstractmethod
    def first_side(self, feet: Mapping[int, FootPose]) -> int:
        """Which foot should move first, from where both (1 left, -1 right) stand."""

    def begin_at(self, robot: FootPose) -> None:
        """Begin from where the robot is in the world; most courses look only at the feet."""
        del robot

    def follow(self, other: Course) -> None:
        """Take over from another course while the robot walks."""
        self.frame = other.frame

    def upcoming(self, support: FootPose, side: int, count: int) -> list[Step]:
        """The next steps, of the foot on the `side` first; fewer than `count` when the course ends."""
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

    def _step(self, side: int, landing: FootPose) -> Step:
        return Step(side, landing, self._gait.period(side), self._gait.of(side))

    def _landing(self, support: FootPose, side: int, rate: Rate) -> FootPose:
        """Where a foot lands when the robot goes on at a rate."""
        x, y, yaw = rate
        settings = self._settings
        mine, other = self._gait.of(side), self._gait.of(-side)
        x *= 2.0 * mine.max_step_x / (mine.max_step_x + other.max_step_x)
        aside = sidestep(y, y * side > 0.0, settings.foot_separation - settings.min_foot_separation)
        turn = spread(yaw, yaw * side > 0.0, settings.outer_turn)
        landing = support.moved(0.0, side * self._half).moved(x, aside, turn).moved(0.0, side * self._half)
        return support.moved(*clip_step(landing.seen_from(support), side, step_limits()))

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

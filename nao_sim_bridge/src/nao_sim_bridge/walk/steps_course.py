"""A walk of steps that somebody else has planned."""

from __future__ import annotations

from typing import Mapping, NamedTuple, Sequence

from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.walk.clipping import clip_step, step_limits
from nao_sim_bridge.walk.courses import STANDSTILL, Course, Rate, Step
from nao_sim_bridge.walk.footsteps import FootPose, middle, side_by_side
from nao_sim_bridge.walk.gait import FeetGait
from nao_sim_bridge.walk.settings import WalkSettings


class Placement(NamedTuple):
    """A step of a foot (1 left, -1 right) that lands `beside` the other one, in its frame, after `period` s."""

    side: int
    beside: FootPose
    period: float


class StepsCourse(Course):
    """Makes steps that somebody else has planned, clipped to what legs can step, as high as `gait` says; takes more."""

    def __init__(self, settings: WalkSettings, gait: FeetGait, placements: Sequence[Placement]) -> None:
        self._queue = list(placements)  # steps that are not begun; states count from its begin
        self._planned = 0.0  # s from the begin of the first step to the landing of the last one that is begun
        self._robot: FootPose | None = None
        super().__init__(settings, gait)

    @property
    def rate(self) -> Rate:
        return STANDSTILL

    @property
    def left(self) -> Sequence[Placement]:
        """Steps that are not begun."""
        return tuple(self._queue)

    def add(self, placements: Sequence[Placement], clear: bool, on_the_clock: bool = False) -> None:
        """More steps, after those that are not begun or instead of them.

        Args:
            placements: The steps.
            clear: Whether those that are not begun are forgotten.
            on_the_clock: Whether the first period counts from the walk's begin, where it goes beyond what is planned.

        Raises:
            BadValue: Together they are too many.
        """
        kept = [] if clear else self._queue
        require_few("footSteps", len(kept) + len(placements), "steps")
        added = list(placements)
        planned = self._planned + sum(each.period for each in kept)
        if on_the_clock and added and added[0].period > planned:
            added[0] = added[0]._replace(period=added[0].period - planned)
        self._queue = [*kept, *added]

    def first_side(self, feet: Mapping[int, FootPose]) -> int:
        """The foot of the first step; the other one before it, if that stands in no way from which steps count."""
        side = self._queue[0].side if self._queue else 1
        if side_by_side(feet[1], feet[-1], self._settings.foot_separation):
            return side
        self._robot = middle(feet[1], feet[-1])
        return -side

    def take(self, support: FootPose, side: int) -> None:
        super().take(support, side)
        self._robot = None
        self._planned += sum(each.period for each in self._queue[: self._state])
        del self._queue[: self._state]
        self._state = 0
        self.reached = not self._queue

    def _first_state(self, rate: Rate) -> int:
        return 0

    def _next(self, state: int, support: FootPose, side: int) -> tuple[Step, int] | None:
        if state >= len(self._queue):
            return None
        placement = self._queue[state]
        if placement.side != side:  # the other foot is due: it stays where it is, beside this one
            landing = self._landing(support, side, STANDSTILL)
            if self._robot is not None:
                landing = self._robot.moved(0.0, side * self._half)
            return self._step(side, landing), state
        step = self._step(side, support.moved(*clip_step(placement.beside, side, step_limits())))
        return step._replace(period=max(placement.period, step.period)), state + 1

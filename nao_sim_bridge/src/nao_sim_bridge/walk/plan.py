"""The plan of a walk: which foot carries when, where the pressure goes, and how the centre of mass follows.

The plan lives in a frame of its own on the ground, in which feet stand exactly where they were put; where that frame
lies in the world is for others to know. It goes through these phases:

- `STANCE`: from how the robot stands to the height and lean of the walk, feet as they are;
- `START`: the pressure goes to the foot that carries first. Before, it goes away from it for a moment, by as much as
  it takes that the body, at rest in the middle, is in time where the first step needs it;
- `STEP`: one step after the other, as a course makes them;
- `SETTLE`: the pressure comes to the middle, the body to rest over it;
- `STAND`: nothing changes.
"""

from __future__ import annotations

from enum import Enum
from math import exp, sqrt
from typing import Mapping, Sequence

from nao_sim_bridge.walk.courses import Course, Rate, Step
from nao_sim_bridge.walk.footsteps import FootInAir, FootPose, middle, swing
from nao_sim_bridge.walk.legs import LEFT, RIGHT
from nao_sim_bridge.walk.pattern import Point, Segment, divergent_component
from nao_sim_bridge.walk.settings import WalkSettings

# A foot is in the air for this at most, s: longer steps stand on both feet the longer.
LONGEST_SWING = 0.48
# A foot leaves the ground when this much of the time is left in which the weight goes to the other one, s, and lands as
# much before the weight comes to it; of shorter times half of it.
LEAVES_BEFORE = 0.06
ROUNDING = 1e-9


class Phase(Enum):
    """What a walk is at, see the module."""

    STANCE = "stance"
    START = "start"
    STEP = "step"
    SETTLE = "settle"
    STAND = "stand"


class WalkPlan:
    """Advances a walk, tick by tick; `gravity` in m/s2.

    Attributes:
        phase: What it is at.
        feet: Side (1 left, -1 right) to where the foot stands or stood.
        support: Side of the foot that carries, or that carries first.
        step: The one that is made; None before the first and after the last.
        com: Where the centre of mass is to be over the ground, m.
        divergent: Where its divergent component is to be, m.
        pressure: Where the zero moment point is to be, m.
        time: Since the begin of the phase or step, s.
        waited: How long the foot in the air has been waited for, s.
    """

    def __init__(self, settings: WalkSettings, gravity: float, feet: Mapping[int, FootPose], com: Point) -> None:
        self._settings = settings
        self.omega = sqrt(gravity / settings.com_height)
        self.phase = Phase.STANCE
        self.feet = dict(feet)
        self.support = LEFT
        self.step: Step | None = None
        self.time = 0.0
        self.waited = 0.0
        self.com = com
        self.divergent = com
        self.pressure = com
        self._start_com = com
        self._course: Course | None = None
        self._take_off = self.feet[RIGHT]
        # What remains of the phase or step: pieces with the time of their end, and the divergent component after them.
        self._pieces: list[tuple[float, Segment]] = []
        self._after: Point = com

    # --- what it is at --------------------------------------------------------------------------------------------

    @property
    def walking(self) -> bool:
        """Whether steps are made or about to be."""
        return self.phase in (Phase.START, Phase.STEP)

    @property
    def swing_share(self) -> float:
        """How far the foot in the air is on its way, 0..1; 0 as long as both feet carry."""
        if self.phase is not Phase.STEP or self.step is None:
            return 0.0
        double = self._double(self.step)
        leaves = double - min(0.5 * double, LEAVES_BEFORE)
        return min(max((self.time - leaves) / (self.step.period - double), 0.0), 1.0)

    def foot(self, side: int) -> FootInAir:
        if self.phase is not Phase.STEP or self.step is None or side != self.step.side:
            return FootInAir(self.feet[side], 0.0)
        settings = self._settings
        lift = self.step.gait.step_height + settings.extra_lift
        now = swing(self._take_off, self.step.landing, self.swing_share, lift)
        sink = settings.sink * min(1.0, self.waited / settings.latest) if self.waited else 0.0
        return now._replace(height=now.height - sink) if sink else now

    def rest(self) -> Point:
        """Where the body is at rest over both feet."""
        return self._between(self.feet)

    @property
    def robot(self) -> FootPose:
        """Where the robot is when this step is done."""
        feet = self.feet
        if self.step is not None:
            feet = {**feet, self.step.side: self.step.landing}
        return middle(feet[LEFT], feet[RIGHT])

    @property
    def way(self) -> Rate:
        """How far the robot goes in this step, as it will be turned then."""
        x, y, yaw = middle(self.feet[LEFT], self.feet[RIGHT]).seen_from(self.robot)
        return (-x, -y, -yaw)

    @property
    def lead(self) -> float:
        """Time from now to the begin of the step that is made or comes first, s; negative when it has begun."""
        settings = self._settings
        before = {Phase.STANCE: settings.lead, Phase.START: settings.lead - settings.stance_time}
        return before.get(self.phase, 0.0) - self.time

    def further(self, count: int) -> list[Step]:
        """Steps after the one that is made, as they are planned now."""
        if self._course is None or self.step is None:
            return []
        return self._course.upcoming(self.step.landing, -self.step.side, count)

    # --- what it does ---------------------------------------------------------------------------------------------

    def begin(self, course: Course) -> None:
        """Start to walk, from standing."""
        self._course = course
        side = course.first_side(self.feet)
        self.support = -side
        self.phase = Phase.START
        settings = self._settings
        self.time = 0.0
        self._commit()
        first = self.step
        assert first is not None
        rest, pressed = self.com, self._pressed(self.feet[self.support], self.support)
        shift = Segment(settings.shift_time, rest, pressed)
        hold = Segment(first.period, pressed, pressed)
        needed = divergent_component([shift, hold], self._after, self.omega)
        decay = exp(-self.omega * settings.push_time)
        away = ((rest[0] - decay * needed[0]) / (1.0 - decay), (rest[1] - decay * needed[1]) / (1.0 - decay))
        self._pieces = []
        end = 0.0
        for piece in (Segment(settings.push_time, away, away), shift, hold):
            end += piece.duration
            self._pieces.append((end, piece))

    def take_course(self, course: Course) -> None:
        """Go somewhere else from the next step on."""
        self._course = course

    def advance(self, dt: float, landed: bool) -> None:
        """One tick of `dt` s; `landed`: whether the foot in the air, if any, feels the ground."""
        if self._late(landed, dt):
            self.waited += dt
        else:
            self.time += dt
            self._go_on()
        self._follow(dt)

    def _late(self, landed: bool, dt: float) -> bool:
        step = self.step
        return (
            self.phase is Phase.STEP
            and step is not None
            and not landed
            and self.time + dt >= step.period - ROUNDING
            and self.waited < self._settings.latest
        )

    def _go_on(self) -> None:
        """To the next phase or step, when its time has come."""
        settings = self._settings
        if self.phase is Phase.STANCE and self.time >= settings.stance_time:
            self._stand()
        elif self.phase is Phase.START and self.time >= settings.push_time + settings.shift_time - ROUNDING:
            self.time -= settings.push_time + settings.shift_time
            self.phase = Phase.STEP
            self._take_off = self.feet[-self.support]
            self._plan_step(self._pressed(self.feet[self.support], self.support))
        elif self.phase is Phase.STEP and self.step is not None and self.time >= self.step.period - ROUNDING:
            self._land(self.step)
        elif self.phase is Phase.SETTLE and self.time >= settings.settle_time + settings.stand_time:
            self._stand()

    def _stand(self) -> None:
        self.phase = Phase.STAND
        self.time = 0.0
        self._pieces, self._after = [], self.rest()

    def _land(self, step: Step) -> None:
        carried = self._pressed(self.feet[self.support], self.support)
        self.feet[step.side] = step.landing
        self.support = step.side
        self.time -= step.period
        self.waited = 0.0
        if not self._commit():
            self.phase = Phase.SETTLE
            self._pieces = [(self._settings.settle_time, Segment(self._settings.settle_time, carried, self.rest()))]
            self._after = self.rest()
            return
        self._take_off = self.feet[-self.support]
        self._plan_step(carried)

    def _commit(self) -> bool:
        """Take the next step of the course; False when there is none."""
        assert self._course is not None
        foot, side = self.feet[self.support], -self.support
        steps = self._course.upcoming(foot, side, self._settings.steps_ahead + 1)
        if not steps:
            self.step = None
            return False
        self._course.take(foot, side)
        self.step = steps[0]
        self._after = self._beyond(steps)
        return True

    def _plan_step(self, start: Point) -> None:
        """Where the pressure goes during the step."""
        assert self.step is not None
        double, period = self._double(self.step), self.step.period
        pressed = self._pressed(self.feet[self.support], self.support)
        self._pieces = [
            (double, Segment(double, start, pressed)),
            (period, Segment(period - double, pressed, pressed)),
        ]

    def _beyond(self, steps: Sequence[Step]) -> Point:
        """Where the divergent component has to be at the end of the first of some steps."""
        feet = {**self.feet, steps[0].side: steps[0].landing}
        pressed = self._pressed(self.feet[-steps[0].side], -steps[0].side)
        segments = []
        for before, step in zip(steps, steps[1:]):
            after = self._pressed(before.landing, before.side)
            double = self._double(step)
            segments += [Segment(double, pressed, after), Segment(step.period - double, after, after)]
            pressed = after
            feet[step.side] = step.landing
        end = self._between(feet)
        over = len(steps) <= self._settings.steps_ahead
        last = self._settings.settle_time if over else 0.5 * self._double(steps[-1])
        return divergent_component([*segments, Segment(last, pressed, end)], end, self.omega)

    def _double(self, step: Step) -> float:
        """Time of a step in which both feet carry, s."""
        return max(self._settings.double_support_share * step.period, step.period - LONGEST_SWING)

    def _between(self, feet: Mapping[int, FootPose]) -> Point:
        (ax, ay), (bx, by) = self._pressed(feet[LEFT], LEFT), self._pressed(feet[RIGHT], RIGHT)
        return ((ax + bx) / 2.0, (ay + by) / 2.0)

    def _pressed(self, foot: FootPose, side: int) -> Point:
        at = foot.moved(self._settings.pressure_ahead, -side * self._settings.pressure_inward)
        return (at.x, at.y)

    def _follow(self, dt: float) -> None:
        """Divergent component and pressure of now, and the centre of mass after them."""
        if self.phase is Phase.STANCE:
            share = min(self.time / self._settings.stance_time, 1.0)
            share *= share * (3.0 - 2.0 * share)
            goal = self.rest()
            x, y = (a + share * (b - a) for a, b in zip(self._start_com, goal))
            self.com = self.divergent = self.pressure = (x, y)
            return
        now, remaining = self.time, []
        for end, piece in self._pieces:
            if end <= now + ROUNDING:
                continue
            left = min(end - now, piece.duration)
            if left < piece.duration:
                share = 1.0 - left / piece.duration
                (ax, ay), (bx, by) = piece.start, piece.end
                piece = Segment(left, (ax + (bx - ax) * share, ay + (by - ay) * share), piece.end)
            remaining.append(piece)
        self.divergent = divergent_component(remaining, self._after, self.omega)
        if remaining:
            self.pressure = remaining[0].start
        else:
            self.pressure = self._pieces[-1][1].end if self._pieces else self.rest()
        (x, y), (dx, dy) = self.com, self.divergent
        step = dt * self.omega
        self.com = (x + step * (dx - x), y + step * (dy - y))

"""Follows a chain of motions before anything moves: where joints would be, how stiff, and whether it can be done. Pure.

The checks of the motion functions tell the plan what each function will do; the plan raises `BadGoal` where a joint
cannot, and adds up how long the chain takes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from ..base.errors import BadGoal
from ..base.field_checks import degrees_hint, require_within
from ..base.limits import limit
from .facts import JointState, MotionFacts
from .health import Health
from .walk_plan import LEGS, WalkPlan

# The robot's numbers have 32 bits: a limit that it tells must be allowed as a target. rad.
TOLERANCE = 1e-4
# A motion that takes this share longer than a joint at top speed would is taken as possible.
SPEED_TOLERANCE = 1.001
POSTURE_TIME = 2.0
ANGLE = limit("angle")


class MotionPlan:
    """The joints as a chain of functions would leave them.

    Attributes:
        touched: Joints that the chain moves or asks for, in order, each once.
        aimed: Those that the chain gives targets without waiting for them.
        moves: Whether the chain moves anything.
        durations: Place of each function in the chain, counted from 1 -> how long it takes as far as known, s.
        walk: What the chain does with the walk.
        health: How the robot is; asked for when a function first needs to know.

    Args:
        facts: The joints.
        read_state: Asks the robot where they are; called when a function first needs to know.
        read_walking: Asks the robot whether it walks.
        read_posture: Asks the robot for the family of its posture.
        read_health: Asks the robot how it is.
    """

    def __init__(
        self,
        facts: Callable[[], MotionFacts],
        read_state: Callable[[], JointState],
        read_walking: Callable[[], bool] = lambda: False,
        read_posture: Callable[[], str] = lambda: "Standing",
        read_health: Callable[[], Health] = Health,
    ) -> None:
        self.touched: dict[str, None] = {}
        self.aimed: dict[str, None] = {}
        self.moves = False
        self.durations: dict[int, float] = {}
        self._read_facts = facts
        self._read_state = read_state
        self._read_health = read_health
        self._health: Health | None = None
        self._angles: dict[str, float | None] | None = None
        self._stiffnesses: dict[str, float] | None = None
        self._position = 0
        self._moved: frozenset[str] = frozenset()  # replaced as a whole: other threads read it
        self.walk = WalkPlan(
            lambda: self.facts.chains, self._stiffness, lambda joint: joint in self._moved, read_walking, read_posture
        )

    @property
    def facts(self) -> MotionFacts:
        """The joints.

        Raises:
            NaoError: If the robot cannot be asked.
        """
        return self._read_facts()

    @property
    def health(self) -> Health:
        """How the robot was when the chain was checked."""
        if self._health is None:
            self._health = self._read_health()
        return self._health

    @property
    def moved(self) -> frozenset[str]:
        """Joints that the chain moves."""
        return self._moved

    def begin_function(self, position: int) -> None:
        """The function at a place of the chain, counted from 1, is looked at next."""
        self._position = position
        self.durations[position] = 0.0

    def takes(self, duration: float) -> None:
        """The function that is looked at takes so long, s."""
        self.durations[self._position] = self.durations.get(self._position, 0.0) + duration

    def touch(self, joints: Iterable[str]) -> None:
        """Note joints for the result."""
        self.touched.update(dict.fromkeys(joints))

    def aim(self, joints: Iterable[str]) -> None:
        """Joints get targets that nobody waits for."""
        self.aimed.update(dict.fromkeys(joints))

    def angle(self, joint: str) -> float | None:
        """Where a joint is by then, rad; None where it is not known any more."""
        self._know()
        assert self._angles is not None
        return self._angles[joint]

    def forget(self, joints: Iterable[str]) -> None:
        """Joints go where only the robot knows."""
        self.moves = True
        self._know()
        assert self._angles is not None
        for joint in joints:
            self._angles[joint] = None
        self._moved |= frozenset(joints)

    def set_stiffness(self, values: Mapping[str, float]) -> None:
        """Joints get stiff or limp."""
        self._know()
        assert self._stiffnesses is not None
        self._stiffnesses.update(values)

    def limp(self, joints: Iterable[str]) -> list[str]:
        """Which of the joints have no stiffness by then."""
        self._know()
        assert self._stiffnesses is not None
        return [joint for joint in joints if not self._stiffnesses[joint] > 0.0]

    def require_stiff(self, joints: Sequence[str], stiffness: float) -> None:
        """See that joints can move: stiff already, or stiffened by the function; and that no walk moves them.

        Raises:
            BadGoal: If they are limp, or the robot walks with them.
        """
        self.walk.require_free(joints)
        self.health.require_fit(joints)
        limp = self.limp(joints)
        if limp and stiffness == 0.0:
            raise BadGoal(
                "stiffness",
                stiffness,
                "above 0 to 1 to stiffen them first; or call wakeUp or setStiffnesses before",
                problem=f"no stiffness in {', '.join(limp)}: nothing would move",
            )
        self.set_stiffness(dict.fromkeys(limp, stiffness))

    def require_fit_legs(self) -> None:
        """See that the robot can get on its feet; an arm or a head that is too hot stays limp then.

        Raises:
            NotFit: If a motor of the legs is too hot, or the battery empty.
        """
        chains = self.facts.chains
        self.health.require_fit([joint for leg in LEGS for joint in chains.get(leg, ())])

    def require_angle(self, joint: str, angle: float, field: str) -> None:
        """See that an angle is within the limits of a joint.

        Raises:
            BadGoal: If it is not; names the limits.
        """
        limits = self.facts.limits[joint]
        if not (math.isfinite(angle) and limits.lower - TOLERANCE <= angle <= limits.upper + TOLERANCE):
            hint = degrees_hint(angle, limits.lower, limits.upper)
            raise BadGoal(
                field,
                angle,
                f"{limits.lower:.4f} to {limits.upper:.4f}{_unit(joint)}{hint}",
                problem=f"{joint} cannot go to {angle:.4f}{_unit(joint)}",
            )

    def targets(self, angles: Mapping[str, float], relative: bool, field: str = "angles") -> dict[str, float | None]:
        """Where joints are to go.

        Args:
            angles: Joint -> rad.
            relative: Whether they are added to where the joints are by then.
            field: What errors call them.

        Raises:
            BadGoal: If one is out of reach. A relative one of a joint whose angle is not known is taken on trust.
        """
        goals: dict[str, float | None] = {}
        for joint, angle in angles.items():
            before = self.angle(joint) if relative else 0.0
            goals[joint] = None if before is None else before + angle
            if goals[joint] is not None:
                self.require_angle(joint, goals[joint], field)  # type: ignore[arg-type]
            else:
                require_within(field, angle, ANGLE)
        return goals

    def move(self, goals: Mapping[str, float | None], duration: float) -> None:
        """Joints go to where they are to go, in a straight line; the speed is not looked at."""
        self.moves = True
        self._know()
        assert self._angles is not None
        self._angles.update(goals)
        self._moved |= frozenset(goals)
        self.touch(goals)
        self.takes(duration)

    def move_with_speed(self, goals: Mapping[str, float | None], fractions: Mapping[str, float]) -> None:
        """Joints go to where they are to go at fractions of their top speeds."""
        longest = 0.0
        fractions = {joint: self.health.careful(goals, fraction) for joint, fraction in fractions.items()}
        for joint, goal in goals.items():
            before = self.angle(joint)
            if goal is not None and before is not None:
                top = self.facts.limits[joint].max_speed * fractions[joint]
                longest = max(longest, abs(goal - before) / top)
        self.move(goals, longest)

    def follow(
        self, values: Mapping[str, Sequence[float]], times: Sequence[float], relative: bool, field: str = "angles"
    ) -> None:
        """Joints go through key frames.

        Args:
            values: Joint -> its angles at the times, rad.
            times: s from the start, rising, above 0.
            relative: Whether the angles are added to where the joint is at the start.
            field: What errors call the angles.

        Raises:
            BadGoal: If an angle is out of reach, or a joint would have to be faster than it is.
        """
        goals: dict[str, float | None] = {}
        for joint, angles in values.items():
            start = self.angle(joint)
            offset = start if relative else 0.0
            before, since = start, 0.0
            for angle, time in zip(angles, times):
                goal = None if offset is None else offset + angle
                if goal is not None:
                    self.require_angle(joint, goal, field)
                    self._require_time(joint, before, goal, time - since, time)
                else:
                    require_within(field, angle, ANGLE)
                before, since = goal, time
            goals[joint] = before
        self.move(goals, times[-1])

    def _require_time(self, joint: str, before: float | None, goal: float, given: float, time: float) -> None:
        if before is None:
            return
        least = abs(goal - before) / self.facts.limits[joint].max_speed
        if given * SPEED_TOLERANCE < least:
            raise BadGoal(
                "times",
                time,
                f"at least {least:.3f} s for this step",
                problem=f"{joint} cannot go from {before:.3f} to {goal:.3f} in {given:.3f} s",
            )

    def _stiffness(self, joint: str) -> float:
        self._know()
        assert self._stiffnesses is not None
        return self._stiffnesses[joint]

    def _know(self) -> None:
        if self._angles is None:
            state = self._read_state()
            self._angles, self._stiffnesses = dict(state.angles), dict(state.stiffnesses)


def _unit(joint: str) -> str:
    return "" if joint.endswith("Hand") else " rad"

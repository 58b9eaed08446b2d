"""Follows a chain of motions before anything moves: where joints would be, how stiff, and whether it can be done. Pure.

The checks of the motion functions tell the plan what each function will do; the plan raises `BadGoal` where a joint
cannot, and adds up how long the chain takes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from ..base.errors import BadGoal, CannotWalk
from ..base.field_checks import degrees_hint, require_within
from ..base.limits import limit
from ..nao.stiff_legs import require_stiff
from .facts import ARMS, BODY, LEGS, JointState, MotionFacts
from .health import Health

# The robot's numbers have 32 bits: a limit that it tells must be allowed as a target. rad.
TOLERANCE = 1e-4
# A motion that takes this share longer than a joint at top speed would is taken as possible.
SPEED_TOLERANCE = 1.001
POSTURE_TIME = 2.0
ANGLE = limit("angle")
NOT_ON_FEET = ("Sit", "Lying")
"""How names of postures and families begin from which nobody walks."""


class MotionPlan:
    """The joints as a chain of functions would leave them.

    Attributes:
        touched: Joints that the chain moves or asks for, in order, each once.
        asked: Those of them that it only asks for after its last motion of them.
        answers: Joint -> angle that was last answered of it, rad (hands 0..1); filled while the chain runs.
        aimed: Those that the chain gives targets without waiting for them.
        moves: Whether the chain moves anything.
        moved: Joints that it moves; replaced as a whole, for other threads read it.
        durations: Place of each function in the chain, counted from 1 -> how long it takes as far as known, s.
        walk: What the chain does with the walk.

    Args:
        read_facts, read_state, read_walking, read_posture, read_health: Ask the robot, each when a function first
            needs to know: its joints, their state, whether it walks, the family of its posture, how it is.
    """

    def __init__(
        self,
        read_facts: Callable[[], MotionFacts],
        read_state: Callable[[], JointState],
        read_walking: Callable[[], bool] = lambda: False,
        read_posture: Callable[[], str] = lambda: "Standing",
        read_health: Callable[[], Health] = Health,
    ) -> None:
        self.touched: dict[str, None] = {}
        self.asked: set[str] = set()
        self.answers: dict[str, float] = {}
        self.aimed: dict[str, None] = {}
        self.moves = False
        self.moved: frozenset[str] = frozenset()
        self.durations: dict[int, float] = {}
        self._read_facts = read_facts
        self._read_state = read_state
        self._read_health = read_health
        self._health: Health | None = None
        self._known: tuple[dict[str, float | None], dict[str, float]] | None = None
        self._position = 0
        self.walk = WalkPlan(self, read_walking, read_posture)

    @property
    def facts(self) -> MotionFacts:
        """The joints. Raises NaoError if the robot cannot be asked."""
        return self._read_facts()

    @property
    def health(self) -> Health:
        """How the robot was when the chain was checked."""
        if self._health is None:
            self._health = self._read_health()
        return self._health

    @property
    def angles(self) -> dict[str, float | None]:
        """Where joints are by then, rad; None where it is not known any more."""
        return self._know()[0]

    @property
    def stiffnesses(self) -> dict[str, float]:
        """How stiff joints are by then, 0..1."""
        return self._know()[1]

    def begin_function(self, position: int) -> None:
        """The function at a place of the chain, counted from 1, is looked at next."""
        self._position = position
        self.durations[position] = 0.0

    def takes(self, duration: float) -> None:
        """The function that is looked at takes so long, s."""
        self.durations[self._position] = self.durations.get(self._position, 0.0) + duration

    def touch(self, joints: Iterable[str]) -> None:
        self.touched.update(dict.fromkeys(joints))

    def ask(self, joints: Iterable[str]) -> None:
        """The result has joints as they are at this place of the chain."""
        self.touch(joints)
        self.asked.update(joints)

    def aim(self, joints: Iterable[str]) -> None:
        """Joints get targets that nobody waits for."""
        self.aimed.update(dict.fromkeys(joints))

    def forget(self, joints: Iterable[str]) -> None:
        """Joints go where only the robot knows."""
        self._goes(dict.fromkeys(joints))

    def leave_to_robot(self, joints: Sequence[str], duration: float = 0.0) -> None:
        """Joints that the result names go where only the robot knows, in a time, s."""
        self.move(dict.fromkeys(joints), duration)

    def change_posture(self, duration: float, posture: str | None = None) -> None:
        """The whole robot moves as only it knows: it is stiff afterwards, and does not walk."""
        body = list(self.facts.chains[BODY])
        self.stiffnesses.update(dict.fromkeys(body, 1.0))
        self.leave_to_robot(body, duration)
        self.walk.stands(posture)

    def _goes(self, goals: Mapping[str, float | None]) -> None:
        self.moves = True
        self.angles.update(goals)
        self.asked.difference_update(goals)
        self.moved |= frozenset(goals)

    def limp(self, joints: Iterable[str]) -> list[str]:
        return [joint for joint in joints if not self.stiffnesses[joint] > 0.0]

    def require_stiff(self, joints: Sequence[str], stiffness: float) -> None:
        """See that joints can move: stiff already, or stiffened by the function; and that no walk moves them.

        Raises BadGoal if they are limp, or the robot walks with them.
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
        self.stiffnesses.update(dict.fromkeys(limp, stiffness))

    def require_fit_legs(self) -> None:
        """See that the robot can get on its feet; an arm or a head that is too hot stays limp then.

        Raises NotFit if a motor of the legs is too hot, or the battery empty.
        """
        self.health.require_fit(self.legs())

    def legs(self) -> list[str]:
        chains = self.facts.chains
        return [joint for leg in LEGS for joint in chains.get(leg, ())]

    def require_angle(self, joint: str, angle: float, field: str) -> None:
        """See that an angle is within the limits of a joint. Raises BadGoal if it is not; names the limits."""
        limits = self.facts.limits[joint]
        if not (math.isfinite(angle) and limits.lower - TOLERANCE <= angle <= limits.upper + TOLERANCE):
            unit = "" if joint.endswith("Hand") else " rad"
            hint = degrees_hint(angle, limits.lower, limits.upper)
            allowed = f"{limits.lower:.4f} to {limits.upper:.4f}{unit}{hint}"
            raise BadGoal(field, angle, allowed, problem=f"{joint} cannot go to {angle:.4f}{unit}")

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
            goals[joint] = self._goal(joint, angle, self.angles[joint] if relative else 0.0, field)
        return goals

    def move(self, goals: Mapping[str, float | None], duration: float) -> None:
        """Joints go to where they are to go, in a straight line; the speed is not looked at."""
        self._goes(goals)
        self.touch(goals)
        self.takes(duration)

    def move_with_speed(self, goals: Mapping[str, float | None], fractions: Mapping[str, float]) -> None:
        """Joints go to where they are to go at fractions of their top speeds."""
        longest = 0.0
        fractions = {joint: self.health.careful(goals, fraction) for joint, fraction in fractions.items()}
        for joint, goal in goals.items():
            before = self.angles[joint]
            if goal is not None and before is not None:
                top = self.facts.limits[joint].max_speed * fractions[joint]
                longest = max(longest, abs(goal - before) / top)
        self.move(goals, longest)

    def follow(
        self, values: Mapping[str, Sequence[float]], times: Sequence[float], relative: bool, field: str = "angles"
    ) -> None:
        """Joints go through key frames.

        Raises BadGoal if an angle is out of reach, or a joint would have to be faster than it is.

        Args:
            values: Joint -> its angles at the times, rad.
            times: s from the start, rising, above 0.
            relative: Whether the angles are added to where the joint is at the start.
            field: What errors call the angles.
        """
        goals: dict[str, float | None] = {}
        for joint, angles in values.items():
            start = self.angles[joint]
            offset = start if relative else 0.0
            before, since = start, 0.0
            for angle, time in zip(angles, times):
                goal = self._goal(joint, angle, offset, field)
                self._require_time(joint, before, goal, time - since, time)
                before, since = goal, time
            goals[joint] = before
        self.move(goals, times[-1])

    def _goal(self, joint: str, angle: float, offset: float | None, field: str) -> float | None:
        """Where a joint gets to that goes to `angle` from `offset`, within its limits; None where that is not known."""
        if offset is None:
            require_within(field, angle, ANGLE)
            return None
        self.require_angle(joint, offset + angle, field)
        return offset + angle

    def _require_time(self, joint: str, before: float | None, goal: float | None, given: float, time: float) -> None:
        if before is None or goal is None:
            return
        least = abs(goal - before) / self.facts.limits[joint].max_speed
        if given * SPEED_TOLERANCE < least:
            problem = f"{joint} cannot go from {before:.3f} to {goal:.3f} in {given:.3f} s"
            raise BadGoal("times", time, f"at least {least:.3f} s for this step", problem=problem)

    def _know(self) -> tuple[dict[str, float | None], dict[str, float]]:
        if self._known is None:
            state = self._read_state()
            self._known = (dict(state.angles), dict(state.stiffnesses))
        return self._known


class WalkPlan:
    """Where a chain of functions has the walk."""

    def __init__(self, plan: MotionPlan, read_walking: Callable[[], bool], read_posture: Callable[[], str]) -> None:
        self._plan = plan
        self._read_walking = read_walking
        self._read_posture = read_posture
        self._walking: bool | None = None
        self._posture: str | None = None

    @property
    def walking(self) -> bool:
        if self._walking is None:
            self._walking = self._read_walking()
        return self._walking

    def moved_joints(self) -> list[str]:
        """What a walk moves: legs and arms."""
        chains = self._plan.facts.chains
        return [joint for chain in LEGS + ARMS for joint in chains.get(chain, ()) if not joint.endswith("Hand")]

    def require_ready(self) -> None:
        """See that a walk can begin: on its feet, with stiff legs. Raises CannotWalk if it cannot."""
        legs = self._plan.legs()
        require_stiff({joint: self._plan.stiffnesses[joint] for joint in legs})
        posture = self._posture
        if posture is None and self._plan.moved.isdisjoint(legs) and not self.walking:
            posture = self._read_posture()
        if posture is not None and posture.startswith(NOT_ON_FEET):
            raise CannotWalk(f"the robot does not stand on its feet (posture {posture})", "goToPosture Stand first")

    def require_free(self, joints: Iterable[str]) -> None:
        """See that the walk does not move the joints.

        Raises BadGoal if the robot walks by then, and one is in a leg.
        """
        legs = set(self._plan.legs())
        wanted = [joint for joint in joints if joint in legs]
        if wanted and self.walking:
            problem = f"the robot walks, and {', '.join(wanted)} with it"
            raise BadGoal("names", wanted, "stopMove or waitUntilMoveIsFinished first", problem=problem)

    def goes(self) -> None:
        """The robot walks on when the function is over."""
        self._walking, self._posture = True, None

    def stands(self, posture: str | None = None) -> None:
        """The robot does not walk when the function is over; it is in a posture, if that is known."""
        self._walking, self._posture = False, posture

"""The plan of a chain of motions (where joints would be, how stiff), and the joints and health that it starts from."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError

from ..core.chain import Part
from ..core.errors import BadGoal, CannotWalk, MotionStopped, NotFit
from ..core.fields import degrees_hint, limit, require_within
from ..core.joint_trajectory import expand_names
from ..core.memory_functions import MEMORY
from ..core.nao_facts import (
    CHARGE,
    CURRENT,
    FOOT_CONTACT,
    HOT_MOTOR,
    TOO_HOT_MOTOR,
    JointNames,
    require_stiff,
    temperature_key,
)
from ..core.nao_facts import LEGS as LEGS
from ..core.nao_facts import MOTION as MOTION
from ..core.waiting import OncePerConnection

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic

log = logging.getLogger(__name__)


BODY = "Body"
ARMS = ("LArm", "RArm")


@dataclass(frozen=True)
class JointLimits:
    lower: float  # rad (hands 0..1)
    upper: float
    max_speed: float  # rad/s (hands 1/s)

    def within(self, angle: float) -> float:
        """The nearest angle to this one that the joint can have."""
        return min(max(angle, self.lower), self.upper)


@dataclass(frozen=True)
class MotionFacts:
    """Joints of one robot: those of each chain, and the limits of each."""

    chains: Mapping[str, Sequence[str]]
    limits: Mapping[str, JointLimits]

    def joints(self, names: Sequence[str], field: str = "names") -> list[str]:
        """Joints behind joint and chain names, in order.

        Raises BadGoal if there is none, one is unknown, or one comes twice.
        """
        return list(expand_names([name.strip() for name in names], self.chains, field))


@dataclass(frozen=True)
class JointState:
    """The commands of the joints, and how stiff they are."""

    angles: Mapping[str, float | None]  # rad (hands 0..1); None where it is not known
    stiffnesses: Mapping[str, float]  # 0..1


def one_each(values: Sequence[float], joints: Sequence[str], field: str) -> list[float]:
    """One value for each joint, from one for all or one each. Raises BadGoal if there are as many as neither."""
    if len(values) == 1:
        return list(values) * len(joints)
    if len(values) != len(joints):
        problem = f"{len(values)} values for {len(joints)} joints"
        raise BadGoal(field, list(values), f"one value, or one for each of {', '.join(joints)}", problem=problem)
    return list(values)


HOT_SPEED = 0.5
"""Largest fraction of the top speed that goals give hot motors."""
EMPTY, TOO_LOW_TO_WALK = 0.02, 0.05
"""Charge, 0..1: the robot rests, and a walk might not get to its end."""


@dataclass(frozen=True)
class Health:
    """How the robot was when it was asked; what it does not tell is no hindrance."""

    temperatures: Mapping[str, float] = field(default_factory=dict)  # joint -> degC of its motor
    charge: float | None = None  # of the battery, 0..1
    charging: bool = False
    on_ground: bool | None = None  # whether a foot touches the ground

    def require_fit(self, joints: Iterable[str]) -> None:
        """See that joints may be moved. Raises NotFit if a motor is too hot, or the battery empty."""
        if self.charge is not None and self.charge <= EMPTY and not self.charging:
            raise NotFit(f"the battery is empty ({self.charge:.0%} left)", "plug the charger in")
        hot = self._warmer(joints, TOO_HOT_MOTOR)
        if hot:
            raise NotFit(f"too hot to move: {_list(hot)}", f"rest until they are below {TOO_HOT_MOTOR:g} degC")

    def require_walk(self, joints: Iterable[str], moved: bool) -> None:
        """See that the robot may walk.

        `joints`: what the walk moves. `moved`: whether something moves the robot before: where its feet are then is not
        known. Raises NotFit if a motor is too hot, or the battery empty; CannotWalk if the battery is too low for it,
        or no foot touches the ground.
        """
        self.require_fit(joints)
        if self.charge is not None and self.charge <= TOO_LOW_TO_WALK and not self.charging:
            raise CannotWalk(f"the battery is too low to walk ({self.charge:.0%} left)", "plug the charger in")
        if self.on_ground is False and not moved:
            raise CannotWalk("no foot touches the ground", "put the robot on its feet first")

    def careful(self, joints: Iterable[str], fraction: float) -> float:
        """A fraction of the top speed, or less where one of the joints is hot."""
        if fraction <= HOT_SPEED or not self._warmer(joints, HOT_MOTOR):
            return fraction
        return HOT_SPEED

    def _warmer(self, joints: Iterable[str], limit: float) -> dict[str, float]:
        degrees = {joint: self.temperatures.get(joint, 0.0) for joint in joints}
        return {joint: celsius for joint, celsius in degrees.items() if celsius >= limit}


def read_health(call: Callable[..., Any], joints: Sequence[str]) -> Health:
    """The health of now, with one call; all is well if a robot cannot tell.

    `call`: calls a module of the robot: its name, a method, arguments. `joints`: those whose motors are of interest.
    """
    keys = [CHARGE, CURRENT, FOOT_CONTACT, *map(temperature_key, joints)]
    try:
        values = list(call(MEMORY, "getListData", keys))
    except NaoError as error:
        log.debug("the robot does not tell its health: %s", error)
        return Health()
    numbers = [float(v) if isinstance(v, (int, float)) else None for v in values]
    if len(numbers) != len(keys):
        return Health()
    charge, current, contact, *degrees = numbers
    return Health(
        {joint: celsius for joint, celsius in zip(joints, degrees) if celsius is not None},
        charge,
        current is not None and current > 0.0,
        None if contact is None else contact > 0.0,
    )


def in_chain(joint: str, chain: str) -> bool:
    """Whether a joint rests with a chain of ALMotion's protection: Head, LArm, RArm, LLeg, RLeg, Legs, Body."""
    if chain in ("Body", "Legs"):  # without its legs the whole robot rests
        return True
    if chain == "Head":
        return joint.startswith("Head")
    of_leg = any(part in joint for part in ("Hip", "Knee", "Ankle"))
    return joint[:1] == chain[:1] and chain[1:] == ("Leg" if of_leg else "Arm")


def _list(hot: Mapping[str, float]) -> str:
    return ", ".join(f"{joint} {celsius:.0f} degC" for joint, celsius in sorted(hot.items(), key=lambda row: -row[1]))


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


POSTURES = "ALRobotPosture"
# A command is there when it is this close, rad: the robot's numbers have 32 bits, and its curves end where they end.
REACHED = 0.01
# s
NEWS_TIME = 0.2
DEFAULT_SPEED = 0.3
"""Fraction of the top speed where a message leaves it to us."""


class RobotBody(Part):
    """The joints of the robot, and what the chain of a goal does with them.

    `plan`: what the chain that is checked, or runs, does; new for each goal.
    """

    def __init__(self, module: NaoBasic) -> None:
        self._module = module
        names = JointNames(module.robot)

        def read_facts() -> MotionFacts:
            chains = names.chains
            rows = self.motion("getLimits", BODY)
            limits = {joint: JointLimits(*map(float, row[:3])) for joint, row in zip(chains[BODY], rows)}
            return MotionFacts(chains, limits)

        self._facts = OncePerConnection(module.robot, read_facts)
        self.begin_chain()

    def begin_chain(self, now: bool = True) -> None:
        """Plan a new chain. `now`: whether it finds the joints where they are; else they are anywhere, and stiff."""
        if not now:
            self.plan = MotionPlan(lambda: self.facts, self._any_state)
            return
        self.plan = MotionPlan(
            lambda: self.facts,
            self._state,
            lambda: bool(self.motion("moveIsActive")),
            lambda: str(self.call(POSTURES, "getPostureFamily")),
            lambda: read_health(self.call, list(self.facts.limits)),
        )

    @property
    def facts(self) -> MotionFacts:
        """The joints that there are, asked again after each reconnection.

        Raises NaoError if the robot cannot be asked.
        """
        return self._facts()

    def joints(self, names: Sequence[str], field: str = "names") -> list[str]:
        """Joints behind joint and chain names, as MotionFacts has them."""
        return self.facts.joints(names, field)

    def call(self, proxy: str, method: str, *args: Any) -> Any:
        """Call a module of the robot by its name; preemption ends the call and what it does."""
        return self._module.call(self._module.robot.proxy(proxy), method, *args)

    def motion(self, method: str, *args: Any) -> Any:
        """Call ALMotion; preemption ends the call and what it does."""
        return self.call(MOTION, method, *args)

    def motion_now(self, method: str, *args: Any) -> Any:
        """Call a quick method of ALMotion that preemption must not end."""
        return self._module.call_now(self._module.robot.proxy(MOTION), method, *args)

    def stiffen(self, joints: Sequence[str], stiffness: float) -> None:
        """Give joints that have none this stiffness; nothing with 0."""
        if stiffness <= 0.0:
            return
        now = self._state().stiffnesses
        limp = [joint for joint in joints if not now[joint] > 0.0]
        if limp:
            self.motion("setStiffnesses", limp, [stiffness] * len(limp))

    def careful(self, joints: Iterable[str], fraction: float) -> float:
        """A fraction of the top speed, or less where a motor is hot."""
        allowed = self.plan.health.careful(joints, fraction)
        if allowed < fraction:
            log.warning("%s is hot: at %g of the top speed instead of %g", ", ".join(joints), allowed, fraction)
        return allowed

    def require_reached(self, goals: Mapping[str, float]) -> None:
        """See that the commands of joints are where a motion was to bring them.

        A motion that somebody stops ends like one that is over; NAOqi does not distinguish the two. Raises
        MotionStopped if one is not, NaoError if something else is known to have stopped it: a fall. `goals`: joint ->
        rad (hands 0..1).
        """
        now = self.motion("getAngles", list(goals), False)
        off = {joint: (goal, at) for (joint, goal), at in zip(goals.items(), now) if abs(at - goal) > REACHED}
        if off and not self._swing(off):
            # The news of a fall may be on its way.
            if self._module.interrupt.wait(NEWS_TIME):
                self._module.interrupt.check()
            raise MotionStopped(off)

    def halt(self) -> None:
        """Stop what the chain has set going, where the joints are; preemption does not interrupt this."""
        touched, aimed = list(self.plan.touched), list(self.plan.aimed)
        try:
            if touched:
                self.motion_now("killTasksUsingResources", touched)
            if aimed:
                # A target is no task: a new one, at the present command of the joint, ends it.
                self.motion_now("setAngles", aimed, self.motion_now("getAngles", aimed, False), 1.0)
        except NaoError as error:
            log.warning("joints may go on moving: %s", error)

    def _swing(self, joints: Iterable[str]) -> bool:
        """Whether the joints are of arms that swing: when a motion is over they go back to that at once."""
        chains = self.facts.chains
        arms = {joint for arm in ARMS for joint in chains.get(arm, ())}
        return arms.issuperset(joints) and bool(self.motion("moveIsActive"))

    def _state(self) -> JointState:
        joints = self.facts.chains[BODY]
        angles, stiffnesses = self.motion("getAngles", BODY, False), self.motion("getStiffnesses", BODY)
        return JointState(dict(zip(joints, angles)), dict(zip(joints, stiffnesses)))

    def _any_state(self) -> JointState:
        joints = self.facts.chains[BODY]
        return JointState(dict.fromkeys(joints), dict.fromkeys(joints, 1.0))


class BodyPart(Part):
    """Functions that move the joints or ask about them. Their parameters are fields of MotionFunction."""

    def __init__(self, body: RobotBody) -> None:
        self.body = body
        self.motion = body.motion

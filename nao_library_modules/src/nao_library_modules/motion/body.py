"""What the parts of NaoMotion share: the robot's joints, the plan of the chain, calls to ALMotion, stopping."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from naoqi.errors import NaoError

from ..base.errors import MotionStopped
from ..base.once_per_connection import OncePerConnection
from ..functions.parts import Part
from ..nao.joint_names import JointNames
from .facts import ARMS, BODY, MOTION, JointLimits, JointState, MotionFacts
from .health import read_health
from .plan import MotionPlan

if TYPE_CHECKING:
    from ..server.nao_basic import NaoBasic

log = logging.getLogger(__name__)

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

"""What the groups of motion functions share: the robot's motion, the plan of the chain, and stopping."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from naoqi.errors import NaoError

from ..base.cancellation import CancellationToken
from ..base.errors import MotionStopped
from .facts import MOTION, MotionAccess
from .plan import MotionPlan
from .walk_plan import ARMS

log = logging.getLogger(__name__)

# A command is there when it is this close, rad: the robot's numbers have 32 bits, and its curves end where they end.
REACHED = 0.01
# s
NEWS_TIME = 0.2
DEFAULT_SPEED = 0.3
"""Fraction of the top speed where a message leaves it to us."""


class MotionBase:
    """To be mixed into NaoBasic.

    Attributes:
        access: Facts and state of the joints.
        plan: What the chain that is checked, or runs, does; new for each goal.
    """

    robot: Any  # Robot
    interrupt: CancellationToken
    call: Callable[..., Any]  # of NaoBasic: a call that preemption interrupts
    call_now: Callable[..., Any]  # of NaoBasic: a call that it does not
    access: MotionAccess
    plan: MotionPlan

    def motion(self, method: str, *args: Any) -> Any:
        """Call ALMotion; preemption ends the call and what it does."""
        return self.call(self.robot.proxy(MOTION), method, *args)

    def joints(self, names: Sequence[str]) -> list[str]:
        """Joints behind joint and chain names."""
        return self.access.facts.joints(names)

    def stiffen(self, joints: Sequence[str], stiffness: float) -> None:
        """Give joints that have none this stiffness; nothing with 0."""
        if stiffness <= 0.0:
            return
        now = self.access.state().stiffnesses
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
        """See that joints are told to be where a motion was to bring them.

        A motion that somebody stops ends like one that is over; NAOqi does not tell the two apart.

        Args:
            goals: Joint -> rad (hands 0..1).

        Raises:
            MotionStopped: If one is not.
            NaoError: If something else is known to have stopped it: a fall.
        """
        now = self.motion("getAngles", list(goals), False)
        off = {joint: (goal, at) for (joint, goal), at in zip(goals.items(), now) if abs(at - goal) > REACHED}
        if off and not self._swing(off):
            # The news of a fall may be on its way.
            if self.interrupt.wait(NEWS_TIME):
                self.interrupt.check()
            raise MotionStopped(off)

    def _swing(self, joints: Iterable[str]) -> bool:
        """Whether the joints are of arms that swing: when a motion is over they go back to that at once."""
        chains = self.access.facts.chains
        arms = {joint for arm in ARMS for joint in chains.get(arm, ())}
        return arms.issuperset(joints) and bool(self.motion("moveIsActive"))

    def halt(self) -> None:
        """Stop what the chain has set going, where the joints are; preemption does not interrupt this."""
        proxy = self.robot.proxy(MOTION)
        touched, aimed = list(self.plan.touched), list(self.plan.aimed)
        try:
            if touched:
                self.call_now(proxy, "killTasksUsingResources", touched)
            if aimed:
                # A target is no task: a new one, where the joint is told to be, ends it.
                self.call_now(proxy, "setAngles", aimed, self.call_now(proxy, "getAngles", aimed, False), 1.0)
        except NaoError as error:
            log.warning("joints may go on moving: %s", error)

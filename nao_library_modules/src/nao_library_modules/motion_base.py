"""What the groups of motion functions share: the robot's motion, the plan of the chain, and stopping."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from typing import Any

from naoqi.errors import NaoError

from .interrupt import Interrupt
from .motion_facts import MOTION, MotionAccess
from .motion_plan import MotionPlan

log = logging.getLogger(__name__)

DEFAULT_SPEED = 0.3
"""Fraction of the top speed where a message leaves it to us."""


class MotionBase:
    """To be mixed into NaoBasic.

    Attributes:
        access: Facts and state of the joints.
        plan: What the chain that is checked, or runs, does; new for each goal.
    """

    robot: Any  # Robot
    interrupt: Interrupt
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

#!/usr/bin/env python3
"""Rules and a process module of one's own: `an(action, type="greeting", person="Anna")` in three steps.

1. A rule with a pattern: what the keys have to be, and which command or plan that is.
2. A rule that gives several solutions: the next one is tried when one fails.
3. A process module with a command: one more command is one key-value pair.

Needs a running robot, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator

import rospy

from nao_library_modules.process_modules.control import do, par
from nao_library_modules.process_modules.designators.designator import action, an
from nao_library_modules.process_modules.designators.rules import Command, command, number, rule, text
from nao_library_modules.process_modules.failures import ManipulationPoseUnreachable
from nao_library_modules.process_modules.low_level import this_robot
from nao_library_modules.process_modules.nao_modules import RobotModule
from nao_library_modules.process_modules.plan_runner import run_and_tell, wake_up
from nao_library_modules.process_modules.registry import perform, with_process_modules_running


# 1. Keys that have to be there, and one that may be left out. The rule gives a plan: a function.
@rule(action, type="greeting", person=text(), waves=number(1, 5).or_else(2))
def greeting(person: str, waves: float) -> Callable[[], None]:
    """Greet somebody by name, and wave meanwhile."""

    def plan() -> None:
        par(
            do(perform, an(action, type="saying", text=f"Hello, {person}!")),
            do(perform, an(action, type="waving", times=waves)),
        )

    return plan


# 2. Several solutions, the best first: a high wave, a low one.
@rule(action, type="waving", times=number(1, 5))
def waving(times: float) -> Iterator[Command]:
    """Wave with the right hand."""
    for height in (0.25, 0.15):
        yield command("waver", "wave", times=int(times), height=height)


# 3. A module whose command waves: with the functions of the module beside it.
class Waver(RobotModule):
    """Waves."""

    name = "waver"

    def __init__(self) -> None:
        super().__init__(this_robot())
        self.commands = {"wave": self.wave}

    def wave(self, times: int, height: float) -> None:
        """Move the right hand to and fro at a height over the torso, m."""
        for _ in range(times):
            for aside in (-0.2, -0.12):
                perform(an(action, type="reaching", side="right", target=[0.1, aside, height]))


def greet(person: str) -> None:
    """Greet, with the next solution of the wave when the first one is out of reach."""
    desig = an(action, type="greeting", person=person)
    try:
        perform(desig)
    except ManipulationPoseUnreachable:
        perform(an(action, type="saying", text="My arm is too short for that."))


def main() -> int:
    """Greet; the exit status tells whether it succeeded."""
    person = " ".join(rospy.myargv()[1:]) or "world"
    rospy.init_node("add_a_rule", anonymous=True)
    wake_up()
    with with_process_modules_running(Waver()):
        return run_and_tell(do(greet, person))


if __name__ == "__main__":
    sys.exit(main())

"""Diagnosis effect: what cannot work safely is put to rest, and stays limp until it is fine again.

A chain with a very hot motor goes to a safe posture first, one with a critical motor is limp at once, and so is one
with a motor that was found broken. For legs that means the whole body, and the robot does not wake up before they are
fine. An empty battery puts the whole body to rest, too, until it is charged.

Source: NAOqi's table of rest reflexes of NAO (motor temperature, diagnosis).
"""

from __future__ import annotations

import logging
from typing import Callable, Sequence

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.battery import BatteryReading
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.temperatures import CRITICAL, VERY_HOT, heat_status
from nao_sim_bridge.body.temperatures import HOT as LIMITS
from nao_sim_bridge.control.joints.idle import chain_indices
from nao_sim_bridge.core import posture_change, sequences
from nao_sim_bridge.core.robot import SimulatedRobot

log = logging.getLogger("nao_sim.diagnosis")

LEGS = "Legs"
# Motors below this, degC, are no reason for anything.
HOTTEST = LIMITS[VERY_HOT - 1]
SAFE_POSTURE = "Crouch"
SAFE_TIME = 2.0
HOT = "the motors of the legs are too hot, the robot wakes up when they have cooled down"
BROKEN = "a motor of the legs is broken, the robot wakes up when it is repaired"
EMPTY = "the battery is empty, the robot wakes up when it is charged"


class DiagnosisEffect:
    """Puts chains to rest; called with each snapshot, in the simulation thread.

    Attributes:
        disabled: Chains that are kept limp: Head, LArm, RArm, or Legs for the whole body.

    Args:
        robot: Which robot there is now.
        on_rest: Called when the whole body goes to rest.
    """

    def __init__(self, robot: Callable[[], SimulatedRobot], on_rest: Callable[[], None] = lambda: None) -> None:
        self._robot_now = robot
        self._on_rest = on_rest
        self._robot: SimulatedRobot | None = None
        self._temperatures: Sequence[float] = ()
        self.disabled: frozenset[str] = frozenset()
        self._exhausted = False

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at motors and battery when there are new temperatures, which is ten times a second."""
        if snapshot.temperatures is self._temperatures:
            return
        self._temperatures = snapshot.temperatures
        robot = self._robot_now()
        if robot is not self._robot:
            self._begin(robot)
        enabled, found = robot.reflexes.diagnosis_enabled, robot.faults.found
        healthy = max(snapshot.temperatures) < HOTTEST and not (found or snapshot.battery.nearly_empty)
        if healthy and not (self.disabled or self._exhausted):
            return
        status = {
            name: max(heat_status(snapshot.temperatures[i]) for i in chain) for name, chain in self._chains.items()
        }
        broken = {name for name, chain in self._chains.items() if not found.isdisjoint(chain)}
        bad = {name for name, worst in status.items() if worst >= VERY_HOT or name in broken} if enabled else set()
        self._exhausted = _exhausted(snapshot.battery, self._exhausted)
        robot.reflexes.wake_forbidden = self._reason(bad, broken)
        if self._exhausted:
            bad.add(LEGS)
        for name in sorted(bad - self.disabled):
            log.warning("%s goes to rest: %s", name, self._why(name, broken))
            self._rest(robot, name, status[name] >= CRITICAL, snapshot)
        if bad != self.disabled:
            self.disabled = frozenset(bad)
            if not bad:
                log.warning("nothing keeps the robot at rest any more")
        # A chain that is fine again takes stiffness again.
        robot.joints.kept_limp &= frozenset(i for name in bad for i in self._limp_of(name))

    def _begin(self, robot: SimulatedRobot) -> None:
        self._robot, self.disabled, self._exhausted = robot, frozenset(), False
        self._chains = chain_indices(robot.model)

    def _reason(self, bad: set, broken: set) -> str:
        if self._exhausted:
            return EMPTY
        if LEGS not in bad:
            return ""
        return BROKEN if LEGS in broken else HOT

    def _why(self, name: str, broken: set) -> str:
        if name in broken:
            return "a motor is broken"
        return "the battery is empty" if self._exhausted and name == LEGS else "a motor is too hot"

    def _limp_of(self, name: str) -> Sequence[int]:
        return range(len(self._temperatures)) if name == LEGS else self._chains[name]

    def _rest(self, robot: SimulatedRobot, name: str, at_once: bool, snapshot: Snapshot) -> None:
        limp = self._limp_of(name)

        def keep() -> None:
            if name in self.disabled:
                robot.joints.kept_limp |= frozenset(limp)
                robot.joints.set_stiffness({})

        def goodbye() -> None:
            keep()
            if name == LEGS:
                self._on_rest()

        robot.motion.kill_using(limp)
        if at_once:
            robot.motion.set_stiffness_now({i: 0.0 for i in self._chains[name]})
        if name == LEGS:
            posture_change.rest(robot, lambda: robot.snapshot or snapshot, goodbye)
            return

        def go_safe() -> Task | None:
            chain = self._chains[name]
            return None if at_once else sequences.posture_task(robot, "rest", SAFE_POSTURE, SAFE_TIME, chain)

        steps = [
            go_safe,
            lambda: sequences.stiffness_task(robot, "rest", limp, 0.0, sequences.STIFFEN_TIME),
            goodbye,
        ]
        sequences.run_steps(robot, "rest", steps)


def _exhausted(battery: BatteryReading, before: bool) -> bool:
    """Whether the battery keeps the robot at rest: from empty until it is charged beyond nearly empty."""
    return battery.empty or (before and battery.nearly_empty)

"""Diagnosis effect: chains whose motors are too hot are put to rest and stay limp until they have cooled down.

A chain with a very hot motor goes to a safe posture first, one with a critical motor is limp at once. For legs that
means the whole body, and the robot does not wake up before they are fine.

Source: NAOqi's table of rest reflexes of NAO (motor temperature).
"""

from __future__ import annotations

import logging
from typing import Callable, Sequence

from nao_sim_bridge.sim.motion import sequences
from nao_sim_bridge.sim.motion.curves import SmoothCurve
from nao_sim_bridge.sim.motion.idle import CHAINS
from nao_sim_bridge.sim.postures import posture
from nao_sim_bridge.sim.robot import SimulatedRobot
from nao_sim_bridge.sim.sensors.heat import CRITICAL, VERY_HOT, heat_status
from nao_sim_bridge.sim.snapshot import Snapshot
from nao_sim_bridge.sim.tasks import Task

log = logging.getLogger("nao_sim.diagnosis")

LEGS = "Legs"
SAFE_POSTURE = "Crouch"
SAFE_TIME = 2.0


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
        self._enabled = True
        self.disabled: frozenset[str] = frozenset()

    def __call__(self, snapshot: Snapshot) -> None:
        """Look at the motors when their temperatures are new."""
        robot = self._robot_now()
        if robot is not self._robot:
            self._robot, self.disabled, self._temperatures = robot, frozenset(), ()
            self._chains = {
                name: [robot.model.joint_index[joint] for part in parts for joint in robot.model.chains[part]]
                for name, parts in CHAINS.items()
            }
        enabled = robot.reflexes.diagnosis_enabled
        if snapshot.temperatures is self._temperatures and enabled == self._enabled:
            return
        self._temperatures, self._enabled = snapshot.temperatures, enabled
        status = {
            name: max(heat_status(snapshot.temperatures[i]) for i in chain) for name, chain in self._chains.items()
        }
        hot = frozenset(name for name, worst in status.items() if worst >= VERY_HOT) if enabled else frozenset()
        for name in sorted(hot - self.disabled):
            log.warning("%s: a motor is too hot, the chain goes to rest", name)
            self._rest(robot, name, status[name] >= CRITICAL, snapshot)
        if hot != self.disabled:
            self.disabled = hot
            robot.reflexes.wake_forbidden = LEGS in hot
            if not hot:
                log.warning("all motors have cooled down")
        # A chain that has cooled down since takes stiffness again.
        robot.joints.kept_limp &= frozenset(i for name in hot for i in self._limp_of(name))

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
            sequences.rest(robot, lambda: robot.snapshot or snapshot, goodbye)
            return
        steps = [
            lambda: None if at_once else self._safe_posture(robot, name),
            lambda: sequences.stiffness_task(robot, "rest", limp, 0.0, sequences.STIFFEN_TIME),
            goodbye,
        ]
        sequences.run_steps(robot, "rest", steps)

    def _safe_posture(self, robot: SimulatedRobot, name: str) -> Task:
        goal = posture(robot.model, SAFE_POSTURE)
        return robot.motion.follow(
            "rest",
            self._chains[name],
            lambda now: {i: SmoothCurve((0.0, SAFE_TIME), (now[i], goal[i])) for i in self._chains[name]},
        )

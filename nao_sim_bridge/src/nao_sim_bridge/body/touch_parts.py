"""Touches of arms and legs, which have no sensors for it: somebody keeps their joints from where they go.

Only a limb that keeps still can tell: one that moves lags behind its commands by itself.
"""

from __future__ import annotations

from typing import Dict, FrozenSet, Tuple

from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.model.robot_model import RobotModel

LIMBS = ("LArm", "LLeg", "RLeg", "RArm")
PERIOD = 0.1
"""Time between two looks, s."""
STILL_TIME = 0.5
"""A limb keeps still when its commands have not changed for this time, s."""
TOUCHED, RELEASED = 0.12, 0.06
"""A joint this far from its command, rad, is held by somebody; nearer than the second it is not any more."""
LEAST_STIFFNESS = 0.5
"""Softer joints give way to their own weight."""


class LimbTouch:
    """Which limbs somebody holds: feed it with every snapshot."""

    def __init__(self, model: RobotModel) -> None:
        self._joints: Dict[str, Tuple[int, ...]] = {
            # The joints HipYawPitch share one motor, so that either may be off its own command.
            limb: tuple(
                model.joint_index[name]
                for name in model.chains[limb]
                if not (model.joint(name).is_hand or name.endswith("HipYawPitch"))
            )
            for limb in LIMBS
        }
        self._due = 0.0
        self._commands: Dict[str, Tuple[float, ...]] = {}
        self._since: Dict[str, float] = {}
        self._touched: FrozenSet[str] = frozenset()

    def look(self, snapshot: Snapshot) -> FrozenSet[str]:
        """Names of the limbs that are touched; looked at anew when it is time to."""
        if snapshot.time >= self._due:
            self._due = snapshot.time + PERIOD
            touched = frozenset(limb for limb in LIMBS if self._feels(limb, snapshot))
            if touched != self._touched:
                self._touched = touched
        return self._touched

    def _feels(self, limb: str, now: Snapshot) -> bool:
        joints = self._joints[limb]
        commands = tuple(now.commands[i] for i in joints)
        if commands != self._commands.get(limb):
            self._commands[limb], self._since[limb] = commands, now.time
        if now.time - self._since[limb] < STILL_TIME:
            return False
        limit = RELEASED if limb in self._touched else TOUCHED
        return any(
            abs(now.positions[i] - now.commands[i]) > limit and now.stiffnesses[i] >= LEAST_STIFFNESS for i in joints
        )

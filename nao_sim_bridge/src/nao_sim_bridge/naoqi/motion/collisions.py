"""Part of ALMotion: protection from collisions, with the robot itself and with what its sonars see."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.joints.self_collision import ARMS, COLLISION, NONE
from nao_sim_bridge.model.frames import space_in_torso
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.motion.part import MotionPart
from nao_sim_bridge.naoqi.motion.placements import placement, space_of

BOTH = {"Arms": ARMS, **{arm: (arm,) for arm in ARMS}}
PROTECTED = {"All": ("Move", *ARMS), "Move": ("Move",), **BOTH}
# From the mildest to the worst.
SEVERITY = (NONE, "near", COLLISION)


class Collisions(MotionPart):
    """Switches, distances, and what is close."""

    def isCollision(self, name: str) -> str:
        guard, commands = self._robot.reflexes.self_collision, self._robot.joints.commands
        return max((guard.state(arm, commands) for arm in _members(BOTH, name)), key=SEVERITY.index)

    def getCollisionProtectionEnabled(self, name: str) -> bool:
        return self._robot.reflexes.self_collision.enabled.issuperset(_members(BOTH, name))

    def setCollisionProtectionEnabled(self, name: str, enabled: bool) -> Task:
        """Answers whether it was done: the protection of an arm in collision cannot be switched off."""
        arms = _members(BOTH, name)

        def switch() -> bool:
            guard, commands = self._robot.reflexes.self_collision, self._robot.joints.commands
            if not enabled and any(guard.state(arm, commands) == COLLISION for arm in arms):
                return False
            (guard.enabled.update if enabled else guard.enabled.difference_update)(arms)
            return True

        return self._runner.execute(switch, "setCollisionProtectionEnabled")

    def getExternalCollisionProtectionEnabled(self, name: str) -> bool:
        return self._robot.reflexes.external_collision.enabled.issuperset(_members(PROTECTED, name))

    def setExternalCollisionProtectionEnabled(self, name: str, enabled: bool) -> Task:
        parts = _members(PROTECTED, name)

        def switch() -> None:
            protected = self._robot.reflexes.external_collision.enabled
            (protected.update if enabled else protected.difference_update)(parts)

        return self._runner.execute(switch, "setExternalCollisionProtectionEnabled")

    def getOrthogonalSecurityDistance(self) -> float:
        return self._robot.reflexes.external_collision.orthogonal

    def setOrthogonalSecurityDistance(self, distance: float) -> Task:
        return self._set_distance("orthogonal", distance)

    def getTangentialSecurityDistance(self) -> float:
        return self._robot.reflexes.external_collision.tangential

    def setTangentialSecurityDistance(self, distance: float) -> Task:
        return self._set_distance("tangential", distance)

    def getChainClosestObstaclePosition(self, name: str, space: int) -> list[float]:
        """[x, y, z] in m of what is nearest to the hand; empty when the sonars see nothing within a metre."""
        if name not in ARMS:
            raise UnknownName("arm", name, ARMS)
        now = self._runner.snapshot
        found = self._robot.reflexes.external_collision.closest_obstacle(name, now.positions, now.sonars)
        if found is None:
            return []
        placed = placement(self._model, self._robot, now, use_sensors=True)
        torso_in_space = np.linalg.inv(space_in_torso(self._model, space_of(space), placed))
        return (torso_in_space @ np.append(found, 1.0))[:3].tolist()

    def _set_distance(self, which: str, distance: Any) -> Task:
        # A negative distance is taken for none.
        metres = max(number(distance, "securityDistance"), 0.0)

        def change() -> None:
            setattr(self._robot.reflexes.external_collision, which, metres)

        return self._runner.execute(change, which)


def _members(groups: Mapping[str, Sequence[str]], name: Any) -> Sequence[str]:
    if name not in groups:
        raise UnknownName("arm or group", name, groups)
    return groups[name]

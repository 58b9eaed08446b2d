"""Parts of ALMotion that switch what works by itself: fall manager, collision protection, breathing, named switches."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue, NotAllowed, UnknownName
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.balance.reflexes import SWITCHES
from nao_sim_bridge.control.joints.idle import AMPLITUDE, BPM, GROUPS, Mode
from nao_sim_bridge.control.joints.self_collision import ARMS, COLLISION, NONE
from nao_sim_bridge.model.frames import space_in_torso
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.motion.part import MotionPart
from nao_sim_bridge.naoqi.motion.placements import placement, space_of

# The owner's permission to do without the fall manager; off at the start.
DEACTIVATION = "ENABLE_DEACTIVATION_OF_FALL_MANAGER"


class Falls(MotionPart):
    """What keeps the robot on its feet, switched on and off; on after each start."""

    def getFallManagerEnabled(self) -> bool:
        return self._robot.stability.falls.enabled

    def setFallManagerEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            if not (enabled or self._robot.reflexes.switches[DEACTIVATION]):
                raise NotAllowed(f"the fall manager stays on; setMotionConfig([[{DEACTIVATION!r}, True]]) allows it")
            self._robot.stability.falls.enabled = enabled

        return self._runner.execute(switch, "setFallManagerEnabled")

    def getPushRecoveryEnabled(self) -> bool:
        return self._robot.stability.balance.enabled

    def setPushRecoveryEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.stability.balance.enabled = enabled

        return self._runner.execute(switch, "setPushRecoveryEnabled")


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


LIMITS = {"Bpm": BPM, "Amplitude": AMPLITUDE}


class Idling(MotionPart):
    """Breathing and idle posture: the last call for a chain says which of them, or none, it is."""

    def getBreathEnabled(self, chain: str) -> bool:
        return self._robot.reflexes.idle.has_mode(_group(chain), Mode.BREATH)

    def setBreathEnabled(self, chain: str, enabled: bool) -> Task:
        return self._set_mode("setBreathEnabled", chain, Mode.BREATH if enabled else Mode.NOTHING)

    def getIdlePostureEnabled(self, chain: str) -> bool:
        return self._robot.reflexes.idle.has_mode(_group(chain), Mode.POSTURE)

    def setIdlePostureEnabled(self, chain: str, enabled: bool) -> Task:
        return self._set_mode("setIdlePostureEnabled", chain, Mode.POSTURE if enabled else Mode.NOTHING)

    def getBreathConfig(self) -> list:
        idle = self._robot.reflexes.idle
        return [["Bpm", idle.bpm], ["Amplitude", idle.amplitude]]

    def setBreathConfig(self, config: Any) -> Task:
        given = _pairs(config)

        def change() -> None:
            idle = self._robot.reflexes.idle
            idle.set_breath(given.get("Bpm", idle.bpm), given.get("Amplitude", idle.amplitude))

        return self._runner.execute(change, "setBreathConfig")

    def _set_mode(self, call: str, chain: str, mode: Mode) -> Task:
        group = _group(chain)
        return self._runner.execute(lambda: self._robot.reflexes.idle.set_mode(group, mode), call)


def _group(name: Any) -> str:
    if name not in GROUPS:
        raise UnknownName("chain", name, GROUPS)
    return name


def _pairs(config: Any) -> dict[str, float]:
    if not isinstance(config, (list, tuple)) or any(not isinstance(p, (list, tuple)) or len(p) != 2 for p in config):
        raise BadValue("pConfig", config, 'pairs such as [["Bpm", 12.0], ["Amplitude", 0.5]]')
    given = {}
    for name, value in config:
        if not isinstance(name, str) or name not in LIMITS:
            raise UnknownName("breath parameter", name, LIMITS)
        given[name] = number(value, name, *LIMITS[name])
    return given


class Switches(MotionPart):
    """Smart stiffness, diagnosis effect, notifications, and the named switches of setMotionConfig."""

    def getSmartStiffnessEnabled(self) -> bool:
        return self._robot.reflexes.smart_stiffness.enabled

    def setSmartStiffnessEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.reflexes.smart_stiffness.enabled = enabled

        return self._runner.execute(switch, "setSmartStiffnessEnabled")

    def getDiagnosisEffectEnabled(self) -> bool:
        return self._robot.reflexes.diagnosis_enabled

    def setDiagnosisEffectEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.reflexes.diagnosis_enabled = enabled

        return self._runner.execute(switch, "setDiagnosisEffectEnabled")

    def areNotificationsEnabled(self) -> bool:
        return self._robot.motion.notices.enabled

    def setEnableNotifications(self, enabled: bool) -> Task:
        def switch() -> None:
            self._robot.motion.notices.enabled = enabled

        return self._runner.execute(switch, "setEnableNotifications")

    def setMotionConfig(self, config: Any) -> Task:
        wanted = _switches(config)

        def change() -> None:
            self._robot.reflexes.switches.update(wanted)
            if "ENABLE_FALL_MANAGER_PROTECTION" in wanted:
                self._robot.stability.falls.enabled = wanted["ENABLE_FALL_MANAGER_PROTECTION"]

        return self._runner.execute(change, "setMotionConfig")


def _switches(config: Any) -> dict[str, bool]:
    if not isinstance(config, (list, tuple)) or any(not isinstance(p, (list, tuple)) or len(p) != 2 for p in config):
        raise BadValue("config", config, 'pairs such as [["ENABLE_STIFFNESS_PROTECTION", true]]')
    wanted = {}
    for name, value in config:
        if name not in SWITCHES:
            raise UnknownName("motion switch", name, SWITCHES)
        if value not in (True, False):
            raise BadValue(name, value, "true or false")
        wanted[name] = bool(value)
    return wanted

"""Parts of ALMotion that switch what works by itself: fall manager, protection from collisions, breathing, reflexes."""

from __future__ import annotations

from operator import attrgetter
from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.errors import BadValue, NotAllowed
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.balance.reflexes import SWITCHES
from nao_sim_bridge.control.joints.idle import AMPLITUDE, BPM, GROUPS, Mode
from nao_sim_bridge.control.joints.self_collision import ARMS, COLLISION, NONE
from nao_sim_bridge.naoqi.binding.arguments import known, number
from nao_sim_bridge.naoqi.motion.arguments import pairs
from nao_sim_bridge.naoqi.motion.part import MotionPart

# The owner's permission to do without the fall manager; off at the start.
DEACTIVATION = "ENABLE_DEACTIVATION_OF_FALL_MANAGER"
PROTECTION = "ENABLE_FALL_MANAGER_PROTECTION"
BOTH = {"Arms": ARMS, **{arm: (arm,) for arm in ARMS}}
PROTECTED = {"All": ("Move", *ARMS), "Move": ("Move",), **BOTH}
# From the mildest to the worst.
SEVERITY = (NONE, "near", COLLISION)
LIMITS = {"Bpm": BPM, "Amplitude": AMPLITUDE}


def _switch(call: str, path: str) -> tuple[Callable[[MotionPart], bool], Callable[[MotionPart, bool], Task]]:
    """The two methods that read and set the switch at `path` of the robot; `call` is NAOqi's name of the second."""
    owner, _, name = path.rpartition(".")

    def read(part: MotionPart) -> bool:
        return attrgetter(path)(part._robot)

    def write(part: MotionPart, enabled: bool) -> Task:
        return part._runner.execute(lambda: setattr(attrgetter(owner)(part._robot), name, enabled), call)

    return read, write


class Switches(MotionPart):
    """What keeps the robot on its feet, smart stiffness, diagnosis effect, notifications, and setMotionConfig."""

    getPushRecoveryEnabled, setPushRecoveryEnabled = _switch("setPushRecoveryEnabled", "stability.balance.enabled")
    getSmartStiffnessEnabled, setSmartStiffnessEnabled = _switch(
        "setSmartStiffnessEnabled", "reflexes.smart_stiffness.enabled"
    )
    getDiagnosisEffectEnabled, setDiagnosisEffectEnabled = _switch(
        "setDiagnosisEffectEnabled", "reflexes.diagnosis_enabled"
    )
    areNotificationsEnabled, setEnableNotifications = _switch("setEnableNotifications", "motion.notices.enabled")

    def getFallManagerEnabled(self) -> bool:
        return self._robot.stability.falls.enabled

    def setFallManagerEnabled(self, enabled: bool) -> Task:
        def switch() -> None:
            if not (enabled or self._robot.reflexes.switches[DEACTIVATION]):
                raise NotAllowed(f"the fall manager stays on; setMotionConfig([[{DEACTIVATION!r}, True]]) allows it")
            self._robot.stability.falls.enabled = enabled

        return self._runner.execute(switch, "setFallManagerEnabled")

    def setMotionConfig(self, config: Any) -> Task:
        wanted = {}
        for name, value in pairs(config, "config", '[["ENABLE_STIFFNESS_PROTECTION", true]]'):
            known(name, "motion switch", SWITCHES)
            if value not in (True, False):
                raise BadValue(name, value, "true or false")
            wanted[name] = bool(value)

        def change() -> None:
            self._robot.reflexes.switches.update(wanted)
            if PROTECTION in wanted:
                self._robot.stability.falls.enabled = wanted[PROTECTION]

        return self._runner.execute(change, "setMotionConfig")


class Collisions(MotionPart):
    """Protection from collisions, with the robot itself and with what its sonars see."""

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
        known(name, "arm", ARMS)
        now = self._runner.snapshot
        found = self._robot.reflexes.external_collision.closest_obstacle(name, now.positions, now.sonars)
        if found is None:
            return []
        return (self._torso_in(space, self._placement(True, now)) @ np.append(found, 1.0))[:3].tolist()

    def _set_distance(self, which: str, distance: Any) -> Task:
        # A negative distance is taken for none.
        metres = max(number(distance, "securityDistance"), 0.0)
        return self._runner.execute(lambda: setattr(self._robot.reflexes.external_collision, which, metres), which)


class Idling(MotionPart):
    """Breathing and idle posture: the last call for a chain says which of them, or none, it is."""

    def getBreathEnabled(self, chain: str) -> bool:
        return self._has_mode(chain, Mode.BREATH)

    def setBreathEnabled(self, chain: str, enabled: bool) -> Task:
        return self._set_mode("setBreathEnabled", chain, Mode.BREATH if enabled else Mode.NOTHING)

    def getIdlePostureEnabled(self, chain: str) -> bool:
        return self._has_mode(chain, Mode.POSTURE)

    def setIdlePostureEnabled(self, chain: str, enabled: bool) -> Task:
        return self._set_mode("setIdlePostureEnabled", chain, Mode.POSTURE if enabled else Mode.NOTHING)

    def getBreathConfig(self) -> list:
        idle = self._robot.reflexes.idle
        return [["Bpm", idle.bpm], ["Amplitude", idle.amplitude]]

    def setBreathConfig(self, config: Any) -> Task:
        given = {}
        for name, value in pairs(config, "pConfig", '[["Bpm", 12.0], ["Amplitude", 0.5]]'):
            given[name] = number(value, name, *LIMITS[known(name, "breath parameter", LIMITS)])

        def change() -> None:
            idle = self._robot.reflexes.idle
            idle.set_breath(given.get("Bpm", idle.bpm), given.get("Amplitude", idle.amplitude))

        return self._runner.execute(change, "setBreathConfig")

    def _has_mode(self, chain: str, mode: Mode) -> bool:
        return self._robot.reflexes.idle.has_mode(known(chain, "chain", GROUPS), mode)

    def _set_mode(self, call: str, chain: str, mode: Mode) -> Task:
        group = known(chain, "chain", GROUPS)
        return self._runner.execute(lambda: self._robot.reflexes.idle.set_mode(group, mode), call)


def _members(groups: dict[str, tuple[str, ...]], name: Any) -> tuple[str, ...]:
    return groups[known(name, "arm or group", groups)]

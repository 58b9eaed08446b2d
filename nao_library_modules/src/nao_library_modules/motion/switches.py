"""Motion functions that switch what the robot does by itself, and whole body control."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..base.errors import BadGoal
from ..base.field_checks import require_each, require_within
from ..base.limits import limit
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from .base import DEFAULT_SPEED, MotionBase
from .cartesian import POSE_NUMBER, require_frame
from .facts import BODY
from .plan import DURATION, require_fraction

CHAINS = ("Body", "Head", "LArm", "RArm", "Arms", "LLeg", "RLeg", "Legs")
ARMS = ("LArm", "RArm", "Arms")
COLLISION_PARTS = ("All", "Move", "LArm", "RArm", "Arms")
EFFECTORS = ("Head", "LArm", "RArm")
LEGS = ("LLeg", "RLeg", "Legs")
ONE_LEG_OR_BOTH = ("LLeg", "RLeg", "Legs")
FOOT_STATES = ("Fixed", "Plane", "Free")
BALANCE_TIME = 2.0
"""s that a shift of weight is planned to take where a speed is given."""
BREATH_KEYS = ("Bpm", "Amplitude")
SETTING = limit("setting")


def _require(field: str, value: str, allowed: Sequence[str]) -> str:
    if value not in allowed:
        raise BadGoal(
            field,
            value,
            f"one of {', '.join(allowed)}",
            problem=f"{value!r} is not known{did_you_mean(value, allowed)}",
        )
    return value


def _chains_check(allowed: Sequence[str]) -> Callable[..., None]:
    def check(_self: object, names: Sequence[str]) -> None:
        if not names:
            raise BadGoal("names", [], f"one or more of {', '.join(allowed)}", problem="nothing is named")
        for name in names:
            _require("names", name, allowed)

    return check


def check_obstacles(self: object, names: Sequence[str], frame: int) -> None:
    """Arms, a known frame."""
    _chains_check(ARMS[:2])(self, names)
    require_frame(frame)


def check_leg(_self: object, str_param: str) -> None:
    """A leg, or both."""
    _require("str_param", str_param, LEGS)


def check_foot_state(_self: object, texts: Sequence[str], str_param: str) -> None:
    """The state of a foot, and a leg."""
    if len(texts) != 1:
        raise BadGoal("texts", list(texts), f"one of {', '.join(FOOT_STATES)}")
    _require("texts", texts[0], FOOT_STATES)
    _require("str_param", str_param, LEGS)


def check_balance(self: MotionBase, str_param: str, duration: float) -> None:
    """A leg, or both, and a time."""
    _require("str_param", str_param, ONE_LEG_OR_BOTH)
    require_within("duration", duration, DURATION)
    body = self.plan.facts.chains[BODY]
    self.plan.walk.require_free(body)
    self.plan.forget(body)
    self.plan.takes(duration)


def check_balance_speed(self: MotionBase, str_param: str, speed: float) -> None:
    """A leg, or both, and a fraction of speed."""
    require_fraction("speed", speed, DEFAULT_SPEED)
    check_balance(self, str_param, BALANCE_TIME)


def check_config(_self: object, texts: Sequence[str], values: Sequence[float]) -> None:
    """Names of switches, a value each: 0 for off."""
    if not texts or len(values) != len(texts):
        raise BadGoal("values", list(values), f"one for each of {', '.join(texts) or 'the names in texts'}")
    require_each("values", values, SETTING)


def check_effector(_self: object, names: Sequence[str], values: Sequence[float]) -> None:
    """One effector and its target: rotations for the head, a position or a pose for an arm."""
    if len(names) != 1:
        raise BadGoal("names", list(names), f"one of {', '.join(EFFECTORS)}")
    _require("names", names[0], EFFECTORS)
    if len(values) not in (3, 6):
        raise BadGoal("values", list(values), "wx wy wz (Head), x y z or x y z wx wy wz (arms)")
    require_each("values", values, POSE_NUMBER)


def check_breath(_self: object, texts: Sequence[str], values: Sequence[float]) -> None:
    """Known settings of breathing, a value each."""
    for text in texts:
        _require("texts", text, BREATH_KEYS)
    if not texts or len(values) != len(texts):
        raise BadGoal("values", list(values), f"one for each of {', '.join(texts) or ', '.join(BREATH_KEYS)}")
    require_each("values", values, SETTING)


class MotionSwitches(MotionBase):
    """Functions of ALMotion for what the robot does by itself. Parameters are fields of MotionFunction."""

    def switch_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "setBreathEnabled": self.set_breath_enabled,
            "getBreathEnabled": self.get_breath_enabled,
            "setBreathConfig": self.set_breath_config,
            "getBreathConfig": self.get_breath_config,
            "setIdlePostureEnabled": self.set_idle_posture_enabled,
            "getIdlePostureEnabled": self.get_idle_posture_enabled,
            "setSmartStiffnessEnabled": self.set_smart_stiffness_enabled,
            "getSmartStiffnessEnabled": self.get_smart_stiffness_enabled,
            "setCollisionProtectionEnabled": self.set_collision_protection_enabled,
            "getCollisionProtectionEnabled": self.get_collision_protection_enabled,
            "isCollision": self.is_collision,
            "setExternalCollisionProtectionEnabled": self.set_external_collision_protection_enabled,
            "getExternalCollisionProtectionEnabled": self.get_external_collision_protection_enabled,
            "setFallManagerEnabled": self.set_fall_manager_enabled,
            "getFallManagerEnabled": self.get_fall_manager_enabled,
            "setPushRecoveryEnabled": self.set_push_recovery_enabled,
            "getPushRecoveryEnabled": self.get_push_recovery_enabled,
            "setDiagnosisEffectEnabled": self.set_diagnosis_effect_enabled,
            "getDiagnosisEffectEnabled": self.get_diagnosis_effect_enabled,
            "wbEnable": self.wb_enable,
            "wbFootState": self.wb_foot_state,
            "wbEnableBalanceConstraint": self.wb_enable_balance_constraint,
            "wbGoToBalance": self.wb_go_to_balance,
            "wbEnableEffectorControl": self.wb_enable_effector_control,
            "wbSetEffectorControl": self.wb_set_effector_control,
            "wbEnableEffectorOptimization": self.wb_enable_effector_optimization,
            "wbGoToBalanceWithSpeed": self.wb_go_to_balance_with_speed,
            "setMotionConfig": self.set_motion_config,
            "setEnableNotifications": self.set_enable_notifications,
            "areNotificationsEnabled": self.are_notifications_enabled,
            "getChainClosestObstaclePosition": self.get_chain_closest_obstacle_position,
        }

    # Life-like motion

    @checked_by(_chains_check(CHAINS))
    def set_breath_enabled(self, names: Sequence[str], enable: bool) -> None:
        """Let chains breathe, or stop it."""
        self._each("setBreathEnabled", names, enable)

    @checked_by(_chains_check(CHAINS))
    def get_breath_enabled(self, names: Sequence[str]) -> list[bool]:
        """Whether chains breathe."""
        return self._each("getBreathEnabled", names)

    @checked_by(check_breath)
    def set_breath_config(self, texts: Sequence[str], values: Sequence[float]) -> None:
        """How the robot breathes: Bpm (breaths a minute) and Amplitude (0..1)."""
        self.motion("setBreathConfig", [list(pair) for pair in zip(texts, values)])

    def get_breath_config(self) -> list[list[Any]]:
        """How the robot breathes."""
        return [list(pair) for pair in self.motion("getBreathConfig")]

    @checked_by(_chains_check(CHAINS))
    def set_idle_posture_enabled(self, names: Sequence[str], enable: bool) -> None:
        """Let chains go back to their idle posture when nothing moves them, or stop it."""
        self._each("setIdlePostureEnabled", names, enable)

    @checked_by(_chains_check(CHAINS))
    def get_idle_posture_enabled(self, names: Sequence[str]) -> list[bool]:
        """Whether chains go back to their idle posture."""
        return self._each("getIdlePostureEnabled", names)

    # Protections

    def set_smart_stiffness_enabled(self, enable: bool) -> None:
        """Let the robot lower the stiffness of joints that hold little."""
        self.motion("setSmartStiffnessEnabled", enable)

    def get_smart_stiffness_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("getSmartStiffnessEnabled"))

    @checked_by(_chains_check(ARMS))
    def set_collision_protection_enabled(self, names: Sequence[str], enable: bool) -> list[bool]:
        """Keep arms from hitting the body; tells whether that could be switched."""
        return self._each("setCollisionProtectionEnabled", names, enable)

    @checked_by(_chains_check(ARMS[:2]))
    def get_collision_protection_enabled(self, names: Sequence[str]) -> list[bool]:
        """Whether arms are kept from hitting the body."""
        return self._each("getCollisionProtectionEnabled", names)

    @checked_by(_chains_check(ARMS))
    def is_collision(self, names: Sequence[str]) -> list[str]:
        """Whether arms touch the body: none, near or collision."""
        return self._each("isCollision", names)

    @checked_by(_chains_check(COLLISION_PARTS))
    def set_external_collision_protection_enabled(self, names: Sequence[str], enable: bool) -> None:
        """Keep arms and walk from hitting what is around."""
        self._each("setExternalCollisionProtectionEnabled", names, enable)

    @checked_by(_chains_check(COLLISION_PARTS))
    def get_external_collision_protection_enabled(self, names: Sequence[str]) -> list[bool]:
        """Whether they are kept from it."""
        return self._each("getExternalCollisionProtectionEnabled", names)

    def set_fall_manager_enabled(self, enable: bool) -> None:
        """Let the robot protect itself when it falls."""
        self.motion("setFallManagerEnabled", enable)

    def get_fall_manager_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("getFallManagerEnabled"))

    def set_push_recovery_enabled(self, enable: bool) -> None:
        """Let the robot balance when it is pushed."""
        self.motion("setPushRecoveryEnabled", enable)

    def get_push_recovery_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("getPushRecoveryEnabled"))

    def set_diagnosis_effect_enabled(self, enable: bool) -> None:
        """Let faults and heat limit the robot's motion."""
        self.motion("setDiagnosisEffectEnabled", enable)

    def get_diagnosis_effect_enabled(self) -> bool:
        """Whether they do."""
        return bool(self.motion("getDiagnosisEffectEnabled"))

    # Whole body

    def wb_enable(self, enable: bool) -> None:
        """Switch whole body control."""
        self.motion("wbEnable", enable)

    @checked_by(check_foot_state)
    def wb_foot_state(self, texts: Sequence[str], str_param: str) -> None:
        """What a foot does under whole body control: Fixed, Plane or Free."""
        self.motion("wbFootState", texts[0], str_param)

    @checked_by(check_leg)
    def wb_enable_balance_constraint(self, enable: bool, str_param: str) -> None:
        """Keep the centre of mass over one foot or both, or stop it."""
        self.motion("wbEnableBalanceConstraint", enable, str_param)

    @checked_by(check_balance)
    def wb_go_to_balance(self, str_param: str, duration: float) -> bool:
        """Move the centre of mass over one foot or both in a time; tells whether it got there."""
        return bool(self.motion("wbGoToBalance", str_param, duration))

    @checked_by(_chains_check(EFFECTORS))
    def wb_enable_effector_control(self, names: Sequence[str], enable: bool) -> None:
        """Let effectors follow wbSetEffectorControl, or stop it."""
        self._each("wbEnableEffectorControl", names, enable)

    @checked_by(check_effector)
    def wb_set_effector_control(self, names: Sequence[str], values: Sequence[float]) -> None:
        """Where an effector is to go, in FRAME_ROBOT: rotation of the head (rad), position of an arm (m)."""
        self.motion("wbSetEffectorControl", names[0], list(values))

    @checked_by(_chains_check(EFFECTORS))
    def wb_enable_effector_optimization(self, names: Sequence[str], enable: bool) -> None:
        """Let effectors use what whole body control leaves free, or stop it."""
        self._each("wbEnableEffectorOptimization", names, enable)

    def _each(self, method: str, names: Sequence[str], *args: Any) -> list[Any]:
        answers = [self.motion(method, name, *args) for name in names]
        return [answer for answer in answers if answer is not None]

    @checked_by(check_balance_speed)
    def wb_go_to_balance_with_speed(self, str_param: str, speed: float) -> bool:
        """Move the centre of mass over one foot or both at a fraction of the top speed; tells whether it got there."""
        return bool(self.motion("wbGoToBalanceWithSpeed", str_param, speed or DEFAULT_SPEED))

    # Inside the motion

    @checked_by(check_config)
    def set_motion_config(self, texts: Sequence[str], values: Sequence[float]) -> None:
        """Set switches of the motion by NAOqi's names, ENABLE_FOOT_CONTACT_PROTECTION and the like: 0 off, else on."""
        self.motion("setMotionConfig", [[name, bool(value)] for name, value in zip(texts, values)])

    def set_enable_notifications(self, enable: bool) -> None:
        """Let the robot tell of hot motors and the like, or not."""
        self.motion("setEnableNotifications", enable)

    def are_notifications_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("areNotificationsEnabled"))

    @checked_by(check_obstacles)
    def get_chain_closest_obstacle_position(self, names: Sequence[str], frame: int) -> list[list[float]]:
        """What is nearest to each arm: x, y, z in m in a frame (0 torso, 1 world, 2 robot)."""
        return [list(self.motion("getChainClosestObstaclePosition", name, frame)) for name in names]

"""Motion functions that report the robot's motion, end tasks, and switch what the robot does by itself."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from ..core.chain import checked_by
from ..core.errors import BadGoal
from .motion_fields import Frame, SomeJoints, Speed, Task
from .motion_plan import BODY, DEFAULT_SPEED, BodyPart
from .walk_fields import (
    BREATH_KEYS,
    Arms,
    BalanceLeg,
    BalanceTime,
    BodyEffector,
    BodyEffectors,
    BreathKeys,
    Chains,
    CollisionParts,
    EachArm,
    EffectorGoal,
    Enable,
    Foot,
    FootState,
    MotionSwitch,
    Settings,
    SwitchValues,
)


class MotionState(BodyPart):
    def _joints(self, names: Sequence[str]) -> list[str]:
        return self.body.joints(names or [BODY])

    @checked_by(_joints)
    def get_body_names(self, names: SomeJoints) -> list[str]:
        """Joints behind chains, of the whole body if none is named."""
        return self._joints(names)

    @checked_by(_joints)
    def get_limits(self, names: SomeJoints) -> list[list[float]]:
        """Of each joint: lower and upper limit (rad), top speed (rad/s) and torque (N m)."""
        rows = dict(zip(self.body.joints([BODY]), self.motion("getLimits", BODY)))
        return [list(rows[joint]) for joint in self._joints(names)]

    def get_mass(self, names: SomeJoints) -> list[float]:
        """Mass of joints, chains or, if none is named, the body: kg."""
        return [float(self.motion("getMass", name)) for name in names or [BODY]]

    def get_robot_config(self) -> list[list[Any]]:
        """Names and values of the robot's configuration."""
        return [list(row) for row in self.motion("getRobotConfig")]

    def get_sensor_names(self) -> list[str]:
        """Sensors that getPosition knows."""
        return list(self.motion("getSensorNames"))

    def get_motion_cycle_time(self) -> int:
        """Period of ALMotion in ms."""
        return int(self.motion("getMotionCycleTime"))

    def get_summary(self) -> str:
        """A table of all joints: stiffness, command, sensor."""
        return str(self.motion("getSummary"))

    def get_task_list(self) -> list[list[Any]]:
        """Tasks that run: name, number, broker, priority, resources."""
        return [list(task) for task in self.motion("getTaskList")]

    @checked_by(_joints)
    def are_resources_available(self, names: SomeJoints) -> bool:
        """Whether no task holds the joints."""
        return bool(self.motion("areResourcesAvailable", self._joints(names)))

    def kill_task(self, values: Task) -> bool:
        """End a task by its number; tells whether there was one."""
        return bool(self.motion("killTask", int(values[0])))

    @checked_by(_joints)
    def kill_tasks_using_resources(self, names: SomeJoints) -> None:
        """End all tasks that hold the joints."""
        self.motion("killTasksUsingResources", self._joints(names))

    def _check_kill_all(self) -> None:
        self.body.plan.walk.stands()  # a walk ends with all tasks

    @checked_by(_check_kill_all)
    def kill_all(self) -> None:
        """End all motion tasks."""
        self.motion("killAll")

    functions = {
        "getBodyNames": get_body_names,
        "getLimits": get_limits,
        "getMass": get_mass,
        "getRobotConfig": get_robot_config,
        "getSensorNames": get_sensor_names,
        "getMotionCycleTime": get_motion_cycle_time,
        "getSummary": get_summary,
        "getTaskList": get_task_list,
        "areResourcesAvailable": are_resources_available,
        "killTask": kill_task,
        "killTasksUsingResources": kill_tasks_using_resources,
        "killAll": kill_all,
    }


BALANCE_TIME = 2.0
"""s that a shift of weight is planned to take where a speed is given."""


class MotionSwitches(BodyPart):
    # Life-like motion

    def set_breath_enabled(self, names: Chains, enable: Enable) -> None:
        """Let chains breathe, or stop it."""
        self._each("setBreathEnabled", names, enable)

    def get_breath_enabled(self, names: Chains) -> list[bool]:
        """Whether chains breathe."""
        return self._each("getBreathEnabled", names)

    def _check_settings(self, texts: Sequence[str], values: Sequence[float], known: str = "the names in texts") -> None:
        if not texts or len(values) != len(texts):
            raise BadGoal("values", list(values), f"one for each of {', '.join(texts) or known}")

    @checked_by(partial(_check_settings, known=", ".join(BREATH_KEYS)))
    def set_breath_config(self, texts: BreathKeys, values: Settings) -> None:
        """How the robot breathes: Bpm (breaths a minute) and Amplitude (0..1)."""
        self.motion("setBreathConfig", [list(pair) for pair in zip(texts, values)])

    def get_breath_config(self) -> list[list[Any]]:
        """How the robot breathes."""
        return [list(pair) for pair in self.motion("getBreathConfig")]

    def set_idle_posture_enabled(self, names: Chains, enable: Enable) -> None:
        """Let chains go back to their idle posture when nothing moves them, or stop it."""
        self._each("setIdlePostureEnabled", names, enable)

    def get_idle_posture_enabled(self, names: Chains) -> list[bool]:
        """Whether chains go back to their idle posture."""
        return self._each("getIdlePostureEnabled", names)

    # Protections

    def set_smart_stiffness_enabled(self, enable: Enable) -> None:
        """Let the robot lower the stiffness of joints that hold little."""
        self.motion("setSmartStiffnessEnabled", enable)

    def get_smart_stiffness_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("getSmartStiffnessEnabled"))

    def set_collision_protection_enabled(self, names: Arms, enable: Enable) -> list[bool]:
        """Keep arms from hitting the body; tells whether that could be switched."""
        return self._each("setCollisionProtectionEnabled", names, enable)

    def get_collision_protection_enabled(self, names: EachArm) -> list[bool]:
        """Whether arms are kept from hitting the body."""
        return self._each("getCollisionProtectionEnabled", names)

    def is_collision(self, names: Arms) -> list[str]:
        """Whether arms touch the body: none, near or collision."""
        return self._each("isCollision", names)

    def set_external_collision_protection_enabled(self, names: CollisionParts, enable: Enable) -> None:
        """Keep arms and walk from hitting what is around."""
        self._each("setExternalCollisionProtectionEnabled", names, enable)

    def get_external_collision_protection_enabled(self, names: CollisionParts) -> list[bool]:
        """Whether they are kept from it."""
        return self._each("getExternalCollisionProtectionEnabled", names)

    def set_fall_manager_enabled(self, enable: Enable) -> None:
        """Let the robot protect itself when it falls."""
        self.motion("setFallManagerEnabled", enable)

    def get_fall_manager_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("getFallManagerEnabled"))

    def set_push_recovery_enabled(self, enable: Enable) -> None:
        """Let the robot balance when it is pushed."""
        self.motion("setPushRecoveryEnabled", enable)

    def get_push_recovery_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("getPushRecoveryEnabled"))

    def set_diagnosis_effect_enabled(self, enable: Enable) -> None:
        """Let faults and heat limit the robot's motion."""
        self.motion("setDiagnosisEffectEnabled", enable)

    def get_diagnosis_effect_enabled(self) -> bool:
        """Whether they do."""
        return bool(self.motion("getDiagnosisEffectEnabled"))

    # Whole body

    def wb_enable(self, enable: Enable) -> None:
        """Switch whole body control."""
        self.motion("wbEnable", enable)

    def wb_foot_state(self, texts: FootState, str_param: Foot) -> None:
        """What a foot does under whole body control: Fixed, Plane or Free."""
        self.motion("wbFootState", texts[0].strip(), str_param.strip())

    def wb_enable_balance_constraint(self, enable: Enable, str_param: BalanceLeg) -> None:
        """Keep the centre of mass over one foot or both, or stop it."""
        self.motion("wbEnableBalanceConstraint", enable, str_param.strip())

    def _check_balance(self, duration: float) -> None:
        plan = self.body.plan
        joints = plan.facts.chains[BODY]
        plan.walk.require_free(joints)
        plan.forget(joints)
        plan.takes(duration)

    @checked_by(_check_balance)
    def wb_go_to_balance(self, str_param: BalanceLeg, duration: BalanceTime) -> bool:
        """Move the centre of mass over one foot or both in a time; tells whether it got there."""
        return bool(self.motion("wbGoToBalance", str_param.strip(), duration))

    def wb_enable_effector_control(self, names: BodyEffectors, enable: Enable) -> None:
        """Let effectors follow wbSetEffectorControl, or stop it."""
        self._each("wbEnableEffectorControl", names, enable)

    def wb_set_effector_control(self, names: BodyEffector, values: EffectorGoal) -> None:
        """Where an effector is to go, in FRAME_ROBOT: rotation of the head (rad), position of an arm (m)."""
        self.motion("wbSetEffectorControl", names[0].strip(), list(values))

    def wb_enable_effector_optimization(self, names: BodyEffectors, enable: Enable) -> None:
        """Let effectors use what whole body control leaves free, or stop it."""
        self._each("wbEnableEffectorOptimization", names, enable)

    def _each(self, method: str, names: Sequence[str], *args: Any) -> list[Any]:
        answers = [self.motion(method, name, *args) for name in names]
        return [answer for answer in answers if answer is not None]

    def _check_balance_speed(self) -> None:
        self._check_balance(BALANCE_TIME)

    @checked_by(_check_balance_speed)
    def wb_go_to_balance_with_speed(self, str_param: BalanceLeg, speed: Speed) -> bool:
        """Move the centre of mass over one foot or both at a fraction of the top speed; tells whether it got there."""
        return bool(self.motion("wbGoToBalanceWithSpeed", str_param.strip(), speed or DEFAULT_SPEED))

    # Inside the motion

    @checked_by(_check_settings)
    def set_motion_config(self, texts: MotionSwitch, values: SwitchValues) -> None:
        """Set switches of the motion by NAOqi's names, ENABLE_FOOT_CONTACT_PROTECTION and the like: 0 off, else on."""
        self.motion("setMotionConfig", [[name, bool(value)] for name, value in zip(texts, values)])

    def set_enable_notifications(self, enable: Enable) -> None:
        """Let the robot tell of hot motors and the like, or not."""
        self.motion("setEnableNotifications", enable)

    def are_notifications_enabled(self) -> bool:
        """Whether it does."""
        return bool(self.motion("areNotificationsEnabled"))

    def get_chain_closest_obstacle_position(self, names: EachArm, frame: Frame) -> list[list[float]]:
        """What is nearest to each arm: x, y, z in m in a frame (0 torso, 1 world, 2 robot)."""
        return [list(self.motion("getChainClosestObstaclePosition", name, frame)) for name in names]

    functions = {
        "setBreathEnabled": set_breath_enabled,
        "getBreathEnabled": get_breath_enabled,
        "setBreathConfig": set_breath_config,
        "getBreathConfig": get_breath_config,
        "setIdlePostureEnabled": set_idle_posture_enabled,
        "getIdlePostureEnabled": get_idle_posture_enabled,
        "setSmartStiffnessEnabled": set_smart_stiffness_enabled,
        "getSmartStiffnessEnabled": get_smart_stiffness_enabled,
        "setCollisionProtectionEnabled": set_collision_protection_enabled,
        "getCollisionProtectionEnabled": get_collision_protection_enabled,
        "isCollision": is_collision,
        "setExternalCollisionProtectionEnabled": set_external_collision_protection_enabled,
        "getExternalCollisionProtectionEnabled": get_external_collision_protection_enabled,
        "setFallManagerEnabled": set_fall_manager_enabled,
        "getFallManagerEnabled": get_fall_manager_enabled,
        "setPushRecoveryEnabled": set_push_recovery_enabled,
        "getPushRecoveryEnabled": get_push_recovery_enabled,
        "setDiagnosisEffectEnabled": set_diagnosis_effect_enabled,
        "getDiagnosisEffectEnabled": get_diagnosis_effect_enabled,
        "wbEnable": wb_enable,
        "wbFootState": wb_foot_state,
        "wbEnableBalanceConstraint": wb_enable_balance_constraint,
        "wbGoToBalance": wb_go_to_balance,
        "wbEnableEffectorControl": wb_enable_effector_control,
        "wbSetEffectorControl": wb_set_effector_control,
        "wbEnableEffectorOptimization": wb_enable_effector_optimization,
        "wbGoToBalanceWithSpeed": wb_go_to_balance_with_speed,
        "setMotionConfig": set_motion_config,
        "setEnableNotifications": set_enable_notifications,
        "areNotificationsEnabled": are_notifications_enabled,
        "getChainClosestObstaclePosition": get_chain_closest_obstacle_position,
    }

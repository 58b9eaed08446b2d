"""Part of ALMotion: whole body control, which keeps feet and balance while anything else moves."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.whole_body.aims import TargetAim
from nao_sim_bridge.control.whole_body.cartesian_move import EffectorMove
from nao_sim_bridge.control.whole_body.footholds import FootState
from nao_sim_bridge.control.whole_body.tasks import go_to_balance, lead_to
from nao_sim_bridge.control.whole_body.whole_body import WholeBody as Control
from nao_sim_bridge.model.frames import FEET, ROBOT
from nao_sim_bridge.model.kinematics import rpy_matrix, transform
from nao_sim_bridge.naoqi.binding.arguments import known, number, vector
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.motion.part import MotionPart

SUPPORTS = {"Legs": FEET, **{foot: (foot,) for foot in FEET}}
POSITION, ROTATION, ALL = 7, 56, 63
# Effectors with a target of their own, and the axes it has: three numbers each.
CONTROLLED = {"Head": ROTATION, "LArm": POSITION, "RArm": POSITION}
# Effectors that can be kept where they are.
GROUPS = {"Arms": ("LArm", "RArm"), "Legs": FEET, "All": ("Head", "LArm", "RArm", *FEET, "Torso")}
KEPT = {**CONTROLLED, "LLeg": ALL, "RLeg": ALL, "Torso": ALL}
# How fast targets are approached, m/s and rad/s.
TARGET_SPEED = (0.15, 0.6)
# Top speed of the centre of mass, m/s: what fractions are of.
COM_SPEED = 0.1
LONGEST = 60.0


class WholeBody(MotionPart):
    """Feet, balance and effectors under whole body control."""

    def wbEnable(self, enabled: bool) -> Task:
        return self._runner.execute(lambda: self._robot.whole_body.enable(bool(enabled)), "wbEnable")

    def wbFootState(self, state: str, leg: str) -> Task:
        states = {one.value: one for one in FootState}
        wanted, feet = states[known(state, "foot state", states)], _support(leg)
        return self._while_on("wbFootState", lambda control: control.set_foot_states(feet, wanted))

    def wbEnableBalanceConstraint(self, enabled: bool, leg: str) -> Task:
        feet = _support(leg) if enabled else ()
        return self._while_on("wbEnableBalanceConstraint", lambda control: control.set_balance(feet))

    def wbGoToBalance(self, leg: str, duration: float) -> Task:
        seconds = number(duration, "duration", 0.0, LONGEST)
        return self._go("wbGoToBalance", leg, lambda _: seconds)

    def wbGoToBalanceWithSpeed(self, leg: str, fraction: float) -> Task:
        speed = number(fraction, "fractionMaxSpeed", 0.01, 1.0) * COM_SPEED
        feet = _support(leg)
        return self._go("wbGoToBalanceWithSpeed", leg, lambda control: control.way_to(feet) / speed)

    def wbEnableEffectorControl(self, name: str, enabled: bool) -> Task:
        known(name, "effector", CONTROLLED)

        def switch() -> None:
            control = self._robot.whole_body
            control.enable_effector(name, bool(enabled))
            if enabled:
                self._keep(control, name)

        return self._runner.execute(switch, "wbEnableEffectorControl")

    def wbSetEffectorControl(self, name: str, target: Any) -> Task:
        known(name, "effector", CONTROLLED)
        three = vector(target, "targetCoordinate", 3, "wx, wy, wz in rad for Head, x, y, z in m for an arm")
        turns = name == "Head"
        pose = transform(rpy_matrix(three), (0.0, 0.0, 0.0)) if turns else transform(np.eye(3), three)
        move = EffectorMove(name, ROBOT, CONTROLLED[name], lambda _: pose)

        def lead(control: Control) -> None:
            if name not in control.controlled:
                raise NaoqiError(f"{name} is not controlled, call wbEnableEffectorControl({name!r}, True) before")
            lead_to(control, [move], TARGET_SPEED, self._placement(False))

        return self._while_on("wbSetEffectorControl", lead)

    def wbEnableEffectorOptimization(self, name: str, enabled: bool) -> Task:
        names = GROUPS.get(name, (name,))
        for one in names:
            known(one, "effector", [*KEPT, *GROUPS])

        def change(control: Control) -> None:
            for one in names:
                if not enabled:
                    control.release(one)
                elif control.aim_of(one) is None:
                    self._keep(control, one)

        return self._while_on("wbEnableEffectorOptimization", change)

    def _keep(self, control: Control, name: str) -> None:
        """Lead an effector to where it is."""
        goal = control.goal_here(name, KEPT[name])
        control.lead(name, TargetAim(goal, goal.pose, TARGET_SPEED))

    def _go(self, call: str, leg: str, seconds: Callable[[Control], float]) -> Task:
        feet = _support(leg)

        def start(control: Control) -> Task:
            robot = self._robot
            return go_to_balance(control, robot.motion, robot.joints, call, feet, seconds(control))

        return self._while_on(call, start)

    def _while_on(self, call: str, change: Callable[[Control], Any]) -> Task:
        """Run `change` in the simulation thread; the task ends with a NaoqiError when whole body control is off."""

        def run() -> Any:
            control = self._robot.whole_body
            if not control.active:
                raise NaoqiError("whole body control is off, call wbEnable(True) before")
            return change(control)

        return self._runner.execute(run, call)


def _support(leg: Any) -> tuple[str, ...]:
    return tuple(SUPPORTS[known(leg, "support leg", SUPPORTS)])

"""Devices that are broken: motors that give no torque, sensors that tell nothing, and what the robot knows of it."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, Iterable, Tuple

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.readings import FootForces
from nao_sim_bridge.body.sensors.body import BodySensors, Presses
from nao_sim_bridge.body.sensors.snapshot import Imu, Snapshot
from nao_sim_bridge.model.robot_model import RobotModel

INERTIAL, SONARS = "InertialSensor", ("US/Left", "US/Right")
CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
FORCES = tuple(f"{side}Foot/FSR/{corner}" for side in "LR" for corner in CORNERS)
STILL = Imu((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
NEGLIGIBLE, SERIOUS, CRITICAL = range(3)
LEG = re.compile(r"[LR](Hip|Knee|Ankle).*")


def severity(device: str) -> int:
    """How bad a broken device is: 0 negligible, 1 serious, 2 critical. Without its legs the robot is of no use."""
    if LEG.fullmatch(device):
        return CRITICAL
    if device in SONARS or "/Touch/" in device or "/Bumper/" in device or "/Button" in device:
        return NEGLIGIBLE
    return SERIOUS


class Faults:
    """What is broken in one robot.

    A broken sensor does not answer, which its board tells at once; that a motor gives no torque is found when it is
    tried.

    Attributes:
        motors: Joints whose motors give no torque.
        sensors: Names of the sensors that tell nothing.
        found: Those of `motors` that the robot has found.
        known: Names of all devices that can break.
    """

    def __init__(self, model: RobotModel, touch_names: Iterable[str]) -> None:
        self._joints = model.joint_index
        self.known: Tuple[str, ...] = (*self._joints, *touch_names, *FORCES, *SONARS, INERTIAL)
        self.motors: frozenset[int] = frozenset()
        self.sensors: frozenset[str] = frozenset()
        self.found: frozenset[int] = frozenset()

    def break_device(self, name: str) -> None:
        """Let a device fail: the motor of a joint, or a sensor by its device name.

        Raises:
            UnknownName: There is no such device.
        """
        if name in self._joints:
            self.motors |= {self._joints[name]}
        else:
            self.sensors |= {self._checked(name)}

    def repair(self, name: str) -> None:
        """Have a device work again.

        Raises:
            UnknownName: There is no such device.
        """
        if name in self._joints:
            self.motors -= {self._joints[name]}
            self.found &= self.motors
        else:
            self.sensors -= {self._checked(name)}

    def try_motors(self, stiffnesses: Iterable[float]) -> None:
        """Find the broken ones among the motors that are stiff: they take no current."""
        stiff = {index for index, stiffness in enumerate(stiffnesses) if stiffness > 0.0}
        self.found |= self.motors & stiff

    def spoil(self, snapshot: Snapshot) -> Snapshot:
        """What is sensed by a robot with these sensors broken."""
        broken = self.sensors
        sonars = snapshot.sonars  # itself when both work: who looks at each shot once knows it by that
        if not broken.isdisjoint(SONARS):
            sonars = tuple(0.0 if name in broken else echo for name, echo in zip(SONARS, sonars))
        sensors = _Broken(snapshot.sensors, broken)
        return replace(
            snapshot,
            imu=STILL if INERTIAL in broken else snapshot.imu,
            sonars=sonars,
            fingers=snapshot.fingers - broken,
            foot_loads=sensors.foot_loads(snapshot.contacts),
            sensors=sensors,
        )

    def _checked(self, name: str) -> str:
        if name not in self.known:
            raise UnknownName("device", name, self.known)
        return name


class _Broken:
    """Sensors of the body of which some tell nothing; all else is as `whole` has it."""

    def __init__(self, whole: BodySensors, broken: frozenset) -> None:
        self._whole = whole
        self._broken = broken

    def __getattr__(self, name: str) -> Any:
        return getattr(self._whole, name)

    def touched(self, presses: Presses) -> frozenset:
        return self._whole.touched(presses) - self._broken

    def foot_forces(self, side: str, presses: Presses) -> FootForces:
        read = self._whole.foot_forces(side, presses)
        works = [f"{side}Foot/FSR/{corner}" not in self._broken for corner in CORNERS]
        if all(works):
            return read
        forces = tuple(force if works else 0.0 for force, works in zip(read.forces, works))
        total = sum(forces)
        return replace(read, forces=forces, total=total) if total else FootForces()

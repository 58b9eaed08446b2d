"""What follows from the raw readings of the whole body: foot forces, touch, motor currents. Without state."""

from __future__ import annotations

from typing import Mapping, Sequence, Tuple

from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.readings import Contact, FootForces
from nao_sim_bridge.sim.sensors.contacts import Presses
from nao_sim_bridge.sim.sensors.feet import FootSensors
from nao_sim_bridge.sim.sensors.touch import TouchSensors
from nao_sim_bridge.sim.settings import Settings


class BodySensors:
    """Sensors that are pure functions of contacts and torques.

    Attributes:
        touch_names: Names of all touch sensors.

    Args:
        model: The robot.
        settings: Voltage and gear efficiency.
        links: URDF link name to PyBullet's link index; a name that is not there is the torso.
    """

    def __init__(self, model: RobotModel, settings: Settings, links: Mapping[str, int]) -> None:
        self._feet = {side: FootSensors(model, side) for side in "LR"}
        self._ankles = {side: links[f"{side.lower()}_ankle"] for side in "LR"}
        self._touch = TouchSensors(model, lambda name: links.get(model.link(name).alt_name, -1))
        self._amps_per_torque = tuple(_amps_per_torque(model, joint.name, settings) for joint in model.joints)
        self.touch_names = self._touch.names

    def foot_forces(self, side: str, presses: Presses) -> FootForces:
        """Force sensors of the foot of `side`, "L" or "R"."""
        return self._feet[side].read(presses.get(self._ankles[side], ()))

    def foot_loads(self, contacts: Sequence[Contact]) -> Tuple[float, float]:
        """Upward force on the left and on the right foot, N: at the price of a sum, without the single sensors."""
        left = right = 0.0
        for link, _, normal, force in contacts:
            if link == self._ankles["L"]:
                left += force * normal[2]
            elif link == self._ankles["R"]:
                right += force * normal[2]
        return left, right

    def touched(self, presses: Presses) -> frozenset:
        """Names of the touch sensors that something presses."""
        return self._touch.read(presses)

    def currents(self, torques: Sequence[float]) -> Tuple[float, ...]:
        """Current in A, absolute, of each motor from its torque in N m."""
        return tuple(abs(torque) * amps for torque, amps in zip(torques, self._amps_per_torque))


def _amps_per_torque(model: RobotModel, joint: str, settings: Settings) -> float:
    """A per N m at the joint: the torque constant is the voltage over the no-load speed of the motor."""
    kind = joint[1:] if joint[0] in "LR" else joint
    for motor in model.motors:
        if kind in motor.gear_ratio_of:
            efficiency = motor.gear_ratio_of[kind] * settings.motor.gear_efficiency
            return motor.no_load_speed / settings.battery.voltage_v / efficiency
    raise KeyError(f"no motor drives {joint}")

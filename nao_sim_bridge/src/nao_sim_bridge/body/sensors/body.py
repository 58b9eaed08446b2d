"""What follows from the raw readings of the whole body: foot forces, touch, motor currents. Without state."""

from __future__ import annotations

from typing import Mapping, Sequence, Tuple

from nao_sim_bridge.base.readings import Contact, FootForces
from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.sensors.contacts import Presses
from nao_sim_bridge.body.sensors.feet import FootSensors
from nao_sim_bridge.body.sensors.motors import Motors
from nao_sim_bridge.body.sensors.touch import TouchSensors
from nao_sim_bridge.model.robot_model import RobotModel


class BodySensors:
    """Sensors that are pure functions of contacts and torques.

    Attributes:
        touch_names: Names of all touch sensors.
        motors: What the motors draw.

    Args:
        links: URDF link name to PyBullet's link index; a name that is not there is the torso.
    """

    def __init__(self, model: RobotModel, settings: Settings, links: Mapping[str, int]) -> None:
        self._feet = {side: FootSensors(model, side) for side in "LR"}
        self._ankles = {side: links[f"{side.lower()}_ankle"] for side in "LR"}
        self._touch = TouchSensors(model, lambda name: links.get(model.link(name).alt_name, -1))
        self.motors = Motors(model, settings)
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
        return self.motors.currents(torques)

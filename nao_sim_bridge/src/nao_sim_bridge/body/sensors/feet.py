"""Force sensors under the feet: contact forces shared out over the four sensors of each sole."""

from __future__ import annotations

from typing import Iterable

from nao_sim_bridge.base.readings import FootForces
from nao_sim_bridge.body.sensors.contacts import Press
from nao_sim_bridge.model.robot_model import RobotModel

UNLOADED = FootForces()


class FootSensors:
    """The four sensors of one foot.

    A force between the sensors is shared out bilinearly, as a stiff sole on four springs does; one outside their
    rectangle loads the nearest edge.

    Args:
        side: "L" or "R".
    """

    def __init__(self, model: RobotModel, side: str) -> None:
        # Plain floats: the forces go over the network, which knows no numpy.
        place = {p.name: p.position.tolist() for p in model.fsr if p.name.startswith(f"{side}Foot/")}
        corners = [place[f"{side}Foot/FSR/{name}"] for name in ("FrontLeft", "FrontRight", "RearLeft", "RearRight")]
        self._front = (corners[0][0] + corners[1][0]) / 2
        self._rear = (corners[2][0] + corners[3][0]) / 2
        self._front_y = (corners[0][1], corners[1][1])
        self._rear_y = (corners[2][1], corners[3][1])

    def read(self, presses: Iterable[Press]) -> FootForces:
        """Forces of what presses on this foot, in the ankle roll frame."""
        front_left = front_right = rear_left = rear_right = 0.0
        moment_x = moment_y = total = 0.0
        for x, y, _, upward, force in presses:
            load = force * upward
            if load <= 0.0:
                continue
            to_front = load * _share(x, self._rear, self._front)
            to_rear = load - to_front
            left = to_front * _share(y, self._front_y[1], self._front_y[0])
            front_left += left
            front_right += to_front - left
            left = to_rear * _share(y, self._rear_y[1], self._rear_y[0])
            rear_left += left
            rear_right += to_rear - left
            total += load
            moment_x += load * x
            moment_y += load * y
        if total == 0.0:
            return UNLOADED
        forces = (front_left, front_right, rear_left, rear_right)
        return FootForces(forces, total, (moment_x / total, moment_y / total))


def _share(value: float, low: float, high: float) -> float:
    """How far `value` is from `low` towards `high`, 0..1."""
    if value <= low:
        return 0.0
    return 1.0 if value >= high else (value - low) / (high - low)

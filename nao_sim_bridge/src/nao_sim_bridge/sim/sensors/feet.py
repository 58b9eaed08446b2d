"""Force sensors under the feet: contact forces shared out over the four sensors of each sole."""

from __future__ import annotations

from typing import Iterable, Sequence

from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.physics import Contact
from nao_sim_bridge.sim.rotations import rotate, rotate_back
from nao_sim_bridge.sim.snapshot import FootForces, Pose

UNLOADED = FootForces()


class FootSensors:
    """The four sensors of one foot.

    A force between the sensors is shared out bilinearly, as a stiff sole on four springs does; one outside their
    rectangle loads the nearest edge.

    Args:
        model: The robot.
        side: "L" or "R".
    """

    def __init__(self, model: RobotModel, side: str) -> None:
        place = {p.name: p.position for p in model.fsr if p.name.startswith(f"{side}Foot/")}
        corners = [place[f"{side}Foot/FSR/{name}"] for name in ("FrontLeft", "FrontRight", "RearLeft", "RearRight")]
        self._front = (corners[0][0] + corners[1][0]) / 2
        self._rear = (corners[2][0] + corners[3][0]) / 2
        self._front_y = (corners[0][1], corners[1][1])
        self._rear_y = (corners[2][1], corners[3][1])

    def read(self, contacts: Iterable[Contact], ankle: Pose) -> FootForces:
        """Forces of the contacts on this foot.

        Args:
            contacts: Contacts of the foot's link.
            ankle: Pose of the ankle roll frame in world.
        """
        forces = [0.0, 0.0, 0.0, 0.0]
        moment_x = moment_y = total = 0.0
        up = rotate(ankle.orientation, (0.0, 0.0, 1.0))
        for contact in contacts:
            load = contact.force * sum(n * u for n, u in zip(contact.normal, up))
            if load <= 0.0:
                continue
            offset = [p - o for p, o in zip(contact.position, ankle.position)]
            x, y, _ = rotate_back(ankle.orientation, offset)
            for index, share in enumerate(self._shares(x, y)):
                forces[index] += load * share
            total += load
            moment_x += load * x
            moment_y += load * y
        if total == 0.0:
            return UNLOADED
        return FootForces(tuple(forces), total, (moment_x / total, moment_y / total))

    def _shares(self, x: float, y: float) -> Sequence[float]:
        front = _share(x, self._rear, self._front)
        left_front = _share(y, self._front_y[1], self._front_y[0])
        left_rear = _share(y, self._rear_y[1], self._rear_y[0])
        rear = 1.0 - front
        return (front * left_front, front * (1 - left_front), rear * left_rear, rear * (1 - left_rear))


def _share(value: float, low: float, high: float) -> float:
    return min(max((value - low) / (high - low), 0.0), 1.0)

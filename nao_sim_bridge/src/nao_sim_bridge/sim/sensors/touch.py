"""Touch sensors, bumpers and the chest button: pressed by what really presses on them, or by a simulated finger."""

from __future__ import annotations

from typing import Callable, Iterable, Mapping

from nao_sim_bridge.sim.errors import UnknownName
from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.physics import Contact
from nao_sim_bridge.sim.rotations import rotate_back
from nao_sim_bridge.sim.snapshot import Pose

# A contact this near to the middle of a sensor presses it, in m: the sensors are about 4 cm wide.
REACH = 0.022
# Bumpers are pressed from the front or the side, not by the floor under the sole.
BUMPER_MAX_UPWARD = 0.5


class TouchSensors:
    """All touch sensors of the robot.

    Args:
        model: The robot.
        link_of: Name of a model link to PyBullet's link index.
    """

    def __init__(self, model: RobotModel, link_of: Callable[[str], int]) -> None:
        self.names = tuple(place.name for place in model.touch)
        self._links: dict[int, list[tuple[str, tuple[float, ...]]]] = {}
        for place in model.touch:
            sensors = self._links.setdefault(link_of(place.parent_link), [])
            sensors.append((place.name, tuple(float(p) for p in place.position)))
        self._fingers: frozenset[str] = frozenset()

    def press(self, names: Iterable[str]) -> None:
        """Simulated fingers on these sensors, and on no others, from now on.

        Raises:
            UnknownName: There is no such sensor.
        """
        wanted = frozenset(names)
        for name in wanted:
            if name not in self.names:
                raise UnknownName("touch sensor", name, self.names)
        self._fingers = wanted

    @property
    def pressed_by_finger(self) -> frozenset[str]:
        """Sensors that a simulated finger presses."""
        return self._fingers

    def read(self, contacts: Mapping[int, list[Contact]], pose_of: Callable[[int], Pose]) -> frozenset[str]:
        """Names of the pressed sensors.

        Args:
            contacts: Contacts by link index.
            pose_of: Pose of a link frame in world.
        """
        pressed = set(self._fingers)
        for link in self._links.keys() & contacts.keys():
            pose = pose_of(link)
            for contact in contacts[link]:
                point = rotate_back(pose.orientation, [p - o for p, o in zip(contact.position, pose.position)])
                upward = rotate_back(pose.orientation, contact.normal)[2]
                for name, place in self._links[link]:
                    if "/Bumper/" in name and abs(upward) > BUMPER_MAX_UPWARD:
                        continue
                    if sum((a - b) ** 2 for a, b in zip(point, place)) <= REACH * REACH:
                        pressed.add(name)
        return frozenset(pressed)

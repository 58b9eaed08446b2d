"""Touch sensors, bumpers and the chest button: pressed by what really presses on them."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.sim.model import RobotModel
from nao_sim_bridge.sim.sensors.contacts import Presses

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
        self._links: dict[int, list[tuple[str, bool, tuple[float, ...]]]] = {}
        for place in model.touch:
            sensors = self._links.setdefault(link_of(place.parent_link), [])
            sensors.append((place.name, "/Bumper/" in place.name, tuple(float(p) for p in place.position)))

    def read(self, presses: Presses) -> frozenset[str]:
        """Names of the pressed sensors."""
        pressed = set()
        for link in self._links.keys() & presses.keys():
            for x, y, z, upward, _ in presses[link]:
                from_the_side = abs(upward) <= BUMPER_MAX_UPWARD
                for name, is_bumper, (sx, sy, sz) in self._links[link]:
                    if is_bumper and not from_the_side:
                        continue
                    if (x - sx) ** 2 + (y - sy) ** 2 + (z - sz) ** 2 <= REACH * REACH:
                        pressed.add(name)
        return frozenset(pressed)

"""Touch sensors, bumpers and the chest button: pressed by what really presses on them."""

from __future__ import annotations

from typing import Callable, Sequence

from nao_sim_bridge.sim.model import Place, RobotModel
from nao_sim_bridge.sim.sensors.contacts import Press, Presses

# A contact this near to the middle of a sensor presses it, in m: the sensors are about 4 cm wide.
REACH = 0.022
# Bumpers are pressed from the front or the side, not by the floor under the sole.
BUMPER_MAX_UPWARD = 0.5
# The two bumpers of a foot meet at the tip: what hits less than this beside it, in m, presses both.
BUMPER_OVERLAP = 0.008

Area = Callable[[Press], bool]


class TouchSensors:
    """All touch sensors of the robot.

    Args:
        model: The robot.
        link_of: Name of a model link to PyBullet's link index.
    """

    def __init__(self, model: RobotModel, link_of: Callable[[str], int]) -> None:
        self.names = tuple(place.name for place in model.touch)
        self._areas: dict[int, list[tuple[str, Area]]] = {}
        bumpers = [place for place in model.touch if "/Bumper/" in place.name]
        for place in model.touch:
            pair = [bumper for bumper in bumpers if bumper.parent_link == place.parent_link]
            area = _toes(place, pair) if place in pair else _surroundings(place)
            self._areas.setdefault(link_of(place.parent_link), []).append((place.name, area))

    def read(self, presses: Presses) -> frozenset[str]:
        """Names of the pressed sensors."""
        return frozenset(
            name
            for link in self._areas.keys() & presses.keys()
            for name, holds in self._areas[link]
            if any(map(holds, presses[link]))
        )


def _surroundings(sensor: Place) -> Area:
    sx, sy, sz = map(float, sensor.position)
    return lambda at: (at.x - sx) ** 2 + (at.y - sy) ** 2 + (at.z - sz) ** 2 <= REACH * REACH


def _toes(bumper: Place, pair: Sequence[Place]) -> Area:
    """The shell round one half of the toes, from a little behind the middle of the bumper to the tip of the foot."""
    rear = float(bumper.position[0]) - REACH
    tip = sum(float(place.position[1]) for place in pair) / len(pair)
    side = 1.0 if bumper.position[1] > tip else -1.0

    def holds(at: Press) -> bool:
        return at.x >= rear and side * (at.y - tip) >= -BUMPER_OVERLAP and abs(at.upward) <= BUMPER_MAX_UPWARD

    return holds

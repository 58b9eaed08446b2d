"""Touch sensors, bumpers and the chest button: pressed by what really presses on them."""

from __future__ import annotations

import math
from typing import Callable, Iterable, List, Sequence

from nao_sim_bridge.body.sensors.contacts import Press, Presses
from nao_sim_bridge.model.robot_model import Place, RobotModel

# A contact this near to the middle of a sensor presses it, in m: the sensors are about 4 cm wide.
REACH = 0.022
# A finger between two sensors of one part touches both when it is this much nearer to one of them at most, in m.
OVERLAP = 0.001
# Bumpers are pressed from the front or the side, not by the floor under the sole.
BUMPER_MAX_UPWARD = 0.5
# The two bumpers of a foot meet at the tip: what hits less than this beside it, in m, presses both.
BUMPER_OVERLAP = 0.008

Felt = Callable[[Press], Iterable[str]]


class TouchSensors:
    """All touch sensors of the robot.

    Args:
        link_of: Name of a model link to PyBullet's link index.
    """

    def __init__(self, model: RobotModel, link_of: Callable[[str], int]) -> None:
        self.names = tuple(place.name for place in model.touch)
        self._felt: dict[int, Felt] = {}
        for link in {place.parent_link for place in model.touch}:
            places = [place for place in model.touch if place.parent_link == link]
            bumpers = all("/Bumper/" in place.name for place in places)
            self._felt[link_of(link)] = _toes(places) if bumpers else _pads(places)

    def read(self, presses: Presses) -> frozenset[str]:
        return frozenset(
            name
            for link in self._felt.keys() & presses.keys()
            for press in presses[link]
            for name in self._felt[link](press)
        )


def _pads(places: Sequence[Place]) -> Felt:
    """Sensors side by side, each a little larger than the place that is nearer to it than to the others."""
    middles = [(place.name, *map(float, place.position)) for place in places]

    def felt(at: Press) -> List[str]:
        distances = [(math.dist((at.x, at.y, at.z), middle), name) for name, *middle in middles]
        limit = min(REACH, min(distances)[0] + OVERLAP)
        return [name for distance, name in distances if distance <= limit]

    return felt


def _toes(pair: Sequence[Place]) -> Felt:
    """The shell round the toes, from a little behind the middle of the bumpers to the tip; each has its side of it."""
    rear = min(float(place.position[0]) for place in pair) - REACH
    tip = sum(float(place.position[1]) for place in pair) / len(pair)
    sides = [(place.name, 1.0 if place.position[1] > tip else -1.0) for place in pair]

    def felt(at: Press) -> List[str]:
        if abs(at.upward) > BUMPER_MAX_UPWARD or at.x < rear:
            return []
        return [name for name, side in sides if side * (at.y - tip) >= -BUMPER_OVERLAP]

    return felt

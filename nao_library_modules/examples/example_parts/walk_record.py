"""What a robot tells about its own walk, sample by sample, and the footprints that follow from it. Pure data.

Every place is in the robot's odometry (FRAME_WORLD of NAOqi), in m and rad.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any, List, Optional, Sequence, Tuple

from .record_file import load_record, save_record

Point = Tuple[float, float]
# x, y in m, heading in rad.
Place = Tuple[float, float, float]

LEFT, RIGHT = "left", "right"
OTHER = {LEFT: RIGHT, RIGHT: LEFT}
# A foot carries when it has this share of the weight that both feet feel.
CARRIES = 0.3
# A foot that is further from where it carried before, m or rad, has made a step.
STEP_LENGTH, STEP_TURN = 0.01, 0.07
FORMAT = "nao_walk_record"


@dataclass(frozen=True)
class Sample:
    """One moment of a walk.

    Attributes:
        left: Left foot, on the ground below the ankle.
        right: Right foot.
        mass: Centre of mass over the ground.
        loads: What the left and the right foot feel, kg.
        pressures: Centre of pressure of the left and the right foot in the frame of the foot, m.
        planned: Foot that is to land next ("left" or "right"; empty for none) and where.
    """

    left: Place
    right: Place
    mass: Point
    loads: Point
    pressures: Tuple[Point, Point]
    planned: Tuple[str, Place] = ("", (0.0, 0.0, 0.0))

    @property
    def pressure(self) -> Optional[Point]:
        """Centre of pressure of both feet; None when neither feels the ground."""
        total = sum(self.loads)
        if total <= 0.0:
            return None
        points = [moved(foot, *at) for foot, at in zip((self.left, self.right), self.pressures)]
        x, y = (sum(load * point[axis] for load, point in zip(self.loads, points)) / total for axis in (0, 1))
        return (x, y)


@dataclass(frozen=True)
class Footprint:
    """Where a foot stood.

    Attributes:
        foot: "left" or "right".
        place: There.
        planned: Where the robot meant to put it, None when it did not tell.
    """

    foot: str
    place: Place
    planned: Optional[Place] = None


def moved(place: Place, x: float, y: float) -> Point:
    """A point of the frame of a place."""
    c, s = math.cos(place[2]), math.sin(place[2])
    return (place[0] + c * x - s * y, place[1] + s * x + c * y)


def footprints(samples: Sequence[Sample]) -> List[Footprint]:
    """Where feet stood, in the order in which they came there; the first two are the stance at the start."""
    prints: List[Footprint] = []
    index = {LEFT: -1, RIGHT: -1}
    most = {LEFT: 0.0, RIGHT: 0.0}
    told = {}
    for sample in samples:
        if sample.planned[0]:
            told[sample.planned[0]] = sample.planned[1]
        for foot, load in zip((LEFT, RIGHT), sample.loads):
            place = sample.left if foot == LEFT else sample.right
            if load <= 0.0 or load < CARRIES * sum(sample.loads):
                continue
            if index[foot] < 0 or _stepped(prints[index[foot]].place, place):
                index[foot] = len(prints)
                prints.append(Footprint(foot, place, told.pop(foot, None)))
                most[foot] = load
            elif load > most[foot]:
                # A foot lies flattest, and its place is surest, when it carries most.
                most[foot] = load
                prints[index[foot]] = Footprint(foot, place, prints[index[foot]].planned)
    return prints


def save(samples: Sequence[Sample], path: Path) -> None:
    save_record(path, FORMAT, "m, rad, kg", "sample", samples)


def load(path: Path) -> List[Sample]:
    """Read a record; RecordError if it is none."""
    return load_record(path, FORMAT, "sample", _sample)


def _stepped(before: Place, now: Place) -> bool:
    turn = math.atan2(math.sin(now[2] - before[2]), math.cos(now[2] - before[2]))
    return math.hypot(now[0] - before[0], now[1] - before[1]) > STEP_LENGTH or abs(turn) > STEP_TURN


def _sample(entry: Any) -> Sample:
    foot, place = entry["planned"]
    if foot not in ("", LEFT, RIGHT):
        raise ValueError(f"a foot {foot!r}")
    left, right = entry["pressures"]
    return Sample(
        _floats(entry["left"], 3),
        _floats(entry["right"], 3),
        _floats(entry["mass"], 2),
        _floats(entry["loads"], 2),
        (_floats(left, 2), _floats(right, 2)),
        (foot, _floats(place, 3)),
    )


def _floats(values: Any, count: int) -> Any:
    floats = tuple(float(value) for value in values)
    if len(floats) != count:
        raise ValueError(f"{len(floats)} numbers instead of {count}")
    return floats

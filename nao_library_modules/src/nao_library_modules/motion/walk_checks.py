"""Checks of the functions that walk: numbers that make sense, a robot that can."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..base.errors import BadGoal
from ..base.field_checks import degrees_hint, require_count, require_length
from ..base.limits import limit
from ..base.places import Place
from .base import MotionBase
from .gait import GaitAccess, GaitPairs, read_gait, walk_time
from .walk_plan import LEGS

WORLD = 1
PLACE = "x, y (m), theta (rad)"
WAY, TURN = limit("way"), limit("turn")
"""Seen from the robot. Who asks for more has mistaken the unit; the battery would not do."""
PLACES = limit("places")
# Where a foot can be put beside the other one, m and rad. Source: NAOqi's documentation of the clipping of footsteps,
# which the robot applies in detail.
STEP_X, STEP_Y, STEP_THETA = (-0.04, 0.08), (0.088, 0.16), 0.524
ROUNDING = 1e-6


class WalkBase(MotionBase):
    """What the functions that walk share.

    Attributes:
        gait: Parameters of the robot's walk.
        locate: Where a frame of /tf is, seen from the robot: x and y in m, heading in rad.
    """

    gait: GaitAccess
    locate: Callable[[str], Sequence[float]]

    def walk_config(self, gait: Sequence[str], gait_values: Sequence[float], each_foot: bool = False) -> GaitPairs:
        """Parameters of a walk as ALMotion takes them; nothing is asked of the robot if a message gives none."""
        if not gait and not gait_values:
            return []
        return read_gait(gait, gait_values, self.gait.ranges, each_foot)

    def origin(self, frame: int, str_param: str) -> Place | None:
        """Where the frame of a message is, seen from the robot; None for the world, that the walk itself knows."""
        if str_param.strip():
            return Place(*self.locate(str_param.strip()))
        return None if frame == WORLD else Place(0.0, 0.0, 0.0)


# Numbers


def require_way(way: Place, field: str = "values") -> None:
    """See that a way makes sense.

    Raises:
        BadGoal: If it is too long, or turns by more than half a turn, or a number is none.
    """
    numbers = ("x", way.x, WAY), ("y", way.y, WAY), ("theta", way.yaw, TURN)
    for name, value, (_, most, unit) in numbers:
        if not abs(value) <= most:
            hint = degrees_hint(value, -most, most) if unit == "rad" else ""
            allowed = f"-{most:.5g} to {most:.5g} {unit}{hint}"
            raise BadGoal(field, value, allowed, problem=f"{name} cannot be {value:g}")


def places(values: Sequence[float]) -> list[Place]:
    """Places from one flat list.

    Raises:
        BadGoal: If there is none, not three numbers for each, or too many.
    """
    require_length("values", len(values) // 3, PLACES)
    if len(values) < 3:
        require_count("values", values, 3, PLACE)
    require_count("values", values, 3, PLACE, "place")
    return [Place(*values[i : i + 3]) for i in range(0, len(values), 3)]


def _begin(self: MotionBase) -> None:
    """What all walks need and do."""
    self.plan.walk.require_ready()
    self.plan.health.require_walk(self.plan.walk.moved_joints(), self.plan.moves)
    # Legs walk, arms swing: only the robot knows where they are afterwards.
    self.plan.forget(self.plan.walk.moved_joints())


# Walks to places


def check_move_to(
    self: WalkBase, values: Sequence[float], duration: float, gait: Sequence[str], gait_values: Sequence[float]
) -> None:
    """A time for one place only; parameters of the walk; legs that can."""
    points = places(values)
    if duration > 0.0 and len(points) > 1:
        raise BadGoal("duration", duration, "0 where there are places on the way")
    config = self.walk_config(gait, gait_values)
    _begin(self)
    self.plan.takes(max(duration, walk_time(points, config, self.gait.ranges)))
    self.plan.walk.stands()


def check_path(
    self: WalkBase,
    values: Sequence[float],
    frame: int,
    str_param: str,
    gait: Sequence[str],
    gait_values: Sequence[float],
) -> None:
    """Places near enough, parameters of the walk, legs that can."""
    points = places(values)
    config = self.walk_config(gait, gait_values)
    origin = self.origin(frame, str_param)
    if origin is not None:
        points = [origin.then(point) for point in points]
        for point in points:
            require_way(point)
    _begin(self)
    self.plan.takes(walk_time(points, config, self.gait.ranges))
    self.plan.walk.stands()


# Walks at a speed


def check_pace(self: WalkBase, duration: float, gait: Sequence[str], gait_values: Sequence[float]) -> None:
    """Parameters of the walk, legs that can."""
    self.walk_config(gait, gait_values, each_foot=True)
    _begin(self)
    self.plan.takes(duration)
    if duration > 0.0:
        self.plan.walk.stands()
    else:
        self.plan.walk.goes()


# Footsteps


def steps(names: Sequence[str], values: Sequence[float]) -> list[list[float]]:
    """Footsteps of a message: x, y and theta of each, seen from the other foot.

    Raises:
        BadGoal: If there are not three numbers for each, or a leg cannot put its foot there.
    """
    if len(values) != 3 * len(names):
        problem = f"3 numbers for each step are needed, {3 * len(names)} in all"
        raise BadGoal("values", list(values), f"{PLACE}; here are {len(values)}", problem=problem)
    rows = [list(values[i : i + 3]) for i in range(0, len(values), 3)]
    for leg, (x, y, theta) in zip(names, rows):
        across = STEP_Y if leg == LEGS[0] else (-STEP_Y[1], -STEP_Y[0])
        ranges = (("x", x, STEP_X), ("y", y, across), ("theta", theta, (-STEP_THETA, STEP_THETA)))
        for name, value, (least, most) in ranges:
            if not least - ROUNDING <= value <= most + ROUNDING:
                problem = f"{name} of a step of {leg} cannot be {value:g}"
                raise BadGoal("values", value, f"{least:g} to {most:g}, seen from the other foot", problem=problem)
    return rows


def check_timed_steps(self: WalkBase, names: Sequence[str], values: Sequence[float], times: Sequence[float]) -> None:
    """Where legs step, a time for each; legs that can."""
    steps(names, values)
    if len(times) != len(names):
        raise BadGoal("times", list(times), "one for each step", problem=f"{len(times)} times for {len(names)} steps")
    _begin(self)
    self.plan.walk.goes()


def check_fast_steps(
    self: WalkBase, names: Sequence[str], values: Sequence[float], speed: float, speeds: Sequence[float]
) -> None:
    """Where legs step, a speed for each or for all; legs that can."""
    steps(names, values)
    step_speeds(len(names), speed, speeds)
    _begin(self)
    self.plan.walk.stands()


def step_speeds(count: int, speed: float, speeds: Sequence[float]) -> list[float]:
    """How fast each step is, as a fraction of the fastest; all of it where a message leaves it to us.

    Raises:
        BadGoal: If there are not as many as steps.
    """
    given = list(speeds) or [speed or 1.0]
    if len(given) not in (1, count):
        raise BadGoal("speeds", given, "one, or one for each step", problem=f"{len(given)} speeds for {count} steps")
    return given if len(given) == count else given * count


# Ends and questions


def check_end(self: MotionBase) -> None:
    """Nothing can be wrong; the robot stands afterwards."""
    self.plan.moves = True  # what falls meanwhile ends the goal
    self.plan.walk.stands()


def check_init(self: MotionBase) -> None:
    """Legs that can."""
    _begin(self)
    self.plan.walk.stands()

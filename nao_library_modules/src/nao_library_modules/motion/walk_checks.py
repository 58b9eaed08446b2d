"""Checks of the functions that walk: numbers that make sense, a robot that can."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..base.errors import BadGoal
from ..base.field_checks import (
    degrees_hint,
    require_count,
    require_length,
    require_rising,
    require_within,
    require_zero_or,
)
from ..base.limits import limit
from ..base.places import Place
from ..base.suggestion import did_you_mean
from .base import MotionBase
from .cartesian import require_frame
from .gait import CONFIGS, GaitAccess, GaitPairs, read_gait, walk_time
from .plan import ANGLE, DURATION, FRACTION
from .walk_plan import ARMS, LEGS

WORLD = 1
PLACE = "x, y (m), theta (rad)"
FURTHEST, HALF_TURN = limit("way").highest, limit("turn").highest
"""m and rad. Who asks for more has mistaken the unit; the battery would not do."""
# Far above what a NAO reaches: faster is no wish but a mistake in the unit. m/s and rad/s.
FASTEST, FASTEST_TURN = limit("walking speed").highest, limit("turning speed").highest
PACE, DISTANCE = limit("recording"), limit("place")
PLACES, FOOTSTEPS = limit("places"), limit("footsteps")
# m that sonars see.
FARTHEST_SEEN = 2.5
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
    numbers = ("x", way.x, FURTHEST, "m"), ("y", way.y, FURTHEST, "m"), ("theta", way.yaw, HALF_TURN, "rad")
    for name, value, most, unit in numbers:
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


def _require_seconds(duration: float) -> None:
    require_zero_or("duration", duration, PACE, " for none")


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
    """A way, or places on the way; a time; parameters of the walk; legs that can."""
    points = places(values)
    for point in points:
        require_way(point)
    _require_seconds(duration)
    if duration > 0.0 and len(points) > 1:
        raise BadGoal("duration", duration, "0 where there are places on the way")
    config = self.walk_config(gait, gait_values)
    _begin(self)
    self.plan.takes(max(duration, walk_time(points, config, self.gait.ranges)))
    self.plan.walk.stands()


def check_target(
    self: WalkBase,
    values: Sequence[float],
    frame: int,
    str_param: str,
    gait: Sequence[str],
    gait_values: Sequence[float],
) -> None:
    """One place in a known frame, parameters of the walk, legs that can."""
    require_count("values", values, 3, PLACE)
    check_path(self, values, frame, str_param, gait, gait_values)


def check_path(
    self: WalkBase,
    values: Sequence[float],
    frame: int,
    str_param: str,
    gait: Sequence[str],
    gait_values: Sequence[float],
) -> None:
    """Places in a known frame, parameters of the walk, legs that can."""
    points = places(values)
    for point in points:
        for value, kind in zip(point, (DISTANCE, DISTANCE, ANGLE)):
            require_within("values", value, kind)
    require_frame(frame)
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


def check_move(
    self: WalkBase, values: Sequence[float], duration: float, gait: Sequence[str], gait_values: Sequence[float]
) -> None:
    """A velocity, a time, parameters of the walk, legs that can."""
    _check_velocity(self, values, (FASTEST, FASTEST, FASTEST_TURN), "x, y (m/s), theta (rad/s)")
    _check_pace(self, duration, gait, gait_values)


def check_move_toward(
    self: WalkBase, values: Sequence[float], duration: float, gait: Sequence[str], gait_values: Sequence[float]
) -> None:
    """Shares of the top speed, a time, parameters of the walk, legs that can."""
    _check_velocity(self, values, (1.0, 1.0, 1.0), "x, y, theta, shares of the top speed")
    _check_pace(self, duration, gait, gait_values)


def _check_velocity(self: WalkBase, values: Sequence[float], most: Sequence[float], what: str) -> None:
    require_count("values", values, 3, what)
    for name, value, top in zip(("x", "y", "theta"), values, most):
        if not abs(value) <= top:
            allowed = f"-{top:.4g} to {top:.4g} ({what})"
            raise BadGoal("values", value, allowed, problem=f"{name} cannot be {value:g}")


def _check_pace(self: WalkBase, duration: float, gait: Sequence[str], gait_values: Sequence[float]) -> None:
    _require_seconds(duration)
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
        BadGoal: If a leg is not known, moves twice in a row, or cannot put its foot there, or steps are too many.
    """
    require_length("names", len(names), FOOTSTEPS)
    if not names:
        raise BadGoal("names", [], f"for each step one of {', '.join(LEGS)}", problem="it is empty")
    for leg in names:
        if leg not in LEGS:
            problem = f"{leg!r} is no leg{did_you_mean(leg, LEGS)}"
            raise BadGoal("names", leg, f"for each step one of {', '.join(LEGS)}", problem=problem)
    for leg, following in zip(names, names[1:]):
        if leg == following:
            raise BadGoal("names", list(names), "one leg after the other", problem=f"{leg} cannot step twice in a row")
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
    """Legs, where they step, when; legs that can."""
    steps(names, values)
    require_rising("times", times, DURATION)
    if len(times) != len(names):
        raise BadGoal("times", list(times), "one for each step", problem=f"{len(times)} times for {len(names)} steps")
    _begin(self)
    self.plan.walk.goes()


def check_fast_steps(
    self: WalkBase, names: Sequence[str], values: Sequence[float], speed: float, speeds: Sequence[float]
) -> None:
    """Legs, where they step, how fast; legs that can."""
    steps(names, values)
    step_speeds(len(names), speed, speeds)
    _begin(self)
    self.plan.walk.stands()


def step_speeds(count: int, speed: float, speeds: Sequence[float]) -> list[float]:
    """How fast each step is, as a fraction of the fastest; all of it where a message leaves it to us.

    Raises:
        BadGoal: If one is no fraction, or there are not as many as steps.
    """
    given = list(speeds) or [speed or 1.0]
    if len(given) not in (1, count):
        raise BadGoal("speeds", given, "one, or one for each step", problem=f"{len(given)} speeds for {count} steps")
    for value in given:
        require_within("speeds" if speeds else "speed", value, FRACTION)
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


def check_config(_self: object, str_param: str) -> None:
    """The name of a configuration."""
    if str_param and str_param not in CONFIGS:
        problem = f"{str_param!r} is not known{did_you_mean(str_param, CONFIGS)}"
        raise BadGoal("str_param", str_param, f"one of {', '.join(CONFIGS)}", problem=problem)


def check_distance(_self: object, values: Sequence[float]) -> None:
    """One distance."""
    if len(values) != 1 or not 0.0 <= values[0] <= FARTHEST_SEEN:
        raise BadGoal("values", list(values), f"one distance, 0 to {FARTHEST_SEEN:g} m")


def check_arms(_self: object, names: Sequence[str]) -> None:
    """Arms, or nothing for both."""
    for name in names:
        if name not in (*ARMS, "Arms"):
            problem = f"{name!r} is no arm{did_you_mean(name, (*ARMS, 'Arms'))}"
            raise BadGoal("names", name, f"{', '.join(ARMS)}, Arms, or nothing for both", problem=problem)

"""What the fields of a MotionFunction mean to walks, effectors in space and switches; the numbers of a gait."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, List, Union

from ..core.errors import BadGoal, did_you_mean
from ..core.fields import (
    Annotated,
    Field,
    Limit,
    degrees_hint,
    flag,
    free,
    limit,
    moments,
    number,
    numbers,
    require_count,
    require_each,
    require_length,
    require_within,
    usual,
    word,
)
from ..core.geometry import Place
from ..core.nao_facts import step_period
from .motion_fields import FRAME, NAMES, single
from .motion_plan import ARMS, LEGS

SETTABLE = (
    "MaxStepX",
    "MaxStepY",
    "MaxStepTheta",
    "MaxStepFrequency",
    "StepHeight",
    "TorsoWx",
    "TorsoWy",
)
"""What a walk may change; the other parameters that getMoveConfig tells are fixed."""
FEET = ("Left", "Right")
FREQUENCY = "Frequency"
DEFAULT, LEAST, MOST = CONFIGS = ("Default", "Min", "Max")
# The robot's numbers have 32 bits: a limit that it tells must be allowed as a value.
TOLERANCE = 1e-6
FOOT_SEPARATION = 0.1
"""m; from NAOqi's documentation of the walk."""
# From standing to the first step and from the last one to standing, about, s.
BEGIN_AND_END = 2.0

PLACE = "x, y (m), theta (rad)"
WAY, TURN = limit("way"), limit("turn")
"""Seen from the robot. Who asks for more has mistaken the unit; the battery would not do."""
PLACES = limit("places")
# Where a foot can be put beside the other one, m and rad. Source: NAOqi's documentation of the clipping of footsteps,
# which the robot applies in detail.
STEP_X, STEP_Y, STEP_THETA = (-0.04, 0.08), (0.088, 0.16), 0.524
ROUNDING = 1e-6

GaitPairs = List[List[Union[str, float]]]
"""What ALMotion takes: [["MaxStepX", 0.04], ...]."""


@dataclass(frozen=True)
class GaitRange:
    """One parameter of a walk: its default, and the least and largest that is allowed; m, rad, or a share 0..1."""

    default: float
    lower: float
    upper: float


def read_ranges(motion: Callable[..., Any]) -> Mapping[str, GaitRange]:
    """Parameter that can be set -> its range, with `motion` to call ALMotion.

    Raises NaoError if the robot cannot be asked.
    """
    configs = [{name: float(v) for name, v in motion("getMoveConfig", which)} for which in CONFIGS]
    names = [name for name in SETTABLE if all(name in values for values in configs)]
    return {name: GaitRange(*(values[name] for values in configs)) for name in names}


def read_gait(
    names: Sequence[str], values: Sequence[float], ranges: Mapping[str, GaitRange], each_foot: bool
) -> GaitPairs:
    """The parameters that a message gives, in the shape that ALMotion takes.

    Raises BadGoal if a name is not known, or a value is out of its range.

    Args:
        names, values, ranges: NAOqi's names, one value each, what the robot allows.
        each_foot: Whether the walk takes parameters for one foot, and a frequency.
    """
    if len(names) != len(values):
        problem = f"{len(values)} values for {len(names)} parameters"
        raise BadGoal("gait_values", list(values), f"one for each of {', '.join(names) or 'gait'}", problem=problem)
    allowed = _allowed(ranges, each_foot)
    pairs: GaitPairs = []
    for name, value in zip(names, values):
        if name not in allowed:
            raise BadGoal("gait", name, f"one of {', '.join(allowed)}", problem=_unknown(name, allowed, each_foot))
        limits = allowed[name]
        if not limits.lower - TOLERANCE <= value <= limits.upper + TOLERANCE:
            problem = f"{name} cannot be {value:g}"
            bounds = f"{limits.lower:.3g} to {limits.upper:.3g} {_unit(name)}"
            raise BadGoal("gait_values", value, bounds, problem=problem)
        pairs.append([name, float(value)])
    return pairs


def _unit(name: str) -> str:
    """Of a parameter of a walk; a frequency is a share of the highest."""
    if name.endswith(FREQUENCY):
        return "of the highest"
    return "rad" if name.endswith(("Theta", "Wx", "Wy")) else "m"


def walk_time(points: Sequence[Place], pairs: GaitPairs, ranges: Mapping[str, GaitRange]) -> float:
    """About how long a walk takes, s, through points seen from the robot; `pairs` are parameters that it changes."""
    gait = {name: limits.default for name, limits in ranges.items()}
    gait.update({str(name): float(value) for name, value in pairs})
    period = step_period(gait.get("MaxStepFrequency", 1.0))
    # Of two steps to the side only the first one gets ahead.
    most = (gait["MaxStepX"], 0.5 * (gait["MaxStepY"] - FOOT_SEPARATION), gait["MaxStepTheta"])
    steps, before = 0.0, Place(0.0, 0.0, 0.0)
    for point in points:
        way = point.seen_from(before)
        steps += math.sqrt(sum((part / size) ** 2 for part, size in zip(way, most)))
        before = point
    return steps * period + (BEGIN_AND_END if steps else 0.0)


def _allowed(ranges: Mapping[str, GaitRange], each_foot: bool) -> dict[str, GaitRange]:
    allowed = dict(ranges)
    if each_foot:
        allowed.update({foot + name: limits for foot in FEET for name, limits in ranges.items()})
        allowed[FREQUENCY] = GaitRange(1.0, 0.0, 1.0)
    return allowed


def _unknown(name: str, allowed: Mapping[str, GaitRange], each_foot: bool) -> str:
    if not each_foot and (name == FREQUENCY or name.startswith(FEET)):
        return f"{name} is for move and moveToward"
    return f"{name!r} is no parameter of a walk{did_you_mean(name, allowed)}"


# Places and footsteps


def require_way(way: Place, field: str = "values") -> None:
    """See that a way makes sense.

    Raises BadGoal if it is too long, or turns by more than half a turn, or a number is none.
    """
    numbers = ("x", way.x, WAY), ("y", way.y, WAY), ("theta", way.yaw, TURN)
    for name, value, (_, most, unit) in numbers:
        if not abs(value) <= most:
            hint = degrees_hint(value, -most, most) if unit == "rad" else ""
            allowed = f"-{most:.5g} to {most:.5g} {unit}{hint}"
            raise BadGoal(field, value, allowed, problem=f"{name} cannot be {value:g}")


def places(values: Sequence[float]) -> list[Place]:
    """Places from one flat list. Raises BadGoal if there is none, not three numbers for each, or too many."""
    require_length("values", len(values) // 3, PLACES)
    if len(values) < 3:
        require_count("values", values, 3, PLACE)
    require_count("values", values, 3, PLACE, "place")
    return [Place(*values[i : i + 3]) for i in range(0, len(values), 3)]


def steps(names: Sequence[str], values: Sequence[float]) -> list[list[float]]:
    """Footsteps of a message: x, y and theta of each, seen from the other foot.

    Raises BadGoal if there are not three numbers for each, or a leg cannot put its foot there.
    """
    if len(values) != 3 * len(names):
        problem = f"3 numbers for each step are needed, {3 * len(names)} in all"
        raise BadGoal("values", list(values), f"{PLACE}; here are {len(values)}", problem=problem)
    rows = [list(values[i : i + 3]) for i in range(0, len(values), 3)]
    for leg, (x, y, theta) in zip(names, rows):
        across = STEP_Y if leg == LEGS[0] else (-STEP_Y[1], -STEP_Y[0])
        ranges = (("x", x, STEP_X, "m"), ("y", y, across, "m"), ("theta", theta, (-STEP_THETA, STEP_THETA), "rad"))
        for name, value, (least, most), unit in ranges:
            if not least - ROUNDING <= value <= most + ROUNDING:
                problem = f"{name} of a step of {leg} cannot be {value:g}"
                allowed = f"{least:g} to {most:g} {unit}, seen from the other foot"
                raise BadGoal("values", value, allowed, problem=problem)
    return rows


def step_speeds(count: int, speed: float, speeds: Sequence[float]) -> list[float]:
    """How fast each step is, as a fraction of the fastest; all of it where a message leaves it to us.

    Raises BadGoal if there are not as many as steps.
    """
    given = list(speeds) or [speed or 1.0]
    if len(given) not in (1, count):
        raise BadGoal("speeds", given, "one, or one for each step", problem=f"{len(given)} speeds for {count} steps")
    return given if len(given) == count else given * count


# Chains that an effector moves; the torso moves on both legs.
EFFECTORS: Mapping[str, Sequence[str]] = {
    "Head": ("Head",),
    "LArm": ("LArm",),
    "RArm": ("RArm",),
    "LLeg": ("LLeg",),
    "RLeg": ("RLeg",),
    "Torso": ("LLeg", "RLeg"),
}
POSE_NUMBER, POSES, FOOTSTEPS = limit("pose"), limit("poses"), limit("footsteps")
ANYWHERE, ANGLE = limit("place"), limit("angle")
# Far above what a NAO reaches: faster is no wish but a mistake in the unit.
PACE, TURNING, SHARE = limit("walking speed"), limit("turning speed"), Limit(-1.0, 1.0, "")
# m that sonars see.
FARTHEST_SEEN = 2.5
PARTS = "effectors, joints or sensors"
GOAL_OF_EFFECTOR = "wx wy wz (Head), x y z or x y z wx wy wz (arms)"
BOTH_ARMS, BOTH_LEGS = (*ARMS, "Arms"), (*LEGS, "Legs")
WHOLE_BODY = ("Head", *ARMS)
BREATH_KEYS = ("Bpm", "Amplitude")


# Kinds of fields


def _words(
    choices: Sequence[str], meaning: str, kind: str = "", nothing: str | None = "nothing is named", allowed: str = ""
) -> Field:
    """Some of several words that name a `kind` ("arm"); `nothing` says what is wrong with none of them, if anything."""
    listed = ", ".join(choices)

    def check(name: str, words: Sequence[str]) -> None:
        if nothing is not None and not words:
            raise BadGoal(name, [], allowed or f"one or more of {listed}", problem=nothing)
        for each in words:
            if each not in choices:
                problem = f"{each!r} is {f'no {kind}' if kind else 'not known'}{did_you_mean(each, choices)}"
                raise BadGoal(name, each, allowed or f"one of {listed}", problem=problem)

    return free(meaning, allowed=allowed or f"one or more of {listed}", choices=choices, check=check)


def _in_plane(along: Limit, turn: Limit) -> str:
    """Bounds of x, y and theta, in words."""
    return f"x, y {along.lowest:g}..{along.highest:g} {along.unit}, theta {turn.lowest:g}..{turn.highest:g} {turn.unit}"


def _velocity(along: Limit, turn: Limit, what: str, field: Field) -> Field:
    """x, y and theta of a walk that goes on, with bounds as far below 0 as above."""

    def check(name: str, values: Sequence[float]) -> None:
        require_count(name, values, 3, what)
        for axis, value, bounds in zip(("x", "y", "theta"), values, (along, along, turn)):
            if not abs(value) <= bounds.highest:
                allowed = f"-{bounds.highest:.4g} to {bounds.highest:.4g} {bounds.unit} ({what})".replace("  ", " ")
                raise BadGoal(name, value, allowed, problem=f"{axis} cannot be {value:g}")

    return field.but(check=check)


# Checks of one field


def _require_named(name: str, names: Sequence[str]) -> None:
    if not names:
        raise BadGoal(name, [], PARTS, problem="nothing is named")


def _require_turns(name: str, legs: Sequence[str]) -> None:
    require_length(name, len(legs), FOOTSTEPS)
    _STEPS.require(name, legs)
    for leg, following in zip(legs, legs[1:]):
        if leg == following:
            raise BadGoal(name, list(legs), "one leg after the other", problem=f"{leg} cannot step twice in a row")


def _require_ways(name: str, values: Sequence[float]) -> None:
    for way in places(values):
        require_way(way, name)


def _require_places(name: str, values: Sequence[float]) -> None:
    for place in places(values):
        require_each(name, place[:2], ANYWHERE)
        require_within(name, place.yaw, ANGLE)


def _require_place(name: str, values: Sequence[float]) -> None:
    require_count(name, values, 3, PLACE)
    _require_places(name, values)


def _require_effector_goal(name: str, values: Sequence[float]) -> None:
    if len(values) not in (3, 6):
        raise BadGoal(name, list(values), GOAL_OF_EFFECTOR)
    require_each(name, values, POSE_NUMBER._replace(unit="m, rad"))


# Effectors in space

_POSES = numbers("pose", "x y z wx wy wz for each effector", "m, rad")
_TRANSFORMS = numbers("pose", "rotation and translation for each effector: 12 numbers, row by row", "m")
_PATH = "for each time, all of the first effector first"

Parts = Annotated[List[str], NAMES.but(help=PARTS, allowed=PARTS, check=_require_named)]
Effectors = Annotated[List[str], _words(tuple(EFFECTORS), "effectors that move", "effector", "no effector is named")]
Poses = Annotated[List[float], _POSES]
PoseChanges = Annotated[List[float], _POSES.but(help="differences in x y z wx wy wz for each effector")]
PosePath = Annotated[List[float], _POSES.but(help=f"x y z wx wy wz {_PATH}")]
Transforms = Annotated[List[float], _TRANSFORMS]
TransformPath = Annotated[List[float], _TRANSFORMS.but(help=f"12 numbers of rotation and translation {_PATH}")]
PoseTimes = Annotated[List[float], moments("duration", "when each place is reached, from the start", POSES)]
AxisMask = Annotated[
    int,
    number(
        (0, 63),
        "what counts: 7 position, 56 rotation, 63 both; 0: 7",
        allowed="1..63: the sum of 1 x, 2 y, 4 z, 8 wx, 16 wy, 32 wz; 0 for 7",
    ),
]

# Walks

_GAIT = free("parameters of the walk by NAOqi's names", allowed=f"some of {', '.join(SETTABLE)}", choices=SETTABLE)
_OF_EACH_FOOT = (*SETTABLE, *(foot + name for foot in FEET for name in SETTABLE), FREQUENCY)
_PLACES = free(
    "x, y, theta of each place on the way",
    "m, rad",
    f"for each place {_in_plane(ANYWHERE, ANGLE)}; seen from the robot {_in_plane(WAY, TURN)}",
    check=_require_places,
)
_STEPS = _words(
    LEGS, "leg of each step, one after the other", "leg", "it is empty", f"for each step one of {', '.join(LEGS)}"
)

Ways = Annotated[
    List[float],
    _PLACES.but(
        help="x, y, theta of each place on the way, seen from the robot",
        allowed=f"for each place {_in_plane(WAY, TURN)}",
        check=_require_ways,
        usual=(usual("way"), usual("way"), None),
    ),
]
Places = Annotated[List[float], _PLACES]
Target = Annotated[
    List[float],
    _PLACES.but(
        help="x, y, theta of the place",
        allowed=f"{_in_plane(ANYWHERE, ANGLE)}; seen from the robot {_in_plane(WAY, TURN)}",
        check=_require_place,
    ),
]
PlaceFrame = Annotated[int, FRAME.but(help="frame of the places where str_param names none; 0 and 2: the robot's")]
TfFrame = Annotated[str, free("name of a frame of /tf; empty: see frame", allowed="a frame of /tf, or nothing")]
Velocity = Annotated[
    List[float],
    _velocity(
        PACE,
        TURNING,
        "x, y (m/s), theta (rad/s)",
        free("velocity along x, y and around z", "m/s, rad/s", _in_plane(PACE, TURNING)),
    ).but(usual=(usual("walking speed"), usual("walking speed"), usual("turning speed"))),
]
VelocityShares = Annotated[
    List[float],
    _velocity(
        SHARE,
        SHARE,
        "x, y, theta, shares of the top speed",
        numbers(SHARE, "velocity along x, y and around z, as shares of the greatest", allowed="3 numbers, each -1..1"),
    ),
]
LeastTime = Annotated[float, number("recording", "least time of the walk; to one place only", zero=" for none")]
TimeOfWalk = Annotated[float, number("recording", "time until the robot stops; 0: it walks on", zero=" for none")]
Gait = Annotated[List[str], _GAIT]
GaitOfEachFoot = Annotated[
    List[str],
    _GAIT.but(
        help="parameters of the walk by NAOqi's names; those with Left and Right are for one foot",
        allowed=f"some of {', '.join(SETTABLE)}, each also with {' or '.join(FEET)} before it, {FREQUENCY}",
        choices=_OF_EACH_FOOT,
    ),
]
GaitValues = Annotated[
    List[float],
    free("values of the parameters in gait", "m, rad", "one for each of gait, within the ranges of the robot"),
]
StepLegs = Annotated[List[str], _STEPS.but(check=_require_turns)]
Steps = Annotated[
    List[float],
    free(
        "x, y, theta of each step, seen from the other foot",
        "m, rad",
        "for each step x {:g}..{:g} m, y {:g}..{:g} m to the own side, theta -{:g}..{:g} rad".format(
            *STEP_X, *STEP_Y, STEP_THETA, STEP_THETA
        ),
    ),
]
StepTimes = Annotated[List[float], moments("duration", "when each foot has landed, from the start")]
StepSpeed = Annotated[float, number("fraction", "fraction of the greatest speed", zero=" for 1")]
StepSpeeds = Annotated[
    List[float],
    numbers("fraction", "fractions of the greatest speed, one for all steps, or one for each; none: see speed"),
]
Replace = Annotated[bool, flag("whether the steps that are not begun yet are dropped")]
WalkLimits = Annotated[str, word(CONFIGS, "which values of the parameters", empty=DEFAULT)]
SecurityDistance = Annotated[
    List[float],
    single(number((0.0, FARTHEST_SEEN), "distance from obstacles", "m"), f"one distance, 0 to {FARTHEST_SEEN:g} m"),
]
SwingingArms = Annotated[
    List[str], _words(BOTH_ARMS, "arms; none: both", "arm", None, f"{', '.join(BOTH_ARMS)}, or nothing for both")
]

# Switches

Enable = Annotated[bool, flag("whether it is switched on")]
Chains = Annotated[List[str], _words(("Body", "Head", *BOTH_ARMS, *BOTH_LEGS), "chains")]
Arms = Annotated[List[str], _words(BOTH_ARMS, "arms")]
EachArm = Annotated[List[str], _words(ARMS, "arms")]
CollisionParts = Annotated[List[str], _words(("All", "Move", *BOTH_ARMS), "arms; Move: the walk; All: all of them")]
BreathKeys = Annotated[List[str], _words(BREATH_KEYS, "settings: breaths a minute, depth 0..1", nothing=None)]
Settings = Annotated[List[float], numbers("setting", "values of the settings in texts")]
MotionSwitch = Annotated[List[str], free("switches of the motion by NAOqi's names")]
SwitchValues = Annotated[List[float], numbers("setting", "0: off, else on; one for each switch in texts")]

# Whole body

Foot = Annotated[str, word(BOTH_LEGS, "leg of the foot, or both")]
FootState = Annotated[List[str], single(word(("Fixed", "Plane", "Free"), "state of the foot"))]
BalanceLeg = Annotated[str, word(BOTH_LEGS, "leg that the centre of mass is over, or both")]
BalanceTime = Annotated[float, number("duration", "time of the shift")]
BodyEffectors = Annotated[List[str], _words(WHOLE_BODY, "effectors")]
BodyEffector = Annotated[List[str], single(word(WHOLE_BODY, "effector"))]
EffectorGoal = Annotated[
    List[float],
    _POSES.but(
        help="rotation of the head; position or pose of an arm",
        allowed=GOAL_OF_EFFECTOR,
        check=_require_effector_goal,
    ),
]

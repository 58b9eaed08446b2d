"""What the fields of a MotionFunction mean to the functions of walks, of effectors in space, and of switches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import List

from ..base.errors import BadGoal
from ..base.field_checks import require_count, require_each, require_length, require_within
from ..base.limits import Limit, limit, usual
from ..base.suggestion import did_you_mean
from ..functions.fields import Annotated, Field, flag, free, moments, number, numbers, word
from .facts import ARMS, LEGS
from .fields import FRAME, NAMES, single
from .gait import (
    CONFIGS,
    DEFAULT,
    FEET,
    FREQUENCY,
    PLACE,
    SETTABLE,
    STEP_THETA,
    STEP_X,
    STEP_Y,
    TURN,
    WAY,
    places,
    require_way,
)

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

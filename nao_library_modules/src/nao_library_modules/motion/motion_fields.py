"""What the fields of a MotionFunction mean to the functions of motion; those of effectors and walks: `walk_fields`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any, List

from ..core.describe import JOINTS, POSTURES
from ..core.errors import BadGoal, did_you_mean
from ..core.fields import Annotated, Field, flag, free, moments, number, numbers, whole
from ..core.nao_facts import load_head
from .motion_plan import DEFAULT_SPEED

FRAMES = ("FRAME_TORSO", "FRAME_WORLD", "FRAME_ROBOT")
"""Frames by their numbers."""
POSTURE_SPEED = 0.6
"""Fraction of the top speed on the way to a posture where a message leaves it to us."""
RATE = 25.0
"""Samples a second where a message leaves it to us."""
CAMERA = "CameraTop"
"""The one that looks where a message names none."""
MOST_TRIES = 20
MOST_TASKS = 2**31 - 1
# No separators and no dot in front: a name stays in the folder.
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_. -]*")
NAME_ALLOWED = "letters, digits, '_', '-', '.' and blanks, the first a letter, a digit or '_'"


def require_name(field: str, name: str) -> None:
    """See that a motion can have a name; `field` of the message has it. Raises BadGoal if it cannot."""
    if not NAME.fullmatch(name):
        raise BadGoal(field, name, NAME_ALLOWED, problem=f"{name!r} is no name for a motion")


def each(field: Field, meaning: str) -> Field:
    """A list of what one field holds."""
    return field.but(help=meaning, check=lambda name, values: [field.require(name, value) for value in values])


def single(field: Field, allowed: str = "") -> Field:
    """A list with one of what a field holds; `allowed`: in words, where not those of the field."""
    allowed = allowed or field.allowed

    def check(name: str, values: Sequence[Any]) -> None:
        if len(values) != 1:
            raise BadGoal(name, list(values), allowed)
        field.require(name, values[0])

    return field.but(allowed=allowed, check=check)


def _require_joints(name: str, names: Sequence[str]) -> None:
    if not names:
        raise BadGoal(name, [], "joints or chains", problem="no joint is named")


def _require_stiffnesses(name: str, values: Sequence[float]) -> None:
    for value in values:
        if not 0.0 <= value <= 1.0:  # also for NaN
            raise BadGoal(name, value, _STIFFNESSES.allowed, problem=f"{value:g} is no stiffness")


def _require_velocities(name: str, trajectory: Any) -> None:
    if any(not point.velocities for point in trajectory.points):
        raise BadGoal(f"{name}.points", "no velocities", "velocities in every point; setTrajectory needs none")


def _require_pose(name: str, trajectory: Any) -> None:
    if len(trajectory.points) > 1:
        raise BadGoal(f"{name}.points", len(trajectory.points), "one point; setTrajectory takes more")
    for what in ("velocities", "accelerations"):
        given = list(getattr(trajectory.points[0], what)) if trajectory.points else []
        if any(given):
            allowed = "none, or zeros, for joints rest in a pose; setTrajectory moves with them"
            raise BadGoal(f"{name}.points[0].{what}", given, allowed)


def _require_tries(name: str, values: Sequence[float]) -> None:
    if len(values) != 1 or not 1 <= values[0] <= MOST_TRIES or values[0] != int(values[0]):
        raise BadGoal(name, list(values), f"one whole number from 1 to {MOST_TRIES}")


def _require_point(name: str, values: Sequence[float]) -> None:
    if len(values) != 3:
        raise BadGoal(name, list(values), "x, y, z of a point in m")
    _POINT.require(name, values)


def _require_camera(name: str, camera: str) -> None:
    if camera and camera not in CAMERAS:
        problem = f"there is no camera {camera!r}{did_you_mean(camera, CAMERAS)}"
        raise BadGoal(name, camera, f"{', '.join(CAMERAS)}, or nothing for {CAMERA}", problem=problem)


NAMES = free(
    "joints and chains: HeadYaw, LArm, Body",
    allowed="joints and chains of the robot, at least one, every joint once",
    asked=JOINTS,
    check=_require_joints,
)
_SOME_NAMES = NAMES.but(help="joints and chains; none: the whole body", allowed="", check=None)
SPEED = number("fraction", "fraction of the greatest speed", zero=f" for {DEFAULT_SPEED:g}")
FRAME = number(
    (0, len(FRAMES) - 1),
    "frame that the numbers are in",
    allowed=", ".join(f"{i} ({name})" for i, name in enumerate(FRAMES)),
)
# The limits of each joint, which the plan knows, are narrower and told with a hint where degrees were meant.
_ANGLES = numbers("angle", "angles (hands: 0..1), one for all joints, or one for each").but(
    allowed="within the limits of the joint", check=None
)
_STIFFNESSES = numbers(
    "share",
    "stiffnesses, one for all joints, or one for each",
    allowed="stiffnesses from 0 (limp) to 1",
).but(check=_require_stiffnesses)
_POINT = numbers("point", "x, y, z of a point")
CAMERAS = tuple(load_head().cameras)
_MOTION = free("name of a recorded motion", allowed="a recorded motion", check=require_name)
_TRAJECTORY = free(
    "key frames: positions and, for curves through them, velocities",
    allowed="joint_names, or names; at least one point; times that rise; velocities in every point or in none",
)

# Joints and how they move

Joints = Annotated[List[str], NAMES]
SomeJoints = Annotated[List[str], _SOME_NAMES]
Hands = Annotated[List[str], NAMES.but(help="hands", allowed="LHand, RHand", asked=(), choices=("LHand", "RHand"))]
Angles = Annotated[List[float], _ANGLES]
Changes = Annotated[List[float], _ANGLES.but(help="differences of angles, one for all joints, or one for each")]
KeyAngles = Annotated[
    List[float],
    _ANGLES.but(help="angles (hands: 0..1) at the times: for all joints, or those of the first joint, the second, ..."),
]
Times = Annotated[List[float], moments("duration", "when each key frame is reached, from the start", shared=True)]
Stiffness = Annotated[
    float,
    number(
        "share",
        "stiffness that limp joints get before they move; 0: limp joints are an error",
        allowed="0 (leave as it is) to 1",
    ),
]
HandStiffness = Annotated[float, free("of no effect: the robot makes a hand stiff itself")]
Speed = Annotated[float, SPEED]
Speeds = Annotated[List[float], each(SPEED, "fractions of the greatest speed, one for each joint; none: see speed")]
Duration = Annotated[float, number("duration", "time that the motion takes; 0: see speed", zero="")]
Relative = Annotated[bool, flag("whether the values are added to where the joints, or the effectors, are")]
Commanded = Annotated[bool, flag("whether what the joints are told is answered, not what they measure")]
Frame = Annotated[int, FRAME]

# Trajectories and poses

Trajectory = Annotated[Any, _TRAJECTORY]
SmoothTrajectory = Annotated[
    Any,
    _TRAJECTORY.but(
        help="key frames: positions and velocities", allowed="velocities in every point", check=_require_velocities
    ),
]
PosePoint = Annotated[
    Any, free("pose as a point", allowed="one point without velocities, or none", check=_require_pose)
]
TrajectoryJoints = Annotated[
    List[str],
    _SOME_NAMES.but(
        help="joints and chains where the trajectory names none",
        allowed="nothing, or the joint_names of the trajectory",
    ),
]
PoseJoints = Annotated[List[str], _SOME_NAMES.but(help="joints and chains; none: all that the pose names")]
Pose = Annotated[
    str, free("name of a pose; file.xap:name where several pose libraries know it; empty: angles or trajectory have it")
]

# Stiffnesses and postures

Stiffnesses = Annotated[List[float], _STIFFNESSES]
KeyStiffnesses = Annotated[List[float], _STIFFNESSES.but(help="stiffnesses, one for each of the times")]
Posture = Annotated[str, free("name of a posture", allowed="a posture of the robot", asked=POSTURES)]
PostureSpeed = Annotated[float, number("fraction", SPEED.help, zero=f" for {POSTURE_SPEED:g}")]
Tries = Annotated[
    List[float],
    numbers((1, MOST_TRIES), "how often to try", allowed=f"one whole number from 1 to {MOST_TRIES}").but(
        check=_require_tries
    ),
]

# Gaze

Point = Annotated[List[float], _POINT.but(allowed="x, y, z of a point in m", check=_require_point)]
Camera = Annotated[
    str,
    free(
        "camera that looks",
        allowed=f"{', '.join(CAMERAS)}, or nothing for {CAMERA}",
        choices=CAMERAS,
        check=_require_camera,
    ),
]

# Recorded motions

Motion = Annotated[str, _MOTION]
NewMotion = Annotated[str, _MOTION.but(help="name of the new motion", allowed=NAME_ALLOWED)]
NewName = Annotated[List[str], single(_MOTION.but(help="new name"), "the new name, and nothing else")]
RecordingTime = Annotated[float, number("recording", "length of the recording")]
SampleRate = Annotated[float, number("sampling rate", "rate of the samples", zero=f" for {RATE:g}")]
ReplaySpeed = Annotated[
    float, number("factor", "factor on the speed of the recording", zero=" for the speed of the recording")
]
Mirror = Annotated[bool, flag("whether left and right are exchanged")]
Limp = Annotated[bool, flag("whether the joints can be moved by hand meanwhile")]
Overwrite = Annotated[bool, flag("whether a motion of that name may be replaced")]

# Tasks

Task = Annotated[List[float], single(whole(0, MOST_TASKS, "number of a task"), "the number of one task")]

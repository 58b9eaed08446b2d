"""Function messages written as calls: newMotionFunction("getAngles", ["RArm"]), newLedFunction("off", ["Brain0"]).

Each value goes to the next field of its kind in the order of the message: a text to `str_param`, a list of texts to
`lights` or `names`, a list of numbers to the first list of numbers, a duration to `time`, a trajectory, one point or a
list of points to `trajectory`. What has no value has its default; fields may also be named, as in the messages
themselves, and `on_error` has to be.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, Type, TypeVar

import genpy
from trajectory_msgs.msg import JointTrajectory
from trajectory_msgs.msg import JointTrajectoryPoint as _JointTrajectoryPoint

from nao_library_msgs.msg import (
    AudioInFunction,
    AudioOutFunction,
    BehaviorFunction,
    LedFunction,
    MotionFunction,
    TactileFunction,
    VisionFunction,
)

Message = TypeVar("Message")

TRAJECTORY = "trajectory_msgs/JointTrajectory"
FITS: dict[str, Callable[[Any], bool]] = {
    "bool": lambda value: isinstance(value, bool),
    "string": lambda value: isinstance(value, str),
    "duration": lambda value: isinstance(value, genpy.Duration),
    "int32": lambda value: isinstance(value, int) and not isinstance(value, bool),
    "float64": lambda value: isinstance(value, Real) and not isinstance(value, bool),
    TRAJECTORY: lambda value: isinstance(_as_field(TRAJECTORY, value), JointTrajectory),
}
"""Type of a field -> whether a value is one for it; of a list each member has to be."""


def new_function(kind: type, function: str, *values: Any, **fields: Any) -> Any:
    """A function message.

    `values`: each for the next field of its kind. Raises TypeError if there is no such field, or none is left for a
    value.
    """
    message = kind(function=function)
    types = dict(zip(message.__slots__, message._slot_types))
    for name, value in fields.items():
        if name not in types:
            raise TypeError(f"{kind.__name__} has no field {name!r}, it has {', '.join(types)}")
        setattr(message, name, _as_field(types[name], value))
    taken = ("function", "on_error", *fields)
    left = [pair for pair in types.items() if pair[0] not in taken]
    for value in values:
        place = next((place for place, (_, type_) in enumerate(left) if _fits(type_, value)), None)
        if place is None:
            raise TypeError(
                f"{kind.__name__} has no field left for {value!r}, after {function!r} and the values before"
            )
        name, type_ = left[place]
        setattr(message, name, _as_field(type_, value))
        del left[: place + 1]
    return message


def _fits(type_: str, value: Any) -> bool:
    if type_.endswith("[]"):
        return isinstance(value, (list, tuple)) and all(FITS[type_[:-2]](member) for member in value)
    return FITS[type_](value)


def _as_field(type_: str, value: Any) -> Any:
    """A value as its field holds it: points alone are a trajectory whose joints the field `names` has."""
    points = [value] if isinstance(value, _JointTrajectoryPoint) else value
    if type_ != TRAJECTORY or not isinstance(points, (list, tuple)) or not points:
        return value
    return JointTrajectory(points=points) if all(isinstance(each, _JointTrajectoryPoint) for each in points) else value


def _maker(kind: Type[Message], server: str, example: str) -> Callable[..., Message]:
    """`new_function` for one kind of message, under the name that the paper gives it."""
    name = f"new{kind.__name__}"

    def make(function: str, *values: Any, **fields: Any) -> Message:
        return new_function(kind, function, *values, **fields)

    make.__name__ = make.__qualname__ = name
    make.__doc__ = f"A function of {server}, as in `{name}({example})`."
    return make


newLedFunction = _maker(LedFunction, "NaoLights", '"setIntensity", ["Brain0"], [0.5]')  # noqa: N816
newMotionFunction = _maker(MotionFunction, "NaoMotion", '"setAngles", ["HeadYaw"], [0.5]')  # noqa: N816
newAudioOutFunction = _maker(AudioOutFunction, "nao_audio_out", '"say", "Hello"')  # noqa: N816
newAudioInFunction = _maker(AudioInFunction, "nao_audio_in", '"listen", ["yes", "no"]')  # noqa: N816
newVisionFunction = _maker(VisionFunction, "NaoVision", '"takePicture", "desk.png"')  # noqa: N816
newTactileFunction = _maker(TactileFunction, "NaoTactile", '"waitForTouch", ["head"], timeout=30.0')  # noqa: N816
newBehaviorFunction = _maker(BehaviorFunction, "NaoBehavior", '"runBehavior", "greet", ["name=Ada"]')  # noqa: N816


def JointTrajectoryPoint(  # noqa: N802
    time_from_start: Any,
    positions: Sequence[float],
    velocities: Sequence[float] = (),
    accelerations: Sequence[float] = (),
) -> _JointTrajectoryPoint:
    """A point of a trajectory.

    Args:
        time_from_start: ROS duration, or s.
        positions: rad, hands 0 to 1; one a joint.
        velocities: rad/s likewise, or none.
        accelerations: rad/s2 likewise, or none.
    """
    if isinstance(time_from_start, Real):
        time_from_start = genpy.Duration.from_sec(time_from_start)
    return _JointTrajectoryPoint(
        time_from_start=time_from_start,
        positions=list(positions),
        velocities=list(velocities),
        accelerations=list(accelerations),
    )

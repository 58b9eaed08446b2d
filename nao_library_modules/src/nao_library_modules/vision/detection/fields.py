"""Fields of a VisionFunction for functions that detect and follow something."""

from __future__ import annotations

from ...base.errors import BadGoal
from ...base.field_checks import require_text
from ...base.limits import limit
from ...base.suggestion import did_you_mean
from ...functions.fields import Annotated, flag, free, number
from ..capture.cameras import CAMERAS, camera_name
from ..capture.fields import DEFAULT_TIMEOUT
from .events import BALL, CODE, FACE, LANDMARK
from .space import DEFAULT_SIZES

LONGEST_NAME = 100
LOOKED_FOR = (BALL, FACE, LANDMARK, CODE)
"""What lookFor looks for."""
MARK = "the number of a landmark, or nothing for all"
THING = f"{', '.join(LOOKED_FOR)}; a name, a number or a text may follow: {FACE} NAME"
WAIT = f"up to {limit('timeout').highest:g} s, or 0"
SEARCH_TIMEOUT = 20.0
"""Default of lookFor, s: a search of the whole range takes about 15."""


def camera_index(camera: str) -> int | None:
    """Index of a camera that a message names; None for the active one."""
    return CAMERAS[camera_name(camera, "top")] if camera.strip() else None


def timeout_of(timeout: float) -> float:
    return timeout or DEFAULT_TIMEOUT


def require_mark(number: str) -> str:
    """The number of a landmark, without blanks and leading zeros; empty for any."""
    bare = number.strip()
    if bare and not (bare.isascii() and bare.isdigit() and len(bare) < 10):
        raise BadGoal("str_param", number, MARK)
    return str(int(bare)) if bare else ""


def require_name(name: str) -> str:
    """The name of a person, without blanks around it."""
    bare = require_text("str_param", name, "the name of a person")
    if len(bare) > LONGEST_NAME:
        problem = f"{bare[:20]!r}... is too long"
        raise BadGoal("str_param", name, f"up to {LONGEST_NAME} characters", problem=problem)
    if not bare.isprintable():
        raise BadGoal("str_param", name, "a name of characters that can be printed")
    return bare


def wanted_thing(text: str) -> tuple[str, str]:
    """Kind and name (or nothing) of what lookFor looks for."""
    kind, _, name = text.strip().partition(" ")
    name = name.strip()
    if kind not in LOOKED_FOR:
        problem = f"{kind!r} is nothing to look for{did_you_mean(kind, LOOKED_FOR)}"
        raise BadGoal("str_param", text, THING, problem=problem)
    if kind == BALL and name:
        raise BadGoal("str_param", text, BALL, problem="balls have no names")
    return kind, require_mark(name) if kind == LANDMARK else name


_TIMEOUT = number("timeout", f"longest look, in ROS time; 0: {DEFAULT_TIMEOUT:g}", allowed=f"{WAIT} for the default")
_CONFIDENCE = number("share", "least confidence; what is seen with less does not count")
_SIZE = number("size", "", allowed=f"up to {limit('size').highest:g} m, or 0 for the default")

Person = Annotated[
    str,
    free(
        "name of the person",
        allowed=f"the name of a person, up to {LONGEST_NAME} characters that can be printed",
        check=lambda _, text: require_name(text),
    ),
]
AnyPerson = Annotated[str, free("name of the only person who counts; empty: anybody")]
AnyCode = Annotated[str, free("text of the only code that counts; empty: any")]
AnyMark = Annotated[
    str,
    free("number of the only landmark that counts; empty: any", allowed=MARK, check=lambda _, text: require_mark(text)),
]
Thing = Annotated[
    str,
    free(
        "what is looked for, and behind it the only one that counts: a name, number or text",
        allowed=THING,
        choices=LOOKED_FOR,
        check=lambda _, text: wanted_thing(text),
    ),
]
DetectionTimeout = Annotated[float, _TIMEOUT]
Patience = Annotated[
    float, _TIMEOUT.but(help=f"time out of view after which it ends, in ROS time; 0: {DEFAULT_TIMEOUT:g}")
]
SearchTimeout = Annotated[float, _TIMEOUT.but(help=f"longest search, in ROS time; 0: {SEARCH_TIMEOUT:g}")]
Confidence = Annotated[float, _CONFIDENCE]
NameConfidence = Annotated[
    float, _CONFIDENCE.but(help="least confidence in the name of a face; with less it counts as unknown")
]
ThingConfidence = Annotated[
    float, _CONFIDENCE.but(help="least confidence, of faces in their names; what is seen with less does not count")
]
Looks = Annotated[
    int,
    number(
        "looks",
        "number of pictures in which something is seen before it ends; 0: 1",
        allowed=f"up to {limit('looks').highest} looks, or 0 for one",
    ),
]
BallSize = Annotated[float, _SIZE.but(help=f"radius of the ball; 0: {DEFAULT_SIZES[BALL]:g}")]
MarkSize = Annotated[float, _SIZE.but(help=f"diameter of the landmark; 0: {DEFAULT_SIZES[LANDMARK]:g}")]
HeadSize = Annotated[float, _SIZE.but(help=f"width of the head; 0: {DEFAULT_SIZES[FACE]:g}")]
CodeSize = Annotated[float, _SIZE.but(help="width of the code without its margin; 0: not known")]
ThingSize = Annotated[
    float,
    _SIZE.but(help="radius of a ball, diameter of a landmark, width of a head or code; 0: as detections have it"),
]
Sensitivity = Annotated[float, number("share", "sensitivity to changes of colour; 0: as the robot has it")]
Duration = Annotated[
    float, number("timeout", "how long it follows, in ROS time", allowed=f"{WAIT}: until the goal is preempted")
]
Search = Annotated[bool, flag("whether the head turns to look for what is out of view")]
Speed = Annotated[
    float,
    number(
        "fraction",
        "greatest fraction of the head's top speed",
        zero=" for a moderate one",
        allowed="0..1 of the top speed, or 0 for a moderate one",
    ),
]
HeadRevert = Annotated[bool, flag("whether the head goes back to where it was after `time`")]

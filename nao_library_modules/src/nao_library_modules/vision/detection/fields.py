"""What the fields of a VisionFunction mean to the functions that see things, and to those whose eyes follow them."""

from __future__ import annotations

from ...base.limits import limit
from ...functions.fields import Annotated, flag, free, number
from ..capture.fields import DEFAULT_TIMEOUT
from .events import BALL, FACE, LANDMARK
from .goals import LONGEST_NAME, LOOKED_FOR, MARK, THING, require_mark, require_name, wanted_thing
from .space import DEFAULT_SIZES

WAIT = f"up to {limit('timeout').highest:g} s, or 0"
SEARCH_TIMEOUT = 20.0
"""s that lookFor looks, where a message leaves it to us: the whole way round takes about 15."""

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
Timeout = Annotated[float, _TIMEOUT]
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
        "share",
        "greatest fraction of the head's top speed",
        allowed="0..1 of the top speed, or 0 for a moderate one",
    ),
]
Revert = Annotated[bool, flag("whether the head goes back to where it was after `time`")]

"""What the fields of a VisionFunction mean to functions that capture, set the cameras, detect and follow."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import List

from ..core.errors import BadGoal, did_you_mean
from ..core.fields import CONTROL, Annotated, Field, flag, free, limit, number, require_number, require_text
from ..core.nao_facts import RESOLUTIONS
from .cameras import (
    ANY_CAMERA,
    CAMERAS,
    FRAME_RATES,
    KNOWN_PARAMETERS,
    KNOWN_RESOLUTIONS,
    ONE_CAMERA,
    PARAMETERS,
    camera_name,
    parameter_number,
    resolution_name,
)
from .detections import BALL, CODE, DEFAULT_SIZES, FACE, LANDMARK
from .pictures import DEFAULT_QUALITY, PICTURE_TYPES
from .video import CODECS, SHORT, VIDEO_TYPES, known_type, require_short

PIXELS, PICTURES, TIMEOUT = limit("pixels"), limit("pictures"), limit("timeout")
DEFAULT_TIMEOUT = 10.0
"""s to wait for a frame, or for a detection, where a message has none."""
LONGEST_ID = 64
LARGEST_VALUE = 1 << 31
TOPIC = re.compile(r"[~/]?[A-Za-z]\w*(/\w+)*")
TOPICS = "letters, digits and underscores, with slashes in between; empty: the default"
IDS = f"a name of up to {LONGEST_ID} characters, without slashes"
WHOLE = "one whole number"


def _require_id(name: str, ident: str) -> None:
    """Check that a name can be part of names of files and topics."""
    bare = require_text(name, ident, IDS)
    if len(bare) > LONGEST_ID or "/" in bare or CONTROL.search(bare) or bare.startswith((".", "~")):
        raise BadGoal(name, ident, IDS)


def _require_topic(name: str, topic: str) -> None:
    if topic.strip() and not TOPIC.fullmatch(topic.strip()):
        raise BadGoal(name, topic, TOPICS)


def _require_named_camera(name: str, camera: str) -> None:
    require_text(name, camera, ONE_CAMERA)
    camera_name(camera, "")


def _require_value(name: str, values: Sequence[float]) -> None:
    if len(values) != 1 or not math.isfinite(values[0]) or values[0] != int(values[0]):
        raise BadGoal(name, list(values), WHOLE)
    require_number(name, values[0], -LARGEST_VALUE, LARGEST_VALUE - 1)


def _file(known: Sequence[str], behind: str = "") -> Field:
    def check(name: str, path: str) -> None:
        known_type(name, Path(path.strip()).suffix, known)
        require_short(name, path)

    ends = ", ".join(f".{kind}" for kind in known)
    return free(
        f"file in the server's folder{behind}; empty: named by the time",
        allowed=f"a relative name, or an absolute one inside the folder, with {ends} at its end or none; {SHORT}",
        check=check,
    )


def _file_type(known: Sequence[str]) -> Field:
    return free(
        f"type of the file; empty: as its name ends, else {known[0]}",
        allowed=f"one of {', '.join(known)}",
        choices=known,
        check=lambda name, text: known_type(name, text, known),
    )


def _codecs(file_type: str) -> str:
    return f"{file_type}: {', '.join(name for name, codec in CODECS.items() if file_type in codec.file_types)}"


_ID = free("name of a stream or recording", allowed=IDS, check=_require_id)
_TOPIC = free("topic of frames, instead of a camera of the robot", allowed=TOPICS, check=_require_topic)
_CAMERA = free(
    "camera of the robot",
    allowed=ANY_CAMERA,
    choices=tuple(CAMERAS),
    check=lambda _, text: camera_name(text, ""),
)
_SIDE = number("pixels", "", allowed=f"1..{PIXELS.highest} pixels, or 0")

NewStream = Annotated[str, _ID.but(help="name of your choice for the stream")]
NewRecording = Annotated[str, _ID.but(help="name of your choice for the recording")]
StreamId = Annotated[str, _ID.but(help="name of a stream")]
RecordingId = Annotated[str, _ID.but(help="name of a recording")]
ThreadId = Annotated[str, _ID]
SomeThread = Annotated[
    str,
    _ID.but(
        help="name of a stream or recording; empty: all",
        check=lambda name, ident: _require_id(name, ident) if ident.strip() else None,
    ),
]
Camera = Annotated[str, _CAMERA]
NamedCamera = Annotated[str, _CAMERA.but(allowed=ONE_CAMERA, check=_require_named_camera)]
Topic = Annotated[str, _TOPIC]
TopicOut = Annotated[
    str,
    _TOPIC.but(help="topic of the stream, with /compressed at its end as JPEG; empty: NaoVision/ID/image_raw"),
]
Rate = Annotated[float, number("frame rate", "greatest rate of frames", zero=": all")]
Width = Annotated[int, _SIDE.but(help="width; 0: in proportion to the height, or as the camera has it")]
Height = Annotated[int, _SIDE.but(help="height; 0: in proportion to the width, or as the camera has it")]
VideoName = Annotated[str, _file(VIDEO_TYPES)]
VideoType = Annotated[str, _file_type(VIDEO_TYPES)]
VideoCodec = Annotated[
    str,
    free(
        "codec of the video; empty: for mp4 h264 where there is one, else mpeg4; for avi mjpeg",
        allowed=f"{'; '.join(map(_codecs, VIDEO_TYPES))}; those that this computer has",
        choices=tuple(CODECS),
    ),
]
PictureName = Annotated[str, _file(PICTURE_TYPES)]
PictureNames = Annotated[str, _file(PICTURE_TYPES, ", of several with -001, -002, ... behind its name")]
PictureType = Annotated[str, _file_type(PICTURE_TYPES)]
Quality = Annotated[
    int,
    number((0, 100), f"quality of jpg and webp; 0: {DEFAULT_QUALITY}", allowed="1..100, or 0 for the default"),
]
Overwrite = Annotated[bool, flag("whether a file that is there may be replaced; else it is an error")]
Timeout = Annotated[
    float,
    number(
        "timeout",
        "longest wait for a frame, in ROS time",
        allowed=f"up to {TIMEOUT.highest:g} s, or 0: {DEFAULT_TIMEOUT:g} s",
    ),
]
Count = Annotated[int, number("pictures", "number of pictures; 0: 1", allowed=f"1..{PICTURES.highest}, or 0: 1")]
Interval = Annotated[float, number("timeout", "from one picture to the next, in ROS time; 0: as they come")]

Parameter = Annotated[
    str,
    free(
        "parameter of the camera: brightness, kCameraBrightnessID, 0",
        allowed=KNOWN_PARAMETERS,
        choices=tuple(PARAMETERS),
        check=lambda _, text: parameter_number(text),
    ),
]
Value = Annotated[
    List[float],
    free(
        "value of the parameter; getParameterRange tells its range",
        allowed=WHOLE,
        minimum=-LARGEST_VALUE,
        maximum=LARGEST_VALUE - 1,
        check=_require_value,
    ),
]
AutoExposure = Annotated[bool, flag("whether the camera chooses exposure and gain by itself")]
AutoWhiteBalance = Annotated[bool, flag("whether the camera chooses the white balance by itself")]
Resolution = Annotated[
    str,
    free(
        "resolution by its name, its size or NAOqi's number",
        allowed=KNOWN_RESOLUTIONS,
        choices=tuple(RESOLUTIONS),
        check=lambda _, text: resolution_name(text),
    ),
]
FrameRate = Annotated[
    float,
    number(
        FRAME_RATES,
        "rate at which frames are read from the camera",
        "Hz",
        allowed=f"{FRAME_RATES[0]}..{FRAME_RATES[1]} frames a second",
    ),
]
Revert = Annotated[bool, flag("whether the former setting comes back after `time`")]


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

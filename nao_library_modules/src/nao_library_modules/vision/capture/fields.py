"""Fields of a VisionFunction for streams, recordings, pictures and the settings of the cameras."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import List

from ...base.errors import BadGoal
from ...base.field_checks import CONTROL, require_number, require_text
from ...base.limits import limit
from ...functions.fields import Annotated, Field, flag, free, number
from ...nao.camera_facts import RESOLUTIONS
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
from .files import SHORT, known_type, require_short
from .pictures import DEFAULT_QUALITY, PICTURE_TYPES
from .video import CODECS, VIDEO_TYPES

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

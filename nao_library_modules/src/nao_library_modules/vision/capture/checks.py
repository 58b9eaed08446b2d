"""Checks of streams, recordings and pictures, made before a chain begins. Parameters are fields of VisionFunction.

`context["threads"]` is what the chain will have made of the streams and recordings: name -> kind and whether it runs.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, Protocol, Tuple

from ...base.errors import BadGoal
from ...base.field_checks import CONTROL, require_known, require_number, require_text, require_within, require_zero_or
from ...base.limits import limit
from .cameras import camera_name
from .files import VisionFiles
from .jobs import MOST_THREADS, VisionThreads, taken, too_many, unknown
from .pictures import PICTURE_TYPES
from .video import CODECS, VIDEO_TYPES, codec_name, known_codecs

TIMEOUT, FRAMES, PIXELS, PICTURES = limit("timeout"), limit("frame rate"), limit("pixels"), limit("pictures")
LONGEST_WAIT = TIMEOUT.highest
"""s of ROS time that any wait may take."""
DEFAULT_TIMEOUT = 10.0
"""s to wait for a frame, or for something to be seen, where a message leaves it to us."""
LONGEST_ID = 64
TOPIC = re.compile(r"[~/]?[A-Za-z]\w*(/\w+)*")

Plan = Dict[str, Tuple[str, bool]]


class HasThreads(Protocol):
    """The module, as far as the checks need it."""

    threads: VisionThreads
    files: VisionFiles
    topics: Any
    active_camera: str

    def source(self, camera: str, topic: str) -> str:
        """Topic that frames come from."""
        ...


# Fields


def require_id(ident: str) -> str:
    """A name for a stream or recording: it becomes part of names of files and topics."""
    allowed = f"a name of up to {LONGEST_ID} characters, without slashes"
    bare = require_text("id", ident, allowed)
    if len(bare) > LONGEST_ID or "/" in bare or CONTROL.search(bare) or bare.startswith((".", "~")):
        raise BadGoal("id", ident, allowed)
    return bare


def require_topic(field: str, topic: str) -> None:
    """A name that a topic can have; empty is one as well."""
    if topic.strip() and not TOPIC.fullmatch(topic.strip()):
        raise BadGoal(field, topic, "letters, digits and underscores, with slashes in between; empty: the default")


def require_size(width: int, height: int) -> None:
    """A size in pixels."""
    for field, value in (("width", width), ("height", height)):
        require_within(field, value, PIXELS, f"1..{PIXELS[1]} pixels, or 0")


def require_timeout(timeout: float) -> None:
    """How long to wait, s; 0 for the default."""
    require_within("timeout", timeout, TIMEOUT, f"up to {LONGEST_WAIT:g} s, or 0: {DEFAULT_TIMEOUT:g} s")


def require_source(self: HasThreads, camera: str, topic: str) -> None:
    """Where frames come from."""
    camera_name(camera, self.active_camera)
    require_topic("topic", topic)


def require_codec(codec: str, file_type: str) -> str:
    """A codec that this computer has, and that the type of file can hold."""
    name = codec_name(codec, file_type)
    here = known_codecs(file_type)
    if name in CODECS and name not in here:
        problem = f"{file_type} files cannot have {name} here"
        raise BadGoal("codec", codec, f"one of {', '.join(here)}", problem=problem)
    return require_known("codec", name, here, "codec")


def topic_out_of(ident: str, topic_out: str) -> str:
    """Topic of a stream: as named, or after its id."""
    return topic_out.strip() or f"NaoVision/{re.sub(r'[^A-Za-z0-9_]', '_', ident.strip())}/image_raw"


# What a chain will have made of the streams and recordings


def plan_of(self: HasThreads, context: dict[str, Any]) -> Plan:
    """Streams and recordings as they will be at this place of a chain."""
    if "threads" not in context:
        context["threads"] = {ident: (thread.kind, thread.runs) for ident, thread in self.threads.known.items()}
    return context["threads"]


def _plan_new(self: HasThreads, ident: str, kind: str, runs: bool, context: dict[str, Any]) -> None:
    plan = plan_of(self, context)
    name = require_id(ident)
    if plan.get(name, ("", False))[1]:
        raise taken(name)
    if name not in plan and len(plan) >= MOST_THREADS:
        raise too_many(name)
    plan[name] = (kind, runs)


def _plan_file(self: HasThreads, path: Path, overwrite: bool, context: dict[str, Any]) -> None:
    files = context.setdefault("files", set())
    self.files.require_free(path, overwrite)
    if path in files and not overwrite:
        problem = f"an earlier function writes {path}"
        raise BadGoal("str_param", path.name, "another name, or overwrite", problem=problem)
    files.add(path)


def require_thread(self: HasThreads, ident: str, context: dict[str, Any], kind: str = "") -> str:
    """The name of a stream or recording that there will be, without blanks around it."""
    plan = plan_of(self, context)
    name = require_id(ident)
    if name not in plan:
        raise unknown(name, plan)
    if kind and plan[name][0] != kind:
        names = [other for other, (own, _) in plan.items() if own == kind]
        allowed = f"one of {', '.join(names)}" if names else f"there is no {kind}"
        raise BadGoal("id", ident, allowed, problem=f"{name!r} is a {plan[name][0]}")
    return name


# Functions


def check_new_stream(
    self: HasThreads, id: str, camera: str, topic: str, topic_out: str, rate: float, width: int, height: int,
    context: dict[str, Any], runs: bool = False,
) -> None:  # fmt: skip
    """A name, where frames come from and go to, a rate and a size."""
    require_source(self, camera, topic)
    require_topic("topic_out", topic_out)
    require_zero_or("rate", rate, FRAMES, ": all")
    require_size(width, height)
    _plan_new(self, id, "stream", runs, context)
    target = self.topics.resolved(topic_out_of(id, topic_out))
    if target == self.source(camera, topic):
        raise BadGoal("topic_out", topic_out, "another topic", problem="frames come from there")
    streams = [thread for thread in self.threads.known.values() if thread.kind == "stream"]
    for thread in streams:
        if thread.ident != id.strip() and self.topics.resolved(thread.topic_out) == target:
            raise BadGoal("topic_out", topic_out, "another topic", problem=f"{thread.ident!r} publishes {target}")


def check_subscribe(
    self: HasThreads, id: str, camera: str, topic: str, topic_out: str, rate: float, width: int, height: int,
    context: dict[str, Any],
) -> None:  # fmt: skip
    """As createStream; it runs then."""
    check_new_stream(self, id, camera, topic, topic_out, rate, width, height, context, runs=True)


def check_new_recording(
    self: HasThreads, id: str, str_param: str, camera: str, topic: str, rate: float, width: int, height: int,
    file_type: str, codec: str, overwrite: bool, context: dict[str, Any], runs: bool = False,
) -> None:  # fmt: skip
    """A name, where frames come from, a file that may be written, a codec, a rate and a size."""
    require_source(self, camera, topic)
    kind = self.files.file_type(str_param, file_type, VIDEO_TYPES)
    require_codec(codec, kind)
    require_zero_or("rate", rate, FRAMES, ": all")
    require_size(width, height)
    _plan_new(self, id, "recording", runs, context)
    if str_param.strip():
        _plan_file(self, self.files.path(str_param, kind), overwrite, context)


def check_start_recording(
    self: HasThreads, id: str, str_param: str, camera: str, topic: str, rate: float, width: int, height: int,
    file_type: str, codec: str, overwrite: bool, context: dict[str, Any],
) -> None:  # fmt: skip
    """As createRecording; it runs then."""
    check_new_recording(
        self, id, str_param, camera, topic, rate, width, height, file_type, codec, overwrite, context, runs=True
    )


def check_start(self: HasThreads, id: str, context: dict[str, Any]) -> None:
    """A stream or recording that does not run."""
    name = require_thread(self, id, context)
    plan = plan_of(self, context)
    if plan[name][1]:
        raise taken(name)
    plan[name] = (plan[name][0], True)


def check_stop(self: HasThreads, id: str, context: dict[str, Any], kind: str = "") -> None:
    """A stream or recording."""
    name = require_thread(self, id, context, kind)
    plan = plan_of(self, context)
    plan[name] = (plan[name][0], False)


def check_unsubscribe(self: HasThreads, id: str, context: dict[str, Any]) -> None:
    """A stream."""
    check_stop(self, id, context, "stream")


def check_stop_recording(self: HasThreads, id: str, context: dict[str, Any]) -> None:
    """A recording."""
    check_stop(self, id, context, "recording")


def check_delete(self: HasThreads, id: str, context: dict[str, Any]) -> None:
    """A stream or recording; later functions of the chain do not have it any more."""
    del plan_of(self, context)[require_thread(self, id, context)]


def check_list(self: HasThreads, id: str, context: dict[str, Any]) -> None:
    """A stream or recording, if one is named."""
    if id.strip():
        require_thread(self, id, context)


def check_picture(
    self: HasThreads, str_param: str, camera: str, topic: str, file_type: str, quality: int, width: int, height: int,
    timeout: float, overwrite: bool, context: dict[str, Any],
) -> None:  # fmt: skip
    """A file that may be written, where the frame comes from, a size and a timeout."""
    _check_shot(self, camera, topic, quality, width, height, timeout)
    kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
    if str_param.strip():
        _plan_file(self, self.files.path(str_param, kind), overwrite, context)


def check_pictures(
    self: HasThreads, str_param: str, camera: str, topic: str, file_type: str, quality: int, width: int, height: int,
    timeout: float, count: int, interval: float, overwrite: bool, context: dict[str, Any],
) -> None:  # fmt: skip
    """As takePicture, how many, and how long from one to the next."""
    _check_shot(self, camera, topic, quality, width, height, timeout)
    require_within("count", count, PICTURES, f"1..{PICTURES[1]}, or 0: 1")
    require_within("interval", interval, TIMEOUT)
    kind = self.files.file_type(str_param, file_type, PICTURE_TYPES)
    if str_param.strip():
        path = self.files.path(str_param, kind)
        for number in range(1, (count or 1) + 1):
            _plan_file(self, numbered(path, number, count or 1), overwrite, context)


def numbered(path: Path, number: int, count: int) -> Path:
    """Path of one of several pictures: name-001 and so on; as it is if it is the only one."""
    if count == 1:
        return path
    return path.with_name(f"{path.stem}-{number:0{max(3, len(str(count)))}d}{path.suffix}")


def _check_shot(
    self: HasThreads, camera: str, topic: str, quality: int, width: int, height: int, timeout: float
) -> None:
    require_source(self, camera, topic)
    require_size(width, height)
    require_timeout(timeout)
    require_number("quality", quality, 0, 100, "1..100, or 0 for the default")

"""Checks of streams, recordings and pictures, made before a chain begins. Parameters are fields of VisionFunction.

`context["threads"]` is what the chain will have made of the streams and recordings: name -> kind and whether it runs.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, Dict, Protocol, Tuple

from ...base.errors import BadGoal
from ...base.field_checks import require_known
from .files import VisionFiles
from .jobs import MOST_JOBS, CaptureJobs, taken, too_many, unknown
from .pictures import PICTURE_TYPES
from .video import CODECS, VIDEO_TYPES, codec_name, known_codecs

Plan = Dict[str, Tuple[str, bool]]


class HasThreads(Protocol):
    """The module, as far as the checks need it."""

    threads: CaptureJobs
    files: VisionFiles
    topics: Any

    def source(self, camera: str, topic: str) -> str:
        """Topic that frames come from."""
        ...


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
    name = ident.strip()
    if plan.get(name, ("", False))[1]:
        raise taken(name)
    if name not in plan and len(plan) >= MOST_JOBS:
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
    name = ident.strip()
    if name not in plan:
        raise unknown(name, plan)
    if kind and plan[name][0] != kind:
        names = [other for other, (own, _) in plan.items() if own == kind]
        allowed = f"one of {', '.join(names)}" if names else f"there is no {kind}"
        raise BadGoal("id", ident, allowed, problem=f"{name!r} is a {plan[name][0]}")
    return name


# Functions


def check_new_stream(
    self: HasThreads, id: str, camera: str, topic: str, topic_out: str, context: dict[str, Any], runs: bool = False
) -> None:
    """A free name, and where frames come from and go to."""
    _plan_new(self, id, "stream", runs, context)
    target = self.topics.resolved(topic_out_of(id, topic_out))
    if target == self.source(camera, topic):
        raise BadGoal("topic_out", topic_out, "another topic", problem="frames come from there")
    streams = [thread for thread in self.threads.known.values() if thread.kind == "stream"]
    for thread in streams:
        if thread.ident != id.strip() and self.topics.resolved(thread.topic_out) == target:
            raise BadGoal("topic_out", topic_out, "another topic", problem=f"{thread.ident!r} publishes {target}")


def check_subscribe(
    self: HasThreads, id: str, camera: str, topic: str, topic_out: str, context: dict[str, Any]
) -> None:
    """As createStream; it runs then."""
    check_new_stream(self, id, camera, topic, topic_out, context, runs=True)


def check_new_recording(
    self: HasThreads,
    id: str,
    str_param: str,
    file_type: str,
    codec: str,
    overwrite: bool,
    context: dict[str, Any],
    runs: bool = False,
) -> None:
    """A free name, a file that may be written, and a codec for it."""
    kind = self.files.file_type(str_param, file_type, VIDEO_TYPES)
    require_codec(codec, kind)
    _plan_new(self, id, "recording", runs, context)
    if str_param.strip():
        _plan_file(self, self.files.path(str_param, kind), overwrite, context)


def check_start_recording(
    self: HasThreads, id: str, str_param: str, file_type: str, codec: str, overwrite: bool, context: dict[str, Any]
) -> None:
    """As createRecording; it runs then."""
    check_new_recording(self, id, str_param, file_type, codec, overwrite, context, runs=True)


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


def check_picture(self: HasThreads, str_param: str, file_type: str, overwrite: bool, context: dict[str, Any]) -> None:
    """A file that may be written."""
    check_pictures(self, str_param, file_type, 1, overwrite, context)


def check_pictures(
    self: HasThreads, str_param: str, file_type: str, count: int, overwrite: bool, context: dict[str, Any]
) -> None:
    """Files that may be written."""
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

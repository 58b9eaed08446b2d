"""Functions that begin and end streams and recordings, which outlive the goals that began them."""

from __future__ import annotations

import logging
import re
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, NamedTuple

from naoqi.errors import NaoError

from ..core.chain import Part, checked_by
from ..core.errors import BadGoal
from ..core.fields import require_known
from .cameras import Cameras, ChainResults
from .capture_jobs import (
    MOST_JOBS,
    CaptureJob,
    CaptureJobs,
    Stream,
    VideoRecording,
    VideoSpec,
    taken,
    too_many,
    unknown,
)
from .video import CODECS, VIDEO_TYPES, VisionFiles, codec_name, known_codecs
from .vision_fields import (
    Camera,
    Height,
    NewRecording,
    NewStream,
    Overwrite,
    Rate,
    RecordingId,
    SomeThread,
    StreamId,
    ThreadId,
    Topic,
    TopicOut,
    VideoCodec,
    VideoName,
    VideoType,
    Width,
)

if TYPE_CHECKING:
    from ..nao_basic import NaoBasic


log = logging.getLogger(__name__)


class PlannedJob(NamedTuple):
    """A stream or recording as the chain will have left it."""

    kind: str
    runs: bool
    target: str = ""  # topic of a stream, resolved


Plan = Dict[str, PlannedJob]
"""By name: what the chain will have made of the streams and recordings."""


class StreamingFunctions(Part):
    left_by_goals = frozenset({"jobs", "files"})

    def __init__(
        self, module: NaoBasic, cameras: Cameras, files: VisionFiles, jobs: CaptureJobs, results: ChainResults
    ) -> None:
        self.jobs = jobs
        self.files = files
        self._module = module
        self._cameras = cameras
        self._results = results

    # Checks before a chain; `context["threads"]` holds its plan, `context["files"]` the files that it writes

    def _plan(self, context: dict[str, Any]) -> Plan:
        if "threads" not in context:
            context["threads"] = {ident: self._as_planned(job) for ident, job in self.jobs.known.items()}
        return context["threads"]

    def _as_planned(self, job: CaptureJob) -> PlannedJob:
        target = self._cameras.topics.resolved(job.topic_out) if isinstance(job, Stream) else ""
        return PlannedJob(job.kind, job.runs, target)

    def _plan_new(self, ident: str, job: PlannedJob, context: dict[str, Any]) -> None:
        plan = self._plan(context)
        name = ident.strip()
        if name in plan and plan[name].runs:
            raise taken(name)
        if name not in plan and len(plan) >= MOST_JOBS:
            raise too_many(name)
        plan[name] = job

    def _planned(self, ident: str, context: dict[str, Any], kind: str = "") -> str:
        """The name of a job that there will be, without blanks around it."""
        plan = self._plan(context)
        name = ident.strip()
        if name not in plan:
            raise unknown(name, plan)
        if kind and plan[name].kind != kind:
            names = [other for other, job in plan.items() if job.kind == kind]
            allowed = f"one of {', '.join(names)}" if names else f"there is no {kind}"
            raise BadGoal("id", ident, allowed, problem=f"{name!r} is a {plan[name].kind}")
        return name

    def _check_create_stream(
        self, id: str, camera: str, topic: str, topic_out: str, context: dict[str, Any], runs: bool = False
    ) -> None:
        target = self._cameras.topics.resolved(_topic_out(id, topic_out))
        self._plan_new(id, PlannedJob("stream", runs, target), context)
        if target == self._cameras.source(camera, topic):
            raise BadGoal("topic_out", topic_out, "another topic", problem="frames come from there")
        for name, job in self._plan(context).items():
            if name != id.strip() and job.target == target:
                raise BadGoal("topic_out", topic_out, "another topic", problem=f"{name!r} publishes {target}")

    def _check_create_recording(
        self,
        id: str,
        str_param: str,
        file_type: str,
        codec: str,
        overwrite: bool,
        context: dict[str, Any],
        runs: bool = False,
    ) -> None:
        kind = self.files.file_type(str_param, file_type, VIDEO_TYPES)
        _require_codec(codec, kind)
        self._plan_new(id, PlannedJob("recording", runs), context)
        if str_param.strip():
            self.files.plan(self.files.path(str_param, kind), overwrite, context.setdefault("files", set()))

    def _check_start(self, id: str, context: dict[str, Any]) -> None:
        name = self._planned(id, context)
        plan = self._plan(context)
        if plan[name].runs:
            raise taken(name)
        plan[name] = plan[name]._replace(runs=True)

    def _check_stop(self, id: str, context: dict[str, Any], kind: str = "") -> None:
        name = self._planned(id, context, kind)
        plan = self._plan(context)
        plan[name] = plan[name]._replace(runs=False)

    def _check_delete(self, id: str, context: dict[str, Any]) -> None:
        del self._plan(context)[self._planned(id, context)]

    def _check_list(self, id: str, context: dict[str, Any]) -> None:
        if id.strip():
            self._planned(id, context)

    # Functions

    @checked_by(partial(_check_create_stream, runs=True))
    def subscribe(
        self, id: NewStream, camera: Camera, topic: Topic, topic_out: TopicOut, rate: Rate, width: Width, height: Height
    ) -> list[str]:
        """Begin a stream, which goes on until it is stopped; answers its topic."""
        answer = self.create_stream(id, camera, topic, topic_out, rate, width, height)
        self.start_thread(id)
        return answer

    @checked_by(_check_create_stream)
    def create_stream(
        self, id: NewStream, camera: Camera, topic: Topic, topic_out: TopicOut, rate: Rate, width: Width, height: Height
    ) -> list[str]:
        """Make a stream ready; startThread begins it. Answers its topic."""
        target = self._cameras.topics.resolved(_topic_out(id, topic_out))
        source = self._cameras.source(camera, topic)
        if source == target:  # the active camera may be another one than at the check
            raise BadGoal("topic_out", topic_out, "another topic", problem="frames come from there")
        self.jobs.add(Stream(id.strip(), source, rate, self._cameras.topics, self._module.clock, target, width, height))
        self._keep()
        return [target]

    @checked_by(partial(_check_stop, kind="stream"))
    def unsubscribe(self, id: StreamId) -> None:
        """Stop a stream; it can be started again."""
        self._stop(self.jobs.get(id.strip()))

    @checked_by(partial(_check_create_recording, runs=True))
    def start_recording(
        self,
        id: NewRecording,
        str_param: VideoName,
        camera: Camera,
        topic: Topic,
        rate: Rate,
        width: Width,
        height: Height,
        file_type: VideoType,
        codec: VideoCodec,
        overwrite: Overwrite,
    ) -> list[str]:
        """Begin a recording, which goes on until it is stopped; answers its file."""
        self.create_recording(id, str_param, camera, topic, rate, width, height, file_type, codec, overwrite)
        return self.start_thread(id)

    @checked_by(_check_create_recording)
    def create_recording(
        self,
        id: NewRecording,
        str_param: VideoName,
        camera: Camera,
        topic: Topic,
        rate: Rate,
        width: Width,
        height: Height,
        file_type: VideoType,
        codec: VideoCodec,
        overwrite: Overwrite,
    ) -> None:
        """Make a recording ready; startThread begins it."""
        kind = self.files.file_type(str_param, file_type, VIDEO_TYPES)
        path = self.files.path(str_param, kind) if str_param.strip() else None
        spec = VideoSpec(path, kind, codec_name(codec, kind), width, height, overwrite)
        source = self._cameras.source(camera, topic)
        self.jobs.add(
            VideoRecording(id.strip(), source, rate, self._cameras.topics, self._module.clock, self.files, spec)
        )
        self._keep()

    @checked_by(partial(_check_stop, kind="recording"))
    def stop_recording(self, id: RecordingId) -> list[Any]:
        """Stop a recording; answers file, frames and length (s)."""
        job = self.jobs.get(id.strip())
        self._stop(job)
        video = job.video
        return [video.path, video.frames, video.duration]

    @checked_by(_check_start)
    def start_thread(self, id: ThreadId) -> list[str]:
        """Start a stream or recording, also once more: a recording then makes a further file. Answers where it goes."""
        job = self.jobs.get(id.strip())
        job.start()
        self._keep()
        report = job.report()
        return [report.path or report.topic_out]

    @checked_by(_check_stop)
    def stop_thread(self, id: ThreadId) -> None:
        """Stop a stream or recording; it can be started again."""
        self._stop(self.jobs.get(id.strip()))

    @checked_by(_check_delete)
    def delete_thread(self, id: ThreadId) -> None:
        """Stop a stream or recording, and forget it; files stay."""
        job = self.jobs.get(id.strip())
        if job.runs:
            self._stop(job)
        self.jobs.remove(job.ident)
        self._keep()

    @checked_by(_check_list)
    def list_threads(self, id: SomeThread) -> list[str]:
        """How streams and recordings are, or the one that is named; answers their names."""
        wanted = id.strip()
        found = [job.report() for job in self.jobs.known.values() if wanted in ("", job.ident)]
        self._results.threads += found
        return [report.id for report in found]

    def _stop(self, job: CaptureJob) -> None:
        job.stop()
        self._keep()
        if isinstance(job, VideoRecording):
            self._results.recordings.append(job.video)

    # After the death of the node

    def make_again(self) -> None:
        """Make the jobs again that the node had before it died; those that ran go on, recordings in a further file."""
        for former in self._module.kept.load(list) or ():
            try:
                job = self._job(**former["settings"])
                self.jobs.add(job)
                if former["runs"]:
                    job.start()
                    log.info("%s %r goes on", job.kind, job.ident)
            except (NaoError, KeyError, TypeError) as error:
                log.warning("a stream or recording is not made again: %s: %s", former, error)

    def _job(self, spec: dict[str, Any] | None = None, **settings: Any) -> CaptureJob:
        settings.update(topics=self._cameras.topics, clock=self._module.clock)
        if spec is None:
            return Stream(**settings)
        path = spec["path"] and Path(spec["path"])
        return VideoRecording(files=self.files, spec=VideoSpec(**{**spec, "path": path}), again=True, **settings)

    def _keep(self) -> None:
        self._module.kept.save([{"settings": each.settings, "runs": each.runs} for each in self.jobs.known.values()])

    functions = {
        "subscribe": subscribe,
        "unsubscribe": unsubscribe,
        "startRecording": start_recording,
        "stopRecording": stop_recording,
        "createStream": create_stream,
        "createRecording": create_recording,
        "startThread": start_thread,
        "stopThread": stop_thread,
        "deleteThread": delete_thread,
        "listThreads": list_threads,
    }


def _topic_out(ident: str, topic_out: str) -> str:
    """Topic of a stream: as named, or after its id."""
    return topic_out.strip() or f"NaoVision/{re.sub(r'[^A-Za-z0-9_]', '_', ident.strip())}/image_raw"


def _require_codec(codec: str, file_type: str) -> None:
    """A codec that this computer has, and that the type of file can hold."""
    name = codec_name(codec, file_type)
    here = known_codecs(file_type)
    if name in CODECS and name not in here:
        problem = f"{file_type} files cannot have {name} here"
        raise BadGoal("codec", codec, f"one of {', '.join(here)}", problem=problem)
    require_known("codec", name, here, "codec")

"""Functions that begin and end streams and recordings, which outlive the goals that began them."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from ...functions.chain import checked_by
from .base import VisionBase
from .checks import (
    check_delete,
    check_list,
    check_new_recording,
    check_new_stream,
    check_start,
    check_start_recording,
    check_stop,
    check_stop_recording,
    check_subscribe,
    check_unsubscribe,
    topic_out_of,
)
from .fields import (
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
from .jobs import CaptureJob
from .recorder import Recording, VideoSpec
from .stream import Stream
from .video import VIDEO_TYPES, codec_name

log = logging.getLogger(__name__)


class StreamingFunctions(VisionBase):
    """Streams and recordings. Parameters are fields of VisionFunction."""

    @checked_by(check_subscribe)
    def subscribe(
        self, id: NewStream, camera: Camera, topic: Topic, topic_out: TopicOut, rate: Rate, width: Width, height: Height
    ) -> list[str]:
        """Begin a stream, which goes on until it is stopped; answers its topic."""
        answer = self.create_stream(id, camera, topic, topic_out, rate, width, height)
        self.start_thread(id)
        return answer

    @checked_by(check_new_stream)
    def create_stream(
        self, id: NewStream, camera: Camera, topic: Topic, topic_out: TopicOut, rate: Rate, width: Width, height: Height
    ) -> list[str]:
        """Make a stream ready; startThread begins it. Answers its topic."""
        target = self.topics.resolved(topic_out_of(id, topic_out))
        source = self.source(camera, topic)
        if source == target:  # the active camera may be another one than at the check
            raise BadGoal("topic_out", topic_out, "another topic", problem="frames come from there")
        self.threads.add(Stream(id.strip(), source, rate, self.topics, self.clock, target, width, height))
        self._keep()
        return [target]

    @checked_by(check_unsubscribe)
    def unsubscribe(self, id: StreamId) -> None:
        """Stop a stream; it can be started again."""
        self._stop(self.threads.get(id.strip()))

    @checked_by(check_start_recording)
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

    @checked_by(check_new_recording)
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
        source = self.source(camera, topic)
        self.threads.add(Recording(id.strip(), source, rate, self.topics, self.clock, self.files, spec))
        self._keep()

    @checked_by(check_stop_recording)
    def stop_recording(self, id: RecordingId) -> list[Any]:
        """Stop a recording; answers file, frames and length (s)."""
        thread = self.threads.get(id.strip())
        self._stop(thread)
        video = thread.video
        return [video.path, video.frames, video.duration]

    @checked_by(check_start)
    def start_thread(self, id: ThreadId) -> list[str]:
        """Start a stream or recording, also once more: a recording then makes a further file. Answers where it goes."""
        thread = self.threads.get(id.strip())
        thread.start()
        self._keep()
        report = thread.report()
        return [report.path or report.topic_out]

    @checked_by(check_stop)
    def stop_thread(self, id: ThreadId) -> None:
        """Stop a stream or recording; it can be started again."""
        self._stop(self.threads.get(id.strip()))

    @checked_by(check_delete)
    def delete_thread(self, id: ThreadId) -> None:
        """Stop a stream or recording, and forget it; files stay."""
        thread = self.threads.get(id.strip())
        if thread.runs:
            self._stop(thread)
        self.threads.remove(thread.ident)
        self._keep()

    @checked_by(check_list)
    def list_threads(self, id: SomeThread) -> list[str]:
        """How streams and recordings are, or the one that is named; answers their names."""
        wanted = id.strip()
        found = [thread.report() for thread in self.threads.known.values() if wanted in ("", thread.ident)]
        self.taken.threads += found
        return [report.id for report in found]

    def _stop(self, thread: CaptureJob) -> None:
        thread.stop()
        self._keep()
        if isinstance(thread, Recording):
            self.taken.recordings.append(thread.video)

    # After the death of the node

    def make_again(self) -> None:
        """Make the streams and recordings that the node had before it died; those that ran go on, in a further file."""
        for told in self.kept.load() or ():
            try:
                thread = self._thread(**told["settings"])
                self.threads.add(thread)
                if told["runs"]:
                    thread.start()
                    log.info("%s %r goes on", thread.kind, thread.ident)
            except (NaoError, KeyError, TypeError) as error:
                log.warning("a stream or recording is not there again: %s: %s", told, error)

    def _thread(self, spec: dict[str, Any] | None = None, **settings: Any) -> CaptureJob:
        settings.update(topics=self.topics, clock=self.clock)
        if spec is None:
            return Stream(**settings)
        path = spec["path"] and Path(spec["path"])
        return Recording(files=self.files, spec=VideoSpec(**{**spec, "path": path}), again=True, **settings)

    def _keep(self) -> None:
        self.kept.save([{"settings": each.settings, "runs": each.runs} for each in self.threads.known.values()])

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

"""Streams and recordings of cameras: threads that handle the frames in order, by the names that users gave them."""

from __future__ import annotations

import logging
import posixpath
import threading
import time
from abc import ABC, abstractmethod
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from genpy import Time
from sensor_msgs.msg import CameraInfo, CompressedImage, Image, RegionOfInterest

from nao_library_msgs.msg import RecordedVideo, VisionThread
from naoqi.errors import NaoError

from ..core.errors import BadGoal, did_you_mean
from ..core.files import WholeFile
from .pictures import (
    COMPRESSED,
    BadPicture,
    Frame,
    FrameQueue,
    RateLimit,
    RecentRate,
    encoded,
    encoding_of,
    frame_of,
    is_compressed,
    picture_of,
    scaled,
    visible,
    wanted_size,
)
from .video import VideoFile, VisionFiles

log = logging.getLogger(__name__)

STALLED_AFTER = 2.0
"""s of ROS time without a frame after which a camera has stalled."""
SLOW_CAMERA = 5.0
"""Periods without a frame after which a camera with few frames a second has stalled."""
STALL_CHECK = 1.0
"""s of wall-clock time between two checks whether frames still come."""
STAMP_STEP = 1e-6
"""s; more than what rounding does to stamps, which are whole nanoseconds."""
END_LIMIT = 10.0
"""s that the waiting frames may take when a job is stopped."""
LAST_FRAME_LIMIT = 1.0
"""s to wait at a stop for frames that are on their way; a camera that is later than that has another clock."""


def taken(ident: str) -> BadGoal:
    """The error for the name of a job that runs."""
    return BadGoal("id", ident, "stop it first, or take another name", problem=f"{ident!r} runs already")


class CaptureJob(ABC):
    """Handles the frames of a topic in a thread of its own from each start to the next stop.

    Threads: the receiver of messages calls `_arrived`, the worker `_handle` and `_end`, the executor of goals all else;
    the thread that ends the node may call `stop`. The condition guards what they share.
    """

    kind = ""
    """stream or recording"""
    whole = False
    """Whether a stop waits for frames that were taken before it and have not come yet."""

    def __init__(self, ident: str, topic: str, rate: float, topics: Any, clock: Any) -> None:
        """Nothing is received before `start`.

        Args:
            ident: The user's name for the job.
            topic: Full name of the source.
            rate: Frames a second at most; 0: all.
            topics: VisionTopics, or what takes its place.
            clock: ROS time.
        """
        self.ident = ident
        self.topic = topic
        self._rate = rate
        self._topics = topics
        self._clock = clock
        self._changed = threading.Condition()
        self._state = "ready"
        self._worker: threading.Thread | None = None
        self._subscription: Any = None
        self._forget()

    @abstractmethod
    def _begin(self) -> None:
        """Open the target, before the first frame can come; if a NaoError is raised the job does not start."""

    @abstractmethod
    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        """Pass a frame on; width and height at the target, None if the frame was dropped.

        Raises:
            BadPicture: The frame cannot be read; the job goes on.
            NaoError: The job fails.
        """

    @abstractmethod
    def _end(self) -> None:
        """Close the target."""

    @property
    def settings(self) -> dict[str, Any]:
        """Arguments of the constructor that JSON can hold, to make the job again after the death of the node."""
        return {"ident": self.ident, "topic": self.topic, "rate": self._rate}

    @abstractmethod
    def _fill(self, report: VisionThread) -> None:
        """Fill the fields that only this kind of job has."""

    # Life

    @property
    def runs(self) -> bool:
        with self._changed:
            return self._state == "running"

    def start(self) -> None:
        """Begin to take frames. Raises NaoError if it runs already, or cannot."""
        if self.runs:
            raise taken(self.ident)
        self._finish()  # what failed before may still have something open
        self._forget()
        self._begin()
        with self._changed:
            self._state = "running"
            self._began = self._clock.now()
        self._worker = threading.Thread(target=self._work, name=f"{self.kind} {self.ident}", daemon=True)
        self._worker.start()
        try:
            self._subscription = self._topics.subscribe(self.topic, self._arrived)
        except NaoError:
            self._state = "ready"
            self._finish()
            raise

    def stop(self, at_once: bool = False) -> None:
        """End after the frames that have come; no effect on a job that does not run.

        `at_once`: whether not to wait for frames that are on their way.
        """
        with self._changed:
            if self._state == "running" and self.whole and not at_once:
                self._wait_for_the_last()
            if self._state == "running":
                self._state = "stopped"
        self._finish()

    def let_go(self) -> None:
        """Take no further frames, without any wait; `stop` has to follow."""
        with self._changed:
            if self._state == "running":
                self._state = "stopped"
            self._ended = self._ended or self._clock.now()
            self._changed.notify_all()

    def wait_until(self, deadline: float) -> None:
        """Wait until the frames that have come are handled; drop those left at the deadline (`time.monotonic`, s)."""
        worker = self._worker
        if worker is not None:
            worker.join(max(0.0, deadline - time.monotonic()))
            with self._changed:
                self._queue.drop_all()

    def _wait_for_the_last(self) -> None:
        """Wait for a frame that was taken after this moment; with the condition held."""
        now = self._clock.now()
        late = self._last_arrival - self._last_stamp
        if not self._arrivals or self._stalled(now) or not -STAMP_STEP <= late < LAST_FRAME_LIMIT:
            return
        self._until = self._ended = now
        due = now - STAMP_STEP
        self._changed.wait_for(lambda: self._last_stamp >= due or self._state != "running", LAST_FRAME_LIMIT)

    def _finish(self) -> None:
        """Unsubscribe, and wait for the worker's end."""
        subscription, self._subscription = self._subscription, None
        if subscription is not None:
            subscription.close()
        with self._changed:
            self._ended = self._ended or self._clock.now()
            self._changed.notify_all()
        worker = self._worker
        if worker is not None:
            worker.join(END_LIMIT)
            if worker.is_alive():
                log.warning("%s %r has not ended after %g s", self.kind, self.ident, END_LIMIT)

    def report(self) -> VisionThread:
        """State, counts, rate and size now."""
        now = self._clock.now()
        with self._changed:
            stalled = self._stalled(now)
            state = self._state
            if state == "running":
                state = "stalled" if stalled else "running" if self._arrivals else "waiting"
            report = VisionThread(
                id=self.ident,
                kind=self.kind,
                state=state,
                error=self._error,
                topic=self.topic,
                frames=self._frames,
                dropped=self._dropped + self._queue.dropped,
                frame_rate=0.0 if stalled or self._state != "running" else self._meter.rate,
                width=self._size[0],
                height=self._size[1],
                duration=max(0.0, (self._ended or now) - self._began) if self._began is not None else 0.0,
            )
        self._fill(report)
        return report

    # Frames

    def _forget(self) -> None:
        self._queue = FrameQueue()
        self._limit = RateLimit(self._rate)
        self._meter = RecentRate()
        self._arrivals = self._frames = self._dropped = 0
        self._size = (0, 0)
        self._error = ""
        self._began: float | None = None
        self._ended: float | None = None
        self._last_arrival = self._last_stamp = 0.0
        self._until: float | None = None
        self._stall_reported = False

    def _arrived(self, message: Any) -> None:
        """Queue a message, and nothing that takes time: rospy calls this from the thread that receives."""
        now = self._clock.now()
        frame = frame_of(message, now)
        with self._changed:
            if self._state != "running":
                return
            self._arrivals += 1
            self._last_arrival, self._last_stamp = now, frame.stamp
            if self._until is not None and frame.stamp >= self._until:
                self._changed.notify_all()
                return
            if not self._limit.passes(frame.stamp):
                return
            self._queue.put(frame)
            self._changed.notify_all()

    def _next(self) -> Frame | None:
        """The oldest frame that waits, or the next to come; None when no further one will come."""
        while True:
            with self._changed:
                if not self._queue and self._state == "running":
                    self._changed.wait(STALL_CHECK)
                if self._queue:
                    return self._queue.take()
                if self._state != "running":
                    return None
            self._report_stall()

    def _work(self) -> None:
        problem = ""
        try:
            for frame in iter(self._next, None):
                self._pass_on(frame)
        except NaoError as error:
            problem = str(error)
        except Exception as error:
            log.exception("%s %r", self.kind, self.ident)
            problem = f"unexpected error: {error!r}"
        try:
            self._end()
        except NaoError as error:
            problem = problem or str(error)
        if problem:
            log.error("%s %r ended: %s", self.kind, self.ident, problem)
            with self._changed:
                self._state, self._error = "failed", problem
                self._ended = self._ended or self._clock.now()
            subscription = self._subscription  # `stop` may close it as well, which does no harm
            if subscription is not None:
                subscription.close()

    def _pass_on(self, frame: Frame) -> None:
        try:
            size = self._handle(frame)
        except BadPicture as error:
            with self._changed:
                is_new = self._error != str(error)
                self._error = str(error)
                self._dropped += 1
            if is_new:
                log.error("%s %r: %s", self.kind, self.ident, error)
            return
        with self._changed:
            if size is None:
                self._dropped += 1
                return
            self._error = ""
            self._size = size
            self._frames += 1
            self._meter.count(frame.stamp)

    def _stalled(self, now: float) -> bool:
        """Whether frames have come and no longer come; with the condition held."""
        if not self._arrivals or self._state != "running":
            return False
        rate = self._meter.rate
        return now - self._last_arrival > max(STALLED_AFTER, SLOW_CAMERA / rate if rate else 0.0)

    def _report_stall(self) -> None:
        with self._changed:
            stalled = self._stalled(self._clock.now())
            is_new = stalled != self._stall_reported
            self._stall_reported = stalled
        if is_new and stalled:
            log.warning("%s %r: no frames come from %s any more", self.kind, self.ident, self.topic)


MOST_JOBS = 100
CLOSING = 2.0
"""s of wall-clock time that the end of the server waits for frames that have come and are not written yet."""


class CaptureJobs:
    """A table of capture jobs. Goals use it from one thread, the end of the node from another."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._jobs: dict[str, CaptureJob] = {}
        self._closed = False

    @property
    def known(self) -> dict[str, CaptureJob]:
        """Name -> job, in the order of the names; a copy."""
        with self._lock:
            return dict(sorted(self._jobs.items()))

    def recorded(self) -> list[str]:
        """Names of the recordings that run and still get pictures, or wait for the first."""
        reports = [job.report() for job in self.known.values()]
        return [each.id for each in reports if each.kind == "recording" and each.state in ("waiting", "running")]

    def get(self, ident: str) -> CaptureJob:
        """The job of a name. Raises BadGoal if there is none."""
        known = self.known
        if ident not in known:
            raise unknown(ident, known)
        return known[ident]

    def add(self, job: CaptureJob) -> None:
        """Add a job; it replaces one of the same name that does not run.

        Raises BadGoal if one of that name runs, or there are too many.
        """
        with self._lock:
            old = self._jobs.get(job.ident)
            if old is not None and old.runs:
                raise taken(job.ident)
            if old is None and len(self._jobs) >= MOST_JOBS:
                raise too_many(job.ident)
            if self._closed:
                raise BadGoal("id", job.ident, "none any more", problem="the server ends")
            self._jobs[job.ident] = job
        if old is not None:
            old.stop()  # it has failed, or was never started

    def remove(self, ident: str) -> None:
        """Forget a job; it must have been stopped."""
        with self._lock:
            self._jobs.pop(ident, None)

    def close(self) -> None:
        """Stop all jobs together and soon: the files of a node that is killed meanwhile would be incomplete."""
        with self._lock:
            self._closed = True
        jobs = list(self.known.values())
        running = [job for job in jobs if job.runs]
        for job in jobs:
            job.let_go()
        for job in running:
            log.info("%s %r ends with the server", job.kind, job.ident)
        deadline = time.monotonic() + CLOSING
        for job in jobs:
            job.wait_until(deadline)
        for job in jobs:
            job.stop(at_once=True)


def unknown(ident: str, known: object) -> BadGoal:
    """The error for a name that no job has."""
    names = list(known)
    problem = f"there is no stream or recording {ident!r}{did_you_mean(ident, names)}"
    return BadGoal("id", ident, f"one of {', '.join(names)}" if names else "there are none", problem=problem)


def too_many(ident: str) -> BadGoal:
    problem = "there are too many streams and recordings"
    return BadGoal("id", ident, f"up to {MOST_JOBS}: deleteThread makes room", problem=problem)


class Stream(CaptureJob):
    """Passes frames on to a topic.

    Frames whose form does not change are published as they came; others are converted only while the topic has
    subscribers. The camera_info of the camera, if there is one, is published beside them in the size of the stream.
    """

    kind = "stream"

    def __init__(
        self, ident: str, topic: str, rate: float, topics: Any, clock: Any, topic_out: str, width: int, height: int
    ) -> None:
        """Take what CaptureJob takes, the topic to publish (as JPEG if it ends in /compressed), and `wanted_size`."""
        super().__init__(ident, topic, rate, topics, clock)
        self.topic_out = topic_out
        self._wanted = (width, height)
        self._compress = topic_out.endswith(COMPRESSED)
        self._publisher: Any = None
        self._infos: Any = None
        self._info_subscription: Any = None
        self._info: Any = None  # the latest one; set by the thread that receives it

    @property
    def settings(self) -> dict[str, Any]:
        width, height = self._wanted
        return {**super().settings, "topic_out": self.topic_out, "width": width, "height": height}

    def _begin(self) -> None:
        self._publisher = self._topics.publisher(self.topic_out, CompressedImage if self._compress else Image)
        theirs, ours = info_topic(self.topic), info_topic(self.topic_out)
        if theirs and ours and theirs != ours:
            self._info = None
            self._infos = self._topics.publisher(ours, CameraInfo)
            self._info_subscription = self._topics.subscribe_info(theirs, self._take_info)

    def _take_info(self, info: Any) -> None:
        self._info = info

    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        size = self._publish(frame.message)
        info = self._info
        if info is not None and self._infos.is_heard():
            width, height = size if all(size) else (info.width, info.height)
            self._infos.publish(scaled_info(info, frame.message.header, width, height))
        return size

    def _publish(self, message: Any) -> tuple[int, int]:
        if self._as_it_came(message):
            self._publisher.publish(message)
            return (0, 0) if is_compressed(message) else (message.width, message.height)
        if not self._publisher.is_heard():
            return self._size if is_compressed(message) else wanted_size((message.width, message.height), *self._wanted)
        picture = scaled(picture_of(message), *self._wanted)
        self._publisher.publish(self._message(message, picture))
        return picture.shape[1], picture.shape[0]

    def _as_it_came(self, message: Any) -> bool:
        if is_compressed(message) != self._compress:
            return False
        if self._compress:
            return self._wanted == (0, 0)
        size = (message.width, message.height)
        return 0 in size or wanted_size(size, *self._wanted) == size

    def _message(self, message: Any, picture: Any) -> Any:
        if self._compress:
            original = "bgr8" if is_compressed(message) else message.encoding
            return CompressedImage(
                header=message.header, format=f"{original}; jpeg compressed bgr8", data=encoded(picture, "jpg")
            )
        if picture.ndim == 2:  # grey of 16 bits
            encoding = "mono16"
        elif encoding_of(message) == "mono8":
            encoding, picture = "mono8", picture[:, :, 0].copy()
        else:
            encoding = "bgr8"
        height, width = picture.shape[:2]
        return Image(
            header=message.header,
            height=height,
            width=width,
            encoding=encoding,
            is_bigendian=0,
            step=picture.nbytes // height,
            data=picture.tobytes(),
        )

    def _end(self) -> None:
        for end in (self._info_subscription, self._infos, self._publisher):
            if end is not None:
                end.close()
        self._info_subscription = self._infos = self._publisher = None

    def _fill(self, report: VisionThread) -> None:
        report.topic_out = self.topic_out


def info_topic(topic: str) -> str:
    """Topic of the camera_info beside a topic of pictures (full name), where ROS's tools look for it.

    Empty for a topic whose last part does not begin with "image": no camera publishes it.
    """
    base = topic[: -len(COMPRESSED)] if topic.endswith(COMPRESSED) else topic
    folder, name = posixpath.split(base)
    return posixpath.join(folder, "camera_info") if name.startswith("image") else ""


def scaled_info(info: Any, header: Any, width: int, height: int) -> CameraInfo:
    """The sensor_msgs/CameraInfo of a camera for pictures of another size (pixels), with the header of the picture."""
    across, down = width / info.width if info.width else 1.0, height / info.height if info.height else 1.0
    k, p, region = list(info.K), list(info.P), info.roi
    # Of both matrices the first row counts columns of the picture, the second one rows.
    k = [value * (across, down, 1.0)[index // 3] for index, value in enumerate(k)]
    p = [value * (across, down, 1.0)[index // 4] for index, value in enumerate(p)]
    return CameraInfo(
        header=header,
        width=width,
        height=height,
        distortion_model=info.distortion_model,
        D=list(info.D),
        K=k,
        R=list(info.R),
        P=p,
        binning_x=info.binning_x,
        binning_y=info.binning_y,
        roi=RegionOfInterest(
            x_offset=round(region.x_offset * across),
            y_offset=round(region.y_offset * down),
            width=round(region.width * across),
            height=round(region.height * down),
            do_rectify=region.do_rectify,
        ),
    )


@dataclass(frozen=True)
class VideoSpec:
    path: Path | None  # None: named by the time of the start
    file_type: str  # mp4 or avi
    codec: str  # one of `known_codecs`
    width: int = 0  # pixels, as `wanted_size` takes them
    height: int = 0
    overwrite: bool = False


class VideoRecording(CaptureJob):
    """Writes frames into a file; each start makes a new one."""

    kind = "recording"
    whole = True

    def __init__(
        self,
        ident: str,
        topic: str,
        rate: float,
        topics: Any,
        clock: Any,
        files: VisionFiles,
        spec: VideoSpec,
        again: bool = False,
    ) -> None:
        """Take what CaptureJob takes; again: a node that has died started it before, and its file stays."""
        super().__init__(ident, topic, rate, topics, clock)
        self._files = files
        self._spec = spec
        self._file: WholeFile | None = None
        self._video: VideoFile | None = None
        self._again = again

    @property
    def settings(self) -> dict[str, Any]:
        return {**super().settings, "spec": {**asdict(self._spec), "path": self._spec.path and str(self._spec.path)}}

    @property
    def video(self) -> RecordedVideo:
        """The file of the latest start."""
        report = self.report()
        video = self._video
        message = RecordedVideo(
            id=self.ident,
            path=report.path,
            file_type=self._spec.file_type,
            codec=self._spec.codec,
            topic=self.topic,
            dropped=report.dropped,
            error=report.error or ("" if video is not None else f"no frame came from {self.topic}: there is no file"),
        )
        if video is None:
            message.path = ""
        else:
            message.began = Time.from_sec(video.began)
            message.duration, message.frames = video.duration, video.frames
            message.width, message.height = video.width, video.height
            message.frame_rate = video.frames / video.duration if video.duration > 0.0 else 0.0
        return message

    def _begin(self) -> None:
        again, self._again = self._again, True
        self._video = None
        spec = self._spec
        path = spec.path or self._files.named_by_time(self.ident, spec.file_type)
        # Only the first start was checked before the chain: a second one must not replace its file.
        self._file = self._files.create(path, spec.overwrite and not again, numbered=again or spec.path is None)
        self._wanted = self._file.path

    def _handle(self, frame: Frame) -> tuple[int, int] | None:
        picture = visible(scaled(picture_of(frame.message), self._spec.width, self._spec.height))
        if self._video is None:
            height, width = picture.shape[:2]
            self._video = VideoFile(self._file, self._spec.file_type, self._spec.codec, width, height)
        written = self._video.write(picture, frame.stamp)
        return (self._video.width, self._video.height) if written else None

    def _end(self) -> None:
        file = self._file
        if file is None or file.closed:
            return
        try:
            if self._video is not None:
                self._video.close()
            else:
                file.discard()  # no frame came: an empty file is no video
        finally:
            if self._video is not None and not self._video.frames:
                self._video = None  # the disk was full before there was anything to be seen
            self._files.done(self._wanted)

    def _fill(self, report: VisionThread) -> None:
        report.path = str(self._file.path if self._file is not None else self._spec.path or "")

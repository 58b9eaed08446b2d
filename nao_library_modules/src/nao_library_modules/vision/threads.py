"""Threads for the pictures of any camera on ROS topics: streams in another size or rate, and recordings.

    rospy.init_node("lab_camera")
    with ImageThreads("~/videos") as threads:
        threads.stream("small", "usb_cam/image_raw", "usb_cam/small/image_raw", width=320, rate=5.0)
        film = threads.record("trial", "usb_cam/image_raw", "trial_1.mp4")
        ...
        print(film.stop().duration)

No robot is needed. Topics are of sensor_msgs/Image or CompressedImage and need not be there yet. Each thread has a
name, runs beside the others and reports its state (`report`).
"""

from __future__ import annotations

from typing import Any

from nao_library_msgs.msg import RecordedVideo, VisionThread

from ..ros.time_and_frames import RosClock
from .capture_jobs import CaptureJob, CaptureJobs, Stream, VideoRecording, VideoSpec
from .video import DEFAULT_RECORD_DIR, VIDEO_TYPES, VisionFiles, codec_name
from .vision_topics import VisionTopics


class ImageThread:
    """A stream or a recording that runs."""

    def __init__(self, job: CaptureJob, jobs: CaptureJobs) -> None:
        self.name = job.ident
        self._job = job
        self._jobs = jobs

    def report(self) -> VisionThread:
        """State, frames, rate and size now."""
        return self._job.report()

    def stop(self) -> VisionThread | RecordedVideo:
        """End it, and answer its report; of a recording the file, which is complete."""
        self._job.stop()
        self._jobs.remove(self.name)
        return self._job.video if isinstance(self._job, VideoRecording) else self._job.report()


class ImageThreads:
    """Streams and recordings of this node. Any thread; `close`, or the end of a `with`, ends them all.

    Args:
        folder: For videos; names lead nowhere else. "~" stands for the home of the user.
        topics: Subscriptions and publishers, where not those of this process's node.
        clock: Time, where not ROS time.
    """

    def __init__(self, folder: str = DEFAULT_RECORD_DIR, topics: Any = None, clock: Any = None) -> None:
        self._topics = topics or VisionTopics()
        self._clock = clock or RosClock()
        self._files = VisionFiles(folder)
        self._jobs = CaptureJobs()

    def stream(
        self, name: str, topic: str, topic_out: str, width: int = 0, height: int = 0, rate: float = 0.0
    ) -> ImageThread:
        """Pass the pictures of a topic on to another one, with their camera_info if there is one.

        Raises NaoError if a thread of that name runs, or the topic holds no pictures.

        Args:
            name: Of the thread.
            topic: Of the camera.
            topic_out: Of the stream; as JPEG if it ends in /compressed.
            width: Pixels; 0: in proportion to the height, or as it is.
            height: Pixels; 0: likewise.
            rate: Pictures a second at most; 0: all.
        """
        return self._start(Stream(name, topic, rate, self._topics, self._clock, topic_out, width, height))

    def record(
        self,
        name: str,
        topic: str,
        file: str,
        width: int = 0,
        height: int = 0,
        rate: float = 0.0,
        codec: str = "",
        overwrite: bool = False,
    ) -> ImageThread:
        """Record the pictures of a topic, each at the time at which it was taken.

        Raises NaoError if a thread of that name runs, the topic holds no pictures, or the file cannot be written.

        Args:
            name: Of the thread.
            topic: Of the camera.
            file: Name in the folder, .mp4 or .avi.
            width: As `stream` takes it.
            height: Likewise.
            rate: Pictures a second at most; 0: all.
            codec: h264, mpeg4, mjpeg or ffv1; empty: what fits the file.
            overwrite: Whether a file that is there may be replaced.
        """
        kind = self._files.file_type(file, "", VIDEO_TYPES)
        spec = VideoSpec(self._files.path(file, kind), kind, codec_name(codec, kind), width, height, overwrite)
        return self._start(VideoRecording(name, topic, rate, self._topics, self._clock, self._files, spec))

    def reports(self) -> list[VisionThread]:
        """State of all now, in the order of their names."""
        return [job.report() for job in self._jobs.known.values()]

    def close(self) -> None:
        """End all; files are complete afterwards."""
        self._jobs.close()

    def __enter__(self) -> ImageThreads:
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def _start(self, job: CaptureJob) -> ImageThread:
        self._jobs.add(job)
        try:
            job.start()
        except Exception:
            self._jobs.remove(job.ident)
            raise
        return ImageThread(job, self._jobs)

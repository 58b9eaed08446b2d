"""What the groups of NaoVision's functions share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ...base.cancellation import CancellationToken
from .cameras import camera_name
from .files import VisionFiles
from .jobs import CaptureJobs
from .taken import Taken


class VisionBase:
    """To be mixed into NaoBasic.

    Attributes:
        active_camera: The one that functions take which name none: top or bottom.
        camera_topic: Camera -> topic of its pictures.
        camera_servers: Camera -> where its node takes dynamic_reconfigure.
        files: Folder for pictures and videos.
        threads: Streams and recordings.
        topics: Subscriptions, publishers and settings of cameras.
        taken: What the chain has taken so far; new for each goal.
    """

    robot: Any  # Robot
    interrupt: CancellationToken
    clock: Any  # WallClock or RosClock
    kept: Any  # Kept, of NaoBasic
    call: Callable[..., Any]  # of NaoBasic: a call that preemption interrupts
    call_now: Callable[..., Any]  # of NaoBasic: a call that it does not
    after_wait: Callable[[Callable[[], None]], None]  # of NaoBasic
    active_camera: str
    camera_topic: Callable[[str], str]
    camera_servers: Mapping[str, str]
    files: VisionFiles
    threads: CaptureJobs
    topics: Any  # VisionTopics
    taken: Taken
    tell: Callable[..., None]  # of NaoVision: feedback

    def source(self, camera: str, topic: str) -> str:
        """Topic that frames come from: the one that is named, or that of a camera.

        Args:
            camera: As a goal has it.
            topic: Likewise.
        """
        named = topic.strip()
        return self.topics.resolved(named or self.camera_topic(camera_name(camera, self.active_camera)))

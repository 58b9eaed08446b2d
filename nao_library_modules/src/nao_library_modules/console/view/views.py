"""What the pages share of each robot: one live view, one set of senses, one feed a camera."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .alarm_watch import AlarmWatch
from .body_watch import BodyWatch
from .camera_feed import CAMERA_VIEWS, CameraFeed
from .live_view import LiveView
from .memory_topics import MemoryTopics
from .senses import Senses
from .simulator import Simulator


@dataclass(frozen=True)
class RobotViews:
    """Of one robot; nothing is listened to before somebody wants it."""

    robot: Any  # its RobotClient
    senses: Senses
    body: BodyWatch
    alarms: AlarmWatch
    simulator: Simulator
    live: LiveView
    cameras: Mapping[str, CameraFeed]


class Views:
    """Of all robots, made when a page or a trial first asks. Any thread.

    `folder`: of the studies.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._robots: dict[str, RobotViews] = {}

    def of(self, robot: Any) -> RobotViews:
        """Those of a RobotClient."""
        with self._lock:
            found = self._robots.get(robot.namespace)
            if found is None or found.robot is not robot:
                memory, simulator = MemoryTopics(robot), Simulator(robot)
                senses, body = Senses(robot, memory), BodyWatch(robot, memory)
                alarms = AlarmWatch(robot, body, self._folder)
                live = LiveView(robot, senses, memory, simulator)
                cameras = {name: CameraFeed(robot, name) for name in CAMERA_VIEWS}
                found = RobotViews(robot, senses, body, alarms, simulator, live, cameras)
                self._robots[robot.namespace] = found
            return found

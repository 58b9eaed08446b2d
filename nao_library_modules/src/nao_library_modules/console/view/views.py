"""What the pages share of each robot: one live view, one set of senses, one feed a camera."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from .camera_feed import NAMES, CameraFeed
from .live_view import LiveView
from .memory_topics import MemoryTopics
from .senses import Senses
from .simulator import Simulator


@dataclass(frozen=True)
class RobotViews:
    """Of one robot."""

    robot: Any  # its RobotClient
    senses: Senses
    simulator: Simulator
    memory: MemoryTopics
    live: LiveView
    cameras: dict[str, CameraFeed] = field(default_factory=dict)


class Views:
    """Of all robots, made when a page or a trial first asks. Event loop only."""

    def __init__(self) -> None:
        self._robots: dict[str, RobotViews] = {}

    def of(self, robot: Any) -> RobotViews:
        """Those of a RobotClient."""
        found = self._robots.get(robot.namespace)
        if found is None or found.robot is not robot:
            memory, simulator = MemoryTopics(robot), Simulator(robot)
            senses = Senses(robot, memory)
            live = LiveView(robot, senses, memory, simulator)
            cameras = {name: CameraFeed(robot, name) for name in NAMES}
            found = self._robots[robot.namespace] = RobotViews(robot, senses, simulator, memory, live, cameras)
        return found

"""Everything a module needs of a running ROS node, in one place that tests can replace."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rospy
from rospkg import get_ros_home

from nao_library_msgs.msg import MemoryEvent
from nao_library_msgs.srv import DescribeFunctions
from naoqi.errors import NaoError

from ..core.files import Kept
from ..core.geometry import Place
from ..core.health import Report
from ..core.memory_functions import json_of
from ..core.server_types import DESCRIBE
from .action_server import SOONEST_END, PromptActionServer
from .diagnostics import DiagnosticsPublisher
from .time_and_frames import RobotFrames, RosClock, tf_prefix

if TYPE_CHECKING:
    from .nao_robot_driver import NaoRobotDriver

EVENT_TOPIC = "memory_events"
LONGEST_SECONDS = 1.0
TYPES = {
    type(None): "null",
    bool: "bool",
    int: "int",
    float: "float",
    dict: "object",
    list: "list",
    tuple: "list",
}
"""Type of an event's value in Python -> in MemoryEvent; others are of type string."""


class ServerNode:
    """The ROS side of a module. Needs `rospy.init_node` before.

    Attributes:
        clock: ROS time.

    ROS API:
        Publishes `memory_events` (nao_library_msgs/MemoryEvent) and `/diagnostics`. Services NAME/describe
        (nao_library_msgs/DescribeFunctions). Listens to /tf when asked for a frame. Parameter `~soonest_end` (0.005 s):
        no goal that is taken up is over sooner; others as a module asks for them with `seconds`.
    """

    def __init__(self) -> None:
        """Make nothing yet: what a module does not use is not made."""
        self.clock = RosClock()
        self._frames: RobotFrames | None = None

    @property
    def namespace(self) -> str:
        return rospy.get_namespace()

    def frame_prefix(self) -> str:
        """Prefix of the robot's frames on /tf, with its slash; may be empty."""
        return tf_prefix()

    def action_server(
        self, name: str, action: type, execute: Callable[[Any], None], on_preempt: Callable[[], None]
    ) -> PromptActionServer:
        """Make an action server; it is not started.

        `execute` carries out a goal, in the server's own thread. `on_preempt` is called under actionlib's lock: it must
        do no more than set a flag.
        """
        server = PromptActionServer(name, action, execute, self.seconds("soonest_end", SOONEST_END))
        server.register_preempt_callback(on_preempt)
        return server

    def seconds(self, name: str, default: float) -> float:
        """A private parameter of the node that is a time, s. Raises NaoError if it is no time from 0 to 1 s."""
        value = rospy.get_param(f"~{name}", default)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 <= value <= LONGEST_SECONDS:
            raise NaoError(f"~{name} is {value!r}: 0 to {LONGEST_SECONDS:g} s")
        return float(value)

    def event_sink(self) -> Callable[[str, Any], None]:
        """A function that publishes an event of the robot's memory: name and value."""
        publisher = rospy.Publisher(EVENT_TOPIC, MemoryEvent, queue_size=100)

        def publish(name: str, value: Any) -> None:
            event = MemoryEvent(name=name, value=json_of(value), type=TYPES.get(type(value), "string"))
            event.header.stamp = rospy.Time.now()
            publisher.publish(event)

        return publish

    def publish_diagnostics(
        self, hardware_id: str, reports: Mapping[str, Callable[[], Report]]
    ) -> DiagnosticsPublisher:
        return DiagnosticsPublisher(hardware_id, reports)

    def serve_description(self, name: str, answer: Callable[[Any], Any]) -> None:
        """Answer what the functions of an action server are, on the service `NAME/describe`; see `serve`."""
        self.serve(name + DESCRIBE, DescribeFunctions, answer)

    def serve(self, name: str, kind: type, answer: Callable[[Any], Any]) -> None:
        """Answer a service: `answer` makes the response of a request, in a thread of each client."""
        rospy.Service(name, kind, answer)

    def subscribe(self, topic: str, kind: type, callback: Callable[[Any], None]) -> None:
        """Have every message of a topic, in a thread of each publisher, until the node ends."""
        rospy.Subscriber(topic, kind, callback, queue_size=1000)

    def driver(self) -> NaoRobotDriver:
        """The robot's driver, which may be there or not."""
        from .nao_robot_driver import NaoRobotDriver  # its actions are those of all modules, and one asks for it

        return NaoRobotDriver()

    def locate(self, frame: str) -> Place:
        """Where a frame of /tf is now, seen from above by the robot.

        Raises NaoError if it is not connected with the robot.
        """
        if self._frames is None:  # /tf is a busy topic: who never asks never listens
            self._frames = RobotFrames()
        return self._frames.locate(frame)

    def kept(self) -> Kept:
        """What users have set up in this node and is there again after its death."""
        return node_file(rospy.get_name())

    def on_shutdown(self, action: Callable[[], None]) -> None:
        """Call `action` when the node ends, while it can still publish."""
        rospy.on_shutdown(action)


def node_file(name: str) -> Kept:
    """The file of a node, or of a part of one, for this run of the ROS master. `name`: its full name."""
    file = name.strip("/").replace("/", "_")
    return Kept(Path(get_ros_home()) / "nao_library" / f"{file}.json", str(rospy.get_param("/run_id", "")))


class RosoutHandler(logging.Handler):
    """Passes on what the loggers of plain Python modules say to the log of the node."""

    _LEVELS = (
        (logging.CRITICAL, rospy.logfatal),
        (logging.ERROR, rospy.logerr),
        (logging.WARNING, rospy.logwarn),
        (logging.INFO, rospy.loginfo),
    )

    def emit(self, record: logging.LogRecord) -> None:
        """Log one record, at the same level."""
        text = self.format(record)
        for level, write in self._LEVELS:
            if record.levelno >= level:
                write("%s", text)
                return
        rospy.logdebug("%s", text)


def forward_logs(*names: str) -> None:
    """Pass on what these loggers say to the log of the node."""
    handler = RosoutHandler()
    for name in names:
        logger = logging.getLogger(name)
        logger.addHandler(handler)
        logger.setLevel(logging.INFO)
        logger.propagate = False

"""What driver nodes share: start, diagnostics, spin, parameters, names, topics that work only with subscribers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Sequence
from typing import Any

import rospy

from naoqi.errors import NaoError

from ...core.errors import RobotLost
from ...core.fields import limit, number_parameter
from ...core.health import connection_report
from ...core.processes import close_all
from ...core.robot import Robot
from ...ros.action_server import ConcurrentActionServer
from ...ros.diagnostics import DiagnosticsPublisher, Reports
from ...ros.driver_types import require_types
from ...ros.node import NodeProcess, being_made, own_as_node, robot_address, take_patience
from ...ros.node_interface import AlreadyOffered, NodeInterface
from ...ros.time_and_frames import tf_prefix


class LazyTopic(rospy.SubscribeListener):
    """Calls a function, which must not wait, when some topics get their first subscriber, and when the last one leaves.

    Callbacks come from threads of rospy, sometimes out of order: so each counts the subscribers, under a lock.

    Attributes:
        listened: Whether there are subscribers, as last reported.
    """

    def __init__(self, report: Callable[[bool], None], *publishers: rospy.Publisher, but: Collection[str] = ()) -> None:
        """`but` has the full names of nodes whose subscriptions do not count."""
        super().__init__()
        self._report = report
        self._publishers = publishers
        self._but = but
        self._lock = threading.Lock()
        self.listened = False
        # Not in the constructor of the publisher: the first subscriber would find none.
        for publisher in publishers:
            publisher.impl.add_subscriber_listener(self)
        self._look()

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Any) -> None:
        self._look()

    def peer_unsubscribe(self, topic_name: str, num_peers: int) -> None:
        self._look()

    def _look(self) -> None:
        with self._lock:
            listens = any(node not in self._but for publisher in self._publishers for node in listeners(publisher))
            if listens != self.listened:
                self.listened = listens
                self._report(listens)


def listeners(publisher: rospy.Publisher) -> list[str]:
    """Full names of the nodes that subscribe to a topic; none of one that was unregistered."""
    return [node for _, node, *_ in publisher.impl.get_stats_info()] if publisher.impl else []


RETRY = 1.0
"""s between two looks whether the services of a node that has to wait are free."""


def run_driver(
    make: Callable[[Robot, NodeInterface], Any],
    name: str,
    description: str,
    argv: Sequence[str] | None = None,
    watches: bool = False,
) -> int:
    """Start a driver node and keep it until it ends, see `NodeProcess`; returns the exit status.

    Args:
        make: Makes the node's object for a robot, which need not be there yet, and a side to ROS: it has `close()`, and
            `reports()` for /diagnostics. Raises NaoError for a wrong parameter.
        name: Default name of the node.
        description: The text of `--help`.
        argv: Arguments, those of the process by default.
        watches: As `run_module` takes it.

    ROS API:
        Parameters `~pip`, `~pport`: the robot; `patience`, see `take_patience`; `nao_driver/messages`, see
        `driver_types`. Publishes `/diagnostics`.
    """
    process = NodeProcess(name, description, argv)
    try:
        require_types()
        ip, port = robot_address(process.options, rospy.get_param)
        robot = Robot(ip, port)
        take_patience(robot)
        with being_made(name):
            node = _made(make, robot)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    own_as_node(robot, watches)
    reports = {"robot": lambda: connection_report(robot.address, robot.connection), **node.reports()}
    keep(process, robot, reports, node.close)
    return 0


def keep(
    process: NodeProcess, robot: Robot, reports: Reports | Callable[[], Reports], close: Callable[[], object]
) -> None:
    """Publish diagnostics as DiagnosticsPublisher takes them until the node ends, then close."""
    diagnostics = DiagnosticsPublisher(robot.address, reports)
    rospy.on_shutdown(lambda: close_all(close, diagnostics.close))
    process.spin()


def _made(make: Callable[[Robot, NodeInterface], Any], robot: Robot) -> Any:
    """The node's object; where another node has its services, when that has ended.

    Raises NaoError if it cannot be made.
    """
    logged = False
    while True:
        interface = NodeInterface()
        try:
            return make(robot, interface)
        except AlreadyOffered as error:
            interface.fail()
            if not logged:
                rospy.logerr("%s; this node waits for its end", error)
                logged = True
            if rospy.core.is_shutdown_requested():
                raise
            time.sleep(RETRY)


def interrupt_when_lost(robot: Robot, node: NodeInterface, *servers: ConcurrentActionServer) -> Callable[[], None]:
    """End the goals of servers whenever the robot is lost, and now if it is; call what it returns to end that."""

    def interrupt() -> None:
        connection = robot.connection
        lost = RobotLost(robot.address, connection.last_error or "no answer")
        for server in servers:
            server.interrupt_all(lost)

    return whenever(robot, node, "lost", interrupt)


def whenever(robot: Robot, node: NodeInterface, state: str, action: Callable[[], None]) -> Callable[[], None]:
    """Call `action` each time the connection gets into `state`, and at once if it is in it. Returns what ends that.

    The first call is made in this thread, later ones in the thread that the connection has for its listeners; `action`
    may call the robot. It ends, too, if the node cannot be made.
    """

    def changed(*_: Any) -> None:
        if robot.connection.state == state:
            action()

    def stop() -> None:
        robot.connection.remove_listener(changed)

    robot.connection.add_listener(changed)
    node.if_it_fails(stop)
    changed()
    return stop


def name_for_robot(name: str) -> str:
    """Name under which NAOqi knows a node, or a part of one: as a module, and as a subscriber of its modules."""
    return "ros" + name.replace("/", "_")


def publish(publisher: rospy.Publisher, message: Any) -> None:
    """Publish something from the robot: it may still come when this node has closed its topics."""
    try:
        publisher.publish(message)
    except rospy.ROSException as error:
        rospy.logdebug("%s: %s", publisher.name, error)


def frame_parameter(node: NodeInterface, name: str, default: str) -> str:
    """A parameter that names a frame, with the prefix of the robot's frames before it."""
    return tf_prefix() + str(node.param(name, default)).lstrip("/")


def number(node: NodeInterface, name: str, default: float, kind: str) -> float:
    """A parameter that is a number; NaoError if it is none within the declared bounds of its kind, see `limit`."""
    return number_parameter(name, node.param(name, default), limit(kind))

"""What all driver nodes do alike: arguments, robot, diagnostics, spin; names and messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import rospy

from naoqi.errors import NaoError

from ..diagnostics import DiagnosticsPublisher
from ..health import connection_report
from ..node import FORWARDED_LOGGERS, robot_address, robot_parser
from ..robot import Robot
from ..ros_edge import forward_logs
from .polling import FASTEST


def run_driver(make: Callable[[Robot], Any], name: str, description: str, argv: Sequence[str] | None = None) -> int:
    """Start a driver node and keep it until it ends.

    Args:
        make: Makes the node's object for a robot: it has `close()`, and `reports()` for /diagnostics.
        name: Default name of the node.
        description: What `--help` says.
        argv: Arguments, those of the process by default.

    Returns:
        Exit status.

    ROS API:
        Parameters `~pip`, `~pport`: the robot. Publishes `/diagnostics`.
    """
    arguments = rospy.myargv(argv)[1:]
    options = robot_parser(description).parse_args(arguments)
    rospy.init_node(name)
    forward_logs(*FORWARDED_LOGGERS)
    try:
        ip, port = robot_address(options, rospy.get_param)
        robot = Robot(ip, port)
        node = make(robot)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    reports = {"robot": lambda: connection_report(robot.address, robot.connection), **node.reports()}
    diagnostics = DiagnosticsPublisher(robot.address, reports)  # it puts the name of the node before each
    rospy.on_shutdown(node.close)
    rospy.on_shutdown(diagnostics.close)
    rospy.spin()
    return 0


def name_for_robot() -> str:
    """Name under which NAOqi knows this node: as a module, and as a subscriber of its modules."""
    return "ros" + rospy.get_name().replace("/", "_")


def publish(publisher: rospy.Publisher, message: Any) -> None:
    """Publish something that the robot has sent: it may still come when this node has closed its topics."""
    try:
        publisher.publish(message)
    except rospy.ROSException as error:
        rospy.logdebug("%s: %s", publisher.name, error)


def rate_parameter(name: str, default: float) -> float:
    """A parameter that is a rate in Hz.

    Raises:
        NaoError: If it is none that a node can keep.
    """
    rate = rospy.get_param(name, default)
    if isinstance(rate, bool) or not isinstance(rate, (int, float)) or not 0.0 < rate <= 1.0 / FASTEST:
        raise NaoError(f"{name} is {rate!r}: above 0 to {1.0 / FASTEST:g} Hz")
    return float(rate)

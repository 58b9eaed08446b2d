"""What all nodes do alike: arguments and parameters, log, spin."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import rospy

from naoqi.errors import NaoError

from .first_contact import require_patience
from .ros_edge import forward_logs

DEFAULT_IP = "127.0.0.1"
DEFAULT_PORT = 9559
FORWARDED_LOGGERS = ("naoqi", "nao_library_modules")


def robot_parser(description: str) -> argparse.ArgumentParser:
    """A parser with the options that every node has.

    An option that is not given is None, so that the node's parameter can take its place.
    """
    parser = argparse.ArgumentParser(
        description=description,
        epilog="The private parameters ~pip and ~pport stand in for options that are not given. "
        "Names and parameters are set with ROS remappings: name:=other, _parameter:=value.",
    )
    parser.add_argument("--pip", metavar="IP", help=f"address of the robot (default {DEFAULT_IP})")
    parser.add_argument("--pport", metavar="PORT", type=int, help=f"port of its NAOqi (default {DEFAULT_PORT})")
    return parser


def robot_address(options: argparse.Namespace, get_param: Callable[[str, Any], Any]) -> tuple[str, int]:
    """Address and port of the robot: command line, then parameter, then default.

    Args:
        options: What `robot_parser` gave.
        get_param: Gives a parameter by name, or the default given with it.

    Raises:
        NaoError: If the port is no port.
    """
    ip = options.pip if options.pip is not None else get_param("~pip", DEFAULT_IP)
    port = options.pport if options.pport is not None else get_param("~pport", DEFAULT_PORT)
    if isinstance(port, bool) or not isinstance(port, int) or not 0 < port < 65536:
        raise NaoError(f"port {port!r} is no port: 1..65535")
    return str(ip), port


def launch_path(value: Any) -> tuple[str, str] | None:
    """`(package, launchfile)` from a parameter: "package launchfile", a list of the two, or nothing.

    Raises:
        NaoError: If it is something else.
    """
    words = value.split() if isinstance(value, str) else value
    if not words:
        return None
    if isinstance(words, list) and len(words) == 2 and all(isinstance(word, str) for word in words):
        return words[0], words[1]
    raise NaoError(f"~launchpath {value!r}: it is 'package launchfile'")


def run_module(
    module: Callable[..., Any],
    name: str,
    description: str,
    argv: Sequence[str] | None = None,
    parameters: Mapping[str, Any] | None = None,
) -> int:
    """Start a module as a node and keep it until the node ends.

    Args:
        module: Class of the module.
        name: Default name of the node.
        description: What `--help` says.
        argv: Arguments, those of the process by default.
        parameters: Name -> default of further private parameters, which the module takes by name.

    Returns:
        Exit status.

    ROS API:
        Parameters `~pip`, `~pport`: the robot. `~autostart`, `~launchpath` ("package launchfile"): launch
        file to start with the module. `~patience`: s from the start for which goals wait for a robot that has never
        been reached (default 30).
    """
    arguments = rospy.myargv(argv)[1:]
    options = robot_parser(description).parse_args(arguments)
    rospy.init_node(name)
    forward_logs(*FORWARDED_LOGGERS)
    try:
        ip, port = robot_address(options, rospy.get_param)
        module(
            ip,
            port,
            autostart=bool(rospy.get_param("~autostart", False)),
            launchpath=launch_path(rospy.get_param("~launchpath", "")),
            **{name: rospy.get_param(f"~{name}", default) for name, default in (parameters or {}).items()},
            **_patience(),
        )
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    rospy.spin()
    return 0


def _patience() -> dict[str, float]:
    """The parameter, where it is set: a module may have been written without it."""
    return {"patience": require_patience(rospy.get_param("~patience"))} if rospy.has_param("~patience") else {}

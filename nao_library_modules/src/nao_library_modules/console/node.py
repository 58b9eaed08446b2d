"""The node of the console."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import Any

import rospy

from naoqi.errors import NaoError

from .app import LOOPBACK, PORT, Console, ConsoleSettings

NAME = "nao_console"
PARAMETERS = {"port": PORT, "listen": LOOPBACK[0], "users": "", "cert": "", "key": "", "buttons": "", "studies": ""}
"""Private parameters of the launched node, with their defaults."""
_PATHS = {"users": "users", "cert": "certificate", "key": "key", "buttons": "buttons", "studies": "studies"}


def serve_console(**settings: Any) -> None:
    """Make this process a node and serve pages until it is told to end; `settings`: of `ConsoleSettings`.

    Raises NaoError if it cannot begin.
    """
    made = ConsoleSettings(**settings)
    if not rospy.core.is_initialized():
        start_node()
    try:
        Console(made).serve()
    finally:
        rospy.signal_shutdown("the console has ended")


def start_node() -> None:
    """Become a node that leaves signals alone. Raises NaoError if there is no ROS master."""
    logging.getLogger("rosout").setLevel(logging.ERROR)
    try:
        rospy.get_master().getPid()
        rospy.init_node(NAME, argv=[NAME], anonymous=True, disable_signals=True, disable_rosout=True)
    except (rospy.ROSException, OSError) as error:
        raise NaoError(f"there is no ROS master to be a node of ({error}): launch the robot's stack first") from None


def run_launched() -> int:
    """Run the launched node, whose parameters stand for the options of `nao console`; returns the exit status."""
    rospy.init_node(NAME, disable_signals=True)
    given = {name: rospy.get_param(f"~{name}", default) for name, default in PARAMETERS.items()}
    paths = {field: Path(given.pop(name)).expanduser() for name, field in _PATHS.items() if given[name]}
    plain = {name: given[name] for name in ("port", "listen")}
    try:
        serve_console(**plain, **paths)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    return 0

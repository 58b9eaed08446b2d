"""The node nao_driver: all parts of the driver in one process, with one connection to the robot."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import rospy

from naoqi.errors import NaoError

from ..robot.robot import Robot
from ..ros.driver_types import require_types
from ..ros.health import Level, Report, connection_report
from ..ros.node import own_as_node, robot_address, start_node, take_patience
from ..ros.node_interface import NodeInterface
from ..ros.part_names import PartNames
from .base.node import keep
from .parts import ALL, PARTS, chosen, part_class

log = logging.getLogger(__name__)

NAME = "nao_driver"
RETRY = 5.0
"""s after which a part that could not be started is tried again."""


class DriverPart:
    """One part of the driver: started in a thread of its own, and tried again as long as that fails."""

    def __init__(self, word: str, robot: Any, names: Any) -> None:
        self.name = PARTS[word][0]
        self._full_name = rospy.resolve_name(self.name)[1:]
        self.started = threading.Event()
        self._word = word
        self._robot = robot
        self._names = names
        self._ended = threading.Event()
        self._problem = "it is being started"
        self._attempts = 0
        self._made: Any = None
        self._thread = threading.Thread(target=self._start, name=f"start of {word}", daemon=True)
        self._thread.start()

    def reports(self) -> Mapping[str, Callable[[], Report]]:
        """Whether the part runs, else why not, and its own reports."""
        made = self._made
        reports = {"part": self._report, **({} if made is None else made.reports())}
        return {f"{self._full_name}: {name}": report for name, report in reports.items()}

    def close(self) -> None:
        self._ended.set()
        self._thread.join()
        if self._made is not None:
            self._made.close()

    def _report(self) -> Report:
        values = {"failed attempts": str(self._attempts)}
        if self._made is not None:
            return Report(Level.OK, "runs", values)
        return Report(Level.ERROR if self._attempts else Level.OK, self._problem, values)

    def _start(self) -> None:
        while not self._ended.is_set():
            interface = NodeInterface(self.name)
            try:
                self._made = part_class(self._word)(self._robot, interface)
            except Exception as error:
                interface.fail()
                self._failed(error)
                self._ended.wait(RETRY)
            else:
                if self._attempts:
                    log.info("%s: started", self.name)
                self.started.set()
                self._names.add(interface.name, interface.offered)
                return

    def _failed(self, error: Exception) -> None:
        problem = str(error) if isinstance(error, NaoError) else f"unexpected error: {error!r}"
        if problem != self._problem:  # of several in a row only the first
            log.error("%s is not there: %s", self.name, problem, exc_info=not isinstance(error, NaoError))
        self._problem = problem
        self._attempts += 1


class Driver:
    """All chosen parts beside each other."""

    def __init__(self, robot: Any, words: Sequence[str], names: Any) -> None:
        """Start the parts. `names`: where their names are registered, see `PartNames`."""
        self._robot = robot
        self._names = names
        self.parts = [DriverPart(word, robot, names) for word in words]

    def reports(self) -> Mapping[str, Callable[[], Report]]:
        connection = lambda: connection_report(self._robot.address, self._robot.connection)  # noqa: E731
        reports: dict[str, Callable[[], Report]] = {f"{rospy.get_name()[1:]}: robot": connection}
        for part in self.parts:
            reports.update(part.reports())
        return reports

    def close(self) -> None:
        """End all parts, at the same time: each may take a moment until the robot stands, or is silent."""
        ends = [threading.Thread(target=part.close, name=f"end of {part.name}") for part in self.parts]
        for end in ends:
            end.start()
        for end in ends:
            end.join()
        self._names.close()


def run(description: str, argv: Sequence[str] | None = None) -> int:
    """Start the node and keep it until it ends; returns the exit status.

    A launched node whose name another node takes comes back when that one has ended.

    ROS API:
        Parameters `~pip`, `~pport`: the robot; `patience`, see `take_patience`; `nao_driver/messages`, see
        `driver_types`; `~parts` ("all"): words of `PARTS`; `~watches` (false): as `run_module` takes it. Publishes
        `/diagnostics`. Each part has the topics, services, actions and parameters that it has as a node of its own,
        under the same names.
    """
    options = start_node(NAME, description, argv)
    try:
        require_types()
        ip, port = robot_address(options, rospy.get_param)
        words = chosen(rospy.get_param("~parts", ALL))
        robot = Robot(ip, port)
        take_patience(robot)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    own_as_node(robot, watches=bool(rospy.get_param("~watches", False)))
    driver = Driver(robot, words, PartNames())
    keep(robot, driver.reports, driver.close)
    return 0

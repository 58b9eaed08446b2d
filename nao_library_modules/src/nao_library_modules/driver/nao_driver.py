"""The node nao_driver: all parts of the driver in one process, with one connection to the robot."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any

import rospy

from naoqi.errors import NaoError

from ..core.errors import did_you_mean
from ..core.health import Level, Report, connection_report
from ..core.robot import Robot
from ..ros.driver_types import require_types
from ..ros.master_api import PartNames
from ..ros.node import NodeProcess, own_as_node, robot_address, take_patience
from ..ros.node_interface import NodeInterface
from .base.driver_node import keep

log = logging.getLogger(__name__)

PARTS = {
    "controller": ("nao_controller", "joints.nao_controller.NaoController"),
    "joint_states": ("nao_joint_states", "joints.nao_joint_states.NaoJointStates"),
    "poses": ("pose_manager", "joints.pose_manager.PoseManager"),
    "walker": ("nao_walker", "walk.nao_walker.NaoWalker"),
    "path_follower": ("nao_path_follower", "path_follower.nao_path_follower.NaoPathFollower"),
    "footsteps": ("nao_footsteps", "walk.nao_footsteps.NaoFootsteps"),
    "moveto": ("naoqi_moveto", "walk.naoqi_moveto.NaoqiMoveTo"),
    "speech": ("nao_speech", "audio.nao_speech.NaoSpeech"),
    "microphone": ("nao_robot/microphone/naoqi_microphone", "audio.nao_microphone.NaoMicrophone"),
    "audio": ("nao_audio", "audio.nao_audio.NaoAudioServices"),
    "cameras": ("nao_camera", "camera.nao_camera.NaoCamera"),
    "vision": ("nao_vision", "sensors.nao_vision.NaoVisionServices"),
    "tactile": ("nao_tactile", "sensors.nao_tactile.NaoTactileNode"),
    "sonar": ("nao_sonar", "sensors.nao_sonar.NaoSonar"),
    "memory": ("nao_memory", "memory.nao_memory.NaoMemory"),
    "leds": ("nao_leds", "life.nao_leds.NaoLeds"),
    "behaviors": ("nao_behaviors", "life.nao_behaviors.NaoBehaviors"),
    "alife": ("nao_alife", "life.nao_alife.NaoAlife"),
    "diagnostics": ("nao_diagnostic_updater", "sensors.nao_diagnostic_updater.NaoDiagnosticUpdater"),
}
"""Word -> the name that the part has in ROS, relative; its class, in this package."""
ALL = "all"


def chosen(words: str | Sequence[str]) -> list[str]:
    """The named parts, in the order of the table: words between blanks, or a list of them; "all" stands for all.

    Raises NaoError if a part is unknown, or none is named.
    """
    named = words.split() if isinstance(words, str) else list(words)
    for word in named:
        if word not in PARTS and word != ALL:
            hint = did_you_mean(str(word), PARTS)
            raise NaoError(f"~parts: part {word!r} not found{hint}; known are {ALL}, {', '.join(PARTS)}")
    if not named:
        raise NaoError(f"~parts is empty: {ALL}, or some of {', '.join(PARTS)}")
    return [part for part in PARTS if ALL in named or part in named]


def part_class(part: str) -> Callable[..., Any]:
    module, _, name = PARTS[part][1].rpartition(".")
    return getattr(import_module(f".{module}", __package__), name)


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
        self._problem = "starting"
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
            log.error("%s cannot be started: %s", self.name, problem, exc_info=not isinstance(error, NaoError))
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
        """Close all parts at the same time: each may take a moment until the robot stands, or is silent."""
        ends = [threading.Thread(target=part.close, name=f"end of {part.name}") for part in self.parts]
        for end in ends:
            end.start()
        for end in ends:
            end.join()
        self._names.close()


def run(description: str, argv: Sequence[str] | None = None) -> int:
    """Start the node and keep it until it ends, see `NodeProcess`; returns the exit status.

    ROS API:
        Parameters `~pip`, `~pport`: the robot; `patience`, see `take_patience`; `nao_driver/messages`, see
        `driver_types`; `~parts` ("all"): words of `PARTS`; `~watches` (false): as `run_module` takes it. Publishes
        `/diagnostics`. Each part has the topics, services, actions and parameters that it has as a node of its own,
        under the same names.
    """
    process = NodeProcess(NAME, description, argv)
    try:
        require_types()
        ip, port = robot_address(process.options, rospy.get_param)
        words = chosen(rospy.get_param("~parts", ALL))
        robot = Robot(ip, port)
        take_patience(robot)
    except NaoError as error:
        rospy.logfatal("%s", error)
        return 1
    own_as_node(robot, watches=bool(rospy.get_param("~watches", False)))
    driver = Driver(robot, words, PartNames())
    keep(process, robot, driver.reports, driver.close)
    return 0

"""The node nao_diagnostic_updater: temperatures, stiffness, battery, and what kind of robot it is."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Mapping
from typing import Any

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from nao_library_msgs.msg import ConnectionState, RobotInfo, StringStamped
from nao_library_msgs.srv import GetRobotInfo, GetRobotInfoResponse
from naoqi.errors import NaoError, UnknownMethod, UnknownModule

from ...core.health import Report, Thresholds, body_reports, keys_of, network_reports, part_of
from ...core.memory_functions import json_of
from ...core.nao_facts import JointNames
from ...core.robot import ask
from ...core.waiting import CancellationToken
from ...ros.node_interface import NodeInterface
from ..base.driver_node import number, publish

log = logging.getLogger(__name__)

CONFIG = "RobotConfig/{}"
KEYS = {
    "head type": CONFIG.format("Head/Type"),
    "body type": CONFIG.format("Body/Type"),
    "head version": CONFIG.format("Head/Version"),
    "body version": CONFIG.format("Body/Version"),
    "arm version": CONFIG.format("Body/Device/LeftArm/Version"),
    "legs version": CONFIG.format("Body/Device/Legs/Version"),
    "left hand version": CONFIG.format("Body/Device/Hand/Left/Version"),
    "laser": CONFIG.format("Head/Device/Laser/Version"),
    "software": CONFIG.format("Body/SoftwareRequirement"),
    "body id": "Device/DeviceList/ChestBoard/BodyId",
    "head id": "RobotConfig/Head/FullHeadId",
}
"""Fact -> its key."""
TYPES = {"nao": 0, "romeo": 1, "juliette": 2, "pepper": 2}
"""As nao_library_msgs/RobotInfo numbers them. NAOqi calls a Pepper by its older name."""


def facts_of(values: Mapping[str, Any]) -> dict[str, str]:
    """Fact -> text, from key -> value; empty for a fact that the robot does not know."""
    return {fact: "" if values.get(key) is None else str(values[key]).strip() for fact, key in KEYS.items()}


def info_fields(facts: Mapping[str, str], joints: int) -> dict[str, Any]:
    """Fields of a nao_library_msgs/RobotInfo from `facts_of`.

    A NAO of 26 joints moves wrists and hands, and with 22 it does not.
    """
    kind = (facts["body type"] or facts["head type"] or "nao").lower()
    number = TYPES.get(kind, TYPES["nao"])
    nao = number == TYPES["nao"]
    return {
        "type": number,
        "model": ("nao_h25" if joints >= 26 else "nao_h21") if nao else kind,
        "head_version": facts["head version"],
        "body_version": facts["body version"],
        "arm_version": facts["arm version"],
        "has_laser": facts["laser"] not in ("", "0"),
        "has_extended_arms": False,
        "number_of_legs": 2 if nao or facts["legs version"] else 1,
        "number_of_arms": 2,
        "number_of_hands": 2 if not nao or joints >= 26 else 0,
    }


MEMORY, NETWORKS = "ALMemory", "ALConnectionManager"
SHUTDOWN_LIMIT = 3.0
DEFAULT_RATE = 0.5
THRESHOLDS = {
    "warning_threshold": "warm",
    "error_threshold": "hot",
    "cpu_warning_threshold": "head_warm",
    "cpu_error_threshold": "head_hot",
    "battery_warning_threshold": "low",
    "battery_error_threshold": "empty",
}
"""Parameter -> field of Thresholds."""


class NaoDiagnosticUpdater:
    """Temperatures, stiffness, battery and connection of one robot on /diagnostics.

    It works in wall-clock time: simulated time stands still exactly when the simulator is gone. Reports of a robot
    that cannot be reached are stale, and say so.

    ROS API:
        Publishes `/diagnostics` (diagnostic_msgs/DiagnosticArray): `nao_joint: JOINT` each, `nao_power: Battery`,
        `nao_power: Current`, `nao_cpu: Head Temperature`, `nao_wlan: Status`, `nao_ethernet: Status`; in a namespace
        that comes before each name. Relative names `connection` (nao_library_msgs/ConnectionState, latched) and
        `info` (nao_library_msgs/StringStamped, latched: facts of the robot as JSON).
        Service `get_robot_config` (nao_library_msgs/GetRobotInfo).
        Parameters `~update_rate` (0.5 Hz), `~warning_threshold` (68), `~error_threshold` (74): of joints, degC;
        `~cpu_warning_threshold` (100), `~cpu_error_threshold` (105): degC; `~battery_warning_threshold` (30),
        `~battery_error_threshold` (10): percent.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        self._robot = robot
        self._period = 1.0 / number(node, "~update_rate", DEFAULT_RATE, "report rate")
        defaults = vars(Thresholds())
        self._limits = Thresholds(
            **{field: number(node, f"~{name}", defaults[field], "setting") for name, field in THRESHOLDS.items()}
        )
        self._names = JointNames(robot)
        namespace = node.namespace.strip("/")
        self._prefix = f"/{namespace}/" if namespace else ""
        self._hardware = robot.address
        self._last: dict[str, Report] = {}
        self._told_facts: dict[str, str] = {}
        self._interrupt = CancellationToken()
        self._diagnostics = self._node.publisher("/diagnostics", DiagnosticArray, queue_size=10)
        self._info = self._node.publisher("info", StringStamped, queue_size=1, latch=True)
        self._connection = self._node.publisher("connection", ConnectionState, queue_size=10, latch=True)
        self._node.offer("get_robot_config", GetRobotInfo, self._robot_config)
        # After the service: a part that cannot offer it leaves no listener.
        robot.connection.add_listener(self._on_state, silence=True)
        self._on_state(robot.connection.state)
        self._thread = threading.Thread(target=self._run, name="diagnosis", daemon=True)
        self._thread.start()

    def reports(self) -> dict[str, Callable[[], Report]]:
        """Empty: it publishes its reports itself."""
        return {}

    def close(self) -> None:
        self._robot.connection.remove_listener(self._on_state)
        self._interrupt.stop()
        self._thread.join(SHUTDOWN_LIMIT)

    # --- connection -----------------------------------------------------------------------------------------------

    def _on_state(self, state: Any) -> None:
        """Called from the connection's thread for listeners."""
        connection = self._robot.connection
        message = ConnectionState(address=self._robot.address, state=str(state), connections=connection.generation)
        if connection.silent:
            message.state = ConnectionState.SILENT
        message.last_error = connection.last_error or ""
        message.header.stamp = rospy.Time.now()
        publish(self._connection, message)

    # --- facts ----------------------------------------------------------------------------------------------------

    def _robot_config(self, _request: Any) -> GetRobotInfoResponse:
        facts, joints = self._facts(), self._names.body
        return GetRobotInfoResponse(RobotInfo(**info_fields(facts, len(joints))))

    def _facts(self) -> dict[str, str]:
        keys = list(KEYS.values())
        return facts_of(dict(zip(keys, self._read(keys))))

    def _tell_facts(self) -> None:
        facts = self._facts()
        if facts == self._told_facts:
            return
        self._told_facts = facts
        body = facts["body id"]
        self._hardware = body if body not in ("", "0") else self._robot.address
        message = StringStamped(data=json_of({**facts, "address": self._robot.address}))
        message.header.stamp = rospy.Time.now()
        publish(self._info, message)

    # --- the thread -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        generation = None
        while not self._interrupt.is_set():
            try:
                if generation != self._robot.connection.generation:
                    self._tell_facts()
                    generation = self._robot.connection.generation
                self._last = self._look()
                self._publish(self._last)
            except NaoError as error:  # the log has it already, from the connection
                self._publish(self._last, str(error))
            except Exception:  # a mistake in here must not leave a node that lives and says nothing
                log.exception("the robot cannot be diagnosed")
            self._interrupt.wait(self._period)

    def _look(self) -> dict[str, Report]:
        joints = self._names.body
        keys = keys_of(joints)
        reports = body_reports(joints, dict(zip(keys, self._read(keys))), self._limits)
        try:
            networks = ask(self._robot, NETWORKS, "services")
        except (UnknownModule, UnknownMethod):
            networks = None
        return {**reports, **network_reports(networks)}

    def _read(self, keys: list[str]) -> list[Any]:
        return ask(self._robot, MEMORY, "getListData", keys)

    def _publish(self, reports: Mapping[str, Report], problem: str = "") -> None:
        message = DiagnosticArray()
        message.header.stamp = rospy.Time.now()
        for name, report in reports.items():
            status = DiagnosticStatus(level=int(report.level), name=self._prefix + name, message=report.message)
            status.hardware_id = f"{self._hardware}#{part_of(name)}"
            status.values = [KeyValue(key, value) for key, value in report.values.items()]
            if problem:
                status.level, status.message = DiagnosticStatus.STALE, f"{report.message} (before: {problem})"
            message.status.append(status)
        if message.status:
            publish(self._diagnostics, message)

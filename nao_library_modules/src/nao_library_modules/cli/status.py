"""How a robot and its servers do, gathered for `nao status`."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from .errors import CommandFailed, StackMissing
from .goals import start_node
from .output import table
from .robot_link import DirectRobot
from .stack import Stack

DIAGNOSTICS = "/diagnostics"
DIAGNOSTICS_TIME = 1.3
"""s to listen: every node reports once a second."""
LEVELS = ("ok", "warning", "error", "stale")


def read_status(stack: Stack) -> dict[str, Any]:
    """What there is to tell; what cannot be asked is None. Raises StackMissing if there are no servers."""
    names = stack.servers()
    reports = _Diagnostics()
    servers = {name: _server_state(stack, name) for name in names}
    ip, port = stack.robot_address()
    found: dict[str, Any] = {
        "robot": stack.namespace.strip("/") or "/",
        "address": f"{ip}:{port}",
        "master": stack.graph.uri,
        "connected": False,
        "silent": "",
        "battery": None,
        "awake": None,
        "posture": None,
        "stiffness": None,
        "servers": servers,
        "nodes": _driver_parts(stack),
        "diagnostics": None,
    }
    found.update(_robot_state((ip, port)))
    found["diagnostics"] = reports.result()
    found["silent"] = reports.silent(found["address"])
    return found


def _server_state(stack: Stack, name: str) -> dict[str, Any]:
    try:
        told = stack.describe(name, brief=True)
    except (StackMissing, CommandFailed) as error:
        return {"up": False, "connected": False, "running": [], "index": 0, "problem": error.message}
    running = list(told.running)
    return {"up": True, "connected": told.connected, "running": running, "index": told.index, "problem": ""}


def _driver_parts(stack: Stack) -> dict[str, list[str]]:
    """Node of the driver -> the nodes of nao_robot that are parts of it; relative names."""
    from ..driver.nao_driver import PARTS
    from ..ros.part_names import parts_among

    nodes, found = parts_among(stack.graph.services()), {}
    for part, _ in PARTS.values():
        node = nodes.get(stack.namespace + part)
        if node is not None:
            found.setdefault(node, []).append(part)
    return found


def _robot_state(address: tuple[str, int]) -> dict[str, Any]:
    from ..nao.body_devices import CHARGE

    try:
        with DirectRobot(address, limit=3.0) as robot:
            stiffnesses = list(robot.call("ALMotion", "getStiffnesses", "Body"))
            return {
                "connected": True,
                "battery": robot.memory("getListData", [CHARGE])[0],
                "awake": bool(robot.call("ALMotion", "robotIsWakeUp")),
                "posture": str(robot.call("ALRobotPosture", "getPosture")),
                "stiffness": {
                    "stiff": sum(value > 0.0 for value in stiffnesses),
                    "joints": len(stiffnesses),
                    "mean": sum(stiffnesses) / max(1, len(stiffnesses)),
                },
            }
    except StackMissing:
        return {}
    except CommandFailed as error:
        return {"connected": True, "problem": error.message}


class _Diagnostics:
    """The reports of all nodes, gathered while the rest is asked."""

    def __init__(self) -> None:
        from diagnostic_msgs.msg import DiagnosticArray

        start_node()
        import rospy

        self._lock = threading.Lock()
        self._reports: dict[str, Any] = {}
        self._began = time.monotonic()
        self._silent: dict[str, str] = {}
        self._subscriber = rospy.Subscriber(DIAGNOSTICS, DiagnosticArray, self._on_array)

    def _on_array(self, message: Any) -> None:
        """Called from a thread of ROS."""
        with self._lock:
            self._reports.update((status.name, status) for status in message.status)

    def silent(self, address: str) -> str:
        """What a node told, by the time of `result`, of a robot that does not answer for the moment; else empty."""
        return self._silent.get(address, "")

    def result(self) -> dict[str, Any]:
        """Counts by level, and the reports that are not ok."""
        threading.Event().wait(max(0.0, self._began + DIAGNOSTICS_TIME - time.monotonic()))
        self._subscriber.unregister()
        with self._lock:
            reports = list(self._reports.values())
        level = [LEVELS[_level_number(status.level) % len(LEVELS)] for status in reports]
        counts = {name: level.count(name) for name in LEVELS}
        problems = [
            {"name": status.name, "level": name, "message": status.message}
            for status, name in sorted(zip(reports, level), key=lambda pair: pair[0].name)
            if name != LEVELS[0]
        ]
        self._silent = silent_robots(reports)
        return {**counts, "problems": problems}


def silent_robots(reports: Iterable[Any]) -> dict[str, str]:
    """Address -> what a node reports of the robot there, of those that do not answer for the moment."""
    from ..ros.health import SILENT

    told = [({each.key: each.value for each in status.values}, status.message) for status in reports]
    return {values["address"]: text for values, text in told if values.get("state") == SILENT and "address" in values}


def _level_number(level: Any) -> int:
    return level[0] if isinstance(level, bytes) else int(level)


def status_lines(found: Mapping[str, Any]) -> Iterator[str]:
    from ..ros.part_names import PART_OF

    stiffness = found["stiffness"]
    reached = "SILENT" if found["silent"] else "connected" if found["connected"] else "NOT REACHED"
    rows = [
        ("robot", f"{found['robot']} at {found['address']}, {reached}"),
        ("master", found["master"]),
    ]
    if found["battery"] is not None:
        rows.append(("battery", f"{found['battery']:.0%}"))
    if found["posture"] is not None:
        rows.append(("posture", f"{found['posture']}, {'awake' if found['awake'] else 'at rest'}"))
    if stiffness is not None:
        rows.append(
            ("stiffness", f"{stiffness['stiff']} of {stiffness['joints']} joints, mean {stiffness['mean']:.2f}")
        )
    if found["silent"]:
        rows.append(("", found["silent"]))
    if found.get("problem"):
        rows.append(("problem", found["problem"]))
    yield from table(rows)
    yield "servers"
    yield from table([(name, _does(server)) for name, server in found["servers"].items()], "  ")
    if found["nodes"]:
        yield f"driver (rosservice call PART{PART_OF}NODE tells what a part has in ROS)"
        yield from table([(node, ", ".join(parts)) for node, parts in found["nodes"].items()], "  ")
    reports = found["diagnostics"]
    yield "diagnostics: " + ", ".join(
        f"{reports[level]} {level}" for level in LEVELS if reports[level] or level == "ok"
    )
    alike: dict[tuple[str, str], list[str]] = {}
    for problem in reports["problems"]:
        alike.setdefault((problem["level"], problem["message"]), []).append(problem["name"])
    for (level, message), names in alike.items():
        yield f"  {level}: {names[0] if len(names) == 1 else f'{len(names)} reports'}: {message}"


def _does(server: Mapping[str, Any]) -> str:
    if not server["up"]:
        return f"DOWN: {server['problem']}"
    running = server["running"]
    text = f"{server['index'] + 1}/{len(running)} {running[server['index']]}" if running else "idle"
    return text if server["connected"] else f"{text}, without a robot"

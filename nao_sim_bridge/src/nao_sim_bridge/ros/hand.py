"""Simulated hands as ROS services. Thin over `hands_control.py`."""

from __future__ import annotations

from typing import Callable

import rospy

from nao_library_msgs.srv import (
    ReleaseSensors,
    ReleaseSensorsRequest,
    ReleaseSensorsResponse,
    TouchSensors,
    TouchSensorsRequest,
    TouchSensorsResponse,
)
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.ros.limits import checked
from nao_sim_bridge.ros.success import success_service
from nao_sim_bridge.server.simulator_server import SimulatorServer
from nao_sim_bridge.server.task_success import success_of

KILLED = "the hand was sent away"


class RosHand:
    """Lets hands touch the robot.

    ROS API: services `~touch`, `~release` (nao_library_msgs).

    Args:
        private: What the names of its services begin with.
        stamp: ROS time of a time of the server's `now`, s.
    """

    def __init__(self, server: SimulatorServer, private: str, stamp: Callable[[float], rospy.Time]) -> None:
        self._server = server
        self._stamp = stamp
        self._services = [
            rospy.Service(f"{private}touch", TouchSensors, self._on_touch),
            success_service(f"{private}release", ReleaseSensors, ReleaseSensorsResponse, self._release, KILLED),
        ]

    def _on_touch(self, request: TouchSensorsRequest) -> TouchSensorsResponse:
        contacts: list[float | None] = []

        def begin() -> Task:
            checked(request)
            called = self._server.hands.touch(request.sensors, request.time.to_sec(), request.wait)
            return called.then(lambda hand: hand and hand.then(contacts.append))

        began = self._server.began
        success, message = success_of(begin, KILLED)
        response = TouchSensorsResponse(success=success, message=message)
        if contacts and contacts[0] is not None:
            response.contact = self._stamp(began + contacts[0])
        return response

    def _release(self, request: ReleaseSensorsRequest) -> Task:
        return self._server.hands.release(request.sensors)

"""Simulated hands as ROS services. Thin over `hands_control.py`."""

from __future__ import annotations

from nao_library_msgs.srv import (
    ReleaseSensors,
    ReleaseSensorsRequest,
    ReleaseSensorsResponse,
    TouchSensors,
    TouchSensorsRequest,
    TouchSensorsResponse,
)
from nao_sim_bridge.ros_success import success_service
from nao_sim_bridge.server import SimulatorServer
from nao_sim_bridge.sim.tasks import Task

KILLED = "the hand was sent away"


class RosHand:
    """Lets hands touch the robot.

    ROS API: services `~touch`, `~release` (nao_library_msgs).

    Args:
        server: The running simulator.
        private: What the names of its services begin with.
    """

    def __init__(self, server: SimulatorServer, private: str = "~") -> None:
        self._server = server
        self._services = [
            success_service(f"{private}touch", TouchSensors, TouchSensorsResponse, self._touch, KILLED),
            success_service(f"{private}release", ReleaseSensors, ReleaseSensorsResponse, self._release, KILLED),
        ]

    def _touch(self, request: TouchSensorsRequest) -> Task:
        return self._server.hands.touch(request.sensors, request.time.to_sec(), request.wait)

    def _release(self, request: ReleaseSensorsRequest) -> Task:
        return self._server.hands.release(request.sensors)

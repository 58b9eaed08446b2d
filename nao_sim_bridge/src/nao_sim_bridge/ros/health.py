"""The charger and the battery of the simulated robot as ROS services. Thin over `health_control.py`."""

from __future__ import annotations

from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse

from nao_library_msgs.srv import SetFloat, SetFloatRequest, SetFloatResponse
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.ros.success import success_service
from nao_sim_bridge.server.simulator_server import SimulatorServer

KILLED = "it was stopped"


class RosHealth:
    """Plugs the charger and sets the charge.

    ROS API: services `~plug_charger` (std_srvs/SetBool), `~set_battery` (nao_library_msgs/SetFloat; 0..1).

    Args:
        private: What the names of its services begin with.
    """

    def __init__(self, server: SimulatorServer, private: str = "~") -> None:
        self._server = server
        self._services = [
            success_service(f"{private}plug_charger", SetBool, SetBoolResponse, self._plug, KILLED),
            success_service(f"{private}set_battery", SetFloat, SetFloatResponse, self._set, KILLED),
        ]

    def _plug(self, request: SetBoolRequest) -> Task:
        return self._server.health.plug_charger(request.data)

    def _set(self, request: SetFloatRequest) -> Task:
        return self._server.health.set_battery_charge(request.data)

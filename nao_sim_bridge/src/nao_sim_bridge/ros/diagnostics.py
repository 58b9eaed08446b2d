"""How the simulation itself is, on /diagnostics: what of it has failed, and whether its thread runs."""

from __future__ import annotations

import time
from typing import Sequence

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from nao_sim_bridge.base.guard import Failure
from nao_sim_bridge.server.simulator_server import SimulatorServer

PERIOD = 1.0
NAME = "nao_sim: Simulation"


class RosDiagnostics:
    """Tells once a second what of the simulation has failed.

    ROS API:
        Publishes `/diagnostics` (diagnostic_msgs/DiagnosticArray): `nao_sim: Simulation`, a warning while something has
        failed since the start of the robot, with who it was, how often, and the last error of each.

    Args:
        server: The running simulator; of several robots that of the first.
    """

    def __init__(self, server: SimulatorServer) -> None:
        self._server = server
        self._next = 0.0
        self._publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=5)

    def tick(self) -> None:
        """Publish when it is time, which is that of the wall: simulated time may stand still."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + PERIOD
        status = status_of(self._server.simulation.shared.guard.failures())
        status.hardware_id = f"{self._server.options.address}:{self._server.broker.port}"
        message = DiagnosticArray(status=[status])
        message.header.stamp = rospy.Time.now()
        self._publisher.publish(message)


def status_of(failures: Sequence[Failure]) -> DiagnosticStatus:
    """What there is to say of failures."""
    status = DiagnosticStatus(level=DiagnosticStatus.OK, name=NAME, message="runs")
    if failures:
        status.level = DiagnosticStatus.WARN
        culprits = dict.fromkeys(failure.culprit for failure in failures)
        status.message = f"runs, but these have failed: {', '.join(culprits)}"
    for failure in failures:
        times = "once" if failure.count == 1 else f"{failure.count} times"
        status.values.append(KeyValue(failure.culprit, f"{times}: {failure.error}"))
    return status

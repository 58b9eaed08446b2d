"""The ports of the robots as parameters of ROS: nodes that were given port 0 find them there."""

from __future__ import annotations

import logging
import time
from typing import Mapping

import rospy

PERIOD = 1.0
"""s between two looks at the parameters. They are kept in this process: a look asks nobody."""
NAME = "bound_port"
log = logging.getLogger("nao_sim.ports")


def parameter(robot: str = "") -> str:
    """Name of the parameter: of a robot that is alone, or of one of several."""
    return f"{robot}/nao_sim/{NAME}" if robot else f"~{NAME}"


def ports_before(robots: int) -> tuple[int, ...]:
    """The ports that the robots had before this simulator was started again, as 0 where they had none.

    Clients that were connected come back there. A launch file sets the parameters to 0 when it starts.
    """
    names = [parameter()] if robots == 1 else [parameter(f"nao{number + 1}") for number in range(robots)]
    return tuple(int(rospy.get_param(name, 0)) for name in names)


class BoundPorts:
    """Tells the ports at once, and again when another launch file on the same master has set a parameter to 0.

    Args:
        ports: By the name of the robot; empty for one that is alone.
    """

    def __init__(self, ports: Mapping[str, int]) -> None:
        self._ports = {parameter(robot): port for robot, port in ports.items()}
        self._next = 0.0
        self.tick()

    def tick(self) -> None:
        """Look when it is time."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + PERIOD
        try:
            for name, port in self._ports.items():
                if rospy.get_param_cached(name, 0) != port:
                    rospy.set_param(name, port)
        except OSError as error:  # the master is away at this moment: that ends no robot
            log.warning("the ports are not told: the ROS master does not answer: %s", error)

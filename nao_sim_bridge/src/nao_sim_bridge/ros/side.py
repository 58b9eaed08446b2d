"""The simulator in ROS: clock, ground truth and control of the simulation. Thin over the server."""

from __future__ import annotations

import threading
from typing import Callable, Mapping

import rospy
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from nao_library_msgs.srv import (
    AdvanceTime,
    AdvanceTimeRequest,
    AdvanceTimeResponse,
    ResetWorld,
    ResetWorldRequest,
    ResetWorldResponse,
    TakePicture,
)
from nao_sim_bridge.base.record_dir import world_of_client
from nao_sim_bridge.ros.diagnostics import RosDiagnostics
from nao_sim_bridge.ros.film import RosFilm
from nao_sim_bridge.ros.robot import RosRobot
from nao_sim_bridge.ros.services import checked, success
from nao_sim_bridge.ros.things import RosSounds, RosThings
from nao_sim_bridge.server.simulator_server import SimulatorServer

# The clock is published at most this often, in s of wall time: every message wakes every node.
CLOCK_WALL_PERIOD = 0.002
LOOK_PERIOD = 0.1
"""s of wall time between two looks whether somebody listens, while nobody does."""


class RosSide:
    """Publishes what the simulator knows and takes commands about it.

    ROS API (relative names):
        Publishes `/clock` (rosgraph_msgs/Clock) when asked to.
        Services `~advance` (nao_library_msgs), `~reset`, `~factory_reset`, `~pause`, `~resume` (std_srvs/Empty),
        `~reset_world` (nao_library_msgs/ResetWorld), with more than one robot `~picture` (nao_library_msgs),
        which shows the first one, and those of `RosRobot` for each robot, `RosSounds`, `RosThings` and `RosFilm`.
        Publishes `/diagnostics`, see `RosDiagnostics`.

    Time in ROS goes on when a factory reset begins that of the robot anew.

    Args:
        server: The running simulator; of several robots that of the first.
        several: Several robots by name; empty for one that is alone.
    """

    def __init__(
        self, server: SimulatorServer, publish_clock: bool, several: Mapping[str, SimulatorServer] | None = None
    ) -> None:
        self._server = server
        self._robots = [RosRobot(one, publish_clock, name) for name, one in (several or {"": server}).items()]
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1) if publish_clock else None
        self._services = [
            rospy.Service("~advance", AdvanceTime, self._on_advance),
            rospy.Service("~reset", Empty, self._empty(server.reset)),
            rospy.Service("~factory_reset", Empty, self._empty(server.factory_reset)),
            rospy.Service("~reset_world", ResetWorld, self._on_reset_world),
            rospy.Service("~pause", Empty, self._empty(lambda: server.runner.pause())),
            rospy.Service("~resume", Empty, self._empty(lambda: server.runner.resume())),
        ]
        if several:
            self._services.append(rospy.Service("~picture", TakePicture, self._robots[0].on_picture))
        self._sounds = RosSounds(server)
        self._things = RosThings(server)
        self._film = RosFilm(server)
        self._diagnostics = RosDiagnostics(server)
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._publish, name="ros publisher", daemon=True)
        self._thread.start()
        rospy.on_shutdown(self.close)  # topics close next

    def close(self) -> None:
        self._closing.set()
        self._thread.join(1.0)

    def _publish(self) -> None:
        last = -1
        while not self._closing.is_set():
            call = self._server.simulation.shared.guard.call  # that of the present simulation
            call(self._diagnostics.tick)
            if self._clock is None and not any(robot.listened for robot in self._robots):
                self._closing.wait(LOOK_PERIOD)
                continue
            runner = self._server.runner
            passed = runner.wait_for_tick(last, timeout=0.5) is not None
            last = runner.ticks
            if self._clock is not None:  # also while time stands still: a node that has just started wants to know it
                call(self._tell_time)
            if not passed:
                continue
            for robot in self._robots:
                call(robot.tick)
            self._closing.wait(CLOCK_WALL_PERIOD)

    def _tell_time(self) -> None:
        self._clock.publish(rospy.Time.from_sec(self._server.now[1]))

    def _on_advance(self, request: AdvanceTimeRequest) -> AdvanceTimeResponse:
        snapshot = self._server.runner.advance(checked(request).time.to_sec()).result()
        return AdvanceTimeResponse(rospy.Time.from_sec(self._server.began + snapshot.time))

    def _on_reset_world(self, request: ResetWorldRequest) -> ResetWorldResponse:
        def reset() -> None:
            server = self._server
            server.factory_reset(world_of_client(checked(request).world, server.files, server.options.scene.world))

        return ResetWorldResponse(*success(reset))

    @staticmethod
    def _empty(action: Callable[[], object]) -> Callable[[EmptyRequest], EmptyResponse]:
        def call(_request: EmptyRequest) -> EmptyResponse:
            action()
            return EmptyResponse()

        return call

"""The simulator in ROS: clock, ground truth and control of the simulation. Thin over the server."""

from __future__ import annotations

import threading
import time
from typing import Any, Callable, Mapping, Sequence

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from nao_library_msgs import srv
from nao_sim_bridge.base.guard import Failure
from nao_sim_bridge.base.record_dir import world_of_client
from nao_sim_bridge.core.runner import FASTEST
from nao_sim_bridge.ros.bound_ports import BoundPorts
from nao_sim_bridge.ros.robot import RosRobot
from nao_sim_bridge.ros.services import ERRORS, checked, success_service
from nao_sim_bridge.ros.shapes import ShapesTopic
from nao_sim_bridge.ros.things import offer_sounds, offer_things
from nao_sim_bridge.server.simulator_server import SimulatorServer

# The clock is published at most this often, in s of wall time: every message wakes every node.
CLOCK_WALL_PERIOD = 0.002
LOOK_PERIOD = 0.1
"""s of wall time between two looks whether somebody listens, while nobody does."""
STATUS_PERIOD = 1.0
STATUS_NAME = "nao_sim: Simulation"
ASKED, REACHED = "speed asked", "speed reached"
"""Values of the status."""


class RosSide:
    """Publishes what the simulator knows and takes commands about it.

    ROS API (relative names):
        Publishes `/clock` (rosgraph_msgs/Clock) when asked to.
        Services `~advance` (nao_library_msgs), `~reset`, `~factory_reset`, `~pause`, `~resume` (std_srvs/Empty),
        `~set_speed` (nao_library_msgs/SetSpeed: simulated seconds per second, 0 for as fast as possible),
        `~reset_world`, `~vary`, `~film/start`, `~film/caption`, `~film/stop` (nao_library_msgs), with more than one
        robot `~picture` (nao_library_msgs), which shows the first one, and those of `RosRobot` for each robot,
        `offer_sounds` and `offer_things`.
        Publishes `/diagnostics`, see `RosDiagnostics`, and `~shapes`, see `ShapesTopic`.
        Sets `~bound_port`, or `nao1/nao_sim/bound_port` and so on for several robots, see `BoundPorts`.

    Time in ROS goes on when a factory reset begins that of the robot anew.

    Args:
        server: The running simulator; of several robots that of the first.
        several: Several robots by name; empty for one that is alone.
    """

    def __init__(
        self, server: SimulatorServer, publish_clock: bool, several: Mapping[str, SimulatorServer] | None = None
    ) -> None:
        self._server = server
        # Before the services: who waits for these may ask for it.
        self._ports = BoundPorts({name: one.broker.port for name, one in (several or {"": server}).items()})
        self._robots = [RosRobot(one, publish_clock, name) for name, one in (several or {"": server}).items()]
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1) if publish_clock else None
        rospy.Service("~advance", srv.AdvanceTime, self._on_advance)
        rospy.Service("~reset", Empty, _empty(server.reset))
        rospy.Service("~factory_reset", Empty, _empty(server.factory_reset))
        success_service("~reset_world", srv.ResetWorld, self._reset_world)
        success_service("~vary", srv.VaryScene, lambda request: server.vary(**_fields(request)))
        rospy.Service("~pause", Empty, _empty(lambda: server.runner.pause()))
        rospy.Service("~resume", Empty, _empty(lambda: server.runner.resume()))
        success_service("~set_speed", srv.SetSpeed, lambda r: server.runner.set_speed(r.speed if r.speed else FASTEST))
        if several:
            rospy.Service("~picture", srv.TakePicture, self._robots[0].on_picture)
        offer_sounds(server)
        offer_things(server)
        rospy.Service("~film/start", srv.StartFilm, self._on_film_start)
        success_service("~film/caption", srv.CaptionFilm, lambda request: server.film.caption(request.text))
        rospy.Service("~film/stop", srv.StopFilm, self._on_film_stop)
        self._diagnostics = RosDiagnostics(server)
        self._shapes = ShapesTopic(server)
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
            call(self._shapes.tick)
            call(self._ports.tick)
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

    def _on_advance(self, request: srv.AdvanceTimeRequest) -> srv.AdvanceTimeResponse:
        snapshot = self._server.runner.advance(checked(request).time.to_sec()).result()
        return srv.AdvanceTimeResponse(rospy.Time.from_sec(self._server.began + snapshot.time))

    def _reset_world(self, request: srv.ResetWorldRequest) -> None:
        server = self._server
        server.factory_reset(world_of_client(request.world, server.files, server.options.scene.world))

    def _on_film_start(self, request: srv.StartFilmRequest) -> dict[str, Any]:
        try:
            checked(request)
            film = self._server.film.start(
                request.file, request.view, request.width, request.height, request.frame_rate
            )
            return {"success": True, "path": film.result()}
        except ERRORS as error:
            return {"success": False, "message": str(error)}

    def _on_film_stop(self, _request: srv.StopFilmRequest) -> dict[str, Any]:
        try:
            film = self._server.film.stop().result()
        except ERRORS as error:
            return {"success": False, "message": str(error)}
        length = rospy.Duration.from_sec(film.duration)
        return {"success": True, "path": str(film.path), "frames": film.frames, "length": length}


def _fields(request: Any) -> dict[str, Any]:
    return {name: getattr(request, name) for name in request.__slots__}


def _empty(action: Callable[[], object]) -> Callable[[EmptyRequest], EmptyResponse]:
    def call(_request: EmptyRequest) -> EmptyResponse:
        action()
        return EmptyResponse()

    return call


class RosDiagnostics:
    """Tells once a second what of the simulation has failed.

    ROS API:
        Publishes `/diagnostics` (diagnostic_msgs/DiagnosticArray): `nao_sim: Simulation`, a warning while something has
        failed since the start of the robot, with who it was, how often, and the last error of each. While time passes
        also `speed asked` (inf: as fast as possible) and `speed reached` since the last report: simulated seconds per
        second of this computer.

    Args:
        server: The running simulator; of several robots that of the first.
    """

    def __init__(self, server: SimulatorServer) -> None:
        self._server = server
        self._speed = SpeedMeter()
        self._next = 0.0
        self._publisher = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=5)

    def tick(self) -> None:
        """Publish when it is time, which is that of the wall: simulated time may stand still."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + STATUS_PERIOD
        status = status_of(self._server.simulation.shared.guard.failures())
        runner = self._server.runner
        passed = runner.ticks * self._server.simulation.settings.tick_s
        reached = self._speed.reached(now, passed, None if runner.paused else runner.speed)
        if reached is not None:
            status.values += [KeyValue(ASKED, f"{runner.speed:g}"), KeyValue(REACHED, f"{reached:.3f}")]
        status.hardware_id = f"{self._server.options.address}:{self._server.broker.port}"
        message = DiagnosticArray(status=[status])
        message.header.stamp = rospy.Time.now()
        self._publisher.publish(message)


class SpeedMeter:
    """How fast simulated time passes, from one look to the next."""

    def __init__(self) -> None:
        self._last: tuple[float, float, float | None] | None = None

    def reached(self, now: float, passed: float, asked: float | None) -> float | None:
        """Simulated seconds per second since the last look; None where the asked speed has changed meanwhile.

        Args:
            now: s of this computer.
            passed: s of simulated time in all.
            asked: Speed that is asked for; None while time stands still.
        """
        last, self._last = self._last, (now, passed, asked)
        if last is None or asked is None or last[2] != asked or now <= last[0]:
            return None
        return (passed - last[1]) / (now - last[0])


def status_of(failures: Sequence[Failure]) -> DiagnosticStatus:
    """What there is to say of failures."""
    status = DiagnosticStatus(level=DiagnosticStatus.OK, name=STATUS_NAME, message="runs")
    if failures:
        status.level = DiagnosticStatus.WARN
        culprits = dict.fromkeys(failure.culprit for failure in failures)
        status.message = f"runs, but these have failed: {', '.join(culprits)}"
    for failure in failures:
        times = "once" if failure.count == 1 else f"{failure.count} times"
        status.values.append(KeyValue(failure.culprit, f"{times}: {failure.error}"))
    return status

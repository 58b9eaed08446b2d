"""The simulator in ROS: clock, ground truth and control of the simulation. Thin over the server."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Callable

import rospy
from geometry_msgs.msg import Point, Quaternion, Twist, Vector3
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty, EmptyResponse

from nao_library_msgs.srv import (
    AdvanceTime,
    AdvanceTimeResponse,
    GetTruepose,
    GetTrueposeResponse,
    PressSensors,
    PressSensorsResponse,
    PushRobot,
    PushRobotResponse,
    TakePicture,
    TakePictureResponse,
)
from nao_sim_bridge.ros_sounds import RosSounds
from nao_sim_bridge.ros_things import RosThings
from nao_sim_bridge.server import SimulatorServer
from nao_sim_bridge.sim.snapshot import Snapshot

TRUTH_PERIOD = 0.02
# The clock is published at most this often, in s of wall time: every message wakes every node.
CLOCK_WALL_PERIOD = 0.002
WORLD_FRAME, TORSO_FRAME = "world", "torso"


class RosSide:
    """Publishes what the simulator knows and takes commands about it.

    ROS API (relative names):
        Publishes `ground_truth/odom` (nav_msgs/Odometry): true pose of the torso in world, velocity in torso; 50 Hz of
        simulated time. `/clock` (rosgraph_msgs/Clock) when asked to.
        Services `~advance`, `~push`, `~press`, `~picture` (nao_library_msgs), `~reset`, `~pause`, `~resume`
        (std_srvs/Empty), `get_truepose` (nao_library_msgs/GetTruepose), and those of `RosSounds` and `RosThings`.

    Args:
        server: The running simulator.
        publish_clock: Whether to publish `/clock`.
    """

    def __init__(self, server: SimulatorServer, publish_clock: bool) -> None:
        self._server = server
        self._clock = rospy.Publisher("/clock", Clock, queue_size=1) if publish_clock else None
        self._truth = rospy.Publisher("ground_truth/odom", Odometry, queue_size=5)
        self._services = [
            rospy.Service("~advance", AdvanceTime, self._on_advance),
            rospy.Service("~push", PushRobot, self._on_push),
            rospy.Service("~press", PressSensors, self._on_press),
            rospy.Service("~picture", TakePicture, self._on_picture),
            rospy.Service("~reset", Empty, self._empty(self._server.reset)),
            rospy.Service("~pause", Empty, self._empty(self._server.runner.pause)),
            rospy.Service("~resume", Empty, self._empty(self._server.runner.resume)),
            rospy.Service("get_truepose", GetTruepose, self._on_true_pose),
        ]
        self._sounds = RosSounds(server.sounds)
        self._things = RosThings(server.things)
        self._closing = threading.Event()
        rospy.on_shutdown(self.close)  # topics close next
        self._thread = threading.Thread(target=self._publish, name="ros publisher", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop publishing."""
        self._closing.set()
        self._thread.join(1.0)

    def _publish(self) -> None:
        last, next_truth = -1, 0.0
        while not self._closing.is_set():
            snapshot = self._server.runner.wait_for_tick(last, timeout=0.5)
            if snapshot is None:
                if self._clock is not None:  # time stands still; a node that has just started wants to know it
                    self._clock.publish(rospy.Time.from_sec(self._server.runner.snapshot.time))
                continue
            last = snapshot.tick
            if self._clock is not None:
                self._clock.publish(rospy.Time.from_sec(snapshot.time))
            if snapshot.time >= next_truth:
                next_truth = snapshot.time + TRUTH_PERIOD
                if self._truth.get_num_connections():
                    self._truth.publish(self._odometry(snapshot))
            self._closing.wait(CLOCK_WALL_PERIOD)

    def _odometry(self, snapshot: Snapshot) -> Odometry:
        message = Odometry()
        message.header.stamp = self._stamp(snapshot)
        message.header.frame_id, message.child_frame_id = WORLD_FRAME, TORSO_FRAME
        message.pose.pose.position = Point(*snapshot.torso.position)
        message.pose.pose.orientation = Quaternion(*snapshot.torso.orientation)
        message.twist.twist = Twist(Vector3(*snapshot.velocity_in_torso), Vector3(*snapshot.turn_in_torso))
        return message

    def _stamp(self, snapshot: Snapshot) -> rospy.Time:
        """ROS time of a snapshot: simulated time when this node publishes the clock, else now."""
        return rospy.Time.from_sec(snapshot.time) if self._clock is not None else rospy.Time.now()

    def _on_advance(self, request: AdvanceTime) -> AdvanceTimeResponse:
        snapshot = self._server.runner.advance(request.time.to_sec()).result()
        return AdvanceTimeResponse(rospy.Time.from_sec(snapshot.time))

    def _on_push(self, request: PushRobot) -> PushRobotResponse:
        force = (request.force.x, request.force.y, request.force.z)
        push = lambda: self._server.push(force, request.time.to_sec(), request.link or TORSO_FRAME)  # noqa: E731
        return PushRobotResponse(*_success(push))

    def _on_press(self, request: PressSensors) -> PressSensorsResponse:
        return PressSensorsResponse(*_success(lambda: self._server.press(request.sensors)))

    def _on_picture(self, request: TakePicture) -> TakePictureResponse:
        size = (request.width or 640, request.height or 480)
        path = Path()

        def take() -> None:
            nonlocal path
            path = self._server.files.to_write(request.file or "picture.png")
            path.write_bytes(self._server.picture(request.view or "three_quarter", *size))

        success, message = _success(take)
        return TakePictureResponse(success, message, str(path) if success else "")

    def _on_true_pose(self, _request: GetTruepose) -> GetTrueposeResponse:
        snapshot = self._server.runner.snapshot
        answer = GetTrueposeResponse()
        answer.pose.header.stamp = self._stamp(snapshot)
        answer.pose.header.frame_id = WORLD_FRAME
        answer.pose.pose.pose.position = Point(*snapshot.torso.position)
        answer.pose.pose.pose.orientation = Quaternion(*snapshot.torso.orientation)
        return answer

    @staticmethod
    def _empty(action: Callable[[], object]) -> Callable[[Empty], EmptyResponse]:
        def call(_request: Empty) -> EmptyResponse:
            action()
            return EmptyResponse()

        return call


def _success(action: Callable[[], object]) -> tuple[bool, str]:
    """Run `action`; (True, "") or (False, what was wrong)."""
    try:
        action()
    except (RuntimeError, ValueError, OSError) as error:
        return False, str(error)
    return True, ""

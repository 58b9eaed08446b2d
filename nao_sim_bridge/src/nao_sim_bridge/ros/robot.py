"""One simulated robot in ROS: its true pose, pushes, touches and pictures. Thin over its server."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

import rospy
from geometry_msgs.msg import Point, Quaternion, Twist, Vector3
from nav_msgs.msg import Odometry

from nao_library_msgs.srv import (
    GetTruepose,
    GetTrueposeRequest,
    GetTrueposeResponse,
    PressSensors,
    PressSensorsRequest,
    PressSensorsResponse,
    PushRobot,
    PushRobotRequest,
    PushRobotResponse,
    TakePicture,
    TakePictureRequest,
    TakePictureResponse,
)
from nao_sim_bridge.base.record_dir import unused
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.ros.hand import RosHand
from nao_sim_bridge.ros.health import RosHealth
from nao_sim_bridge.ros.limits import checked
from nao_sim_bridge.server.simulator_server import SimulatorServer

TRUTH_PERIOD = 0.02
PICTURE = "picture.png"
WORLD_FRAME, TORSO_FRAME = "world", "torso"


class RosRobot:
    """Publishes where a robot is and takes commands about it.

    ROS API (relative names; of several robots those of `nao2` are `nao2/ground_truth/odom`, `nao2/nao_sim/push`...):
        Publishes `ground_truth/odom` (nav_msgs/Odometry): true pose of the torso in world, velocity in torso; 50 Hz of
        simulated time.
        Services `~push`, `~press`, `~picture` (nao_library_msgs), `get_truepose` (nao_library_msgs/GetTruepose),
        and those of `RosHealth` and `RosHand`.

    Args:
        server: Of the robot.
        simulated_time: Whether time of messages is simulated time: this node publishes the clock.
        name: Of one of several robots; empty for one that is alone.
    """

    def __init__(self, server: SimulatorServer, simulated_time: bool, name: str = "") -> None:
        self._server = server
        self._simulated_time = simulated_time
        self._frame = f"{name}/{TORSO_FRAME}" if name else TORSO_FRAME
        self._next_truth = 0.0
        public, private = (f"{name}/", f"{name}/nao_sim/") if name else ("", "~")
        self._truth = rospy.Publisher(f"{public}ground_truth/odom", Odometry, queue_size=5)
        self._services = [
            rospy.Service(f"{private}push", PushRobot, self._on_push),
            rospy.Service(f"{private}press", PressSensors, self._on_press),
            rospy.Service(f"{private}picture", TakePicture, self.on_picture),
            rospy.Service(f"{public}get_truepose", GetTruepose, self._on_true_pose),
        ]
        self._health = RosHealth(server, private)
        self._hand = RosHand(server, private, self._stamp)

    @property
    def listened(self) -> bool:
        """Whether somebody wants what `tick` publishes."""
        return self._truth.get_num_connections() > 0

    def tick(self) -> None:
        """Publish what is due."""
        snapshot, now = self._server.now
        if now >= self._next_truth:
            self._next_truth = now + TRUTH_PERIOD
            if self.listened:
                self._truth.publish(self._odometry(snapshot, now))

    def on_picture(self, request: TakePictureRequest) -> TakePictureResponse:
        """Take a picture; one without a name replaces none."""
        size = (request.width or 640, request.height or 480)
        path = Path()

        def take() -> None:
            nonlocal path
            checked(request)
            path = self._server.files.to_keep(request.file or PICTURE)
            picture = self._server.picture(request.view or "three_quarter", *size)
            path = path if request.file else unused(path)
            write_whole(path, picture)

        success, message = _success(take)
        return TakePictureResponse(success, message, str(path) if success else "")

    def _odometry(self, snapshot: Snapshot, now: float) -> Odometry:
        message = Odometry()
        message.header.stamp = self._stamp(now)
        message.header.frame_id, message.child_frame_id = WORLD_FRAME, self._frame
        message.pose.pose.position = Point(*snapshot.torso.position)
        message.pose.pose.orientation = Quaternion(*snapshot.torso.orientation)
        message.twist.twist = Twist(Vector3(*snapshot.velocity_in_torso), Vector3(*snapshot.turn_in_torso))
        return message

    def _stamp(self, now: float) -> rospy.Time:
        """ROS time of a time of the server's `now`, s: the same if this node publishes the clock."""
        if self._simulated_time:
            return rospy.Time.from_sec(now)
        return rospy.Time.now() - rospy.Duration.from_sec(self._server.now[1] - now)

    def _on_push(self, request: PushRobotRequest) -> PushRobotResponse:
        force = (request.force.x, request.force.y, request.force.z)

        def push() -> None:
            checked(request)
            self._server.push(force, request.time.to_sec(), request.link or TORSO_FRAME)

        return PushRobotResponse(*_success(push))

    def _on_press(self, request: PressSensorsRequest) -> PressSensorsResponse:
        return PressSensorsResponse(*_success(lambda: self._server.press(checked(request).sensors)))

    def _on_true_pose(self, _request: GetTrueposeRequest) -> GetTrueposeResponse:
        snapshot, now = self._server.now
        answer = GetTrueposeResponse()
        answer.pose.header.stamp = self._stamp(now)
        answer.pose.header.frame_id = WORLD_FRAME
        answer.pose.pose.pose.position = Point(*snapshot.torso.position)
        answer.pose.pose.pose.orientation = Quaternion(*snapshot.torso.orientation)
        return answer


def _success(action: Callable[[], object]) -> tuple[bool, str]:
    """Run `action`; (True, "") or (False, what was wrong)."""
    try:
        action()
    except (RuntimeError, ValueError, OSError) as error:
        return False, str(error)
    return True, ""

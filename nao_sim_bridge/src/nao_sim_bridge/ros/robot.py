"""One simulated robot in ROS: its true pose, pushes, touches, pictures and health. Thin over its server."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

import rospy
from geometry_msgs.msg import Point, Quaternion, Twist, Vector3
from nav_msgs.msg import Odometry
from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse

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
    ReleaseSensors,
    ReleaseSensorsRequest,
    ReleaseSensorsResponse,
    SetFloat,
    SetFloatRequest,
    SetFloatResponse,
    TakePicture,
    TakePictureRequest,
    TakePictureResponse,
    TouchSensors,
    TouchSensorsRequest,
    TouchSensorsResponse,
)
from nao_sim_bridge.base.record_dir import unused
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.ros.services import checked, success, success_of, success_service
from nao_sim_bridge.server.simulator_server import SimulatorServer

TRUTH_PERIOD = 0.02
PICTURE = "picture.png"
WORLD_FRAME, TORSO_FRAME = "world", "torso"
SENT_AWAY = "the hand was sent away"
STOPPED = "it was stopped"


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

        taken, message = success(take)
        return TakePictureResponse(taken, message, str(path) if taken else "")

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

        return PushRobotResponse(*success(push))

    def _on_press(self, request: PressSensorsRequest) -> PressSensorsResponse:
        return PressSensorsResponse(*success(lambda: self._server.press(checked(request).sensors)))

    def _on_true_pose(self, _request: GetTrueposeRequest) -> GetTrueposeResponse:
        snapshot, now = self._server.now
        answer = GetTrueposeResponse()
        answer.pose.header.stamp = self._stamp(now)
        answer.pose.header.frame_id = WORLD_FRAME
        answer.pose.pose.pose.position = Point(*snapshot.torso.position)
        answer.pose.pose.pose.orientation = Quaternion(*snapshot.torso.orientation)
        return answer


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
            success_service(f"{private}release", ReleaseSensors, ReleaseSensorsResponse, self._release, SENT_AWAY),
        ]

    def _on_touch(self, request: TouchSensorsRequest) -> TouchSensorsResponse:
        contacts: list[float | None] = []

        def begin() -> Task:
            checked(request)
            called = self._server.hands.touch(request.sensors, request.time.to_sec(), request.wait)
            return called.then(lambda hand: hand and hand.then(contacts.append))

        began = self._server.began
        touched, message = success_of(begin, SENT_AWAY)
        response = TouchSensorsResponse(success=touched, message=message)
        if contacts and contacts[0] is not None:
            response.contact = self._stamp(began + contacts[0])
        return response

    def _release(self, request: ReleaseSensorsRequest) -> Task:
        return self._server.hands.release(request.sensors)


class RosHealth:
    """Plugs the charger and sets the charge.

    ROS API: services `~plug_charger` (std_srvs/SetBool), `~set_battery` (nao_library_msgs/SetFloat; 0..1).
    """

    def __init__(self, server: SimulatorServer, private: str = "~") -> None:
        self._server = server
        self._services = [
            success_service(f"{private}plug_charger", SetBool, SetBoolResponse, self._plug, STOPPED),
            success_service(f"{private}set_battery", SetFloat, SetFloatResponse, self._set, STOPPED),
        ]

    def _plug(self, request: SetBoolRequest) -> Task:
        return self._server.health.plug_charger(request.data)

    def _set(self, request: SetFloatRequest) -> Task:
        return self._server.health.set_battery_charge(request.data)

"""One simulated robot in ROS: its true pose, pushes, touches, pictures and health. Thin over its server."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import rospy
from geometry_msgs.msg import Point, Quaternion, Twist, Vector3
from nav_msgs.msg import Odometry
from std_srvs.srv import SetBool

from nao_library_msgs import srv
from nao_sim_bridge.base.record_dir import unused
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.ros.services import checked, success_of, success_service
from nao_sim_bridge.server.simulator_server import SimulatorServer

TRUTH_RATE = 50.0
"""Hz of simulated time."""
PICTURE = "picture.png"
WORLD_FRAME, TORSO_FRAME = "world", "torso"
SENT_AWAY = "the hand was sent away"


class RosRobot:
    """Publishes where a robot is and takes commands about it.

    ROS API (relative names; of several robots those of `nao2` are `nao2/ground_truth/odom`, `nao2/nao_sim/push`...):
        Publishes `ground_truth/odom` (nav_msgs/Odometry): true pose of the torso in world, velocity in torso; 50 Hz of
        simulated time.
        Services `~push`, `~press`, `~touch`, `~release`, `~picture`, `~set_battery` (nao_library_msgs; SetFloat, 0..1),
        `~plug_charger` (std_srvs/SetBool), `get_truepose` (nao_library_msgs/GetTruepose).

    Args:
        server: Of the robot.
        simulated_time: Whether time of messages is simulated time: this node publishes the clock.
        name: Of one of several robots; empty for one that is alone.
    """

    def __init__(self, server: SimulatorServer, simulated_time: bool, name: str = "") -> None:
        self._server = server
        self._simulated_time = simulated_time
        self._frame = f"{name}/{TORSO_FRAME}" if name else TORSO_FRAME
        self._last_due = -1
        public, private = (f"{name}/", f"{name}/nao_sim/") if name else ("", "~")
        self._truth = rospy.Publisher(f"{public}ground_truth/odom", Odometry, queue_size=5)
        success_service(f"{private}push", srv.PushRobot, self._push)
        success_service(f"{private}press", srv.PressSensors, lambda r: server.press(r.sensors))
        rospy.Service(f"{private}touch", srv.TouchSensors, self._on_touch)
        success_service(f"{private}release", srv.ReleaseSensors, lambda r: server.hands.release(r.sensors), SENT_AWAY)
        success_service(f"{private}plug_charger", SetBool, lambda r: server.health.plug_charger(r.data))
        success_service(f"{private}set_battery", srv.SetFloat, lambda r: server.health.set_battery_charge(r.data))
        rospy.Service(f"{private}picture", srv.TakePicture, self.on_picture)
        rospy.Service(f"{public}get_truepose", srv.GetTruepose, self._on_true_pose)

    @property
    def listened(self) -> bool:
        """Whether somebody wants what `tick` publishes."""
        return self._truth.get_num_connections() > 0

    def tick(self) -> None:
        """Publish what is due."""
        snapshot, now = self._server.now
        due = int(now * TRUTH_RATE)
        if due != self._last_due:
            self._last_due = due
            if self.listened:
                self._truth.publish(self._odometry(snapshot, now))

    def on_picture(self, request: srv.TakePictureRequest) -> srv.TakePictureResponse:
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

        taken, message = success_of(take)
        return srv.TakePictureResponse(taken, message, str(path) if taken else "")

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

    def _push(self, request: srv.PushRobotRequest) -> None:
        force = (request.force.x, request.force.y, request.force.z)
        self._server.push(force, request.time.to_sec(), request.link or TORSO_FRAME)

    def _on_touch(self, request: srv.TouchSensorsRequest) -> dict[str, Any]:
        contacts: list[float | None] = []

        def begin() -> Task:
            checked(request)
            called = self._server.hands.touch(request.sensors, request.time.to_sec(), request.wait)
            return called.then(lambda hand: hand and hand.then(contacts.append))

        began = self._server.began
        touched, message = success_of(begin, SENT_AWAY)
        answer = {"success": touched, "message": message}
        if contacts and contacts[0] is not None:
            answer["contact"] = self._stamp(began + contacts[0])
        return answer

    def _on_true_pose(self, _request: srv.GetTrueposeRequest) -> srv.GetTrueposeResponse:
        snapshot, now = self._server.now
        answer = srv.GetTrueposeResponse()
        answer.pose.header.stamp = self._stamp(now)
        answer.pose.header.frame_id = WORLD_FRAME
        answer.pose.pose.pose.position = Point(*snapshot.torso.position)
        answer.pose.pose.pose.orientation = Quaternion(*snapshot.torso.orientation)
        return answer

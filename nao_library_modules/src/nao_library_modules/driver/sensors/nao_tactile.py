"""The node nao_tactile: touch sensors, bumpers, buttons and soles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from std_msgs.msg import Bool

from nao_library_msgs.msg import Bumper, ChestButton, Fsr, HandTouch, HeadTouch, TactileTouch

from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.robot_frames import tf_prefix
from ...ros.ros_clock import RosClock
from ..base.lazy_topic import LazyTopic
from ..base.node import number, publish
from ..base.polling import Polling
from .foot_pressure import SIDES, FootPressure, read_feet
from .touch_sensors import BUMPER, CHEST, FEET, HAND, HEAD, TouchSensor, TouchSensors

QUEUE = 10
DEFAULT_RATE = 20.0


class NaoTactileNode:
    """What the touch sensors, bumpers, buttons and soles of one robot feel.

    Touches come from the robot's events; nothing is asked for again and again but the forces under the feet, while
    somebody listens to them. A sensor that is touched when the robot is reached is told then.

    ROS API (relative names):
        Publishes `tactile_touch` (nao_library_msgs/TactileTouch) and `head_touch` (nao_library_msgs/HeadTouch): the
        same, under the older and the later name; `hand_touch` (nao_library_msgs/HandTouch), `bumper`
        (nao_library_msgs/Bumper), `chest_button` (nao_library_msgs/ChestButton), `foot_contact` (std_msgs/Bool,
        latched: whether at least one foot stands on the ground), `nao_robot/fsr/left`, `nao_robot/fsr/right`
        (nao_library_msgs/Fsr, while somebody listens).
        Parameters `~fsr_rate` (20 Hz), `tf_prefix` (searched upwards; put before the frames).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._robot = robot
        self._head = node.publisher("tactile_touch", TactileTouch, queue_size=QUEUE)
        self._head_too = node.publisher("head_touch", HeadTouch, queue_size=QUEUE)
        self._hand = node.publisher("hand_touch", HandTouch, queue_size=QUEUE)
        self._bumper = node.publisher("bumper", Bumper, queue_size=QUEUE)
        self._chest = node.publisher("chest_button", ChestButton, queue_size=QUEUE)
        self._contact = node.publisher("foot_contact", Bool, queue_size=1, latch=True)
        self._prefix = tf_prefix()
        rate = number(node, "~fsr_rate", DEFAULT_RATE, "reading rate")
        self._pressure = Polling(robot, "foot pressure", rate, RosClock(), self._read)
        node.if_it_fails(self._pressure.close)
        self._feet = {side: node.publisher(f"nao_robot/fsr/{side}", Fsr, queue_size=QUEUE) for side in SIDES}
        self._lazy = LazyTopic(self._pressure.want, *self._feet.values())
        self._sensors = TouchSensors(robot, self._on_touch, self._on_clicks)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"touch": self._sensors.report, "foot pressure": self._pressure.report}

    def close(self) -> None:
        self._pressure.close()
        self._sensors.close()

    # --- touches; in threads of libqi -----------------------------------------------------------------------------

    def _on_touch(self, sensor: TouchSensor, touched: bool) -> None:
        which, state = sensor.number, int(touched)  # 0 released and 1 pressed in all these messages
        if sensor.place == HEAD:
            publish(self._head, TactileTouch(button=which, state=state))
            publish(self._head_too, HeadTouch(button=which, state=state))
        elif sensor.place == HAND:
            publish(self._hand, HandTouch(hand=which, state=state))
        elif sensor.place == BUMPER:
            publish(self._bumper, Bumper(bumper=which, state=state))
        elif sensor.place == CHEST:
            publish(self._chest, ChestButton(state=state))
        elif sensor.place == FEET:
            publish(self._contact, Bool(data=touched))

    def _on_clicks(self, count: int) -> None:
        publish(self._chest, ChestButton(state=ChestButton.stateReleased, clicks=count))

    # --- feet -----------------------------------------------------------------------------------------------------

    def _read(self) -> None:
        stamp = rospy.Time.now()
        for side, foot in read_feet(self._robot).items():
            if self._feet[side].get_num_connections():
                publish(self._feet[side], self._message(side, foot, stamp))

    def _message(self, side: str, foot: FootPressure, stamp: rospy.Time) -> Fsr:
        message = Fsr(total=foot.total, contact=foot.contact)
        message.header.stamp, message.header.frame_id = stamp, f"{self._prefix}{side[0]}_sole"
        message.front_left, message.front_right, message.rear_left, message.rear_right = foot.forces
        message.center_of_pressure.x, message.center_of_pressure.y = foot.center
        return message

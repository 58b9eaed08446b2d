"""The node nao_sonar: distances ahead."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import rospy
from sensor_msgs.msg import Range

from ...nao.body_devices import FARTHEST, NEAREST, SONAR_CONE, SONARS
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.robot_frames import tf_prefix
from ...ros.ros_clock import RosClock
from ..base.lazy_topic import LazyTopic
from ..base.node import name_for_robot, number, publish
from .sonars import Sonars

QUEUE = 10
DEFAULT_RATE = 10.0


class NaoSonar:
    """The two sonars of one robot. They are silent while nobody listens.

    ROS API (relative names):
        Publishes `nao_robot/sonar/left`, `nao_robot/sonar/right` (sensor_msgs/Range, frames LSonar_frame and
        RSonar_frame; infinite where there is nothing, minus infinite where it is too close, not a number when the
        sensor failed, see REP 117), and the same as `nao_robot/sonar/left/sonar`, `nao_robot/sonar/right/sonar`.
        Parameters `~sonar_rate` (10 Hz), `tf_prefix` (searched upwards; put before the frames).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._prefix = tf_prefix()
        rate = number(node, "~sonar_rate", DEFAULT_RATE, "reading rate")
        self._sonars = Sonars(robot, name_for_robot(node.name), rate, RosClock(), self._publish)
        node.if_it_fails(self._sonars.close)
        self._topics = [
            (side, node.publisher(name, Range, queue_size=QUEUE))
            for side in SONARS
            for name in (f"nao_robot/sonar/{side}", f"nao_robot/sonar/{side}/sonar")
        ]
        self._lazy = LazyTopic(self._sonars.want, *(topic for _, topic in self._topics))

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"sonars": self._sonars.report}

    def close(self) -> None:
        self._sonars.close()

    def _publish(self, ranges: Mapping[str, float]) -> None:
        stamp = rospy.Time.now()
        for side, topic in self._topics:
            if not topic.get_num_connections():
                continue
            message = Range(radiation_type=Range.ULTRASOUND, field_of_view=SONAR_CONE, range=ranges[side])
            message.min_range, message.max_range = NEAREST, FARTHEST
            message.header.stamp, message.header.frame_id = stamp, f"{self._prefix}{side[0].upper()}Sonar_frame"
            publish(topic, message)

"""The node naoqi_microphone: what the robot's microphones hear, as a topic."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import rospy
from rospy.rostime import is_wallclock

from nao_library_msgs.msg import AudioBuffer

from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.ros_clock import RosClock
from ..base.lazy_topic import LazyTopic
from ..base.node import frame_parameter, name_for_robot, publish
from ..base.reconfigure import ReconfigureField, serve
from .microphone import Block, Microphone
from .microphone_blocks import FORMATS, RATES

QUEUE = 50


class NaoMicrophone:
    """Publishes blocks of 170 ms while somebody listens; otherwise the robot sends nothing.

    ROS API:
        Publishes `~audio_raw` (nao_library_msgs/AudioBuffer), stamped with the time of its first sample.
        Parameters, also by dynamic_reconfigure: `~frequency` (16000 Hz: the front microphone; 48000 Hz: all four),
        `~use_ros_time` (true: stamps in ROS time; false: stamps of the robot's own clock. Default true; false on
        simulated time, which is the clock of the simulated robot). `~frame_id` (Head, after `tf_prefix`).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._use_ros_time = True
        self._frame = frame_parameter(node, "~frame_id", "Head")
        self._microphone = Microphone(robot, name_for_robot(node.name), RosClock(), self._publish)
        node.if_it_fails(self._microphone.close)
        fields = (
            ReconfigureField(
                "frequency", min(FORMATS), "samples a second and channel", min(FORMATS), max(FORMATS), RATES
            ),
            ReconfigureField(
                "use_ros_time", is_wallclock(), "whether stamps are in ROS time, instead of the robot's own"
            ),
        )
        self._server = serve(node, fields, self._changed)
        self._audio = node.publisher("~audio_raw", AudioBuffer, queue_size=QUEUE)
        self._lazy = LazyTopic(self._microphone.want, self._audio)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"microphones": self._microphone.report}

    def close(self) -> None:
        self._microphone.close()

    def _changed(self, _before: Mapping[str, Any], after: Mapping[str, Any]) -> Mapping[str, Any]:
        self._microphone.set_rate(after["frequency"])
        self._use_ros_time = after["use_ros_time"]
        return after

    def _publish(self, block: Block) -> None:
        message = AudioBuffer(frequency=block.rate, channelMap=bytes(block.places), data=block.samples)
        message.header.stamp = rospy.Time.from_sec(block.time.ros if self._use_ros_time else block.time.robot)
        message.header.frame_id = self._frame
        publish(self._audio, message)

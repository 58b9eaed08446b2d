"""The node nao_sonar: ranges of the sonars."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import rospy
from sensor_msgs.msg import Range

from naoqi.errors import NaoError

from ...core.health import Level, Report
from ...core.nao_facts import FARTHEST, NEAREST, SONAR_CONE, SONARS, echo_of
from ...core.robot import ask
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock, tf_prefix
from ..base.driver_node import LazyTopic, name_for_robot, number, publish
from ..base.lazy_subscription import LazySubscription
from ..base.polling import Polling

SONAR, MEMORY = "ALSonar", "ALMemory"


def range_of(value: Any) -> float:
    """A distance in m by REP 117, from a value of the robot's memory, see `echo_of`.

    Infinity where there is nothing, minus infinity where it is too close, NaN for a sensor that failed.
    """
    echo = echo_of(value)
    return -math.inf if echo < NEAREST else echo


class Sonars:
    """Has the robot measure while that is wanted, also after a lost connection."""

    def __init__(
        self, robot: Any, subscriber: str, rate: float, clock: Any, sink: Callable[[Mapping[str, float]], None]
    ) -> None:
        """Start idle; the robot need not be connected yet.

        Args:
            subscriber: Name of the subscriber at the robot.
            rate: Hz.
            clock: ROS time.
            sink: Gets each reading by side, in m, in a thread of its own.
        """
        self._robot = robot
        self._subscriber = subscriber
        self._sink = sink
        self._measuring = LazySubscription(
            robot, "sonars", lambda: self._ask("subscribe"), lambda: self._ask("unsubscribe")
        )
        self._polling = Polling(robot, "sonars", rate, clock, self._read)

    def want(self, wanted: bool) -> None:
        self._measuring.want(wanted)
        self._polling.want(wanted)

    def report(self) -> Report:
        report = self._polling.report()
        if self._measuring.wanted and self._measuring.problem:
            return Report(Level.ERROR, f"the sonars do not measure: {self._measuring.problem}", report.values)
        return report

    def close(self) -> None:
        self._polling.close()
        self._measuring.close()

    def _ask(self, method: str) -> None:
        ask(self._robot, SONAR, method, self._subscriber)

    def _read(self) -> None:
        if not self._measuring.running:
            return  # the memory holds an old measurement, of another subscriber
        values = ask(self._robot, MEMORY, "getListData", list(SONARS.values()))
        if len(values) != len(SONARS):
            raise NaoError(f"the robot's memory answers {values!r} for {', '.join(SONARS.values())}")
        self._sink({side: range_of(value) for side, value in zip(SONARS, values)})


QUEUE = 10
DEFAULT_RATE = 10.0


class NaoSonar:
    """The two sonars of one robot. They are silent without subscribers.

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

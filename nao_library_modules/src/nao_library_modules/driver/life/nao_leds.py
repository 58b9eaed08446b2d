"""The node nao_leds: lights that fade, eyes that blink."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import rospy
from std_msgs.msg import ColorRGBA

from nao_library_actions.msg import BlinkAction, BlinkFeedback, BlinkResult
from nao_library_msgs.msg import FadeRGB, LedStates
from naoqi.errors import NaoError

from ...base.cancellation import CancellationToken
from ...base.errors import BadGoal, Preempted
from ...base.field_checks import require_zero_or
from ...ros.concurrent_action_server import ConcurrentActionServer, GoalOutcome
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.ros_clock import RosClock
from ..base.lazy_topic import LazyTopic
from ..base.node import interrupt_when_lost, number, publish
from ..base.polling import Polling
from .blinking import DURATION, EYES, Blinks, Colour, blink, fade
from .led_states import LedReader

QUEUE = 100
COMPLAINT_PERIOD = 5.0
SHUTDOWN_LIMIT = 2.0
DEFAULT_RATE = 10.0


class NaoLeds:
    """Lights of one robot, under the names of nao_robot.

    ROS API (relative names):
        Subscribes `fade_rgb` (nao_library_msgs/FadeRGB): fades one after the other, in the order of the messages.
        Action `blink` (nao_library_actions/Blink): the eyes blink until the goal is cancelled or a newer one comes;
        so it never succeeds. `still_blinking` in its result tells that a newer one has come.
        Publishes `led_states` (nao_library_msgs/LedStates): what each light shows, while somebody listens.
        Parameter `~led_rate` (10 Hz).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        rate = number(node, "~led_rate", DEFAULT_RATE, "reading rate")
        self._robot = robot
        self._clock = RosClock()
        self._chance = random.Random()
        self._interrupt = CancellationToken()
        self._server = ConcurrentActionServer(lambda _: frozenset({EYES}), self._blink, with_feedback=True, robot=robot)
        node.action("blink", BlinkAction, self._server)
        self._stop_watching = interrupt_when_lost(robot, node, self._server)
        node.subscriber("fade_rgb", FadeRGB, self._fade, queue_size=QUEUE)
        self._reader = LedReader(robot)
        self._states = node.publisher("led_states", LedStates, queue_size=1)
        self._polling = Polling(robot, "lights", rate, self._clock, self._read)
        node.if_it_fails(self._polling.close)
        self._lazy = LazyTopic(self._polling.want, self._states)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"goals blink": self._server.counter.report, "lights": self._polling.report}

    def close(self) -> None:
        self._polling.close()
        self._stop_watching()
        self._interrupt.stop()
        self._server.close(SHUTDOWN_LIMIT)

    def _read(self) -> None:
        message = LedStates()
        message.header.stamp = rospy.Time.now()
        shown = self._reader.read()
        message.lights, message.colors = list(shown), [ColorRGBA(*colour, 1.0) for colour in shown.values()]
        publish(self._states, message)

    def _fade(self, message: FadeRGB) -> None:
        colour, duration = _rgb(message.color), message.fade_duration.to_sec()
        try:
            if not all(0.0 <= part <= 1.0 for part in colour):
                raise BadGoal("color", colour, "red, green and blue, each 0 to 1")
            require_zero_or("fade_duration", duration, DURATION)
            fade(self._robot, message.led_name, colour, duration, self._interrupt)
        except Preempted:
            return  # the node ends
        except NaoError as error:
            rospy.logerr_throttle(COMPLAINT_PERIOD, f"fade_rgb: {error}")

    def _blink(self, goal: Any, interrupt: CancellationToken, publish: Callable[[Any], None]) -> GoalOutcome:
        blinks = Blinks(
            [_rgb(color) for color in goal.colors],
            _rgb(goal.bg_color),
            goal.blink_duration.to_sec(),
            goal.blink_rate_mean,
            goal.blink_rate_sd,
        )
        blinks.check()

        def tell(colour: Colour) -> None:
            publish(BlinkFeedback(last_color=ColorRGBA(*colour, 1.0)))

        replaced = blink(self._robot, blinks, self._clock, interrupt, tell, self._chance)
        return GoalOutcome(BlinkResult(still_blinking=replaced), preempted=True)


def _rgb(color: ColorRGBA) -> tuple[float, float, float]:
    return color.r, color.g, color.b

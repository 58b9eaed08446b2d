"""The watch of owners as part of a node that starts nothing itself."""

from __future__ import annotations

import logging
import threading
from collections import defaultdict, deque
from functools import partial
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID
from std_srvs.srv import Empty

from naoqi.errors import NaoError

from .line import GOAL, SERVICE
from .stops import Stops
from .watch import OwnerWatch

log = logging.getLogger(__name__)

QUEUE = 20
"""Cancelled goals of an action that a server which is found late still gets."""


class GoalCanceller(rospy.SubscribeListener):
    """Cancels goals of others. Any thread.

    ROS API:
        Publishes `ACTION/cancel` (actionlib_msgs/GoalID) of the actions whose clients have died.
    """

    def __init__(self) -> None:
        super().__init__()
        self._lock = threading.Lock()
        self._publishers: dict[str, rospy.Publisher] = {}
        self._cancelled: dict[str, deque[str]] = defaultdict(partial(deque, maxlen=QUEUE))

    def cancel(self, topic: str, goal: str) -> None:
        """Cancel a goal; a server that is not connected yet gets the cancellation when it is.

        A server that is connected to another publisher of this process causes no `peer_subscribe`: it gets it at once.
        """
        with self._lock:
            self._cancelled[topic].append(goal)
            publisher = self._publishers.get(topic)
            if publisher is None:
                publisher = rospy.Publisher(topic, GoalID, subscriber_listener=self, queue_size=QUEUE)
                self._publishers[topic] = publisher
        publisher.publish(GoalID(id=goal))

    def peer_subscribe(self, topic_name: str, _publish: Any, peer_publish: Any) -> None:
        for goal in tuple(self._cancelled[topic_name]):
            peer_publish(GoalID(id=goal))


def call_for(service: str, node: str) -> None:
    """Call a service without arguments in the name of a node that has died.

    Raises NaoError if nobody offers it, or it failed.
    """
    try:
        rospy.ServiceProxy(service, Empty, headers={"callerid": node})()
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise NaoError(f"{service} failed: {error}") from error


def _call_in_thread(service: str, node: str) -> None:
    """Call it without waiting: to stop a walk takes a second, and the next thing is to be stopped meanwhile."""

    def call() -> None:
        try:
            call_for(service, node)
        except NaoError as error:
            log.error("what %s has left may go on: %s", node, error)

    threading.Thread(target=call, name=service, daemon=True).start()


def watch_owners(robot: Any) -> None:
    stops = Stops(robot, {GOAL: GoalCanceller().cancel, SERVICE: _call_in_thread})
    watch = OwnerWatch(robot.address, stops.stop)
    rospy.on_shutdown(watch.close)

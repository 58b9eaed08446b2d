"""A topic whose first message is lost to none of those who listen. In ROS."""

from __future__ import annotations

from typing import Any, Callable

import rosgraph
import rospy

from ..language.flow import sleep

PERIOD = 0.02
OTHERS_LIMIT = 2.0
"""s to wait, when the first listener is there, for others that the master knows: one that was killed never comes."""


class LatchedTopic:
    """Publishes when the listeners are connected, which takes a moment after the publisher has been made."""

    def __init__(self, topic: str, kind: type) -> None:
        self._publisher = rospy.Publisher(topic, kind, queue_size=10)
        self._settled = False

    def tell(self, message: Any, limit: float) -> bool:
        """Publish a message; waits in a plan. False if nobody has listened for `limit` s."""
        if not self._listened():
            self._settled = False
            if not self._wait(self._listened, limit):
                return False
        if not self._settled:
            self._wait(self._all_listen, OTHERS_LIMIT)
            self._settled = True
        self._publisher.publish(message)
        return True

    def _listened(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def _all_listen(self) -> bool:
        subscribers = dict(rosgraph.Master(rospy.get_name()).getSystemState()[1])
        known = subscribers.get(self._publisher.resolved_name, ())
        return self._publisher.get_num_connections() >= len(known)

    @staticmethod
    def _wait(condition: Callable[[], bool], limit: float) -> bool:
        waited = 0.0
        while not condition():
            if waited >= limit:
                return False
            sleep(PERIOD)
            waited += PERIOD
        return True

"""Topics whose work is done only while somebody listens."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection
from typing import Any

import rospy


class LazyTopic(rospy.SubscribeListener):
    """Calls a function, which must not wait, when some topics get their first listener, and when the last one leaves.

    Callbacks come from threads of rospy, sometimes out of order: so each counts the listeners, under a lock.

    Attributes:
        listened: Whether somebody listens, as last reported.
    """

    def __init__(self, report: Callable[[bool], None], *publishers: rospy.Publisher, but: Collection[str] = ()) -> None:
        """`but` has the full names of nodes whose listening does not count."""
        super().__init__()
        self._report = report
        self._publishers = publishers
        self._but = but
        self._lock = threading.Lock()
        self.listened = False
        # Not in the constructor of the publisher: the first listener would find none.
        for publisher in publishers:
            publisher.impl.add_subscriber_listener(self)
        self._look()

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Any) -> None:
        self._look()

    def peer_unsubscribe(self, topic_name: str, num_peers: int) -> None:
        self._look()

    def _look(self) -> None:
        with self._lock:
            listens = any(node not in self._but for publisher in self._publishers for node in listeners(publisher))
            if listens != self.listened:
                self.listened = listens
                self._report(listens)


def listeners(publisher: rospy.Publisher) -> list[str]:
    """Full names of the nodes that listen to a topic; none to one that was taken back."""
    return [node for _, node, *_ in publisher.impl.get_stats_info()] if publisher.impl else []

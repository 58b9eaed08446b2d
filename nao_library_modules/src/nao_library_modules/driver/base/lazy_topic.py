"""A topic whose work is done only while somebody listens."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy


class LazyTopic(rospy.SubscribeListener):
    """Calls a function, which must not wait, when the first listener comes, and when the last one leaves.

    Callbacks come from threads of rospy, sometimes out of order: so each counts the listeners, under a lock.
    """

    def __init__(self, publisher: rospy.Publisher, report: Callable[[bool], None]) -> None:
        super().__init__()
        self._publisher = publisher
        self._report = report
        self._lock = threading.Lock()
        self._listened = False
        # Not in the constructor of the publisher: the first listener would find none.
        publisher.impl.add_subscriber_listener(self)
        self._look()

    @property
    def listened(self) -> bool:
        """Whether somebody listens, as last reported."""
        return self._listened

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Any) -> None:
        self._look()

    def peer_unsubscribe(self, topic_name: str, num_peers: int) -> None:
        self._look()

    def _look(self) -> None:
        with self._lock:
            listens = self._publisher.get_num_connections() > 0
            if listens != self._listened:
                self._listened = listens
                self._report(listens)

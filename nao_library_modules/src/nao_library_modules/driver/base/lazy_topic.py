"""Tells whether anybody listens to a topic."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy


class LazyTopic(rospy.SubscribeListener):
    """Calls a function when the first one begins to listen, and when the last one stops.

    Callbacks come from threads of rospy, sometimes out of order: so each looks how many there are, under a lock.
    """

    def __init__(self, publisher: rospy.Publisher, tell: Callable[[bool], None]) -> None:
        """Begin to watch.

        Args:
            publisher: Of the topic.
            tell: Gets whether anybody listens; must not wait.
        """
        super().__init__()
        self._publisher = publisher
        self._tell = tell
        self._lock = threading.Lock()
        self._told = False
        publisher.impl.add_subscriber_listener(self)  # not in the constructor: who comes first would find no publisher
        self._look()

    @property
    def listened(self) -> bool:
        """Whether somebody listens, as it was told last."""
        return self._told

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Any) -> None:
        """One more listens; called by rospy."""
        self._look()

    def peer_unsubscribe(self, topic_name: str, num_peers: int) -> None:
        """One less listens; called by rospy."""
        self._look()

    def _look(self) -> None:
        with self._lock:
            listens = self._publisher.get_num_connections() > 0
            if listens != self._told:
                self._told = listens
                self._tell(listens)

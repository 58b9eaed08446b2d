"""Messages that scenarios wait for, without asking again and again."""

from contextlib import contextmanager
from threading import Condition
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray

from nao_sim_bridge.testing import StackNotReady, wait_until

LIMIT = 60.0


class News:
    """Tells who waits whenever a message has come."""

    def __init__(self):
        self._condition = Condition()

    def subscribe(self, topic, kind, take):
        """Hand each message of a topic to a function, and tell who waits."""

        def on_message(message):
            with self._condition:
                take(message)
                self._condition.notify_all()

        return rospy.Subscriber(topic, kind, on_message, queue_size=1000)

    @contextmanager
    def messages(self, topic, kind):
        """Messages of a topic, in a list, while the block runs."""
        found = []
        subscriber = self.subscribe(topic, kind, found.append)
        wait_until(lambda: connected(subscriber), LIMIT, f"the publisher of {topic}")
        try:
            yield found
        finally:
            subscriber.unregister()

    def wait(self, condition, what):
        """Wait until a message has made something true.

        Raises:
            StackNotReady: If none does within 30 s of wall time.
        """
        with self._condition:
            if not self._condition.wait_for(condition, LIMIT):
                raise StackNotReady(f"not there within {LIMIT:g} s: {what() if callable(what) else what}")


class Reports:
    """The last status of each name on /diagnostics; a slash in front of a name is left out."""

    def __init__(self):
        self._news, self._last = News(), {}
        self.subscriber = self._news.subscribe("/diagnostics", DiagnosticArray, self._read)

    def _read(self, message):
        self._last.update((status.name.lstrip("/"), status) for status in message.status)

    def wait(self, name, fits):
        """The first status of a name that fits."""
        self._news.wait(lambda: name in self._last and fits(self._last[name]), f"{name} on /diagnostics")
        return self._last[name]

    def wait_anew(self, name, fits):
        """The first status of a name from now on that fits."""
        self._last.clear()
        return self.wait(name, fits)

    def values(self, name, message):
        """Values of the first status from now on that has this message."""
        return {e.key: e.value for e in self.wait_anew(name, lambda status: status.message == message).values}


def connected(subscriber):
    """Whether a topic has publishers, and each sends to the subscriber: it knows that a moment before they do."""
    master = rosgraph.Master(rospy.get_name())
    publishers = dict(master.getSystemState()[0]).get(subscriber.resolved_name, [])
    return bool(publishers) and all(sends(master.lookupNode(name), subscriber.resolved_name) for name in publishers)


def sends(node, topic):
    """Whether a node, by the address of its API, sends a topic to this one."""
    _, _, connections = ServerProxy(node).getBusInfo(rospy.get_name())
    return any((way[1], way[2], way[4]) == (rospy.get_name(), "o", topic) for way in connections)

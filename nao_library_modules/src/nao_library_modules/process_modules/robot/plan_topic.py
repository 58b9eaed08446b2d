"""The tree of a plan on a topic, while it runs."""

from __future__ import annotations

import threading
from typing import Any

import rospy

from nao_library_msgs.msg import PlanTask, PlanTree

from ..language.tasks import Task
from ..language.trace import Record, trace_of

TOPIC = "plan_tree"
SHORTEST = 0.1
"""s between two messages: a plan may change much faster than anybody can look."""


class PlanTopic:
    """Publishes the tree of a plan, latched: after changes, ten times a second at most, and at its end.

    Pass it to `top_level` as an observer; `close` it afterwards.
    """

    def __init__(self, topic: str = TOPIC) -> None:
        self._publisher = rospy.Publisher(topic, PlanTree, queue_size=1, latch=True)
        self._root: Task | None = None
        self._changed = threading.Event()
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._publish_changes, name=f"topic {topic}", daemon=True)
        self._thread.start()

    def __call__(self, task: Task) -> None:
        self._root = task.tree.root
        self._changed.set()

    def close(self) -> None:
        """Publish the last state, and end."""
        self._closed.set()
        self._changed.set()
        self._thread.join()

    def _publish_changes(self) -> None:
        while not self._closed.is_set():
            self._changed.wait()
            self._changed.clear()
            self._publish()
            self._closed.wait(SHORTEST)
        self._publish()

    def _publish(self) -> None:
        root = self._root
        if root is None:
            return
        message = PlanTree(plan=root.name, tasks=[_message(record) for record in trace_of(root).records])
        message.header.stamp = rospy.Time.now()
        try:
            self._publisher.publish(message)
        except rospy.ROSException as error:  # the node ends
            rospy.logdebug("%s: %s", TOPIC, error)


def _message(record: Record) -> Any:
    return PlanTask(
        number=record.number,
        parent=-1 if record.parent is None else record.parent,
        name=record.name,
        state=record.state,
        created=record.created,
        began=-1.0 if record.began is None else record.began,
        ended=-1.0 if record.ended is None else record.ended,
        arguments=record.facts.get("arguments", ""),
        result=record.result,
        failure=record.failure,
    )

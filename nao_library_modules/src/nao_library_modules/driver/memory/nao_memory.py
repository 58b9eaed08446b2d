"""The node nao_memory: keys and events of the robot's memory as topics, and services to read and write them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from functools import partial
from typing import Any

import rospy

from nao_library_msgs.msg import (
    BoolStamped,
    FloatArrayStamped,
    FloatStamped,
    IntArrayStamped,
    IntStamped,
    StringArrayStamped,
    StringStamped,
)
from nao_library_msgs.srv import (
    GetMemory,
    GetMemoryResponse,
    ListMemory,
    ListMemoryResponse,
    SetMemory,
    SetMemoryResponse,
    UnwatchMemory,
    UnwatchMemoryResponse,
    WatchMemory,
    WatchMemoryResponse,
)
from naoqi.errors import NaoError

from ...core.errors import did_you_mean
from ...core.health import Report
from ...core.memory_functions import json_of
from ...ros.driver_types import spoken
from ...ros.node_interface import NodeInterface
from ...ros.server_node import node_file
from ...ros.time_and_frames import RosClock
from ..base.driver_node import LazyTopic, number, publish
from .memory_rules import (
    BOOL,
    FLOAT,
    FLOATS,
    INT,
    INTS,
    TEXT,
    TEXTS,
    MemoryAccess,
    MemoryRule,
    check_pattern,
    is_pattern,
    matching,
    parse_value,
    read_rules,
    type_of,
)
from .memory_watch import MemoryWatch

MESSAGES = {
    BOOL: BoolStamped,
    INT: IntStamped,
    FLOAT: FloatStamped,
    TEXT: StringStamped,
    INTS: IntArrayStamped,
    FLOATS: FloatArrayStamped,
    TEXTS: StringArrayStamped,
}
QUEUE = 100
MOST_TOPICS = 1000


class NaoMemory:
    """The memory of one robot. A topic is named after its key, and data is read only while it has subscribers.

    ROS API:
        Publishes `~KEY` for each watched key (nao_library_msgs/BoolStamped, IntStamped, FloatStamped, StringStamped,
        IntArrayStamped, FloatArrayStamped, StringArrayStamped; other values as JSON in a StringStamped). Of an event
        every listener that begins gets the present value first, if there is one.
        Services `~watch` (nao_library_msgs/WatchMemory), `~unwatch` (nao_library_msgs/UnwatchMemory), `~get`
        (nao_library_msgs/GetMemory), `~set` (nao_library_msgs/SetMemory), `~list` (nao_library_msgs/ListMemory).
        Parameters `~keys` (empty: what is watched from the start, a list of keys and patterns, or of {key: KEY,
        rate: HZ, type: TYPE}), `~max_topics` (1000).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._node = node
        largest = int(number(node, "~max_topics", MOST_TOPICS, "topics"))
        rules = read_rules(self._node.param("~keys", []), "~keys")
        self._robot = robot
        self._memory = MemoryAccess(robot)
        self._watch = MemoryWatch(robot, RosClock(), partial(MemoryTopic, node), largest)
        node.if_it_fails(self._watch.close)
        self._kept = node_file(self._node.name)
        kept = self._kept.load(_kept_rules)
        self._watch.watch(rules if kept is None else kept)
        self._serve("~watch", WatchMemory, self._on_watch)
        self._serve("~unwatch", UnwatchMemory, self._on_unwatch)
        self._serve("~get", GetMemory, self._on_get)
        self._serve("~set", SetMemory, self._on_set)
        self._serve("~list", ListMemory, self._on_list)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"memory": self._watch.report}

    def close(self) -> None:
        self._kept.forget()
        self._watch.close()

    # --- services -------------------------------------------------------------------------------------------------

    def _on_watch(self, request: Any) -> WatchMemoryResponse:
        self._watch.watch([MemoryRule(request.pattern, request.rate, request.type)])
        self._keep()
        found = self._watch.watched(request.pattern)
        topics = [self._resolved(topic) for topic in found.values()]
        return WatchMemoryResponse(True, self._missing(request.pattern, topics), list(found), topics)

    def _missing(self, pattern: str, topics: list[str]) -> str:
        """A message for a client that gets no topic."""
        if self._robot.connection.state != "connected":
            return f"the robot at {self._robot.address} is not connected: topics appear when it is"
        shut = topics.count("")
        if topics and not shut:
            return ""
        if shut and is_pattern(pattern):
            return f"{shut} of {len(topics)} have no value yet: their topics appear with the first one"
        known = self._memory.known()
        if pattern in known:
            return f"{pattern} has no value yet: its topic appears with the first one"
        return f"no key matches {pattern!r} yet{did_you_mean(pattern, known)}; topics appear when one does"

    def _on_unwatch(self, request: Any) -> UnwatchMemoryResponse:
        left = self._watch.unwatch(request.pattern)
        self._keep()
        return UnwatchMemoryResponse(True, "", left)

    def _keep(self) -> None:
        """Save the rules: they outlive a crash of the node."""
        self._kept.save([asdict(rule) for rule in self._watch.rules])

    def _on_get(self, request: Any) -> GetMemoryResponse:
        found = self._memory.find(request.pattern)
        values, types = [json_of(v) for v in found.values()], [type_of(v) for v in found.values()]
        return GetMemoryResponse(True, "", list(found), values, types)

    def _on_set(self, request: Any) -> SetMemoryResponse:
        key = check_pattern(request.key, "key")
        self._memory.write(key, parse_value(request.value), request.event)
        return SetMemoryResponse(True, "")

    def _on_list(self, request: Any) -> ListMemoryResponse:
        known = self._memory.known()
        keys = matching(known, request.pattern)
        topics = self._watch.watched(request.pattern)
        names = [self._resolved(topics.get(key, "")) for key in keys]
        return ListMemoryResponse(True, "", keys, [known[key] for key in keys], names)

    def _serve(self, name: str, kind: type, answer: Callable[[Any], Any]) -> None:
        """Offer a service whose response reports errors."""

        def serve(request: Any) -> Any:
            try:
                return answer(request)
            except NaoError as error:
                return kind._response_class(success=False, message=str(error))

        self._node.service(name, kind, serve)

    def _resolved(self, topic: str) -> str:
        return self._node.resolve(f"~{topic}") if topic else ""


class MemoryTopic(LazyTopic):
    """The topic of a key. Each further subscriber gets the last message first."""

    def __init__(self, node: NodeInterface, name: str, kind: str, report: Callable[[bool], None]) -> None:
        """Open the topic `name` below the node, of a kind in MESSAGES; `report` gets whether it has subscribers."""
        self._kind = MESSAGES[kind]
        self._last: Any = None
        self._topic = rospy.Publisher(node.resolve(f"~{name}"), spoken(self._kind), queue_size=QUEUE)
        super().__init__(report, self._topic)

    def publish(self, value: Any) -> None:
        """Publish a value of the topic's kind, with the present time."""
        message = self._kind(data=value)
        message.header.stamp = rospy.Time.now()
        self._last = message
        publish(self._topic, message)

    def peer_subscribe(self, topic_name: str, topic_publish: Any, peer_publish: Any) -> None:
        """One more listens; called by rospy. The first one gets the robot's present value, the others the last."""
        last = self._last
        if self.listened and last is not None:
            peer_publish(last)
        super().peer_subscribe(topic_name, topic_publish, peer_publish)

    def close(self) -> None:
        self._topic.unregister()


def _kept_rules(kept: Any) -> list[MemoryRule]:
    rules = [MemoryRule(**fields) for fields in kept]
    for rule in rules:
        rule.check()
    return rules

"""Pictures on ROS topics, and the settings of the nodes that publish them: the module's side to ROS."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

import rosgraph
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from naoqi.errors import NaoError

from ..core.errors import BadGoal
from .pictures import COMPRESSED

BUFFER = 1 << 24
"""Bytes to read at once: a smaller buffer than a picture makes rospy read it in many pieces, and late."""
PICTURE_TYPES = {kind._type: kind for kind in (Image, CompressedImage)}
SETTINGS_LIMIT = 3.0
"""s to wait for a node that can be set."""
QUEUE = 2
"""Messages that wait for a slow subscriber of a stream."""


class Publisher:
    """A publisher of pictures or camera_info."""

    def __init__(self, publisher: rospy.Publisher) -> None:
        self._publisher = publisher

    def publish(self, message: Any) -> None:
        """Publish; a slow subscriber does not block."""
        self._publisher.publish(message)

    def is_heard(self) -> bool:
        return self._publisher.get_num_connections() > 0

    def close(self) -> None:
        self._publisher.unregister()


class TopicSubscription:
    """Takes messages from a topic until it is closed; may be closed twice."""

    def __init__(self, topic: str, kind: type, take: Callable[[Any], None]) -> None:
        """Subscribe; `take` is called from the thread that receives: it must not take long."""
        self._lock = threading.Lock()
        # rospy makes one connection for all subscriptions to a topic.
        self._subscriber: rospy.Subscriber | None = rospy.Subscriber(topic, kind, take, buff_size=BUFFER)

    def close(self) -> None:
        with self._lock:
            subscriber, self._subscriber = self._subscriber, None
        if subscriber is not None:
            subscriber.unregister()


class VisionTopics:
    """Topics and settings of cameras. Needs `rospy.init_node` before; any thread may use it."""

    def subscribe(self, topic: str, take: Callable[[Any], None]) -> TopicSubscription:
        """Take pictures from a topic, which need not be there yet. Raises BadGoal if what it holds are no pictures."""
        return TopicSubscription(topic, self._kind(topic), take)

    def subscribe_info(self, topic: str, take: Callable[[Any], None]) -> TopicSubscription:
        """Take sensor_msgs/CameraInfo from a topic, which need not be there."""
        return TopicSubscription(topic, CameraInfo, take)

    def publisher(self, topic: str, kind: type) -> Publisher:
        return Publisher(rospy.Publisher(topic, kind, queue_size=QUEUE))

    def images_of(self, nodes: frozenset[str]) -> list[str]:
        """Topics of images that some nodes publish now, those named image_raw first."""
        master = rosgraph.Master(rospy.get_name())
        types = dict(master.getTopicTypes())
        published = [name for name, publishers in master.getSystemState()[0] if not nodes.isdisjoint(publishers)]
        images = [name for name in published if types.get(name) == Image._type]
        return sorted(images, key=lambda name: (not name.endswith("/image_raw"), name))

    def resolved(self, topic: str) -> str:
        return rospy.resolve_name(topic)

    def settings(self, server: str) -> dict[str, Any]:
        """The settings of a node that takes dynamic_reconfigure: name -> value.

        Raises NaoError if there is no such node.
        """
        return self.set(server, {})

    def set(self, server: str, values: Mapping[str, Any]) -> dict[str, Any]:
        """Change some settings; answers all afterwards.

        Raises NaoError if there is no such node, or it refuses.
        """
        # The service alone, for dynamic_reconfigure's client subscribes to two topics, and waits for them.
        from dynamic_reconfigure.encoding import decode_config, encode_config
        from dynamic_reconfigure.srv import Reconfigure

        name = f"{server}/set_parameters"
        try:
            rospy.wait_for_service(name, SETTINGS_LIMIT)
            answer = rospy.ServiceProxy(name, Reconfigure)(encode_config(dict(values)))
        except rospy.ServiceException as error:
            raise NaoError(f"{rospy.resolve_name(server)} refuses: {error}") from error
        except rospy.ROSException as error:
            full = rospy.resolve_name(name)
            raise NaoError(f"the camera's node cannot be set: there is no service {full}") from error
        decoded = decode_config(answer.config)
        return {key: value for key, value in decoded.items() if key != "groups"}

    def _kind(self, topic: str) -> type:
        """Message type of a topic of pictures; by its name where nobody publishes yet."""
        full = rospy.resolve_name(topic)
        try:
            types = dict(rosgraph.Master(rospy.get_name()).getTopicTypes())
        except (OSError, rosgraph.MasterException):
            types = {}  # the subscription waits for the master as well
        there = types.get(full, "*")
        if there in PICTURE_TYPES:
            return PICTURE_TYPES[there]
        if there != "*":
            problem = f"{full} holds {there}"
            raise BadGoal("topic", topic, f"a topic of {' or '.join(PICTURE_TYPES)}", problem=problem)
        return CompressedImage if full.endswith(COMPRESSED) else Image

"""Pictures on ROS topics, and the settings of the nodes that publish them: the module's side to ROS."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

import rosgraph
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from naoqi.errors import NaoError

from ...base.errors import BadGoal
from .pictures import COMPRESSED

BUFFER = 1 << 24
"""Bytes to read at once: a smaller buffer than a picture makes rospy read it in many pieces, and late."""
PICTURE_TYPES = {kind._type: kind for kind in (Image, CompressedImage)}
SETTINGS_LIMIT = 3.0
"""s to wait for a node that can be set."""
QUEUE = 2
"""Messages that wait for a slow subscriber of a stream."""


class SettingsTrouble(NaoError):  # noqa: N818  named like the errors of the proxy layer
    """A camera's node cannot be set."""


class Publisher:
    """Publishes pictures, or what belongs to them."""

    def __init__(self, publisher: rospy.Publisher) -> None:
        """Take over a publisher."""
        self._publisher = publisher

    def publish(self, message: Any) -> None:
        """Publish; a slow subscriber holds nobody up."""
        self._publisher.publish(message)

    def is_heard(self) -> bool:
        """Whether anybody listens."""
        return self._publisher.get_num_connections() > 0

    def close(self) -> None:
        """Publish no more."""
        self._publisher.unregister()


class Subscription:
    """Takes messages from a topic until it is closed; may be closed twice."""

    def __init__(self, topic: str, kind: type, take: Callable[[Any], None]) -> None:
        """Begin.

        Args:
            topic: Where they come from.
            kind: Their message.
            take: Called with each, from the thread that receives it: it must not take long.
        """
        self._lock = threading.Lock()
        # Of several subscriptions to one topic ROS makes one connection, and calls all that want the message.
        self._subscriber: rospy.Subscriber | None = rospy.Subscriber(topic, kind, take, buff_size=BUFFER)

    def close(self) -> None:
        """Take no more."""
        with self._lock:
            subscriber, self._subscriber = self._subscriber, None
        if subscriber is not None:
            subscriber.unregister()


class VisionTopics:
    """Topics and settings of cameras. Needs `rospy.init_node` before; any thread may use it."""

    def subscribe(self, topic: str, take: Callable[[Any], None]) -> Subscription:
        """Take pictures from a topic, which need not be there yet.

        Raises:
            BadGoal: If what it holds are no pictures.
        """
        return Subscription(topic, self._kind(topic), take)

    def subscribe_info(self, topic: str, take: Callable[[Any], None]) -> Subscription:
        """Take what cameras tell of themselves (sensor_msgs/CameraInfo) from a topic, which need not be there."""
        return Subscription(topic, CameraInfo, take)

    def publisher(self, topic: str, kind: type) -> Publisher:
        """Publish messages of a kind on a topic."""
        return Publisher(rospy.Publisher(topic, kind, queue_size=QUEUE))

    def images_of(self, nodes: frozenset[str]) -> list[str]:
        """Topics of images that some nodes publish now, those named image_raw first."""
        master = rosgraph.Master(rospy.get_name())
        types = dict(master.getTopicTypes())
        published = [name for name, publishers in master.getSystemState()[0] if not nodes.isdisjoint(publishers)]
        images = [name for name in published if types.get(name) == Image._type]
        return sorted(images, key=lambda name: (not name.endswith("/image_raw"), name))

    def resolved(self, topic: str) -> str:
        """Full name of a topic."""
        return rospy.resolve_name(topic)

    def settings(self, server: str) -> dict[str, Any]:
        """What a node that takes dynamic_reconfigure is set to: name -> value.

        Raises:
            SettingsTrouble: If there is none.
        """
        return self._configured(server, {})

    def set(self, server: str, values: Mapping[str, Any]) -> dict[str, Any]:
        """Set some of it.

        Returns:
            What it is set to then.

        Raises:
            SettingsTrouble: If there is no such node, or it refuses.
        """
        return self._configured(server, values)

    @staticmethod
    def _configured(server: str, values: Mapping[str, Any]) -> dict[str, Any]:
        # The service alone, for dynamic_reconfigure's client subscribes to two topics, and waits for them.
        from dynamic_reconfigure.encoding import decode_config, encode_config
        from dynamic_reconfigure.srv import Reconfigure

        name = f"{server}/set_parameters"
        try:
            rospy.wait_for_service(name, SETTINGS_LIMIT)
            answer = rospy.ServiceProxy(name, Reconfigure)(encode_config(dict(values)))
        except rospy.ServiceException as error:
            raise SettingsTrouble(f"{rospy.resolve_name(server)} refuses: {error}") from error
        except rospy.ROSException as error:
            full = rospy.resolve_name(name)
            raise SettingsTrouble(f"the camera's node cannot be set: there is no service {full}") from error
        decoded = decode_config(answer.config)
        return {key: value for key, value in decoded.items() if key != "groups"}

    def _kind(self, topic: str) -> type:
        """Message of a topic's pictures; where nobody publishes yet its name tells."""
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

"""What a part of a node has of ROS: names, parameters, topics, services, actions. All that it makes ends with it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy

from naoqi.errors import NaoError

from ..base.errors import Preempted
from .action_server import ActionServer


class NodeInterface:
    """The side to ROS of something that has a name of its own: a node, or one of several parts of a node.

    Names are as everywhere in ROS: "speech" is relative to the namespace of the part, "~rate" is the part's own.

    Attributes:
        name: Full name.
        namespace: That the name is in, with a slash at both ends.
    """

    def __init__(self, name: str = "") -> None:
        """Make nothing yet.

        Args:
            name: Of the part, relative to the node's namespace; empty: the node itself.
        """
        self.name = rospy.resolve_name(name) if name else rospy.get_name()
        self.namespace = self.name.rpartition("/")[0] + "/"
        self._ends: list[Callable[[], Any]] = []

    def resolve(self, name: str) -> str:
        """The full name behind a name, remapped."""
        return rospy.names.resolve_name(name, self.name)

    def param(self, name: str, default: Any = None) -> Any:
        """A parameter, or the default where it is not set."""
        return rospy.get_param(self.resolve(name), default)

    def has_param(self, name: str) -> bool:
        """Whether a parameter is set."""
        return rospy.has_param(self.resolve(name))

    def publisher(self, name: str, kind: type, **options: Any) -> rospy.Publisher:
        """Publish on a topic; options as rospy.Publisher takes them."""
        publisher = rospy.Publisher(self.resolve(name), kind, **options)
        self._ends.append(publisher.unregister)
        return publisher

    def subscriber(self, name: str, kind: type, callback: Callable[[Any], Any], **options: Any) -> rospy.Subscriber:
        """Have the messages of a topic; options as rospy.Subscriber takes them."""
        subscriber = rospy.Subscriber(self.resolve(name), kind, callback, **options)
        self._ends.append(subscriber.unregister)
        return subscriber

    def service(self, name: str, kind: type, answer: Callable[[Any], Any]) -> rospy.Service:
        """Offer a service; what `answer` raises goes its way."""
        service = rospy.Service(self.resolve(name), kind, answer)
        self._ends.append(service.shutdown)
        return service

    def offer(self, name: str, kind: type, answer: Callable[[Any], Any]) -> None:
        """Offer a service whose client gets the text of what goes wrong.

        Args:
            name: Name of the service.
            kind: Its type.
            answer: Gets the request and gives the response; None stands for an empty one. A NaoError is told and
                logged; Preempted means that the part ends.
        """

        def serve(request: Any) -> Any:
            try:
                response = answer(request)
            except Preempted as signal:
                raise rospy.ServiceException("the node ends") from signal
            except NaoError as error:
                rospy.logerr("%s: %s", name, error)
                raise rospy.ServiceException(str(error)) from error
            return kind._response_class() if response is None else response

        self.service(name, kind, serve)

    def caller(self, name: str, kind: type) -> rospy.ServiceProxy:
        """What calls a service."""
        return rospy.ServiceProxy(self.resolve(name), kind)

    def action(self, name: str, kind: type, goals: Any) -> None:
        """Serve an action.

        Args:
            name: Name of the action.
            kind: Its type.
            goals: Takes goals and cancels: a GoalCrowd.
        """
        server = ActionServer(self.resolve(name), kind, goals.on_goal, goals.on_cancel, auto_start=False)
        server.start()
        self._ends.append(server.stop)

    def at_the_end(self, action: Callable[[], Any]) -> None:
        """Have something done when the part ends; what was left last is done first."""
        self._ends.append(action)

    def close(self) -> None:
        """Take back all that was made."""
        while self._ends:
            self._ends.pop()()

"""What a part of a node has of ROS: names, parameters, topics, services, actions."""

from __future__ import annotations

import socket
from collections.abc import Callable
from typing import Any

import rosgraph
import rospy

from naoqi.errors import NaoError

from ..core.errors import Preempted, with_code
from ..core.processes import close_all
from ..core.server_types import names_of
from .action_server import ActionServer
from .driver_types import spoken

PROBE_LIMIT = 1.0
"""s that a node may take to take a connection, to count as alive."""


class AlreadyOffered(NaoError):
    """Another node that is alive offers a service."""

    def __init__(self, service: str, node: str) -> None:
        super().__init__(f"{node} offers {service} already: leave the part out there (~parts of nao_driver), or here")
        self.node = node


class NodeInterface:
    """The side to ROS of something that has a name of its own: a node, or one of several parts of a node.

    Names are as everywhere in ROS: "speech" is relative to the namespace of the part, "~rate" is the part's own. Types
    are those of this library; others see the names that `driver_types.spoken` gives them.
    `name`: full name. `namespace`: that the name is in, with a slash at both ends. `offered`: what was made so far,
    kind -> full names.
    """

    def __init__(self, name: str = "") -> None:
        """Make nothing yet. `name`: of the part, relative to the node's namespace; empty: the node itself."""
        self.name = rospy.resolve_name(name) if name else rospy.get_name()
        self.namespace = self.name.rpartition("/")[0] + "/"
        self.offered: dict[str, list[str]] = {"publishes": [], "subscribes": [], "services": [], "actions": []}
        self._ends: list[Callable[[], Any]] = []

    def resolve(self, name: str) -> str:
        """The full name behind a name, remapped."""
        return rospy.names.resolve_name(name, self.name)

    def param(self, name: str, default: Any = None) -> Any:
        """A parameter, or the default where it is not set."""
        return rospy.get_param(self.resolve(name), default)

    def has_param(self, name: str) -> bool:
        return rospy.has_param(self.resolve(name))

    def publisher(self, name: str, kind: type, **options: Any) -> rospy.Publisher:
        """Publish on a topic; options as rospy.Publisher takes them."""
        publisher = rospy.Publisher(self.resolve(name), spoken(kind), **options)
        self.offered["publishes"].append(publisher.resolved_name)
        self._ends.append(publisher.unregister)
        return publisher

    def subscriber(self, name: str, kind: type, callback: Callable[[Any], Any], **options: Any) -> rospy.Subscriber:
        """Have the messages of a topic; options as rospy.Subscriber takes them."""
        subscriber = rospy.Subscriber(self.resolve(name), spoken(kind), callback, **options)
        self.offered["subscribes"].append(subscriber.resolved_name)
        self._ends.append(subscriber.unregister)
        return subscriber

    def service(self, name: str, kind: type, answer: Callable[[Any], Any]) -> rospy.Service:
        """Offer a service; what `answer` raises goes its way.

        Raises:
            AlreadyOffered: Another node does. It would lose its clients, and take them back to nobody at its end.
        """
        other = node_that_offers(self.resolve(name))
        if other:
            raise AlreadyOffered(self.resolve(name), other)
        service = rospy.Service(self.resolve(name), spoken(kind), answer)
        self.offered["services"].append(service.resolved_name)
        self._ends.append(service.shutdown)
        return service

    def offer(self, name: str, kind: type, answer: Callable[[Any], Any]) -> None:
        """Offer a service whose client gets the text of what goes wrong.

        `answer` gets the request and gives the response; None stands for an empty one. A NaoError of it is told and
        logged; Preempted means that the part ends.
        """

        def serve(request: Any) -> Any:
            try:
                response = answer(request)
            except Preempted as signal:
                raise rospy.ServiceException("the node ends") from signal
            except NaoError as error:
                rospy.logerr("%s: %s", name, error)
                raise rospy.ServiceException(with_code(error)) from error
            return kind._response_class() if response is None else response

        self.service(name, kind, serve)

    def caller(self, name: str, kind: type) -> rospy.ServiceProxy:
        return rospy.ServiceProxy(self.resolve(name), kind)

    def action(self, name: str, kind: type, goals: Any) -> None:
        """Serve an action. `kind`: its type. `goals`: takes goals and cancels: a ConcurrentActionServer."""
        server = ActionServer(self.resolve(name), spoken(kind), goals.on_goal, goals.on_cancel, auto_start=False)
        server.start()
        self.offered["actions"] += names_of(server.ns)
        self._ends.append(server.stop)

    def if_it_fails(self, action: Callable[[], Any]) -> None:
        """Have something done when the part cannot be made; what was left last is done first."""
        self._ends.append(action)

    def fail(self) -> None:
        """Take back all that was made: the part cannot be. At the end of the node rospy does it, after all else."""
        ends, self._ends = self._ends, []
        close_all(*reversed(ends))


def node_that_offers(service: str) -> str:
    """Another node that offers a service and is alive; empty if there is none. `service`: full name."""
    own = rospy.get_name()
    master = rosgraph.Master(own)
    try:
        address = master.lookupService(service).partition("://")[2].strip("/")
        host, _, port = address.rpartition(":")
        socket.create_connection((host, int(port)), PROBE_LIMIT).close()
        node = next(nodes[0] for name, nodes in master.getSystemState()[2] if name == service)
    except (rosgraph.MasterError, StopIteration, OSError):  # of one that was killed the master does not know
        return ""
    return "" if node == own else node

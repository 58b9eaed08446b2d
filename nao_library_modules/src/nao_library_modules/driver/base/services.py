"""Services of the driver's nodes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy

from naoqi.errors import NaoError

from ...base.errors import Preempted


def offer(name: str, kind: type, answer: Callable[[Any], Any]) -> None:
    """Offer a service whose client gets the text of what goes wrong.

    Args:
        name: Name of the service.
        kind: Its type.
        answer: Gets the request and gives the response; None stands for an empty one. A NaoError is told and logged;
            Preempted means that the node ends.
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

    rospy.Service(name, kind, serve)

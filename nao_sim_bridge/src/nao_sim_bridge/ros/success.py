"""ROS services that answer `success` and `message`. Thin over `task_success.py`."""

from __future__ import annotations

from typing import Any, Callable

import rospy

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.ros.limits import checked
from nao_sim_bridge.server.task_success import success_of


def success_service(
    name: str, kind: Any, answer: Callable[..., Any], begin: Callable[[Any], Task], when_killed: str
) -> rospy.Service:
    """Offer a service that answers when what it begins has ended.

    Args:
        answer: Class of its answer, which has `success` and `message`; whatever else it has keeps its default.
        begin: Starts what a request asks for.
        when_killed: What to say when that was ended before its time.
    """

    def handle(request: Any) -> Any:
        success, message = success_of(lambda: begin(checked(request)), when_killed)
        return answer(success=success, message=message)

    return rospy.Service(name, kind, handle)

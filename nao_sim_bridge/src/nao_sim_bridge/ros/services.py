"""What the simulator's ROS services share: bounds of their requests, and answers of `success` and `message`."""

from __future__ import annotations

from typing import Any, Callable

import rospy

from nao_sim_bridge.base.limits import check, field_kind
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.naoqi.binding.limits import check_sizes

ERRORS = (RuntimeError, ValueError, OSError)
"""What a call to the server fails with; a service answers their text."""
STOPPED = "it was stopped"


def checked(request: Any) -> Any:
    """A request whose numbers are within the bounds of the fields that they are in, and whose texts are not too long.

    Raises:
        BadValue: One of them is not.
    """
    check_sizes(_plain(request))
    for field in request.__slots__:
        check(_plain(getattr(request, field)), field, field_kind(field))
    return request


def _plain(value: Any) -> Any:
    """A message as a list, a duration as seconds; anything else as it is."""
    if hasattr(value, "to_sec"):
        return value.to_sec()
    slots = getattr(value, "__slots__", None)
    return value if slots is None else [_plain(getattr(value, slot)) for slot in slots]


def success_service(name: str, kind: Any, begin: Callable[[Any], object], when_killed: str = STOPPED) -> None:
    """Offer a service that answers with `success` and `message`; whatever else its answer has keeps its default.

    Args:
        begin: Does what a request asks for, or starts a task that does; see `success_of`.
    """

    def handle(request: Any) -> dict[str, Any]:
        success, message = success_of(lambda: begin(checked(request)), when_killed)
        return {"success": success, "message": message}

    rospy.Service(name, kind, handle)


def success_of(begin: Callable[[], object], when_killed: str = STOPPED) -> tuple[bool, str]:
    """Wait for what `begin` does or starts, and for what that leads to; (True, ""), or (False, what was wrong).

    Args:
        begin: May start a task, whose result may be another one.
        when_killed: What to say of a task that was ended before its time.
    """
    ended = None
    try:
        task = begin()
        while isinstance(task, Task):
            ended, task = task, task.result()
    except ERRORS as error:
        return False, str(error)
    return (False, when_killed) if ended is not None and ended.killed else (True, "")

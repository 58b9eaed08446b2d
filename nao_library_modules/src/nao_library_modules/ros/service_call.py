"""Calls of services from nodes, with a limit: rospy has none."""

from __future__ import annotations

import threading
from typing import Any

import rospy

from naoqi.errors import NaoError

LIMIT = 10.0
"""s of the computer that a server has for its answer."""


class NotAnswered(NaoError):  # noqa: N818  it says what became of the question
    """A service is not there, refuses, or does not answer in time."""


def call_service(name: str, kind: type, request: Any, limit: float = LIMIT) -> Any:
    """Call a service, if it is there.

    `limit`: s of the computer for the answer. Raises NotAnswered if it is not there, refuses, or does not answer in
    time.
    """
    full = rospy.resolve_name(name)
    try:
        code, _, _ = rospy.get_master().lookupService(full)
    except OSError as error:
        raise NotAnswered(f"there is no ROS master: {error}") from None
    if code != 1:
        raise NotAnswered(f"there is no service {full}")
    answers: list[Any] = []
    errors: list[Exception] = []

    def ask() -> None:
        try:
            answers.append(rospy.ServiceProxy(full, kind)(request))
        except (rospy.ServiceException, rospy.ROSException) as error:
            errors.append(error)

    asking = threading.Thread(target=ask, daemon=True)  # a call of rospy cannot be ended
    asking.start()
    asking.join(limit)
    if errors:
        raise NotAnswered(f"{full}: {errors[0]}")
    if not answers:
        raise NotAnswered(f"{full} does not answer within {limit:g} s")
    return answers[0]

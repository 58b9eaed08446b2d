"""Asks a server whether it could carry out goals, before they are sent: for scripts and servers that are nodes.

from nao_library_modules.check_client import check_goals

goal = NaoLedGoal([LedFunction(function="on", lights=["FaceLed"])])
for problem in check_goals("NaoLights", goal).problems:
    print(problem)
"""

from __future__ import annotations

import threading
from typing import Any

import rospy

from nao_library_msgs.srv import CheckGoals
from naoqi.errors import NaoError

from ..functions.check_service import CHECK, NotValidated, check_request, read_response
from ..functions.goal_checks import GoalCheck

LIMIT = 10.0
"""s of the computer that a server has for its answer."""


class NotAnswered(NaoError):
    """A service is not there, refuses, or does not answer in time."""


class NoService(NotAnswered):
    """A service is not there, or the ROS master is not."""


def check_goals(server: str, *goals: Any, limit: float = LIMIT) -> GoalCheck:
    """What is wrong with goals; nothing is done, and a goal that runs goes on.

    Raises NotValidated if it is not there, has no such service, or does not answer in time.

    Args:
        server: Name of the action: NaoMotion.
        goals: Of its type, in the order in which they would be sent.
        limit: s that the server has.
    """
    try:
        return read_response(call_service(server + CHECK, CheckGoals, check_request(goals), limit))
    except NotAnswered as error:
        raise NotValidated(str(error)) from None


def call_service(name: str, kind: type, request: Any, limit: float = LIMIT) -> Any:
    """Call a service, if it is there; rospy's calls have no limit.

    `limit`: s of the computer for the answer. Raises NoService if it is not there, NotAnswered if it refuses or does
    not answer in time.
    """
    full = rospy.resolve_name(name)
    try:
        code, _, _ = rospy.get_master().lookupService(full)
    except OSError as error:
        raise NoService(f"there is no ROS master: {error}") from None
    if code != 1:
        raise NoService(f"there is no service {full}")
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

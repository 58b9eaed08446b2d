"""Asks a server whether it could carry out goals, before they are sent: for scripts and servers that are nodes.

from nao_library_modules.check_client import check_goals

goal = NaoLedGoal([LedFunction(function="on", lights=["FaceLed"])])
for problem in check_goals("NaoLights", goal).problems:
    print(problem)
"""

from __future__ import annotations

from typing import Any

from nao_library_msgs.srv import CheckGoals

from ..functions.check_service import CHECK, NotValidated, check_request, read_response
from ..functions.goal_checks import GoalCheck
from .service_call import LIMIT, NotAnswered, call_service


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

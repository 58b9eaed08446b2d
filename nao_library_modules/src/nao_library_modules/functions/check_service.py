"""The service that tells whether a server could carry out goals: from messages to checks and back."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from io import BytesIO
from typing import Any

import genpy

from nao_library_msgs import msg
from nao_library_msgs.srv import CheckGoalsRequest, CheckGoalsResponse
from naoqi.errors import NaoError

from .goal_checks import GoalCheck, GoalProblem, check_goals

CHECK = "/check"
"""What the service is called behind the name of the action."""


class NotValidated(NaoError):
    """A server did not say whether it could carry out goals."""


class CheckService:
    """Answers for one server. Clients come in threads of their own, and each has a check of its own.

    ROS API:
        Service `NAME/check` (nao_library_msgs/CheckGoals), NAME the name of the action.
    """

    def __init__(self, module: Any, action: type) -> None:
        self._module = module
        self._goal = type(action().action_goal.goal)

    def answer(self, request: Any) -> Any:
        kind = self._goal
        if (request.type, request.md5sum) != (kind._type, kind._md5sum):
            asked = f"{request.type} ({request.md5sum})"
            return CheckGoalsResponse(refused=f"its goals are {kind._type} ({kind._md5sum}), and not {asked}")
        try:
            goals = [kind().deserialize(goal.data) for goal in request.goals]
        except (genpy.DeserializationError, struct.error) as error:
            return CheckGoalsResponse(refused=f"what was sent is no {kind._type}: {error}")
        check = check_goals(self._module, goals)
        return CheckGoalsResponse("", list(map(_message, check.problems)), list(map(_message, check.unchecked)))


def check_request(goals: Sequence[Any]) -> Any:
    """What to ask a server. `goals`: of one type, at least one."""
    serialized = []
    for goal in goals:
        buffer = BytesIO()
        goal.serialize(buffer)
        serialized.append(msg.SerializedGoal(buffer.getvalue()))
    return CheckGoalsRequest(goals[0]._type, goals[0]._md5sum, serialized)


def read_response(response: Any) -> GoalCheck:
    """What a server answered. Raises NotValidated if it did not look at the goals."""
    if response.refused:
        raise NotValidated(response.refused)
    return GoalCheck(tuple(map(_problem, response.problems)), tuple(map(_problem, response.unchecked)))


def _message(problem: GoalProblem) -> msg.GoalProblem:
    return msg.GoalProblem(problem.goal, problem.index, problem.function, problem.field, problem.text)


def _problem(message: msg.GoalProblem) -> GoalProblem:
    return GoalProblem(message.goal, message.index, message.function, message.field, message.text)

"""Clients of action servers: SimpleActionClient, a tracker of one goal, and checks of goals before they are sent."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, ClassVar

import actionlib
import rospy
from actionlib import CommState

from nao_library_msgs.srv import CheckGoals
from naoqi.errors import NaoError
from naoqi.limits import GOAL_END_LIMIT

from ..core.describe import CHECK, NotValidated, check_request, read_response
from ..core.goal_checks import GoalCheck
from ..core.process_owners import GOAL, OwnerLine


class SimpleActionClient(actionlib.SimpleActionClient):
    """As actionlib's, for goals that may be over within milliseconds.

    actionlib's notes which goal it sent after it has sent it. What the server says before that is taken for news of
    another goal and dropped (ros/actionlib #206): on a busy computer, the end of one goal in a thousand that only asks
    for a value. Then `wait_for_result` waits for ever, or up to its limit.

    The servers of this library end no goal so soon (`~soonest_end`, 5 ms; docs/functions.md), so actionlib's own client
    with a limit does for them. This one is for servers of others, and for whoever sets `~soonest_end` to 0 because
    goals shall take no longer than they must. It looks at news when the goal is noted, and says nothing of news of the
    goal before.
    """

    def __init__(self, name: str, action: type) -> None:
        self._sending = threading.RLock()
        super().__init__(name, action)

    def send_goal(self, *arguments: Any, **options: Any) -> None:
        """Send a goal, and forget about the one before; arguments as actionlib's."""
        with self._sending:
            super().send_goal(*arguments, **options)

    # The names are actionlib's: it calls them in the threads of its topics.

    def _handle_transition(self, gh: Any) -> None:
        if self._is_of_this_goal(gh):
            super()._handle_transition(gh)

    def _handle_feedback(self, gh: Any, feedback: Any) -> None:
        if self._is_of_this_goal(gh):
            super()._handle_feedback(gh, feedback)

    def _is_of_this_goal(self, gh: Any) -> bool:
        with self._sending:  # not during what follows: a callback may wait for who sends
            return gh == self.gh


SERVER_LIMIT = 20.0
"""s in which a client finds a server that is there: rospy connects topics one by one, on a busy computer in seconds."""
ACKNOWLEDGEMENT_LIMIT = 5.0
"""s that a server may take to tell of a goal before it is cancelled all the same."""


class GoalTracker:
    """Sees what becomes of one goal.

    While it goes on it is noted as owned by this process, so that it is cancelled if the process dies.

    Attributes:
        owners: The line of this process to the watch of owners, None where its node has none.
        acknowledged: Set as soon as the server has told of the goal.
        over: Set by its end.

    Args:
        on_end: Called at the end, in actionlib's thread and under the client's lock: it has to be quick.
    """

    owners: ClassVar[OwnerLine | None] = None
    END_LIMIT: ClassVar[float] = GOAL_END_LIMIT
    """s that a server may take to end a goal that was cancelled."""

    def __init__(self, on_end: Callable[[], None] | None = None) -> None:
        self.acknowledged = threading.Event()
        self.over = threading.Event()
        self._on_end = on_end

    def look(self, handle: Any) -> None:
        """To be called at each transition: the `transition_cb` of `send_goal`."""
        state = handle.get_comm_state()
        if self.owners is not None:
            self.owners.let_go(self) if state == CommState.DONE else self.owners.hold(self, "goal", _cure(handle))
        if state != CommState.WAITING_FOR_GOAL_ACK:
            self.acknowledged.set()
        if state == CommState.DONE:
            self.over.set()
            if self._on_end is not None:
                self._on_end()

    def cancel(self, handle: Any, limit: float = ACKNOWLEDGEMENT_LIMIT) -> bool:
        """Cancel the goal, unless it is over.

        `handle`: the client's handle of the goal. `limit`: s of this computer to wait until the server has told of the
        goal. Returns whether it was cancelled; False: it was over before.
        """
        self.acknowledged.wait(limit)
        with handle.comm_state_machine.mutex:  # nothing comes in between
            if self.over.is_set():
                return False
            handle.cancel()
            return True


def _cure(handle: Any) -> list[Any]:
    """What cancels a goal whose client has died: see `core/process_owners.py`."""
    goal = handle.comm_state_machine
    return [GOAL, goal.send_cancel_fn.__self__.resolved_name, goal.action_goal.goal_id.id]


def server_connection(client: Any) -> Any:
    """What goals of a client go through to the server; None while there is none.

    Another one after the server was started again. Who only listens to goals, as a recorder does, is no server.
    """
    status = client.last_status_msg
    if status is None:
        return None
    server = status._connection_header["callerid"]
    return next((each for each in client.pub_goal.impl.connections if each.endpoint_id == server), None)


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

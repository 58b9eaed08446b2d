"""A goal of actionlib's client, watched from its acknowledgement to its end, and cancelled so that its end is not lost.

That client has two traps. It forgets that a goal is over when it cancels it. And it takes a goal for lost that it
cancels before the server has told of it, for the next status message may have been made before the goal came.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, ClassVar

from actionlib import CommState

from naoqi.limits import GOAL_END_LIMIT

from ..owners.line import GOAL, OwnerLine

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
    """What cancels a goal whose client has died: see `owners/stops.py`."""
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

"""Goals with actionlib's own state machine but without its topics, and a server that a test has say what it likes."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from actionlib import CommState
from actionlib.action_client import ClientGoalHandle, CommStateMachine
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from nao_library_actions.msg import NaoLedActionGoal, NaoLedActionResult


class _LateLock:
    """The lock of a goal; something happens just before it is taken for the first time."""

    def __init__(self, lock, before):
        self._lock = lock
        self._before = [before]

    def __enter__(self):
        if self._before:
            self._before.pop()()
        return self._lock.__enter__()

    def __exit__(self, *error):
        return self._lock.__exit__(*error)


class FakeGoal:
    """A goal that was sent, and its server.

    The server ends a goal that is cancelled, if it has told of it. Else the next thing that it tells does not have it.

    Attributes:
        handle: As actionlib's client gives it.
        cancelled: State of the client at each cancel.
    """

    def __init__(self, on_transition):
        self._id = GoalID(id="goal")
        self.cancelled = []
        self._machine = CommStateMachine(NaoLedActionGoal(goal_id=self._id), on_transition, None, None, self._on_cancel)
        self.handle = ClientGoalHandle(self._machine)

    def tell(self, *states, text=""):
        """A status message: the goal in this state, or without it."""
        told = [GoalStatus(self._id, state, text) for state in states]
        self._machine.update_status(GoalStatusArray(status_list=told))

    def end(self, state, text=""):
        """The result."""
        self._machine.update_result(NaoLedActionResult(status=GoalStatus(self._id, state, text)))

    def just_before_the_cancel(self, action):
        """What happens between the last look at the goal and its cancel."""
        self._machine.mutex = _LateLock(self._machine.mutex, action)

    def _on_cancel(self, _):
        state = self._machine.state
        self.cancelled.append(state)
        known = state not in (CommState.WAITING_FOR_GOAL_ACK, CommState.DONE)
        # Told by another thread: it has to wait until the client has done with the cancel.
        answer = (lambda: self.end(GoalStatus.PREEMPTED, "preempted")) if known else self.tell
        threading.Thread(target=answer, daemon=True).start()


class FakeActionClient:
    """Stands for actionlib's; what happens to each goal that it sends, a test says."""

    last_status_msg = SimpleNamespace(_connection_header={"callerid": "/server"})
    pub_goal = SimpleNamespace(impl=SimpleNamespace(connections=[SimpleNamespace(endpoint_id="/server")]))

    def __init__(self, on_sent):
        self._on_sent = on_sent
        self.goals = []

    def wait_for_server(self, *_):
        return True

    def send_goal(self, goal, on_transition=None, on_feedback=None):
        self.goals.append(FakeGoal(on_transition))
        self._on_sent(self.goals[-1])
        return self.goals[-1].handle

"""Goals of a test: sent, watched, and waited for."""

from __future__ import annotations

import threading
from typing import Any, Callable, NamedTuple

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_sim_bridge.testing.waits import LIMIT, StackNotReady


class _End(NamedTuple):
    """How a goal ended: its result, the simulated time here and at the server in s, the state and its text."""

    result: Any
    time: float
    server_time: float
    state: int
    text: str


def _of_end(name: str, text: str) -> Any:
    return property(lambda run: getattr(run._ended(), name), doc=text)


class GoalRun:
    """A goal that was sent, and what came back so far.

    It stands on actionlib's ActionClient: SimpleActionClient loses the end of a goal that is over before its
    `send_goal` has returned, which a test of quick goals meets now and then. Feedback that comes after the result, on
    its own topic, is kept, too; actionlib drops it.

    Attributes:
        feedback: (simulated time in s, feedback message) of each feedback.
        sent: Simulated time at which the goal was sent, s.
    """

    def __init__(self, client: actionlib.SimpleActionClient, goal: Any) -> None:
        self.feedback: list[tuple[float, Any]] = []
        self.sent = rospy.get_time()
        self._news = threading.Condition()
        self._known = False
        self._end: _End | None = None
        self._handle = client.action_client.send_goal(goal, self._on_transition, self._on_feedback)
        self._handle.comm_state_machine.update_feedback = self._on_any_feedback

    @property
    def running(self) -> bool:
        """Whether it has not ended yet; until then `state`, `text`, `result` and `ended` raise StackNotReady."""
        return self._end is None

    state: int = _of_end("state", "Terminal state (actionlib_msgs/GoalStatus); only after `wait`, as the next.")
    text: str = _of_end("text", "Text of the end state.")
    result: Any = _of_end("result", "Result message.")
    ended: float = _of_end("time", "Simulated time at which the result came, s.")
    server_time: float = _of_end("server_time", "Simulated time at the end as the server knew it, s.")

    def cancel(self) -> None:
        """Ask the server to end the goal, unless it is over: actionlib's client would forget that.

        The server has to know of the goal before: actionlib's client may take one for lost that is cancelled sooner.

        Raises:
            StackNotReady: The server says nothing of the goal.
        """
        self._wait(lambda: self._known, LIMIT, "word of the server that it has the goal")
        with self._handle.comm_state_machine.mutex:  # the end does not come in between
            if self._end is None:
                self._handle.cancel()

    def wait(self, limit: float = LIMIT) -> GoalRun:
        """Wait for the end, at most `limit` s of wall time.

        Raises:
            StackNotReady: There is no result in time.
        """
        self._wait(lambda: self._end is not None, limit, "result of the goal")
        return self

    def wait_for_function(self, index: int, limit: float = LIMIT) -> GoalRun:
        """Wait until function `index` (from 0) of the chain begins, at most `limit` s of wall time.

        The end of a goal and its feedback come on different topics: when the end is there first, its result tells.

        Raises:
            StackNotReady: It has not begun in time, or the goal ended before.
        """

        def begun() -> bool:
            # Before the first one it may tell what it waits for.
            if any(feedback.index >= index and feedback.function for _, feedback in self.feedback):
                return True
            return self._end is not None and (self.state == GoalStatus.SUCCEEDED or len(self.result.results) > index)

        self._wait(lambda: begun() or self._end is not None, limit, f"feedback of function {index}")
        if not begun():
            state = GoalStatus.to_string(self.state)
            raise StackNotReady(f"the goal ended before function {index} began: {state} {self.text}")
        return self

    def _ended(self) -> _End:
        if self._end is None:
            raise StackNotReady("the goal has not ended yet: call wait() first")
        return self._end

    def _wait(self, condition: Callable[[], bool], limit: float, what: str) -> None:
        with self._news:
            if not self._news.wait_for(condition, limit):
                raise StackNotReady(f"not there within {limit:g} s: {what}")

    def _on_feedback(self, _handle: Any, feedback: Any) -> None:
        with self._news:
            self.feedback.append((rospy.get_time(), feedback))
            self._news.notify_all()

    def _on_any_feedback(self, message: Any) -> None:
        if message.status.goal_id.id == self._handle.comm_state_machine.action_goal.goal_id.id:
            self._on_feedback(self._handle, message.feedback)

    def _on_transition(self, handle: Any) -> None:
        with self._news:
            self._known = True
            self._news.notify_all()
        if handle.get_comm_state() == actionlib.CommState.DONE:
            with self._news:
                state, text = handle.get_terminal_state(), handle.get_goal_status_text()
                answer = handle.comm_state_machine.latest_result  # none of a goal that was lost
                there = answer.header.stamp.to_sec() if answer else 0.0
                self._end = _End(handle.get_result(), rospy.get_time(), there, state, text)
                self._news.notify_all()


def send(client: actionlib.SimpleActionClient, goal: Any) -> GoalRun:
    """Send a goal and return at once."""
    return GoalRun(client, goal)

"""Goals of actions in plans: sent, waited for, and cancelled when the plan does not want them any more."""

from __future__ import annotations

import logging
import math
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from ..core.errors import of_those
from ..ros.driver_types import spoken
from ..ros.goal_client import SERVER_LIMIT, GoalTracker, server_connection
from .control import Step, subtask
from .failures import ActionlibActionTimedOut, LowLevelFailure
from .fluents import Fluent, retry_after_suspension, uninterrupted, wait_until

log = logging.getLogger(__name__)

LOOK_PERIOD = 0.5
"""s of the plan's clock after which is looked how long that was."""


@dataclass(frozen=True)
class ActionEnd:
    """How a goal ended: one of `actionlib_msgs/GoalStatus`, the server's text, and its result (None if it has none)."""

    status: int
    text: str
    result: Any

    @property
    def succeeded(self) -> bool:
        return self.status == GoalStatus.SUCCEEDED

    def __str__(self) -> str:
        return self.text or f"it ended {GoalStatus.to_string(self.status).lower()}"


class PlanActionClient:
    """Client of an action for plans; several goals may run at once.

    Based on actionlib's ActionClient: SimpleActionClient knows one goal at a time, and polls for its end every tenth of
    a second. `timeout`: longest time a goal may take, s of the plan's clock; None for ever.
    """

    def __init__(self, name: str, action: type, timeout: float | None = None) -> None:
        self.name = name
        self.timeout = timeout
        self._client = actionlib.ActionClient(name, spoken(action))
        self._there = Fluent(f"server of {name}", False)
        threading.Thread(target=self._look_for_server, name=f"server of {name}", daemon=True).start()

    def call(
        self,
        goal: Any,
        timeout: float | None = None,
        on_feedback: Callable[[Any], None] | None = None,
        on_end: Callable[[ActionEnd], None] | None = None,
    ) -> ActionEnd:
        """Send a goal and wait for its end, in a plan.

        A plan that ends cancels it and waits for its end. A suspension cancels it; it is sent again afterwards. Raises
        ActionlibActionTimedOut if there is no server, or the goal took too long; LowLevelFailure if the server went
        away.

        Args:
            timeout: s; default: that of the client.
            on_feedback: Gets the feedback, in actionlib's thread.
            on_end: Gets the end, also that of a goal that was cancelled because the plan ends.
        """
        limit = self.timeout if timeout is None else timeout
        body = lambda: retry_after_suspension(lambda: self._once(goal, limit, on_feedback, on_end))  # noqa: E731
        return subtask(Step(f"action {self.name}", body))

    def wait_for_server(self, timeout: float = SERVER_LIMIT) -> None:
        """Wait until there is a server, in a plan; ActionlibActionTimedOut if there is none."""
        deadline = time.monotonic() + timeout
        while not wait_until(lambda: self._there.value and server_connection(self._client), [self._there], LOOK_PERIOD):
            if time.monotonic() < deadline:
                continue
            where = rospy.resolve_name(self.name)
            raise ActionlibActionTimedOut(f"there is no server for {where} after {timeout:g} s", action=self.name)

    def _wait_for_end(self, done: Fluent, connection: Any, limit: float | None) -> None:
        left = math.inf if limit is None else limit
        while left > 0.0:
            period = min(LOOK_PERIOD, left)
            if wait_until(lambda: done.value, [done], period):
                return
            if server_connection(self._client) is not connection:
                raise LowLevelFailure(f"the server of {self.name} has gone, and its goal with it")
            left -= period

    def _look_for_server(self) -> None:
        if self._client.wait_for_server():
            self._there.value = True

    def _once(
        self,
        goal: Any,
        limit: float | None,
        on_feedback: Callable[[Any], None] | None,
        on_end: Callable[[ActionEnd], None] | None,
    ) -> ActionEnd:
        self.wait_for_server()
        done = Fluent(f"goal of {self.name} is over", False)

        def end() -> None:
            done.value = True

        watch, cancelled = GoalTracker(end), False
        connection = server_connection(self._client)
        feedback_callback = None if on_feedback is None else lambda _, feedback: on_feedback(feedback)
        handle = self._client.send_goal(goal, watch.look, feedback_callback)
        try:
            self._wait_for_end(done, connection, limit)
        finally:
            if not done.value:
                with uninterrupted():
                    cancelled = watch.cancel(handle)
                    if not wait_until(lambda: done.value, [done], watch.END_LIMIT):
                        log.warning(
                            "the goal of %s was cancelled %g s ago and does not end", self.name, watch.END_LIMIT
                        )
            if done.value and on_end is not None:
                on_end(_end_of(handle))
        if cancelled:
            raise ActionlibActionTimedOut(f"the goal of {self.name} took longer than {limit:g} s", action=self.name)
        return _end_of(handle)


def _end_of(handle: Any) -> ActionEnd:
    return ActionEnd(handle.get_terminal_state(), handle.get_goal_status_text(), handle.get_result())


_lock = threading.Lock()
_clients: dict[str, PlanActionClient] = {}


def make_simple_action_client(name: str, ros_name: str, action: type, timeout: float | None = None) -> PlanActionClient:
    """The client known by a name, made if it is new; `timeout` is the longest time of a goal, s, or None."""
    with _lock:
        if name not in _clients:
            _clients[name] = PlanActionClient(ros_name, action, timeout)
        return _clients[name]


def get_simple_action_client(name: str) -> PlanActionClient:
    with _lock:
        if name not in _clients:
            raise KeyError(f"no action client {name!r}{of_those(name, _clients)}")
        return _clients[name]


def call_simple_action_client(name: str, goal: Any, timeout: float | None = None) -> ActionEnd:
    """See `PlanActionClient.call`."""
    return get_simple_action_client(name).call(goal, timeout)


def destroy_simple_action_clients() -> None:
    with _lock:
        _clients.clear()

"""Servers for behaviours without ROS: goals end as their `str_param` says."""

from __future__ import annotations

import threading
from types import SimpleNamespace

from actionlib_msgs.msg import GoalStatus

from nao_library_modules.process_modules.action_client import ActionEnd
from nao_library_modules.process_modules.failures import ActionlibActionTimedOut
from nao_library_modules.process_modules.flow import wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_msgs.msg import FunctionResult

HOLD, FAIL, FAIL_ONCE = "hold", "fail", "fail once"
LIMIT = 10.0


class FakeGoal:
    """A goal that was sent.

    Attributes:
        server: Name of the server.
        functions: Its function messages.
        end: Fluent with its ActionEnd, None until it is over.
    """

    def __init__(self, server, functions):
        self.server = server
        self.functions = functions
        self.end = Fluent("end", None)

    @property
    def text(self):
        return self.functions[0].str_param

    def succeed(self, values=()):
        results = [FunctionResult(function=each.function, values=list(values)) for each in self.functions]
        self.end.value = ActionEnd(GoalStatus.SUCCEEDED, "", SimpleNamespace(results=results))

    def abort(self, text="bad luck"):
        self.end.value = ActionEnd(GoalStatus.ABORTED, text, SimpleNamespace(results=[]))


class FakeClients:
    """Makes clients.

    Attributes:
        goals: All that were sent, in order.
        arrived: Released for every goal.
        most: Server -> how many goals it had at the same time at most.
        missing: Names of servers that are not there.
    """

    def __init__(self):
        self.goals = []
        self.arrived = threading.Semaphore(0)
        self.most = {}
        self.missing = set()
        self._lock = threading.Lock()
        self._tried = set()

    def __call__(self, name):
        return FakeClient(name, self)

    def next_goal(self):
        """Wait until one more goal is sent; all so far."""
        assert self.arrived.acquire(timeout=LIMIT), "no goal comes"
        return self.goals

    def running(self, server=None):
        with self._lock:
            return [g for g in self.goals if g.end.value is None and server in (None, g.server)]

    def send(self, goal):
        with self._lock:
            self.goals.append(goal)
            now = sum(g.end.value is None and g.server == goal.server for g in self.goals)
            self.most[goal.server] = max(self.most.get(goal.server, 0), now)
            first = repr(goal.functions) not in self._tried
            self._tried.add(repr(goal.functions))
        if goal.text.startswith(FAIL) and (goal.text != FAIL_ONCE or first):
            goal.abort()
        elif not goal.text.startswith(HOLD):
            goal.succeed(["done"])
        self.arrived.release()


class FakeClient:
    def __init__(self, name, board):
        self._name = name
        self._board = board

    def wait_for_server(self):
        if self._name in self._board.missing:
            raise ActionlibActionTimedOut(f"there is no server for {self._name}", action=self._name)

    def call(self, goal, on_feedback=None, on_end=None):
        sent = FakeGoal(self._name, goal.functions)
        self._board.send(sent)
        try:
            wait_until(lambda: sent.end.value is not None, [sent.end])
        finally:
            if sent.end.value is None:
                results = [FunctionResult(function="until", values=["cancelled"])]
                sent.end.value = ActionEnd(GoalStatus.PREEMPTED, "", SimpleNamespace(results=results))
            if on_end is not None:
                on_end(sent.end.value)
        return sent.end.value

"""Behaviours from texts, and runs of them with servers whose goals end as their `str_param` says."""

from __future__ import annotations

import textwrap
import threading
from types import SimpleNamespace

import pytest
from actionlib_msgs.msg import GoalStatus
from set_clock import SetClock

from nao_library_modules.behaviors import bind, read
from nao_library_modules.behaviors.behavior_errors import NoSuchBehavior
from nao_library_modules.behaviors.execution import Execution
from nao_library_modules.behaviors.server_functions import FunctionTables
from nao_library_modules.core.waiting import CancellationToken, WallClock
from nao_library_modules.process_modules import Fluent, wait_until
from nao_library_modules.process_modules.failures import ActionlibActionTimedOut
from nao_library_modules.process_modules.plan_action_client import ActionEnd
from nao_library_msgs.msg import FunctionResult

LIMIT = 60.0
HOLD, FAIL, FAIL_ONCE = "hold", "fail", "fail once"


class SentGoal:
    """A goal that was sent; `end` is a fluent with its ActionEnd, None until it is over."""

    def __init__(self, server, functions):
        self.server, self.functions, self.end = server, functions, Fluent("end", None)

    @property
    def text(self):
        return self.functions[0].str_param

    def over(self, status=GoalStatus.SUCCEEDED, text="", *values):
        results = [FunctionResult(function=each.function, values=list(values)) for each in self.functions]
        self.end.value = ActionEnd(status, text, SimpleNamespace(results=results))

    def abort(self):
        self.over(GoalStatus.ABORTED, "bad luck")


class Clients:
    """The clients of all servers.

    Attributes:
        goals: All that were sent, in order; `most` the most of a server at the same time.
        missing: Names of servers that are not there.
        feedback: What each goal tells before anything else.
    """

    def __init__(self):
        self.goals, self.most, self.missing, self.feedback = [], {}, set(), []
        self._arrived, self._lock, self._tried = threading.Semaphore(0), threading.Lock(), set()

    def __call__(self, name):
        return SimpleNamespace(
            wait_for_server=lambda: self._find(name), call=lambda goal, **options: self._call(name, goal, **options)
        )

    def hold(self, count=1):
        """Wait until so many more goals are sent; all so far."""
        for _ in range(count):
            assert self._arrived.acquire(timeout=LIMIT), "no goal comes"
        return self.goals

    def texts(self):
        return [goal.text for goal in self.goals]

    def of(self, text):
        return next(goal for goal in self.goals if goal.text == text)

    def running(self, server=None):
        return [goal for goal in self.goals if goal.end.value is None and server in (None, goal.server)]

    def _find(self, name):
        if name in self.missing:
            raise ActionlibActionTimedOut(f"there is no server for {name}", action=name)

    def _call(self, name, goal, on_feedback=None, on_end=None):
        sent = SentGoal(name, goal.functions)
        with self._lock:
            self.goals.append(sent)
            self.most[name] = max(self.most.get(name, 0), len(self.running(name)))
            first = repr(goal.functions) not in self._tried
            self._tried.add(repr(goal.functions))
        for each in self.feedback:
            on_feedback(each)
        if sent.text.startswith(FAIL) and (sent.text != FAIL_ONCE or first):
            sent.abort()
        elif not sent.text.startswith(HOLD):
            sent.over(GoalStatus.SUCCEEDED, "", "done")
        self._arrived.release()
        try:
            wait_until(lambda: sent.end.value is not None, [sent.end])
        finally:
            if sent.end.value is None:
                sent.over(GoalStatus.PREEMPTED, "", "cancelled")
            on_end(sent.end.value)
        return sent.end.value


class Run:
    """A program that runs in a thread of its own."""

    def __init__(self, program, clients, clock):
        self.events, self.error, self.interrupt = [], None, CancellationToken()
        self.execution = Execution(program, clients, clock, self.events.append)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        try:
            self.execution.run(self.interrupt)
        except Exception as error:
            self.error = error

    def ended(self):
        """Wait for the end; records by path."""
        self._thread.join(LIMIT)
        assert not self._thread.is_alive(), "the behaviour does not end"
        return {record.node.where: record for record in self.execution.report.records()}

    def states(self):
        return {path: record.state for path, record in self.ended().items()}

    def told(self):
        return [(event.node.where, event.state) for event in self.events]


@pytest.fixture(scope="session")
def tables():
    """Functions of all servers; looked up once."""
    return FunctionTables()


@pytest.fixture
def texts():
    """Name -> text of the behaviours that boxes may name."""
    return {}


@pytest.fixture
def library(texts):
    def load(name):
        if name not in texts:
            raise NoSuchBehavior(name, texts)
        return read(texts[name], name)

    return load


@pytest.fixture
def program(library):
    """Makes a program of the steps of a behaviour."""

    def make(steps, parameters="{}", **values):
        body = textwrap.indent(textwrap.dedent(steps).strip(), "  ")
        return bind(read(f"help: A test.\nparameters: {parameters}\ndo:\n{body}\n", "test"), values, library)

    return make


@pytest.fixture
def clients():
    return Clients()


@pytest.fixture
def clock():
    """Time that passes when the test says so."""
    return SetClock()


@pytest.fixture
def start(program, clients):
    """Runs steps, on the clock of the computer if there is no other."""
    return lambda steps, clock=None: Run(program(steps), clients, clock or WallClock())

"""A stack for the command line without ROS: what servers say is real, what they are sent is kept."""

from __future__ import annotations

import signal
import threading
from types import SimpleNamespace

import actionlib
import pytest
from actionlib import CommState
from actionlib_msgs.msg import GoalStatus
from click.testing import CliRunner

from nao_library_modules.cli import goals
from nao_library_modules.cli.app import nao
from nao_library_modules.cli.output import StackMissing
from nao_library_modules.core.describe import offline_servers
from nao_library_msgs.msg import FunctionResult

DESCRIBE = "/describe"


class FakeGraph:
    """A master with servers in some namespaces; services answer what the code says."""

    uri = "http://master:11311"

    def __init__(self, spaces, more):
        self.servers = {space + found.name: found for space in spaces for found in offline_servers()}
        self.more, self.calls, self.connected = dict(more), [], True
        self.parameters, self.dead = {}, set()

    def services(self):
        return [name + DESCRIBE for name in self.servers] + list(self.more)

    def subscribed(self):
        return {f"{name}/goal": ["/node"] for name in self.servers}

    def parameter(self, name):
        return self.parameters.get(name)

    def alive(self, service):
        return True

    def call(self, service, kind, request, patient=False):
        self.calls.append((service, request))
        if service in self.more:
            return self.more[service](request)
        if service[: -len(DESCRIBE)] in self.dead:
            raise StackMissing(f"{service} does not answer: connection refused")
        answer = self.servers[service[: -len(DESCRIBE)]].service.answer(request)
        answer.connected = self.connected
        return answer


@pytest.fixture
def graph(monkeypatch):
    """Makes a master; without, there is none."""

    def make(*spaces, services=()):
        fake = FakeGraph(spaces or ("/",), services)
        monkeypatch.setattr("nao_library_modules.cli.stack.Graph", lambda limit: fake)
        return fake

    monkeypatch.delenv("ROS_NAMESPACE", raising=False)
    return make


@pytest.fixture
def sent(monkeypatch):
    """Goals as they are sent: server and function messages. They end as `end` says, with what `fill` puts in.

    Those with a function of `lasting` go on until they are cancelled; with `interrupted` there is Ctrl-C meanwhile.
    """
    noted = SimpleNamespace(
        goals=[], end=(GoalStatus.SUCCEEDED, ""), fill=lambda result: None, lasting=(), interrupted=False
    )

    class Handle:
        def __init__(self, result, on_change, lasts):
            self._result, self._on_change, self._end = result, on_change, None
            self.comm_state_machine = SimpleNamespace(mutex=threading.RLock())
            if lasts:
                on_change(self)
            else:
                self._over(noted.end)

        def _over(self, end):
            noted.fill(self._result)
            self._end = end
            self._on_change(self)

        def cancel(self):
            self._over((GoalStatus.PREEMPTED, "preempted"))

        def get_comm_state(self):
            return CommState.ACTIVE if self._end is None else CommState.DONE

        def get_terminal_state(self):
            return self._end[0]

        def get_goal_status_text(self):
            return self._end[1]

        def get_result(self):
            return self._result

    class Client:
        def __init__(self, name, action):
            self._name, self._result = name, action().action_result.result

        def wait_for_server(self):
            return True

        def send_goal(self, goal, on_change, on_feedback):
            functions = getattr(goal, goal.__slots__[0])
            noted.goals.append((self._name, functions))
            if hasattr(self._result, "results"):
                self._result.results = [FunctionResult(function=each.function) for each in functions]
            lasts = any(each.function in noted.lasting for each in functions)
            handle = Handle(self._result, on_change, lasts)
            if lasts and noted.interrupted:
                signal.raise_signal(signal.SIGINT)
            return handle

    monkeypatch.setattr(actionlib, "ActionClient", Client)
    monkeypatch.setattr(goals, "start_node", lambda: None)
    return noted


@pytest.fixture
def run():
    """Runs the command; gives exit status, output and what was said besides."""

    def run(*arguments):
        # Standard error apart from standard output, whatever this version of click does by default.
        result = CliRunner(mix_stderr=False).invoke(nao, list(arguments), prog_name="nao")
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return result

    return run

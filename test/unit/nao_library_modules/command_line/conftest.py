"""A stack for the command line without ROS: what servers say is real, what they do is noted."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from click.testing import CliRunner

from nao_library_modules.command_line import goals
from nao_library_modules.command_line.app import nao
from nao_library_modules.command_line.stack import DESCRIBE
from nao_library_modules.describe_offline import offline_servers


class FakeGraph:
    """A master with servers in some namespaces; services answer what the code says."""

    uri = "http://master:11311"

    def __init__(self, spaces=("/",), more=()):
        self._servers = {space + found.name: found for space in spaces for found in offline_servers()}
        self._more = dict(more)
        self.calls = []
        self.connected = False

    def services(self):
        return [name + DESCRIBE for name in self._servers] + list(self._more)

    def subscribed(self):
        return {f"{name}/goal": ["/node"] for name in self._servers}

    def alive(self, service):
        return True

    def call(self, service, kind, request, patient=False):
        self.calls.append((service, request))
        if service in self._more:
            return self._more[service](request)
        answer = self._servers[service[: -len(DESCRIBE)]].service.answer(request)
        answer.connected = self.connected
        return answer


@pytest.fixture
def graph(monkeypatch):
    """Makes a master; without, there is none."""

    def make(*spaces, **more):
        fake = FakeGraph(spaces or ("/",), more.get("services", ()))
        monkeypatch.setattr("nao_library_modules.command_line.stack.Graph", lambda limit: fake)
        return fake

    monkeypatch.delenv("ROS_NAMESPACE", raising=False)
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:9")  # the port of the discard service: nobody listens
    return make


@pytest.fixture
def sent(monkeypatch):
    """Goals as they would be sent: server and function messages. They succeed, or end as `sent.end` says."""
    noted = SimpleNamespace(goals=[], end=("succeeded", ""), result={"results": []})

    def run(self, functions):
        noted.goals.append((self._relative, list(functions)))
        self.last = goals.GoalEnd(self._relative, *noted.end, dict(noted.result), 0.5)
        return self.last

    monkeypatch.setattr(goals.GoalRun, "run", run)
    return noted


@pytest.fixture
def run():
    """Runs the command; gives exit status, output and what was said besides."""

    def run(*arguments):
        # Standard error apart from standard output, whatever this version of click does by default.
        runner = CliRunner(mix_stderr=False)
        result = runner.invoke(nao, list(arguments), prog_name="nao")
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        return result

    return run

"""Behaviours from texts, and runs of them with servers that are not there."""

from __future__ import annotations

import textwrap
import threading

import pytest
from fake_clients import FakeClients
from set_clock import SetClock

from nao_library_modules.behaviors import bind, read
from nao_library_modules.behaviors.errors import NoSuchBehavior
from nao_library_modules.behaviors.execution import Execution
from nao_library_modules.behaviors.servers import FunctionTables
from nao_library_modules.clock import WallClock
from nao_library_modules.interrupt import Interrupt

LIMIT = 10.0


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


class Run:
    """A program that runs in a thread of its own."""

    def __init__(self, program, clients, clock):
        self.events = []
        self.error = None
        self.interrupt = Interrupt()
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


@pytest.fixture
def clients():
    return FakeClients()


@pytest.fixture
def start(program, clients):
    """Runs steps on the clock of the computer."""
    return lambda steps, clock=None, **options: Run(program(steps, **options), clients, clock or WallClock())


@pytest.fixture
def clock():
    """Time that passes when the test says so."""
    return SetClock()


@pytest.fixture(autouse=True)
def no_thread_is_left():
    before = set(threading.enumerate())
    yield
    for thread in set(threading.enumerate()) - before:
        thread.join(LIMIT)
        assert not thread.is_alive(), thread.name

"""Plans that run beside a test, and process modules that keep a log."""

from __future__ import annotations

import threading

import pytest
from cram_modules import Log, Many, One

from nao_library_modules.process_modules import registry
from nao_library_modules.process_modules.control import top_level
from nao_library_modules.process_modules.designators import locations
from nao_library_modules.process_modules.designators.objects import BELIEFS
from nao_library_modules.process_modules.registry import with_process_modules_running

LIMIT = 10.0


class Beside:
    """A plan that runs in a thread of its own; the test looks at its tree and waits for its end."""

    def __init__(self, body, **options):
        self.root = None
        self.answer = self.error = None
        self._there = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(body, options), daemon=True)
        self._thread.start()
        assert self._there.wait(LIMIT)

    def ended(self):
        """Wait for the end; the answer."""
        self._thread.join(LIMIT)
        assert not self._thread.is_alive(), "the plan does not end"
        if self.error is not None:
            raise self.error
        return self.answer

    def _run(self, body, options):
        try:
            self.answer = top_level(body, observers=[self._see], **options)
        except BaseException as error:
            self.error = error

    def _see(self, task):
        if self.root is None:
            self.root = task
            self._there.set()


@pytest.fixture
def beside():
    return Beside


@pytest.fixture
def run_plan():
    """Runs a plan here; its answer and its root task."""

    def run(body, **options):
        roots = []
        answer = top_level(body, observers=[roots.append], **options)
        return answer, roots[0]

    return run


@pytest.fixture
def nothing_is_known(monkeypatch):
    """Known objects, generators and validators of places are as they were before and after the test."""
    monkeypatch.setattr(locations, "_generators", list(locations._generators))
    monkeypatch.setattr(locations, "_validators", list(locations._validators))
    BELIEFS.clear()
    yield
    BELIEFS.clear()


@pytest.fixture(autouse=True)
def _no_module_stays_known(monkeypatch):
    """Modules and their names stay known when they have ended, for the next plan; not for the next test."""
    monkeypatch.setattr(registry, "_modules", {})
    monkeypatch.setattr(registry, "_aliases", {})


@pytest.fixture
def log():
    return Log()


@pytest.fixture
def one(log):
    with with_process_modules_running(One(log)) as (module,):
        yield module


@pytest.fixture
def many(log):
    with with_process_modules_running(Many(log)) as (module,):
        yield module


@pytest.fixture(autouse=True)
def no_thread_is_left():
    before = set(threading.enumerate())
    yield
    left = [thread for thread in threading.enumerate() if thread not in before and thread.is_alive()]
    for thread in left:
        thread.join(LIMIT)
    assert not [thread for thread in left if thread.is_alive()]

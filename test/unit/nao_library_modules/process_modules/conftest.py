"""Plans that run beside a test."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.process_modules.control import top_level

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


@pytest.fixture(autouse=True)
def no_thread_is_left():
    before = set(threading.enumerate())
    yield
    left = [thread for thread in threading.enumerate() if thread not in before and thread.is_alive()]
    for thread in left:
        thread.join(LIMIT)
    assert not [thread for thread in left if thread.is_alive()]

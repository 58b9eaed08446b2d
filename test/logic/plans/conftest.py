"""Plans, and process modules that keep a log; no thread outlives a test."""

from __future__ import annotations

import threading

import pytest
from plan_tools import LIMIT, Log, Many, One, Stays

from nao_library_modules.process_modules import BELIEFS, top_level, with_process_modules_running


@pytest.fixture
def run_plan():
    """Runs a plan; its answer and its root task."""

    def run(body, **options):
        roots = []
        answer = top_level(body, observers=[roots.append], **options)
        return answer, roots[0]

    return run


@pytest.fixture
def stays():
    return Stays()


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
def _nothing_is_left():
    BELIEFS.clear()
    before = set(threading.enumerate())
    yield
    BELIEFS.clear()
    for thread in set(threading.enumerate()) - before:
        thread.join(LIMIT)
        assert not thread.is_alive(), thread.name

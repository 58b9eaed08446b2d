"""The table of posted calls, the worker, and who is inside libqi."""

from __future__ import annotations

import threading

import pytest

from naoqi.errors import RobotError
from naoqi.presence import Presence
from naoqi.state import Timing
from naoqi.tasks import REMEMBERED_ERRORS, TaskTable
from naoqi.worker import Worker

PATIENCE = 20.0


class EndedCall:
    """A call that ended before it was put into the table."""

    method = "ALTest.go"

    def __init__(self, error=None):
        self._error = error

    def add_done_callback(self, callback):
        callback(self)

    def result(self):
        if self._error is not None:
            raise self._error


def failed(number):
    return EndedCall(RobotError("ALTest", "go", f"failure {number}"))


def test_numbers_of_calls_are_unique_known_and_over_with_their_call():
    table = TaskTable()
    first, second = table.add(EndedCall()), table.add(EndedCall())
    assert first != second and table.knows(first) and table.knows(second)
    assert not any(table.knows(other) for other in (0, second + 1, "1", True, None))
    assert not table.is_running(first)
    assert table.wait(first, None) is False


def test_the_newest_errors_are_kept_for_whoever_waits_and_all_are_logged(caplog):
    table = TaskTable()
    tasks = [table.add(failed(number)) for number in range(REMEMBERED_ERRORS + 1)]
    assert table.wait(tasks[0], None) is False
    for number in (1, REMEMBERED_ERRORS, REMEMBERED_ERRORS):
        with pytest.raises(RobotError, match=f"failure {number}$"):
            table.wait(tasks[number], None)
    assert "failure 0" in caplog.text


@pytest.fixture
def worker():
    worker = Worker("test worker")
    yield worker
    worker.close()


def test_jobs_keep_their_order(worker):
    done, seen = threading.Event(), []
    for number in range(100):
        worker.submit(lambda number=number: seen.append(number))
    worker.submit(done.set)
    assert done.wait(PATIENCE)
    assert seen == list(range(100))


def test_a_failing_job_is_logged_and_the_next_one_done(worker, caplog):
    done = threading.Event()
    worker.submit(lambda: 1 / 0)
    worker.submit(done.set)
    assert done.wait(PATIENCE)
    assert "ZeroDivisionError" in caplog.text


def test_closing_does_what_is_there_and_takes_nothing_more(worker):
    seen, done = [], threading.Event()
    worker.submit(lambda: (seen.append(1), worker.close(PATIENCE), done.set()))  # a job may close its worker
    assert done.wait(PATIENCE)
    assert worker.submit(lambda: seen.append(2)) is False
    other = Worker("other worker")
    other.submit(lambda: seen.append(3))
    other.close(PATIENCE)
    assert seen == [1, 3]


def test_who_is_inside_is_waited_for_until_it_leaves():
    presence, answers = Presence(), []
    assert presence.wait_until_empty(0.0)
    presence.enter(threading.get_ident())
    assert presence.wait_until_empty(0.0)  # the waiting thread itself does not count
    presence.enter("somebody")
    assert not presence.wait_until_empty(0.01)
    waiting = threading.Thread(target=lambda: answers.append(presence.wait_until_empty(PATIENCE)))
    presence.leave(threading.get_ident())
    waiting.start()
    presence.leave("somebody")
    presence.leave("nobody")
    waiting.join(PATIENCE)
    assert answers == [True]


def test_a_silent_robot_is_given_up_within_two_seconds():
    timing = Timing()
    assert timing.heartbeat_period + timing.heartbeat_limit < 2.0

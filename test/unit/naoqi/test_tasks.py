"""The table of posted calls forgets what is over, and never loses an error."""

from __future__ import annotations

import pytest

from naoqi.errors import RobotError
from naoqi.tasks import REMEMBERED_ERRORS, TaskTable


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


def test_numbers_are_unique_and_known():
    table = TaskTable()
    first, second = table.add(EndedCall()), table.add(EndedCall())
    assert first != second
    assert table.knows(first) and table.knows(second)
    assert not any(table.knows(other) for other in (0, second + 1, "1", True, None))


def test_a_call_that_is_over_does_not_run_and_needs_no_wait():
    table = TaskTable()
    task = table.add(EndedCall())
    assert not table.is_running(task)
    assert table.wait(task, None) is False


def test_the_error_of_a_call_can_be_had_more_than_once():
    table = TaskTable()
    task = table.add(failed(1))
    for _ in range(2):
        with pytest.raises(RobotError, match="failure 1"):
            table.wait(task, None)


def test_only_the_newest_errors_are_kept():
    table = TaskTable()
    tasks = [table.add(failed(number)) for number in range(REMEMBERED_ERRORS + 1)]
    assert table.wait(tasks[0], None) is False
    with pytest.raises(RobotError, match=f"failure {REMEMBERED_ERRORS}"):
        table.wait(tasks[-1], None)


def test_an_error_nobody_waits_for_is_in_the_log(caplog):
    TaskTable().add(failed(5))
    assert "failure 5" in caplog.text

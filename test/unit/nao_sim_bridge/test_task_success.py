"""What services tell of a task: its success, its error, or that it was ended before its time."""

from __future__ import annotations

from nao_sim_bridge.sim.errors import BadValue
from nao_sim_bridge.sim.tasks import Task
from nao_sim_bridge.task_success import success_of


def ended(result=None, error=None):
    task = Task("glide", 1)
    task.finish(result, error)
    return task


def test_a_task_that_leads_to_another_succeeds_with_that():
    assert success_of(lambda: ended(ended()), "stopped") == (True, "")


def test_an_error_on_the_way_is_told():
    assert success_of(lambda: ended(error=BadValue("mass", -1, "0 or more")), "stopped")[0] is False
    found = success_of(lambda: ended(ended(error=BadValue("mass", -1, "0 or more"))), "stopped")
    assert found == (False, str(BadValue("mass", -1, "0 or more")))


def test_what_cannot_begin_is_told():
    def begin():
        raise BadValue("name", "", "not empty")

    assert success_of(begin, "stopped") == (False, str(BadValue("name", "", "not empty")))


def test_a_task_that_was_ended_before_its_time_is_no_success():
    task = Task("glide", 1)
    task.kill()
    assert success_of(lambda: task, "stopped") == (False, "stopped")

"""What nobody waits for any more ends."""

import threading

import pytest

from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.naoqi.binding import client_calls
from nao_sim_bridge.naoqi.binding.client_calls import ClientWatch

PATIENCE = 60.0


@pytest.fixture
def ids(monkeypatch):
    monkeypatch.setattr(client_calls, "PERIOD", 0.005)
    ids = TaskIds()
    ids.ask = lambda task: task.kill()
    return ids


def test_a_task_is_killed_when_no_client_is_left_and_only_then(ids):
    looks, there = threading.Semaphore(0), threading.Event()
    there.set()

    def connected():
        looks.release()
        return there.is_set()

    watch = ClientWatch(connected)
    over, task = watch.add(ids.make("advance")), watch.add(ids.make("advance"))
    over.finish(1.0)
    for _ in range(3):
        assert looks.acquire(timeout=PATIENCE)
    assert not task.finished
    there.clear()
    assert task.result(PATIENCE) is None and task.killed and not over.killed
    later = watch.add(ids.make("advance"))
    assert later.result(PATIENCE) is None and later.killed

"""The event about moves that fail."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_sim_bridge.services.memory_store import EVENT, MemoryStore
from nao_sim_bridge.services.walk_events import FAILED, MoveFailures


@pytest.fixture
def memory():
    return MemoryStore(lambda: 0.0)


@pytest.mark.parametrize(
    "started, obstacle, told",
    [(False, None, [0, None]), (True, None, [1, None]), (True, (0.5, 0.1, 0.2), [1, [0.5, 0.1, 0.2]])],
)
def test_a_failure_tells_cause_status_and_obstacle(memory, started, obstacle, told):
    locomotion = SimpleNamespace(failures=[])
    MoveFailures(memory).watch(locomotion)
    for tell in locomotion.failures:
        tell("something is wrong", started, obstacle)
    assert memory.get(FAILED) == ["something is wrong", *told]


def test_it_is_told_once_however_often_it_is_watched(memory):
    heard = []
    failures, locomotion = MoveFailures(memory), SimpleNamespace(failures=[])
    memory.subscribe(FAILED, "test", lambda name, value, message: heard.append(value))
    for _ in range(3):
        failures.watch(locomotion)
    for tell in locomotion.failures:
        tell("it is soft", True, None)
    assert heard == [["it is soft", 1, None]]


def test_the_event_is_known_before_anything_fails(memory):
    MoveFailures(memory)
    assert FAILED in memory.names(EVENT)

"""Random behaviours, run to their ends and interrupted: what holds for all of them."""

from __future__ import annotations

import random
import threading

import pytest

from nao_library_modules.behaviors import bind, read
from nao_library_modules.behaviors.execution import Execution
from nao_library_modules.behaviors.servers import NAMES
from nao_library_modules.behaviors.yaml_text import dump
from nao_library_modules.clock import WallClock
from nao_library_modules.interrupt import Interrupt
from nao_library_modules.process_modules.failures import PlanFailure

STATES = {"ended", "failed", "skipped", "preempted", "not run"}


def a_step(chance, servers, depth):
    """A random step, and whether it fails, whatever the order in which branches come."""
    kind = (
        chance.choice(("goal", "goal", "wait", "seq", "par", "time", "repeat"))
        if depth
        else chance.choice(("goal", "wait"))
    )
    if kind == "goal" and servers:
        fails = chance.random() < 0.2
        step = {f"{chance.choice(servers)}.x": {"str_param": "fail" if fails else "works"}}
    elif kind in ("goal", "wait"):
        step, fails = {"wait": chance.choice([0.0, 0.001, 0.003])}, False
    elif kind == "seq":
        steps, fails = some_steps(chance, servers, depth)
        step = {"do": steps}
    elif kind == "repeat":
        steps, fails = some_steps(chance, servers, depth)
        step = {"repeat": chance.randrange(1, 3), "do": steps}
    elif kind == "par":
        shuffled = chance.sample(servers, len(servers))
        cut = chance.randrange(len(shuffled) + 1)
        branches = [a_step(chance, part, depth - 1) for part in (shuffled[:cut], shuffled[cut:])]
        step, fails = {"parallel": [each for each, _ in branches]}, any(fails for _, fails in branches)
    else:
        entries = [a_step(chance, servers, depth - 1) for _ in range(chance.randrange(1, 4))]
        for entry, _ in entries:
            entry["at"] = chance.choice([0.0, 0.002])
        step, fails = {"timeline": [each for each, _ in entries]}, any(fails for _, fails in entries)
    policy = chance.choice(("", "", "", "skip", "retry 1", "retry 1 skip"))
    if policy:
        step["on_error"] = policy
    return step, fails and not policy.endswith("skip")


def some_steps(chance, servers, depth):
    steps = [a_step(chance, servers, depth - 1) for _ in range(chance.randrange(1, 4))]
    return [step for step, _ in steps], any(fails for _, fails in steps)


def run(seed, clients, interrupt):
    chance = random.Random(seed)
    steps, fails = some_steps(chance, list(NAMES), 3)
    program = bind(read(dump({"help": "x", "do": steps}), "random"), {}, lambda name: None)
    execution = Execution(program, clients, WallClock(), lambda event: None)
    failed = False
    try:
        execution.run(interrupt)
    except PlanFailure:
        failed = True
    return execution.report.records(), fails, failed


def check_records(records, clients):
    assert not clients.running()
    assert all(most == 1 for most in clients.most.values())
    by_path = {record.node.path: record for record in records}
    assert {record.state for record in records} <= STATES
    for record in records:
        if record.state == "not run":
            assert (record.began, record.ended, record.attempts) == (-1.0, -1.0, 0)
        else:
            assert 0.0 <= record.began <= record.ended and record.attempts >= 1
        above = by_path.get(record.node.path[:-1])
        if above is not None and record.state != "not run":
            assert above.began <= record.began and record.ended <= above.ended
        if record.state == "failed":
            assert record.error


@pytest.mark.parametrize("seed", range(25))
def test_random_behaviours_end_as_their_steps_say(seed, clients):
    records, fails, failed = run(seed, clients, Interrupt())
    assert failed == fails
    check_records(records, clients)
    top = [record.state for record in records if len(record.node.path) == 1]
    assert ("failed" in top) == failed
    if not failed:
        assert set(top) <= {"ended", "skipped"}


@pytest.mark.parametrize("seed", range(15))
def test_random_behaviours_can_be_interrupted_at_any_time(seed, clients):
    interrupt = Interrupt()
    timer = threading.Timer(random.Random(seed).uniform(0.0, 0.02), interrupt.trigger)
    timer.start()
    records, _, _ = run(seed + 1000, clients, interrupt)
    timer.cancel()
    timer.join()
    check_records(records, clients)

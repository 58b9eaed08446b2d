"""Numbers of NAOqi calls, one at a time, become hostile: the simulator answers, and time goes on."""

from __future__ import annotations

import json
import math
import os
import re
import sys
import time
from itertools import islice

import pytest
from amount import part_of
from gaps import LONGEST, gaps_at
from naoqi_calls import CHAIR, ENDS, SIMULATION, calls_of, example, read_calls
from programs import Program, shell
from simulator import connected

from nao_sim_bridge.naoqi.binding.binding import DEFECT

MEMORY = 8 * 1024 * 1024
"""What the simulator may have of address space, KiB."""
HOSTILE = [1e-320, 1e6, 1e9, 1.7e308, math.nan, -1.0]
PATIENCE = 0.05
"""How long a call may take before it is cancelled, s: most answer at once."""
DEADLINE = 60.0
"""By when a call has answered that is cancelled, s."""
MANY = 10**5
"""Items of a list in the place of its first."""
ONE_IN = 5
"""One in so many numbers of a call is tried in the short form."""
NUMBER = re.compile(r"[iIlLfd]")
"""Of a signature of libqi."""
MODULES = [SIMULATION, *(module for module, (_, calls) in read_calls().items() if calls)]


def with_hostile_numbers(value):
    """Each value that this one becomes when one of its numbers becomes hostile."""
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return
    if isinstance(value, (int, float)):
        yield from HOSTILE
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from ({**value, key: other} for other in with_hostile_numbers(inner))
    else:
        for i, inner in enumerate(value):
            for other in with_hostile_numbers(inner):
                yield [*value[:i], other, *value[i + 1 :]]


def with_long_lists(value):
    """Each value that this one becomes when one of its lists of numbers becomes very long."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from ({**value, key: other} for other in with_long_lists(inner))
    elif isinstance(value, (list, tuple)):
        for i, inner in enumerate(value):
            if isinstance(inner, (list, tuple)) and inner and isinstance(inner[0], (int, float)):
                yield [*value[:i], [inner[0]] * MANY, *value[i + 1 :]]
            yield from ([*value[:i], other, *value[i + 1 :]] for other in with_long_lists(inner))


class Victim:
    """A simulator in a process of its own, with a limit of memory, and a client of it."""

    def __init__(self, folder):
        # At speed 1: faster, time waits for pictures to be drawn.
        words = f"ulimit -v {MEMORY}; exec {sys.executable} -m nao_sim_bridge --port 0 --posture Stand --speed 1"
        self.program = Program(shell(f"{words} --record-dir {folder}/records"), folder, os.environ)
        self.port = self._port()
        self.session = connected(self.port)
        self.calls = self.errors = self.cancelled = 0

    def _port(self):
        end = time.monotonic() + 60.0
        while time.monotonic() < end and not self.program.failed:
            found = re.search(r"listens on [\d.]+:(\d+)", self.program.output)
            if found:
                return int(found[1])
            time.sleep(0.1)
        raise AssertionError(self.program.output)

    def call(self, module, method, arguments):
        """Post a call; what it is, and its future."""
        self.calls += 1
        if module == SIMULATION:
            own = {"name": f"thing {self.calls}"}  # what is there already is refused, whatever its numbers are
            arguments = [json.dumps({**each, **own}) if isinstance(each, dict) else each for each in arguments]
        return f"{module}.{method}{str(arguments)[:200]}", self.session.service(module).call(
            method, *arguments, _async=True
        )

    def wrong(self, what, future):
        """What is wrong with the answer of a call, which is cancelled when it takes long; empty for nothing."""
        if future.wait(int(1000 * PATIENCE)) == 1:
            self.cancelled += 1
            future.cancel()
            if future.wait(int(1000 * DEADLINE)) == 1:
                return f"{what} does not answer"
        if future.hasError(0):
            self.errors += 1
            if DEFECT in future.error() or "Traceback" in future.error():
                return f"{what}: {future.error()}"
        return ""

    def close(self):
        self.session.close()
        self.program.interrupt()
        return self.program.end(30.0)


@pytest.fixture(scope="module")
def victim(tmp_path_factory):
    made = Victim(tmp_path_factory.mktemp("victim"))
    yield made
    ended = made.close()
    print(f"\n{made.calls} calls, {made.errors} errors, {made.cancelled} cancelled")
    assert ended.status == 0, str(ended)


@pytest.mark.timeout(1800)
@pytest.mark.parametrize("module", MODULES)
def test_every_call_with_one_hostile_number_is_answered_and_time_goes_on(victim, module):
    before, wrong, said = victim.calls, [], len(victim.program.output)
    simulation = victim.session.service(SIMULATION)
    simulation.reset()
    simulation.placeObject(json.dumps(CHAIR))
    victim.session.service("ALMotion").setStiffnesses("Body", 1.0)
    gaps = gaps_at(victim.port)
    methods = victim.session.service(module).metaObject()["methods"].values()
    taking = {each["name"] for each in methods if each["uid"] >= 100 and NUMBER.search(each["parametersSignature"])}
    calls = list(calls_of(module))
    tried = {method for method, arguments in calls if any(with_hostile_numbers(list(arguments)))}
    calls += [
        (each["name"], example(each["parametersSignature"]))
        for each in methods
        if each["name"] in taking - ENDS - tried
    ]
    for method, arguments in calls:
        if method[0] == "*" or method in ENDS or (method == "advance" and module != SIMULATION):
            continue
        posted = [victim.call(module, method, bad) for bad in part_of(with_hostile_numbers(list(arguments)), ONE_IN)]
        wrong += filter(None, (victim.wrong(*call) for call in posted))
        for bad in islice(with_long_lists(list(arguments)), 1):  # not with the others: to read it takes long enough
            wrong += filter(None, [victim.wrong(*victim.call(module, method, bad))])
        if module == SIMULATION:
            simulation.setSpeed(1.0)
    gaps.close()
    told = victim.program.output[said:]
    print(f"\n{module}: {victim.calls - before} calls, longest time without a tick {gaps.longest:.2f} s")
    assert wrong == []
    assert "Traceback" not in told and "failed, everything else goes on" not in told, told
    assert gaps.longest < LONGEST and not victim.program.failed

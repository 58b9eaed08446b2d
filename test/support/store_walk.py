"""Calls every method of a simulator with ever new names and texts: what is kept of them must come to an end."""

from __future__ import annotations

import gc
import json
import logging
import os
import re
import sys
import threading
import time
from collections import Counter
from dataclasses import dataclass, field

from naoqi_calls import ENDS, SIMULATION, calls_of, example

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.binding import DEFECT, NATIVE, published_methods

LENGTHS = (900, 20_000)
"""Characters of a name, which no method finds too long, and of a text."""
FIRST, MORE = 12, 150
"""Calls of every method, and at a time of those that keep something."""
MOST = 1000
"""Calls until a store must be full, after `shrink`."""
KEPT = 0.3
"""Share of the new texts from which on they are kept."""
MOST_THREADS, MOST_FILES = 40, 20
"""More than there were before."""
SLOWEST = 0.25
"""CPU time of one call, s, in the median of those that are made at a time."""
MARK = "new {} of way {} "
MARKED = re.compile(MARK.format(r"\d+", r"(\d+)"), re.IGNORECASE)
OURS = ("nao_sim_bridge",)
LEFT_OUT = {
    *ENDS,
    # They write a file of their own for each name, which is what they are for, and take long about it.
    *(
        "sayToFile",
        "sayToFileAndPlay",
        "startFilm",
        "takePicture",
        "takePictures",
        "startRecording",
        "startVideoRecord",
    ),
    *("startVideoRecord_adv", "recordVideo", "startMicrophonesRecording"),
    # They wait for what time would bring.
    *("say", "personSays", "advance", "setSpeed"),
}


def with_new_texts(value, new):
    """Each value that this one becomes when one of its texts, or one of its keys, is replaced by `new`."""
    if isinstance(value, str):
        yield new
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield {**{other: kept for other, kept in value.items() if other != key}, new: inner}
            yield from ({**value, key: other} for other in with_new_texts(inner, new))
    elif isinstance(value, (list, tuple)):
        for i, inner in enumerate(value):
            yield from ([*value[:i], other, *value[i + 1 :]] for other in with_new_texts(inner, new))


@dataclass
class Way:
    """A method, and which text of its arguments becomes a new one; what was seen of it."""

    number: int
    module: str
    method: str
    arguments: list
    place: int
    length: int
    calls: int = 0
    kept: int = 0  # texts that are kept now
    last: int = 0  # calls that were made last, and how many of them were refused
    refused: int = 0
    error: str = ""
    wrong: list[str] = field(default_factory=list)

    def __str__(self):
        what = f"{self.module}.{self.method}, text {self.place} of {str(self.arguments)[:80]}, {self.length} characters"
        return f"{what}: keeps {self.kept} after {self.calls} calls; {self.error[:60]}...{self.error[-120:]}"


FEW = 100
BYTES = {"file_bytes": 300_000, "bytes": 3_000_000}


def shrink(monkeypatch):
    """Have all bounds be small, so that they are soon reached: what heeds them reads them when it is called."""
    small = {"memory", "lists", "clients", "speech", "vocabulary", "kept", "behaviors"}
    for name in small:
        limits = getattr(load_sizes(), name)
        for key, limit in vars(limits).items():
            if isinstance(limit, int) and limit > FEW and "characters" not in key:
                monkeypatch.setitem(vars(limits), key, BYTES.get(key, FEW))


class Walk:
    """Makes the calls in the process of the simulator, past the network: what is kept can be counted there.

    Args:
        robot: A `Simulator` whose time stands still.
    """

    def __init__(self, robot):
        self._robot = robot

    def module(self, name):
        """The ways of a module in which it keeps something, or in which something is wrong."""
        self._robot.fresh()
        logging.disable(logging.CRITICAL)  # what pytest keeps of the log grows, too
        threads, files = threading.active_count(), len(os.listdir("/proc/self/fd"))
        try:
            ways = list(self._ways(name))
            for way in ways:
                self._make(way, FIRST)
            kept = texts_kept(self._robot.server)
            for way in ways:
                way.kept = kept[way.number]
            keeping = [way for way in ways if way.kept >= KEPT * FIRST]
            for way in keeping:
                self._fill(way)
        finally:
            logging.disable(logging.NOTSET)
        for kind, before, now, most in (
            ("threads", threads, threading.active_count(), MOST_THREADS),
            ("open files", files, len(os.listdir("/proc/self/fd")), MOST_FILES),
        ):
            if now > before + most:
                ways[-1].wrong.append(f"{now} {kind} instead of {before}")
        return [way for way in ways if way.wrong or way in keeping]

    def _ways(self, module):
        calls = [(method, list(arguments)) for method, arguments in calls_of(module)]
        if module != SIMULATION:
            known = {method for method, _ in calls}
            calls += [
                (name, example(way.signature))
                for name, method in published_methods(module).items()
                if name not in known | NATIVE and hasattr(self._robot.server._services[module].object, name)
                for way in method.overloads
            ]
        seen = set()
        for method, arguments in calls:
            if method in LEFT_OUT or method[0] == "*":
                continue
            for place in range(len(list(with_new_texts(arguments, "")))):
                if (method, len(arguments), place) not in seen:
                    seen.add((method, len(arguments), place))
                    for length in LENGTHS:
                        yield Way(next(NUMBERS), module, method, arguments, place, length)

    def _fill(self, way):
        """Go on until calls are refused, or what is new takes the place of what is old."""
        while True:
            before = way.kept
            self._make(way, MORE)
            way.kept = texts_kept(self._robot.server)[way.number]
            if way.wrong or way.refused == way.last or way.kept - before < KEPT * way.last:
                return
            if way.calls > MOST:
                way.wrong.append("is never full")
                return

    def _make(self, way, count):
        texts = [MARK.format(way.calls + i, way.number).ljust(way.length, "x") for i in range(count)]
        futures, times = [], []
        for text in texts:
            arguments = list(with_new_texts(way.arguments, text))[way.place]
            begin = time.thread_time()
            futures.append(self._call(way, arguments))
            times.append(time.thread_time() - begin)
        way.calls, way.last = way.calls + count, count
        self._robot.settled()
        way.refused = sum(_refused(future, way) for future in futures)
        median = sorted(times)[count // 2]
        if median > SLOWEST:
            way.wrong.append(f"takes {median:.2f} s of CPU time a call after {way.calls} calls")

    def _call(self, way, arguments):
        server = self._robot.server
        if way.module == SIMULATION:
            own = server.broker._services[SIMULATION][1]
            return getattr(own, way.method)(*(json.dumps(a) if isinstance(a, dict) else a for a in arguments))
        return server._services[way.module].answer(way.method, arguments)


NUMBERS = iter(range(10**9))


def texts_kept(root):
    """How many texts of each way are reached from an object, or from modules of the simulator."""
    gc.collect()
    modules = [vars(module) for name, module in sys.modules.items() if name.startswith(OURS)]
    others = [vars(module) for name, module in sys.modules.items() if not name.startswith(OURS)]
    seen = {id(other) for other in others} | {id(module) for module in sys.modules.values()} | {id(sys.modules)}
    found, left = Counter(), [root, *modules]
    seen.update(map(id, left))
    while left:
        one = left.pop()
        keys = list(one) if isinstance(one, dict) else []  # the collector looks at values alone where keys are texts
        new = [inner for inner in (*gc.get_referents(one), *keys) if id(inner) not in seen]
        seen.update(map(id, new))
        for one in new:
            if type(one) is str:
                if len(one) >= LENGTHS[0] and (mark := MARKED.search(one, 0, 200)):
                    found[int(mark[1])] += 1
            elif type(one) not in LEAVES:
                left.append(one)
    return found


LEAVES = {int, float, bool, bytes, complex, type(None), type, type(len), range}


def _refused(future, way):
    """Whether a call was refused; what has not ended is given up."""
    if not hasattr(future, "hasError"):
        return False
    if future.isRunning():
        future.cancel()
        return False
    if not future.hasError(0):
        return False
    way.error = future.error()
    if DEFECT in way.error:
        way.wrong.append(way.error)
    return True

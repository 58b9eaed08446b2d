"""Every number of every NAOqi call, one at a time, becomes hostile: the simulator answers, and time goes on."""

from __future__ import annotations

import json
import math
import os
import re
import sys
import time
from itertools import islice

import pytest
from gaps import LONGEST, gaps_at
from naoqi_calls import read_calls
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
NUMBER = re.compile(r"[iIlLfd]")
"""Of a signature of libqi."""
ENDS = {"exit", "shutdown", "reboot", "factoryReset"}
"""These end what is tested, or begin it anew."""
SIMULATION = "NaoSimulation"
CHAIR = {"name": "chair", "box": [0.1, 0.1, 0.1], "position": [1.0, 1.0, 0.1]}
SHAPE = {"position": [1.0, 1.0, 0.5], "mass": 0.1, "friction": 0.8, "color": [1.0, 0.0, 0.0], "heading": 1.0}
OWN = [
    ("setSpeed", (1.0,)),
    ("advance", (0.1,)),
    ("push", ([1.0, 0.0, 0.0], 0.1, "torso")),
    ("touch", ("Head/Touch/Front", 0.1)),
    ("stroke", (["Head/Touch/Front", "Head/Touch/Rear"], 0.5)),
    ("picture", ("front", 64, 48)),
    ("setBatteryCharge", (0.5,)),
    ("setTemperature", ("Head", 40.0)),
    ("startFilm", ("film.mp4", "front", 160, 160, 20.0)),
    ("placeObject", ({"box": [0.1, 0.1, 0.1], **SHAPE},)),
    ("placeObject", ({"ball": 0.03, "position": [1.0, 1.0, 0.5]},)),
    ("placeObject", ({"cylinder": [0.02, 0.1], "rpy": [0.0, 0.0, 1.0], "position": [1.0, 1.0, 0.5]},)),
    ("placeObject", ({"face": "anna", "size": 0.2, "position": [1.0, 1.0, 0.5]},)),
    ("moveObject", ("chair", [1.0, 1.0, 0.1], [0.0, 0.0, 0.1], 0.1)),
    ("addSound", ("tone", "tone:440", [1.0, 0.0, 0.0], 60.0, False)),
    ("moveSound", ("tone", [1.0, 0.0, 0.0])),
    ("personSays", ("hello", [1.0, 0.0, 0.5], "", 60.0)),
]
"""Calls of the simulator's own service; descriptions are JSON there."""
BIP = "nao_library/bip.ogg"
MORE = {
    "ALLandMarkDetection": [("setParameter", ("pause", 1.0))],
    "ALMemory": [("getData", ("Test/Key", 0)), ("getDataOnChange", ("Test/Key", 0)), ("getListData", ([1.0],))],
    "ALVideoDevice": [
        *((method, (0,)) for method in ("getColorSpace", "getFrameRate", "getResolution")),
        ("onClientDisconnected", ("ClientDisconnected", 1.0, "")),
    ],
    "ALAudioDevice": [("sendLocalBufferToOutput", (1, 0))],
    "ALAudioPlayer": [
        *((method, (BIP, 0.5, 0.0)) for method in ("playFile", "playFileInLoop")),
        *((method, (1, 0.5, 0.0)) for method in ("play", "playInLoop")),
        ("playFileFromPosition", (BIP, 0.1, 0.5, 0.0)),
        ("playSoundSetFile", ("nao_library", "bip", 0.1, 0.5, 0.0, False)),
        ("playWebStream", ("http://127.0.0.1:9/x.wav", 0.5, 0.0)),
    ],
    "ALMotion": [
        ("setMotionConfig", ([["ENABLE_STIFFNESS_PROTECTION", 1.0]],)),
        ("getAngles", ([1.0], True)),
        ("getStiffnesses", ([1.0],)),
    ],
    "ALSpeechRecognition": [("setContextParam", ("context", "Sensitivity", 0.5))],
    "DCM": [("calibration", ([1.0],)), ("createAlias", (["TestEyes", [1.0]],))],
    "ALMovementDetection": [("setDepthSensitivity", (0.3,))],
    "ALAnimatedSpeech": [
        ("say", ("One.", {"bodyLanguageMode": 1.0})),
        ("addTagsToWords", ({"hello": [1.0]},)),
        ("declareTagForAnimations", ({"ahoy": [1.0]},)),
    ],
}
"""Calls with numbers that `naoqi_calls.txt` has without any."""
TASKS = [("isRunning", (1,)), ("wait", (1, 1)), ("stop", (1,))]
"""Calls of every module."""
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


PLAIN = {"b": True, "s": "HeadYaw", "r": b"piece", "m": [0.5]} | dict.fromkeys("fd", 0.5) | dict.fromkeys("iIlL", 1)
"""A value of each of libqi's letters."""


def example(signature):
    """Arguments for the parameters of a method, "(sf)", as nobody has written down better ones."""
    stack = [[]]
    for letter in re.sub("<[^>]*>", "", signature):
        if letter in "([{":
            stack.append([])
        elif letter in ")]}":
            items = stack.pop()
            stack[-1].append(dict([items]) if letter == "}" else items)
        else:
            stack[-1].append(PLAIN[letter])
    return stack[0][0]


def calls_of(module):
    """Method and arguments of the calls that are tried."""
    if module == SIMULATION:
        return OWN
    known = [(method, arguments) for method, arguments, *_ in read_calls()[module][1]]
    return [*known, *MORE.get(module, ()), *TASKS]


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
        posted = [victim.call(module, method, bad) for bad in with_hostile_numbers(list(arguments))]
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

"""How soon the robot speaks when it is told to, and how soon it is silent when the goal is cancelled."""

from __future__ import annotations

import itertools
import time
from typing import Callable

from ..errors import BenchmarkError
from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample

ROUNDS = 20
SPEAKS = "ALTextToSpeech/TextStarted"
LIMIT = 10.0
NUMBERS = itertools.count(1)


class Mouth:
    """Watches over a connection of its own whether the robot speaks, as fast as it answers."""

    def __init__(self, stack: Stack) -> None:
        self._memory = stack.simulator.session.service("ALMemory")

    @property
    def speaks(self) -> bool:
        """Whether its loudspeakers play a text."""
        return bool(self._memory.getData(SPEAKS))

    def wait(self, speaks: bool, since: float) -> float:
        """Time from `since` (perf_counter) until it speaks, or is silent, s.

        Raises:
            BenchmarkError: If that does not happen.
        """
        return wait_until(lambda: self.speaks == speaks, since, "speaks" if speaks else "is silent")


def wait_until(condition: Callable[[], bool], since: float, what: str) -> float:
    """Time from `since` (perf_counter) until a condition holds, s.

    Raises:
        BenchmarkError: If it never does.
    """
    while time.perf_counter() - since < LIMIT:
        if condition():
            return time.perf_counter() - since
    raise BenchmarkError(f"not within {LIMIT:g} s: the robot {what}")


class SpeechStart(Row):
    """From sending a goal for nao_audio_out to the first sound of a short sentence that was never said before."""

    name = "speech_start"
    subject = "goal say of nao_audio_out, to the first sound"
    unit = "ms"
    bound = at_most(150.0)

    def measure(self, stack: Stack) -> Figures:
        """Say a new sentence each time; it is cancelled as soon as it has begun."""
        started, stopped = _say(stack)
        return _figures(started, stopped)


class SpeechStop(Row):
    """From cancelling a goal that speaks to silence."""

    name = "speech_stop"
    subject = "cancelled goal say of nao_audio_out, to silence"
    unit = "ms"
    bound = at_most(50.0)

    def measure(self, stack: Stack) -> Figures:
        """As SpeechStart; the other half of each round."""
        started, stopped = _say(stack)
        return _figures(stopped, started)


def _say(stack: Stack) -> tuple[Sample, Sample]:
    client = stack.audio_out_client
    from ..goals import say  # not above: it needs the messages of the built workspace

    mouth = Mouth(stack)
    started, stopped = [], []
    client.run(say("Hello."))
    for _ in range(ROUNDS):  # a text that was said before would be at hand
        mouth.wait(False, time.perf_counter())
        began = time.perf_counter()
        handle = client.send(say(f"This is sentence number {next(NUMBERS)}."))
        started.append(mouth.wait(True, began))
        cancelled = time.perf_counter()
        handle.cancel()
        stopped.append(mouth.wait(False, cancelled))
    return Sample(tuple(started)), Sample(tuple(stopped))


def _figures(ours: Sample, other: Sample) -> Figures:
    first, third = ours.quartiles
    details = {"runs": len(ours.seconds), "first quartile": first * 1e3, "third quartile": third * 1e3}
    details.update({"longest": max(ours.seconds) * 1e3, "the other half": other.median * 1e3})
    return Figures(ours.median * 1e3, details=details, note=f"the longest {max(ours.seconds) * 1e3:.0f} ms")

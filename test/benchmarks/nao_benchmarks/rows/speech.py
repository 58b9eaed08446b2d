"""How soon the robot speaks when it is told to, and how soon it is silent when the goal is cancelled."""

from __future__ import annotations

import itertools
import time

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
        while time.perf_counter() - since < LIMIT:
            if self.speaks == speaks:
                return time.perf_counter() - since
        raise BenchmarkError(f"the robot was not {'speaking' if speaks else 'silent'} within {LIMIT:g} s")


class SpeechStart(Row):
    """From sending a goal for nao_audio_out to the first sound of a short sentence that was never said before."""

    name = "speech_start"
    subject = "goal say of nao_audio_out, to the first sound"
    unit = "ms"
    bound = at_most(150.0)

    def measure(self, stack: Stack) -> Figures:
        """Say a new sentence each time; it is cancelled as soon as it has begun."""
        return _figures(_say(stack)[0])


class SpeechStop(Row):
    """From cancelling a goal that speaks to silence."""

    name = "speech_stop"
    subject = "cancelled goal say of nao_audio_out, to silence"
    unit = "ms"
    bound = at_most(50.0)

    def measure(self, stack: Stack) -> Figures:
        """As SpeechStart; the other half of each round."""
        return _figures(_say(stack)[1])


def _say(stack: Stack) -> tuple[Sample, Sample]:
    """Times from goals to the first sound, and from their cancellations to silence."""
    client = stack.audio_out_client
    from ..goals import say  # not above: it needs the messages of the built workspace

    mouth = Mouth(stack)
    started, stopped = [], []
    client.run(say("Hello."))
    for _ in range(ROUNDS):
        mouth.wait(False, time.perf_counter())
        began = time.perf_counter()
        handle = client.send(say(f"This is sentence number {next(NUMBERS)}."))  # one that was said is at hand
        started.append(mouth.wait(True, began))
        cancelled = time.perf_counter()
        handle.cancel()
        stopped.append(mouth.wait(False, cancelled))
    return Sample(tuple(started)), Sample(tuple(stopped))


def _figures(sample: Sample) -> Figures:
    first, third = (seconds * 1e3 for seconds in sample.quartiles)
    longest = max(sample.seconds) * 1e3
    details = {"runs": len(sample.seconds), "first quartile": first, "third quartile": third, "longest": longest}
    return Figures(sample.median * 1e3, details=details, note=f"the longest {longest:.0f} ms")

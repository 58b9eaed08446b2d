"""How soon the robot speaks when it is told to, and how soon it is silent when the goal is cancelled."""

from __future__ import annotations

import itertools
import time
from typing import Any

from ..errors import BenchmarkError
from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample

ROUNDS = 20
SPEAKS = "ALTextToSpeech/TextStarted"
LIMIT = 10.0
NUMBERS = itertools.count(1)


class Speech(Row):
    """How long a goal for nao_audio_out takes from an order to what is heard of it.

    Args:
        name: See `Row`.
        subject: See `Row`.
        most: Bound, ms.
        half: Of each round: 0 the beginning of a sentence that was never said before, 1 its end when it is cancelled.
    """

    unit = "ms"

    def __init__(self, name: str, subject: str, most: float, half: int) -> None:
        self.name, self.subject, self.bound, self._half = name, subject, at_most(most), half

    def measure(self, stack: Stack) -> Figures:
        """Say a new sentence each time; it is cancelled as soon as it has begun."""
        sample = _say(stack)[self._half]
        first, third = (seconds * 1e3 for seconds in sample.quartiles)
        longest = max(sample.seconds) * 1e3
        details = {"runs": len(sample.seconds), "first quartile": first, "third quartile": third, "longest": longest}
        return Figures(sample.median * 1e3, details=details, note=f"the longest {longest:.0f} ms")


SPEECH = (
    Speech("speech_start", "goal say of nao_audio_out, to the first sound", 150.0, 0),
    Speech("speech_stop", "cancelled goal say of nao_audio_out, to silence", 50.0, 1),
)


def _say(stack: Stack) -> tuple[Sample, Sample]:
    """Times from goals to the first sound, and from their cancellations to silence."""
    client = stack.audio_out_client
    memory = stack.simulator.session.service("ALMemory")  # over a connection of its own
    started, stopped = [], []
    client.run(client.goal("say", {"str_param": "Hello."}))
    for _ in range(ROUNDS):
        _wait(memory, False, time.perf_counter())
        began = time.perf_counter()
        text = f"This is sentence number {next(NUMBERS)}."  # one that was said is at hand
        handle = client.send(client.goal("say", {"str_param": text}))
        started.append(_wait(memory, True, began))
        cancelled = time.perf_counter()
        handle.cancel()
        stopped.append(_wait(memory, False, cancelled))
    return Sample(tuple(started)), Sample(tuple(stopped))


def _wait(memory: Any, speaks: bool, since: float) -> float:
    """Time from `since` (perf_counter) until the loudspeakers play a text, or none, s; asked as fast as it is answered.

    Raises:
        BenchmarkError: If that does not happen.
    """
    while time.perf_counter() - since < LIMIT:
        if bool(memory.getData(SPEAKS)) == speaks:
            return time.perf_counter() - since
    raise BenchmarkError(f"the robot was not {'speaking' if speaks else 'silent'} within {LIMIT:g} s")

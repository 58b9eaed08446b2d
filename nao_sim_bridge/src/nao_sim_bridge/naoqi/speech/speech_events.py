"""What happens while the robot speaks, as events of ALTextToSpeech."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.speech import speaker as steps
from nao_sim_bridge.speech.speaker import SpeechEvent

MODULE = "ALTextToSpeech"
STARTED = "ALTextToSpeech/TextStarted"
DONE = "ALTextToSpeech/TextDone"
INTERRUPTED = "ALTextToSpeech/TextInterrupted"
WORD = "ALTextToSpeech/CurrentWord"
POSITION = "ALTextToSpeech/PositionOfCurrentWord"
SENTENCE = "ALTextToSpeech/CurrentSentence"
BOOKMARK = "ALTextToSpeech/CurrentBookMark"
STATUS = "ALTextToSpeech/Status"
EVENTS = (STARTED, DONE, INTERRUPTED, WORD, POSITION, SENTENCE, BOOKMARK, STATUS)
TIMES = "NaoSimulation/SpeechTimes"
"""A key that no robot has: [onset, end] of the text that was spoken last, s: its first and its last sound."""
STATES = (steps.ENQUEUED, steps.STARTED, steps.DONE, steps.STOPPED, steps.THROWN)


class SpeechEvents:
    """Raises the events, while enabled, at the simulated time of what they tell, s of the `clock`."""

    def __init__(self, memory: MemoryStore, clock: Callable[[], float]) -> None:
        self._memory = memory
        self._clock = clock
        self._span: list[float] = []  # of the text that is spoken
        memory.insert(TIMES, [])
        self._speaking: int | None = None
        self.enabled = True
        for name in EVENTS:
            memory.declare_event(name, MODULE)

    def __call__(self, event: SpeechEvent) -> None:
        begins, ends = self._follow(event)
        self._note_span(event, begins, ends)
        if not self.enabled:
            return
        raise_event = self._memory.raise_event
        if event.kind in STATES:
            raise_event(STATUS, [event.task_id, event.kind])
        if begins:
            # Who asks for these keys sees that there is a new text; who waits for the events is not told twice.
            self._memory.put_quietly(DONE, False)
            self._memory.put_quietly(INTERRUPTED, False)
            raise_event(STARTED, True)
        elif event.kind == steps.SENTENCE:
            raise_event(SENTENCE, event.value.text)
        elif event.kind == steps.WORD:
            raise_event(POSITION, event.value.position)
            raise_event(WORD, event.value.text)
        elif event.kind == steps.BOOKMARK:
            raise_event(BOOKMARK, event.value)
        elif ends:
            raise_event(STARTED, False)
            raise_event(DONE if event.kind == steps.DONE else INTERRUPTED, True)

    def _note_span(self, event: SpeechEvent, begins: bool, ends: bool) -> None:
        if begins:
            self._span = []
        if event.kind == steps.SENTENCE:
            span, now = event.value.span(), self._clock()
            if span is not None:
                self._span = [self._span[0] if self._span else now + span[0], now + span[1]]
        if ends:
            now = self._clock()
            self._memory.insert(TIMES, [min(time, now) for time in self._span])

    def _follow(self, event: SpeechEvent) -> tuple[bool, bool]:
        """Whether a text begins, and whether the one that is spoken ends; texts that wait do neither."""
        if event.kind == steps.STARTED:
            self._speaking = event.task_id
            return True, False
        if event.kind in (steps.DONE, steps.STOPPED, steps.THROWN) and event.task_id == self._speaking:
            self._speaking = None
            return False, True
        return False, False

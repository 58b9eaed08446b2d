"""The engine behind ALSpeechRecognition: ears, recogniser and events put together, without NAOqi's methods."""

from __future__ import annotations

import logging
import threading
from typing import Any, Callable, Mapping, Sequence

from nao_sim_bridge.base.samples import frame_at
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.hearing.listening import Hypothesis, Listening, Recognised
from nao_sim_bridge.hearing.recogniser import Recogniser, SpareProcess
from nao_sim_bridge.hearing.settings import load_recognition
from nao_sim_bridge.hearing.voice_activity import SpeechChange
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.binding.switch import Switch
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.sound.ears import Listener, MicrophoneBlock
from nao_sim_bridge.sound.timeline import Alarm

log = logging.getLogger("nao_sim.recognition")

NAME = "ALSpeechRecognition"
WORD, WORD_AND_GRAMMAR, LAST_WORD = "WordRecognized", "WordRecognizedAndGrammar", "LastWordRecognized"
SPEECH = "SpeechDetected"
RUNNING, STATUS, ACTIVE = f"{NAME}/IsRunning", f"{NAME}/Status", f"{NAME}/ActiveListening"
EVENTS = (WORD, WORD_AND_GRAMMAR, SPEECH, RUNNING, STATUS, ACTIVE)
KEYS = (LAST_WORD,)
TIMES = "NaoSimulation/WordTimes"
"""A key that no robot has: [what WordRecognized says, [[onset, end], ...] of its phrases, s]."""
# What the keys hold as long as nothing has been recognised.
NO_WORD, NO_WORD_AND_GRAMMAR = ["", -3.0], ["", -3.0, ""]
HOLD_LAG = 0.25
"""With more unheard sound than this, s, time that runs faster than the wall clock waits."""


class RecognitionEngine(Switch):
    """Recognises what the front microphone hears while it is wanted and not paused.

    Methods may be called from any thread; events are raised in the recogniser's.

    Args:
        on_listen: Called with True when listening begins and with False when it ends; it returns how long, in s, what
            is heard next should be left out (the bip that it makes).
        accepts: Tells whether a hypothesis is good enough for its grammar.
        spare: Where the recogniser's process comes from and goes to; see `Recogniser`.
    """

    def __init__(
        self,
        runner: RobotRunner,
        memory: MemoryStore,
        on_listen: Callable[[bool], float],
        accepts: Callable[[Hypothesis], bool],
        spare: SpareProcess | None = None,
    ) -> None:
        super().__init__()
        self._runner = runner
        self._simulation = simulation = runner.simulation
        self._memory = memory
        self._on_listen = on_listen
        self._accepts = accepts
        self._listener: Listener | None = None
        self._opening: Alarm | None = None
        self._status_lock = threading.Lock()  # that it hears is not told when it does not any more
        self._speech = False
        self._recogniser = Recogniser(self._on_event, on_progress=lambda: simulation.wake(), spare=spare)
        simulation.holds.append(self.behind)
        memory.insert(LAST_WORD, NO_WORD)
        memory.insert(TIMES, [NO_WORD, []])
        self._put_no_word()
        memory.put_quietly(SPEECH, False)
        memory.put_quietly(RUNNING, False)
        memory.put_quietly(ACTIVE, False)
        memory.put_quietly(STATUS, "Idle")

    @property
    def runs(self) -> bool:
        """Whether it listens: wanted and not paused."""
        return self._listener is not None

    def behind(self) -> bool:
        """Whether time should wait for it."""
        return self._recogniser.lag > HOLD_LAG

    def stop(self) -> None:
        """Nobody wants to know any more."""
        with self._lock:
            super().stop()
            self._memory.raise_event(STATUS, "Stop")

    def check_paused(self, what: str) -> None:
        """Refuse what must not be changed while the engine listens; a NaoqiError when it listens."""
        if self.runs:
            raise NaoqiError(f"{what} cannot be changed while the engine runs; call pause(True) first")

    def listen_for(self, grammars: Sequence[Any], parameters: Mapping[str, float]) -> None:
        """What to listen for from now on, with "NbHypotheses" and "Sensitivity"; returns when it is prepared.

        A RecogniserError when it cannot be listened for; the text says why, and what was before stays.
        """
        self._recogniser.listen(Listening(tuple(grammars), int(parameters["NbHypotheses"]), parameters["Sensitivity"]))

    def close(self) -> None:
        with self._lock:
            listener, self._listener = self._listener, None
        if listener is not None:
            listener.close()
        self._recogniser.close()

    def _update(self) -> None:
        runs = self._works
        if runs == self.runs:
            return
        if runs:
            self._put_no_word()
            self._open()
        else:
            with self._status_lock:
                self._opening = None
            listener, self._listener = self._listener, None
            listener.close()
            self._recogniser.finish()
            self._on_listen(False)
            self._memory.raise_event(RUNNING, False)
            self._tell_hearing(False)

    def _put_no_word(self) -> None:
        self._memory.put_quietly(WORD, NO_WORD)
        self._memory.put_quietly(WORD_AND_GRAMMAR, NO_WORD_AND_GRAMMAR)

    def _open(self) -> None:
        """Listen from now on, or from when the own bip is over; what was heard before tells what the room is like."""
        ears = self._simulation.sound.ears
        background_s = load_recognition().voice_activity.background_s
        self._recogniser.get_used_to(ears.past(background_s, wants="16k1", channel="front")[:, 0])
        deaf = self._on_listen(True)
        begin = self._simulation.time + deaf
        self._listener = ears.listen(NAME, self._hear, wants="16k1", channel="front", begin=begin)
        self._memory.raise_event(RUNNING, True)
        if deaf <= 0.0:
            self._tell_hearing(True)
            return
        self._opening = alarm = Alarm(frame_at(begin), lambda: self._opened(alarm))
        self._runner.execute(lambda: self._simulation.sound.timeline.add(alarm), "begin of listening")

    def _opened(self, alarm: Alarm) -> None:
        with self._status_lock:
            if self._opening is alarm:
                self._opening = None
                self._tell_hearing(True)

    def _tell_hearing(self, hears: bool) -> None:
        self._memory.raise_event(ACTIVE, hears)
        self._memory.raise_event(STATUS, "ListenOn" if hears else "ListenOff")

    def _hear(self, block: MicrophoneBlock) -> None:
        self._recogniser.hear(block.time, block.samples[:, 0])

    def _on_event(self, event: SpeechChange | Recognised) -> None:
        if isinstance(event, Recognised):
            self._recognised(event)
        elif event.present != self._speech:
            self._speech = event.present
            self._memory.raise_event(SPEECH, event.present)
            if self.runs:
                self._memory.raise_event(STATUS, "SpeechDetected" if event.present else "EndOfProcess")
                if not event.present:
                    self._memory.raise_event(STATUS, "ListenOn")

    def _recognised(self, event: Recognised) -> None:
        if not self.runs:
            return
        found = [h for h in event.hypotheses if self._accepts(h)]
        if not found:
            self._put_no_word()
            return
        words: list[Any] = [item for h in found for item in (h.phrase, h.confidence)]
        with_grammar: list[Any] = [item for h in found for item in (h.phrase, h.confidence, h.grammar)]
        log.info("heard: %s (%.2f)", found[0].phrase, found[0].confidence)
        self._memory.insert(LAST_WORD, words)
        self._memory.insert(TIMES, [words, [[h.onset, h.end] for h in found]])
        self._memory.raise_event(WORD, words)
        self._memory.raise_event(WORD_AND_GRAMMAR, with_grammar)

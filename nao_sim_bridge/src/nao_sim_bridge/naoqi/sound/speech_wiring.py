"""The robot's voice put together: what the modules that speak share, and what has to be ended in the end."""

from __future__ import annotations

import logging
from typing import Any

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.speech.animated_speech import ALAnimatedSpeech
from nao_sim_bridge.naoqi.speech.speech_events import SpeechEvents
from nao_sim_bridge.naoqi.speech.text_to_speech import ALTextToSpeech
from nao_sim_bridge.naoqi.speech.voice_settings import VoiceSettings
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.speaker import Speaker
from nao_sim_bridge.speech.studio import Studio

log = logging.getLogger("nao_sim.speech")


class SpeechModules:
    """ALTextToSpeech and ALAnimatedSpeech of one robot.

    Attributes:
        studio: Makes the sound.
        speaker: The mouth.
        animator: Moves arms and head through gestures.
        library: The gestures.

    Args:
        simulation: Whose voice it is.
        runner: Its thread.
        memory: Where events are raised.
        files: Where clients may have files read from and written to.
        broker: Finds modules that a text calls: `service(name)`.
        studio: Makes the sound.
    """

    def __init__(
        self,
        simulation: Simulation,
        runner: SimulationRunner,
        memory: MemoryStore,
        files: ClientFiles,
        broker: Any,
        studio: Studio,
    ) -> None:
        self._broker = broker
        self._closed = False
        self.studio = studio
        self.speaker = Speaker(simulation, self.studio)
        self.animator = Animator(simulation)
        self.library = load_animations()
        self._settings = VoiceSettings(self.studio.engines)
        events = SpeechEvents(memory, lambda: simulation.sound.time)
        self.speaker.listeners.append(events)
        self._text_to_speech = ALTextToSpeech(self.speaker, self.studio, self._settings, events, runner, files)
        self._animated_speech = ALAnimatedSpeech(
            simulation,
            runner,
            memory,
            self.speaker,
            self.studio,
            self._settings,
            files,
            self._call,
            self.animator,
            self.library,
        )

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `Service` wants them."""
        return {"ALTextToSpeech": [self._text_to_speech], "ALAnimatedSpeech": [self._animated_speech]}

    def say(self, text: str, animated: bool = False) -> Task:
        """Say a text of a behaviour, with gestures or without; it calls no methods."""
        return self._animated_speech.say_without_calls(text) if animated else self._text_to_speech.say(text)

    def close(self) -> None:
        """Whoever waits for speech gets an error. When the simulation has ended."""
        self._closed = True
        self.speaker.close()

    def _call(self, module: str, method: str, arguments: list) -> Task:
        """Call a method that a text names; the task ends with it, a failure is told in the log."""

        def call() -> None:
            if self._closed:
                return
            try:
                self._broker.service(module).call(method, *arguments)
            except (RuntimeError, AttributeError) as error:
                log.warning("call of %s.%s in a text failed: %s", module, method, error)

        return self.studio.in_background(call, f"{module}.{method}")

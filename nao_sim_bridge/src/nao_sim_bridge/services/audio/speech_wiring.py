"""The robot's voice put together: what the modules that speak share, and what has to be ended in the end."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.audio.speech_events import SpeechEvents
from nao_sim_bridge.services.audio.text_to_speech import ALTextToSpeech
from nao_sim_bridge.services.audio.voice_settings import VoiceSettings
from nao_sim_bridge.services.memory_store import MemoryStore
from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Simulation
from nao_sim_bridge.sim.speech.speaker import Speaker
from nao_sim_bridge.sim.speech.studio import Studio


class SpeechModules:
    """ALTextToSpeech of one robot.

    Attributes:
        studio: Makes the sound.
        speaker: The mouth.

    Args:
        simulation: Whose voice it is.
        runner: Its thread.
        memory: Where events are raised.
        files: Where clients may have files read from and written to.
    """

    def __init__(
        self, simulation: Simulation, runner: SimulationRunner, memory: MemoryStore, files: ClientFiles
    ) -> None:
        self.studio = Studio()
        self.speaker = Speaker(simulation, self.studio)
        self._settings = VoiceSettings(self.studio.engines)
        events = SpeechEvents(memory)
        self.speaker.listeners.append(events)
        self._text_to_speech = ALTextToSpeech(self.speaker, self.studio, self._settings, events, runner, files)

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `make_service` wants them."""
        return {"ALTextToSpeech": [self._text_to_speech]}

    def begin(self) -> None:
        """Have the engines ready for the first text."""
        self.studio.warm_up()

    def close(self) -> None:
        """Whoever waits for speech gets an error; the engines end. When the simulation has ended."""
        self.speaker.close()
        self.studio.close()

"""The robot's sound and voice put together: what their modules share, and what has to be ended in the end."""

from __future__ import annotations

import logging
from typing import Any, Callable

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.background import Background
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.sound.audio_device import ALAudioDevice, MicrophoneEnergy
from nao_sim_bridge.naoqi.sound.audio_player import ALAudioPlayer
from nao_sim_bridge.naoqi.sound.microphone_clients import MicrophoneClients
from nao_sim_bridge.naoqi.sound.recorder import ALAudioRecorder, FilesInUse, Recorder
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles
from nao_sim_bridge.naoqi.speech.animated_speech import ALAnimatedSpeech
from nao_sim_bridge.naoqi.speech.animated_talk import PlaySound
from nao_sim_bridge.naoqi.speech.speech_events import SpeechEvents
from nao_sim_bridge.naoqi.speech.text_to_speech import ALTextToSpeech
from nao_sim_bridge.naoqi.speech.voice_settings import VoiceSettings
from nao_sim_bridge.speech.animations import load_animations
from nao_sim_bridge.speech.animator import Animator
from nao_sim_bridge.speech.body_language import BodyLanguage
from nao_sim_bridge.speech.speaker import Speaker
from nao_sim_bridge.speech.studio import Studio

log = logging.getLogger("nao_sim.speech")


class AudioModules:
    """ALAudioPlayer, ALAudioDevice and ALAudioRecorder of one robot; the broker finds modules of clients."""

    def __init__(
        self, runner: RobotRunner, sounds: SoundFiles, broker: Any, memory: MemoryStore, allow_private_streams: bool
    ) -> None:
        simulation = runner.simulation
        background = Background(released=lambda: simulation.wake())
        ears, settings = simulation.sound.ears, simulation.sound.settings
        self.clients = MicrophoneClients(ears, broker.service, released=lambda: simulation.wake())
        in_use = FilesInUse()
        self.recorders = [Recorder(runner, sounds.files, in_use) for _ in range(2)]
        self._energy = MicrophoneEnergy(ears, {side: settings.energy_channels(side) for side in settings.energies})
        self._player = player = ALAudioPlayer(runner, sounds, background, memory, allow_private_streams)
        device = ALAudioDevice(runner, sounds, self.clients, self._energy, self.recorders[0])
        self.modules: dict[str, list[Any]] = {
            "ALAudioPlayer": player.parts(),
            "ALAudioDevice": [device, self._energy],
            "ALAudioRecorder": [ALAudioRecorder(self.recorders[1])],
        }
        simulation.holds += [self.clients.behind, background.holds]

    def play_sound(self, path: str, volume: float) -> Task:
        """Play a sound of a set, "set/file" or "file", at a volume, 0..1; the task ends with one that ends with it.

        Errors in the task are those of ALAudioPlayer.
        """
        return self._player.playSoundSetFile(*path.rsplit("/", 1), 0.0, volume, 0.0, False)

    def closing(self) -> list[Callable[[], None]]:
        """Steps that complete recordings and call no client any more; blocking."""
        return [
            *(recorder.close for recorder in self.recorders),
            self._energy.disableEnergyComputation,
            self.clients.close,
        ]


class SpeechModules:
    """ALTextToSpeech and ALAnimatedSpeech of one robot; the broker finds modules that a text calls."""

    def __init__(
        self,
        runner: RobotRunner,
        memory: MemoryStore,
        files: ClientFiles,
        broker: Any,
        studio: Studio,
        play_sound: PlaySound,
    ) -> None:
        self._broker = broker
        self._closed = False
        self.studio = studio
        self.speaker = Speaker(runner.simulation, studio)
        self.animator = Animator(runner.simulation)
        self.library = load_animations()
        self.body_language = BodyLanguage()
        self.settings = settings = VoiceSettings(studio.engines, files)
        events = SpeechEvents(memory, lambda: runner.simulation.sound.time)
        self.speaker.listeners.append(events)
        self._text_to_speech = ALTextToSpeech(self.speaker, studio, settings, events, runner, files)
        self._animated_speech = ALAnimatedSpeech(
            runner,
            memory,
            self.speaker,
            studio,
            settings,
            files,
            self._call,
            self.animator,
            self.library,
            self.body_language,
            # A sound set that is not loaded yet has its files read.
            lambda path, volume: studio.in_background(lambda: play_sound(path, volume), "playSoundSetFile"),
        )
        self.modules: dict[str, list[Any]] = {
            "ALTextToSpeech": [self._text_to_speech, settings],
            "ALAnimatedSpeech": [self._animated_speech],
        }

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

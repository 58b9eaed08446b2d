"""Player, device and recorder put together: what they share, and what has to be ended in the end."""

from __future__ import annotations

from functools import partial
from typing import Any, Callable

from nao_sim_bridge.core.runner import SimulationRunner
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.background import Background
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.sound.audio_device import ALAudioDevice
from nao_sim_bridge.naoqi.sound.audio_player import ALAudioPlayer
from nao_sim_bridge.naoqi.sound.audio_recorder import ALAudioRecorder
from nao_sim_bridge.naoqi.sound.microphone_clients import MicrophoneClients
from nao_sim_bridge.naoqi.sound.microphone_energy import MicrophoneEnergy
from nao_sim_bridge.naoqi.sound.recorder import FilesInUse, Recorder
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles


class AudioModules:
    """ALAudioPlayer, ALAudioDevice and ALAudioRecorder of one robot.

    Attributes:
        clients: Modules that hear the microphones.
        recorders: Of the device, and of ALAudioRecorder.

    Args:
        simulation: Whose sound it is.
        runner: Its thread.
        sounds: Reads sound files of clients, from where they may have files read from and written to.
        broker: Finds modules of clients: `service(name)`.
        memory: Of the robot.
        allow_private_streams: See `ALAudioPlayer`.
    """

    def __init__(
        self,
        simulation: Simulation,
        runner: SimulationRunner,
        sounds: SoundFiles,
        broker: Any,
        memory: MemoryStore,
        allow_private_streams: bool,
    ) -> None:
        background = Background(released=lambda: simulation.wake())
        ears, settings = simulation.sound.ears, simulation.sound.settings
        self.clients = MicrophoneClients(ears, broker.service, released=lambda: simulation.wake())
        in_use = FilesInUse()
        self.recorders = [Recorder(simulation, runner, sounds.files, in_use) for _ in range(2)]
        self._energy = MicrophoneEnergy(ears, {side: settings.energy_channels(side) for side in settings.energies})
        self._player = ALAudioPlayer(simulation, runner, sounds, background, memory, allow_private_streams)
        self._device = ALAudioDevice(simulation, runner, sounds, self.clients, self._energy, self.recorders[0])
        self._recorder = ALAudioRecorder(self.recorders[1])
        simulation.holds += [self.clients.behind, background.holds]

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `Service` wants them."""
        return {
            "ALAudioPlayer": [self._player],
            "ALAudioDevice": [self._device],
            "ALAudioRecorder": [self._recorder],
        }

    def closing(self) -> list[Callable[[], None]]:
        """Steps that complete recordings and call no client any more; blocking."""
        return [
            *(recorder.close for recorder in self.recorders),
            partial(self._energy.enable, False),
            self.clients.close,
        ]

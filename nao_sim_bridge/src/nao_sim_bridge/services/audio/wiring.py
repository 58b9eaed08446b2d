"""Player, device and recorder put together: what they share, and what has to be ended in the end."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.audio.audio_device import ALAudioDevice
from nao_sim_bridge.services.audio.audio_player import ALAudioPlayer
from nao_sim_bridge.services.audio.audio_recorder import ALAudioRecorder
from nao_sim_bridge.services.audio.background import Background
from nao_sim_bridge.services.audio.microphone_clients import MicrophoneClients
from nao_sim_bridge.services.audio.microphone_energy import MicrophoneEnergy
from nao_sim_bridge.services.audio.recorder import FilesInUse, Recorder
from nao_sim_bridge.sim.runner import SimulationRunner
from nao_sim_bridge.sim.simulation import Simulation


class AudioModules:
    """ALAudioPlayer, ALAudioDevice and ALAudioRecorder of one robot.

    Attributes:
        clients: Modules that hear the microphones.
        recorders: Of the device, and of ALAudioRecorder.

    Args:
        simulation: Whose sound it is.
        runner: Its thread.
        files: Where clients may have files read from and written to.
        broker: Finds modules of clients: `service(name)`.
    """

    def __init__(self, simulation: Simulation, runner: SimulationRunner, files: ClientFiles, broker: Any) -> None:
        background = Background(released=lambda: simulation.wake())
        ears, settings = simulation.sound.ears, simulation.sound.settings
        self.clients = MicrophoneClients(ears, broker.service, released=lambda: simulation.wake())
        in_use = FilesInUse()
        self.recorders = [Recorder(simulation, runner, files, in_use) for _ in range(2)]
        self._energy = MicrophoneEnergy(ears, {side: settings.energy_channels(side) for side in settings.energies})
        self._player = ALAudioPlayer(simulation, runner, files, background)
        self._device = ALAudioDevice(simulation, runner, files, self.clients, self._energy, self.recorders[0])
        self._recorder = ALAudioRecorder(self.recorders[1])
        simulation.holds += [self.clients.behind, background.holds]

    def modules(self) -> dict[str, list[Any]]:
        """The modules by name, as `make_service` wants them."""
        return {
            "ALAudioPlayer": [self._player],
            "ALAudioDevice": [self._device],
            "ALAudioRecorder": [self._recorder],
        }

    def close(self) -> None:
        """Complete recordings and call no client any more; blocking."""
        for recorder in self.recorders:
            recorder.close()
        self._energy.enable(False)
        self.clients.close()

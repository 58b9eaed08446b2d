"""ALSoundLocalization of the simulated robot, and ALAudioSourceLocalization, its older name."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.hearing.array import microphone_array
from nao_sim_bridge.hearing.detection import DEFAULT_SENSITIVITY
from nao_sim_bridge.hearing.localiser import HeardSound, Localiser, OwnVoice
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.speech.head_track import HeadTrack
from nao_sim_bridge.naoqi.speech.listening import Listening, ListeningModule, sensitivity_of
from nao_sim_bridge.sound.ears import MicrophoneBlock

NAMES = ("ALSoundLocalization", "ALAudioSourceLocalization")
"""Of the module, and of what it was called before NAOqi 1.22."""
ONE, ALL = "{}/SoundLocated", "{}/SoundsLocated"


class SoundLocalization(ListeningModule):
    """Tells where sounds come from, once for each 170 ms in which there is one.

    The event `SoundLocated` has [[seconds, microseconds], [azimuth, elevation, confidence, energy], [pose of the head
    in FRAME_TORSO], [the same in FRAME_ROBOT]]; angles in rad in the frame of the head, energy 0 unless the parameter
    EnergyComputation asks for it. While the robot's own voice is not far weaker than what else there is, nothing is
    located: the robot never takes itself for somebody else.

    Args:
        module: NAOqi name.
        simulation: Whose ears these are.
        memory: Where events go.
    """

    def __init__(self, module: str, simulation: Simulation, memory: MemoryStore) -> None:
        self._one, self._all = ONE.format(module), ALL.format(module)
        self._memory = memory
        self._array = microphone_array(simulation.sound.microphones.places)
        self._own_voice = OwnVoice(simulation.sound)
        self._head = HeadTrack(simulation)
        self._sensitivity = DEFAULT_SENSITIVITY
        self._with_energy = False
        self._localiser: Localiser | None = None
        setters = {
            "Sensitivity": self._set_sensitivity,
            "Sensibility": self._set_sensitivity,
            "EnergyComputation": self._set_energy,
        }
        super().__init__(Listening(simulation.sound.ears, module, self._begin), setters)

    def _begin(self) -> Any:
        self._localiser = Localiser(self._array, RATE)
        self._localiser.sensitivity = self._sensitivity
        return self._hear

    def _hear(self, block: MicrophoneBlock) -> None:
        head = self._head.at((block.time + block.end) / 2.0)
        own_power = lambda: self._own_voice.power(block.time, block.end)  # noqa: E731
        sound = self._localiser.feed(block.samples, block.time, head.up, own_power)
        if sound is not None:
            told = [_stamp(sound.time), self._angles(sound), head.in_torso, head.in_robot]
            self._memory.raise_event(self._one, told)
            self._memory.raise_event(self._all, [told])

    def _angles(self, sound: HeardSound) -> list[float]:
        energy = sound.energy if self._with_energy else 0.0
        return [sound.azimuth, sound.elevation, sound.confidence, energy]

    def _set_sensitivity(self, value: Any) -> None:
        self._sensitivity = sensitivity_of(value)
        if self._localiser is not None:
            self._localiser.sensitivity = self._sensitivity

    def _set_energy(self, value: Any) -> None:
        if value not in (True, False):  # 1 and 0 are equal to them
            raise BadValue("EnergyComputation", value, "true or false")
        self._with_energy = bool(value)


def parts(module: str, simulation: Simulation, memory: MemoryStore) -> list[Any]:
    """The objects that together have the methods of `module`, ALSoundLocalization or ALAudioSourceLocalization."""
    service = SoundLocalization(module, simulation, memory)
    listening = service.listening
    return [
        service,
        Extractor(module, memory, listening.start, listening.stop, [ONE.format(module), ALL.format(module)]),
    ]


def _stamp(time: float) -> list[int]:
    return list(divmod(round(1e6 * time), 1000000))

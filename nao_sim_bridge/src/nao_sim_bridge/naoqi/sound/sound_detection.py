"""ALSoundDetection of the simulated robot. Only NAOqi methods live in the service."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.hearing.detection import DEFAULT_SENSITIVITY, SoundDetector
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.speech.listening import Listening, ListeningModule, sensitivity_of
from nao_sim_bridge.sound.ears import MicrophoneBlock

NAME, EVENT = "ALSoundDetection", "SoundDetected"


class ALSoundDetection(ListeningModule):
    """ALSoundDetection as the simulated robot offers it: tells when a sound begins and ends, also an own one.

    The event `SoundDetected` has [[index, type, confidence, time], ...], one for each beginning (type 1) and end (0)
    in a buffer of 170 ms: index of the sample in the buffer, confidence 0..1, time in us of simulated time. An end is
    told when it has been quiet for a moment; its time is that of the end, its index 0 when that was before the buffer.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        self._memory = memory
        self._sensitivity = DEFAULT_SENSITIVITY
        self._detector = SoundDetector(RATE)
        setters = {"Sensitivity": self._set_sensitivity, "Sensibility": self._set_sensitivity}
        super().__init__(Listening(simulation.sound.ears, NAME, self._begin), setters)

    def _begin(self) -> Any:
        self._detector = SoundDetector(RATE)
        self._detector.sensitivity = self._sensitivity
        return self._hear

    def _hear(self, block: MicrophoneBlock) -> None:
        edges = self._detector.feed(block.samples, block.time)
        if edges:
            told = [[edge.index, edge.kind, edge.confidence, round(1e6 * edge.time)] for edge in edges]
            self._memory.raise_event(EVENT, told)

    def _set_sensitivity(self, value: Any) -> None:
        self._sensitivity = self._detector.sensitivity = sensitivity_of(value)


def parts(simulation: Simulation, memory: MemoryStore) -> list[Any]:
    """The objects that together have the methods of ALSoundDetection."""
    service = ALSoundDetection(simulation, memory)
    listening = service.listening
    return [service, Extractor(NAME, memory, listening.start, listening.stop, [EVENT])]

"""ALSoundDetection, ALSoundLocalization and ALAudioSourceLocalization, its older name, and what they share."""

from __future__ import annotations

import bisect
from collections import deque
from dataclasses import dataclass
from itertools import islice
from typing import Any, Callable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import RATE
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.hearing.detection import DEFAULT_SENSITIVITY, SoundDetector
from nao_sim_bridge.hearing.localisation import microphone_array
from nao_sim_bridge.hearing.localiser import HeardSound, Localiser, OwnVoice
from nao_sim_bridge.model.frames import ROBOT, space_in_torso
from nao_sim_bridge.model.kinematics import quaternion_matrix
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.switch import Switch, SwitchModule
from nao_sim_bridge.naoqi.memory.extractor import Extractor
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.motion.arguments import as_position
from nao_sim_bridge.sound.ears import Ears, Listener, MicrophoneBlock
from nao_sim_bridge.tracking.geometry import placement

DETECTION, DETECTED = "ALSoundDetection", "SoundDetected"
LOCALIZATIONS = ("ALSoundLocalization", "ALAudioSourceLocalization")
"""Names of the module, and of what it was called before NAOqi 1.22."""
# Snapshots that are kept: about a second.
KEPT = 256
HEAD = "Head"
Hear = Callable[[MicrophoneBlock], None]


class Listening(Switch):
    """Opens and closes the ears of one module. Any thread.

    What `begin` returns each time that listening begins gets the blocks, four channels of 48 kHz.
    """

    def __init__(self, ears: Ears, name: str, begin: Callable[[], Hear]) -> None:
        super().__init__()
        self._ears = ears
        self._name = name
        self._begin = begin
        self._listener: Listener | None = None

    @property
    def runs(self) -> bool:
        return self._listener is not None

    def _update(self) -> None:
        if self._works and self._listener is None:
            self._listener = self._ears.listen(self._name, self._begin(), wants="48k4")
        elif not self._works and self._listener is not None:
            self._listener.close()
            self._listener = None


class SoundExtractor(SwitchModule):
    """An extractor that listens while somebody is subscribed. Only NAOqi methods are public, and `parts`.

    Who inherits it writes `_hear`, which gets the blocks, four channels of 48 kHz. `detector` makes what looks through
    them, anew each time that listening begins; it has a `sensitivity`. `setters` take other parameters.
    """

    def __init__(
        self,
        module: str,
        simulation: Simulation,
        memory: MemoryStore,
        events: Sequence[str],
        detector: Callable[[], Any],
        **setters: Callable[[Any], None],
    ) -> None:
        listening = Listening(simulation.sound.ears, module, self._begin)
        super().__init__(
            listening, {"Sensitivity": self._set_sensitivity, "Sensibility": self._set_sensitivity, **setters}
        )
        self._memory = memory
        self._make_detector = detector
        self._detector: Any = None
        self._sensitivity = DEFAULT_SENSITIVITY
        self._extractor = Extractor(module, memory, listening.start, listening.stop, events, by_events=True)

    def parts(self) -> list[Any]:
        return [self, self._extractor]

    def _begin(self) -> Hear:
        self._detector = self._make_detector()
        self._detector.sensitivity = self._sensitivity
        return self._hear

    def _hear(self, block: MicrophoneBlock) -> None:
        raise NotImplementedError

    def _set_sensitivity(self, value: Any) -> None:
        self._sensitivity = number(value, "Sensitivity", 0.0, 1.0)
        if self._detector is not None:
            self._detector.sensitivity = self._sensitivity


class ALSoundDetection(SoundExtractor):
    """ALSoundDetection as the simulated robot offers it: tells when a sound begins and ends, also an own one.

    The event `SoundDetected` has [[index, type, confidence, time], ...], one for each beginning (type 1) and end (0)
    in a buffer of 170 ms: index of the sample in the buffer, confidence 0..1, time in us of simulated time. An end is
    told when it has been quiet for a moment; its time is that of the end, its index 0 when that was before the buffer.
    """

    def __init__(self, simulation: Simulation, memory: MemoryStore) -> None:
        super().__init__(DETECTION, simulation, memory, [DETECTED], lambda: SoundDetector(RATE))

    def _hear(self, block: MicrophoneBlock) -> None:
        edges = self._detector.feed(block.samples, block.time)
        if edges:
            told = [[edge.index, edge.kind, edge.confidence, round(1e6 * edge.time)] for edge in edges]
            self._memory.raise_event(DETECTED, told)


@dataclass(frozen=True)
class HeadPose:
    """The head at one time."""

    up: tuple[float, float, float]  # unit vector upwards in the world, in the frame of the head
    in_torso: list[float]  # x, y, z in m, wx, wy, wz in rad, in FRAME_TORSO
    in_robot: list[float]  # the same in FRAME_ROBOT


class HeadTrack:
    """Remembers the last snapshots. Written in the simulation thread, read in any."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self._link = simulation.model.effectors[HEAD]
        self._snapshots: deque[Snapshot] = deque([simulation.snapshot], maxlen=KEPT)
        simulation.after_tick.append(self._snapshots.append)

    def at(self, time: float) -> HeadPose:
        """The head at a simulated time, s; the oldest that is known when that is too long ago."""
        known = self._known()
        return self._pose(known[max(0, bisect.bisect_right([snapshot.time for snapshot in known], time) - 1)])

    def _known(self) -> list[Snapshot]:
        while True:
            try:
                return list(islice(self._snapshots, len(self._snapshots)))
            except RuntimeError:  # the simulation thread appended meanwhile
                continue

    def _pose(self, snapshot: Snapshot) -> HeadPose:
        model = self._simulation.model
        placed = placement(model, snapshot)
        head = placed.links[self._link.parent_link]
        in_robot = np.linalg.inv(space_in_torso(model, ROBOT, placed)) @ head
        up = (quaternion_matrix(snapshot.torso.orientation) @ head[:3, :3])[2]
        return HeadPose(tuple(up.tolist()), as_position(head), as_position(in_robot))


class SoundLocalization(SoundExtractor):
    """Tells where sounds come from, once for each 170 ms in which there is one.

    The event `SoundLocated` has [[seconds, microseconds], [azimuth, elevation, confidence, energy], [pose of the head
    in FRAME_TORSO], [the same in FRAME_ROBOT]]; angles in rad in the frame of the head, energy 0 unless the parameter
    EnergyComputation asks for it. While the robot's own voice is not far weaker than what else there is, nothing is
    located: the robot never takes itself for somebody else.
    """

    def __init__(self, module: str, simulation: Simulation, memory: MemoryStore) -> None:
        self._one, self._all = events = [f"{module}/SoundLocated", f"{module}/SoundsLocated"]
        array = microphone_array(simulation.sound.microphones.places)
        self._own_voice = OwnVoice(simulation.sound)
        self._head = HeadTrack(simulation)
        self._with_energy = False
        localiser = lambda: Localiser(array, RATE)  # noqa: E731
        super().__init__(module, simulation, memory, events, localiser, EnergyComputation=self._set_energy)

    def _hear(self, block: MicrophoneBlock) -> None:
        head = self._head.at((block.time + block.end) / 2.0)
        own_power = lambda: self._own_voice.power(block.time, block.end)  # noqa: E731
        sound = self._detector.feed(block.samples, block.time, head.up, own_power)
        if sound is not None:
            told = [list(divmod(round(1e6 * sound.time), 1000000)), self._angles(sound), head.in_torso, head.in_robot]
            self._memory.raise_event(self._one, told)
            self._memory.raise_event(self._all, [told])

    def _angles(self, sound: HeardSound) -> list[float]:
        energy = sound.energy if self._with_energy else 0.0
        return [sound.azimuth, sound.elevation, sound.confidence, energy]

    def _set_energy(self, value: Any) -> None:
        if value not in (True, False):  # 1 and 0 are equal to them
            raise BadValue("EnergyComputation", value, "true or false")
        self._with_energy = bool(value)

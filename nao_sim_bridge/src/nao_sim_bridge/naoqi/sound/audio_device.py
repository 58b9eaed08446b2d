"""ALAudioDevice of the simulated robot."""

from __future__ import annotations

from typing import Any, Callable, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task, WorkThreads
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import limited, number, one_of
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.sound.microphone_clients import MicrophoneClients
from nao_sim_bridge.naoqi.sound.microphone_formats import ALL, HIGH, LOW, MicrophoneFormat, microphone_format
from nao_sim_bridge.naoqi.sound.output_buffers import RATES, OutputBuffers, samples_of
from nao_sim_bridge.naoqi.sound.recorder import Recorder, kind_of
from nao_sim_bridge.naoqi.sound.sound_extractors import Listening
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles, side, sine

OUTPUT_RATE, INPUT_SIZE = "outputSampleRate", "inputBufferSize"
# Frames that clients get at once; the first is about a block.
INPUT_SIZES = (8192, 16384)
UNKNOWN = -1
INPUTS, OUTPUTS = ("microphones",), ("loudspeakers",)
FRONT = 3


def _energy_of(side: str) -> Callable[[MicrophoneEnergy], float]:
    return lambda self: self._energies.get(side, 0.0) if self._listening.runs else 0.0


class MicrophoneEnergy:
    """Part of ALAudioDevice: root mean square of the newest block of 170 ms, 0 to 32768; 0 while it is not computed.

    `sides` are the channels of a block that are left, right, front and rear.
    """

    def __init__(self, ears: Any, sides: Mapping[str, Sequence[int]]) -> None:
        self._listening = Listening(ears, "microphone energy", self._begin)
        self._sides = sides
        self._energies: dict[str, float] = {}

    getLeftMicEnergy, getRightMicEnergy = _energy_of("left"), _energy_of("right")
    getFrontMicEnergy, getRearMicEnergy = _energy_of("front"), _energy_of("rear")

    def enableEnergyComputation(self) -> None:
        self._listening.start()

    def disableEnergyComputation(self) -> None:
        self._listening.stop()

    def set_closed(self, closed: bool) -> None:
        """Whether the microphones are closed: then there is nothing to compute."""
        self._listening.pause(closed)

    def _begin(self) -> Callable[[Any], None]:
        self._energies = {}
        return self._on_block

    def _on_block(self, block: Any) -> None:
        squares = np.mean(block.samples.astype(np.float64) ** 2, axis=0)
        self._energies = {
            side: float(np.sqrt(np.mean(squares[list(channels)]))) for side, channels in self._sides.items()
        }


class ALAudioDevice:
    """ALAudioDevice as the simulated robot offers it."""

    def __init__(
        self,
        runner: RobotRunner,
        sounds: SoundFiles,
        clients: MicrophoneClients,
        energy: MicrophoneEnergy,
        recorder: Recorder,
    ) -> None:
        self._runner = runner
        self._sounds = sounds
        self._clients = clients
        self._energy = energy
        self._recorder = recorder
        self._buffers = OutputBuffers(runner.simulation)
        self._working = WorkThreads("microphones", load_sizes().clients.threads)
        self._input_size = INPUT_SIZES[0]
        self._input_closed = False

    # --- loudspeakers ---------------------------------------------------------------------------------------------

    def setOutputVolume(self, volume: int) -> Task:
        checked = limited(volume, "volume", 0, 100)
        return self._do(lambda: setattr(self._speakers, "volume", checked), "setOutputVolume")

    def getOutputVolume(self) -> int:
        return round(self._speakers.volume)

    def muteAudioOut(self, mute: bool) -> Task:
        return self._do(lambda: setattr(self._speakers, "muted", mute), "muteAudioOut")

    def isAudioOutMuted(self) -> bool:
        return self._speakers.muted

    def openAudioOutputs(self) -> Task:
        return self._do(lambda: setattr(self._speakers, "closed", False), "openAudioOutputs")

    def closeAudioOutputs(self) -> Task:
        return self._do(lambda: setattr(self._speakers, "closed", True), "closeAudioOutputs")

    def isOutputClosed(self) -> bool:
        return self._speakers.closed

    def playSine(self, frequency: int, gain: int, pan: int, duration: float) -> Task:
        sound, pan = sine(frequency, gain, duration), side(pan)
        return self._do(lambda: self._speakers.play(sound, f"{frequency} Hz", pan=pan).task, "playSine")

    def sendRemoteBufferToOutput(self, frames: int, buffer: Any) -> Task:
        samples = samples_of(frames, buffer)
        return self._do(lambda: self._buffers.add(samples), "sendRemoteBufferToOutput")

    def sendLocalBufferToOutput(self, frames: int, buffer: int) -> bool:
        raise NaoqiError("addresses are for modules inside the robot's own process; use sendRemoteBufferToOutput")

    def flushAudioOutputs(self) -> Task:
        return self._do(self._buffers.drop, "flushAudioOutputs")

    # --- microphones ----------------------------------------------------------------------------------------------

    def setClientPreferences(self, module: str, rate: int, channels: Any, deinterleaved: int, *_time: int) -> None:
        self._clients.prefer(module, microphone_format(rate, channels, deinterleaved))

    def subscribe(self, module: str) -> Task:
        # Not in libqi's own thread: the first call of a module may need that to get through.
        return self._working.work_out("subscribe", lambda: self._clients.subscribe(module))

    def unsubscribe(self, module: str) -> Task:
        return self._working.work_out("unsubscribe", lambda: self._clients.unsubscribe(module))

    def client_gone(self, module: str) -> None:
        self._clients.gone(module)

    def openAudioInputs(self) -> Task:
        return self._set_input_closed(False)

    def closeAudioInputs(self) -> Task:
        return self._set_input_closed(True)

    def isInputClosed(self) -> bool:
        return self._input_closed

    def setFileAsInput(self, name: str) -> Task:
        sound = self._sounds.read(name) if name else None
        if sound is not None and sound.channels == 2:  # of two channels nobody knows which microphones they are for
            sound = sound.mono()
        microphones = self._runner.simulation.sound.microphones
        return self._do(lambda: setattr(microphones, "replaced_by", sound), "setFileAsInput")

    def startMicrophonesRecording(self, name: str) -> Task:
        kind = kind_of(name)
        heard = MicrophoneFormat(HIGH, ALL) if kind == "wav" else MicrophoneFormat(LOW, FRONT)
        return self._recorder.start(name, kind, heard)

    def stopMicrophonesRecording(self) -> Task:
        return self._recorder.stop()

    # --- parameters and devices -----------------------------------------------------------------------------------

    def setParameter(self, name: str, value: int) -> Task | None:
        if name == INPUT_SIZE:
            self._input_size = one_of(value, name, INPUT_SIZES)
            self._clients.set_at_once(self._input_size // INPUT_SIZES[0])
            return None
        if name != OUTPUT_RATE:
            raise UnknownName("parameter", name, (OUTPUT_RATE, INPUT_SIZE))
        rate = one_of(value, name, RATES)
        return self._do(lambda: self._buffers.set_rate(rate), "setParameter")

    def getParameter(self, name: str) -> int:
        return {OUTPUT_RATE: self._buffers.rate, INPUT_SIZE: self._input_size}.get(name, UNKNOWN)

    def listInputs(self) -> list:
        return list(INPUTS)

    def listOutputs(self) -> list:
        return list(OUTPUTS)

    def input(self, index: int) -> list:
        return [["name", _device(index, INPUTS)], ["channels", 4], ["sampleRate", HIGH]]

    def output(self, index: int) -> list:
        return [["name", _device(index, OUTPUTS)], ["channels", 2], ["sampleRate", self._buffers.rate]]

    def defaultInput(self) -> int:
        return 0

    def defaultOutput(self) -> int:
        return 0

    def setDefaultInput(self, index: int) -> None:
        _device(index, INPUTS)

    def setDefaultOutput(self, index: int) -> None:
        _device(index, OUTPUTS)

    @property
    def _speakers(self) -> Any:
        return self._runner.simulation.sound.loudspeakers

    def _do(self, action: Callable[[], Any], name: str) -> Task:
        return self._runner.execute(action, name)

    def _set_input_closed(self, closed: bool) -> Task:
        def change() -> None:
            self._input_closed = closed
            self._clients.set_closed(closed)
            self._energy.set_closed(closed)

        return self._working.work_out("closeAudioInputs", change)


def _device(index: int, devices: tuple[str, ...]) -> str:
    number(index, "index", 0, len(devices) - 1)
    return devices[index]

"""What the audio modules share: the robot's sound card, ALAudioDevice."""

from __future__ import annotations

from typing import Any

from ..server.nao_basic import NaoBasic
from .fields import DeviceParameter, DeviceSetting, Mute, OutputRate, OutputVolume, Revert

DEVICE = "ALAudioDevice"


def decimal(value: Any) -> float:
    """A number of the robot as it was meant: it keeps 32-bit numbers, and 0.3 comes back as 0.30000001192092896."""
    return round(float(value), 6)


def put_back(module: NaoBasic, name: str, method: str, *args: Any) -> None:
    """Call a quick method of a NAOqi module when the running function and the wait after it are over, however they end.

    Args:
        module: Whose function runs.
        name: Name of the NAOqi module.
        method: Its method, which restores a setting.
        args: The former setting.
    """
    module.after_wait(lambda: module.call_now(module.robot.proxy(name), method, *args))


class NaoAudio(NaoBasic):
    """Base of the modules for sound: wraps ALAudioDevice.

    Parameters of functions are fields of the function message; it need not have those with defaults. `revert` puts back
    what a function has changed, after the wait that follows it, however the goal ends.
    """

    # Volume

    def set_output_volume(self, volume: OutputVolume, revert: Revert = False) -> None:
        """Set the volume of everything that sounds, 0..100."""
        if revert:
            put_back(self, DEVICE, "setOutputVolume", int(self.device("getOutputVolume")))
        self.device("setOutputVolume", int(volume))

    def get_output_volume(self) -> int:
        """Volume of everything that sounds, 0..100."""
        return int(self.device("getOutputVolume"))

    def mute_audio_out(self, enable: Mute, revert: Revert = False) -> None:
        """Silence the loudspeakers (`enable` true), or let them sound again."""
        if revert:
            put_back(self, DEVICE, "muteAudioOut", bool(self.device("isAudioOutMuted")))
        self.device("muteAudioOut", bool(enable))

    def is_audio_out_muted(self) -> bool:
        """Whether the loudspeakers are silenced."""
        return bool(self.device("isAudioOutMuted"))

    # Outputs and inputs

    def flush_audio_outputs(self) -> None:
        """Drop sound that waits to be played."""
        self.device("flushAudioOutputs")

    def open_audio_outputs(self) -> None:
        """Take the loudspeakers again."""
        self.device("openAudioOutputs")

    def close_audio_outputs(self) -> None:
        """Release the loudspeakers."""
        self.device("closeAudioOutputs")

    def is_output_closed(self) -> bool:
        """Whether the loudspeakers are released."""
        return bool(self.device("isOutputClosed"))

    def open_audio_inputs(self) -> None:
        """Take the microphones again."""
        self.device("openAudioInputs")

    def close_audio_inputs(self) -> None:
        """Release the microphones."""
        self.device("closeAudioInputs")

    def is_input_closed(self) -> bool:
        """Whether the microphones are released."""
        return bool(self.device("isInputClosed"))

    def list_outputs(self) -> list[Any]:
        """Outputs of the robot, as it describes them."""
        return list(self.device("listOutputs"))

    def list_inputs(self) -> list[Any]:
        """Inputs of the robot, as it describes them."""
        return list(self.device("listInputs"))

    # Parameters

    def set_device_parameter(self, str_param: DeviceSetting, values: OutputRate, revert: Revert = False) -> None:
        """Set a parameter of the sound card named in `str_param`: outputSampleRate, Hz."""
        name = str_param.strip()
        if revert:
            put_back(self, DEVICE, "setParameter", name, int(self.device("getParameter", name)))
        self.device("setParameter", name, int(values[0]))

    def get_device_parameter(self, str_param: DeviceParameter) -> int:
        """A parameter of the sound card named in `str_param`: outputSampleRate, inputBufferSize."""
        return int(self.device("getParameter", str_param.strip()))

    def device(self, method: str, *args: Any) -> Any:
        """Call ALAudioDevice; preemption ends the call."""
        return self.call(self.robot.proxy(DEVICE), method, *args)

    function_table = {
        "setOutputVolume": set_output_volume,
        "getOutputVolume": get_output_volume,
        "muteAudioOut": mute_audio_out,
        "isAudioOutMuted": is_audio_out_muted,
        "flushAudioOutputs": flush_audio_outputs,
        "openAudioOutputs": open_audio_outputs,
        "closeAudioOutputs": close_audio_outputs,
        "isOutputClosed": is_output_closed,
        "openAudioInputs": open_audio_inputs,
        "closeAudioInputs": close_audio_inputs,
        "isInputClosed": is_input_closed,
        "listOutputs": list_outputs,
        "listInputs": list_inputs,
    }

"""The robot's sound card, ALAudioDevice, and the fields of messages that both audio modules have."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import Any, List

from .core.errors import BadGoal
from .core.fields import CONTROL, LONGEST_NAME, Annotated, Field, flag, free, require_known, require_text, whole, word
from .core.nao_facts import HOME, READ, full_path, is_in
from .nao_basic import NaoBasic

OUTPUT_RATES = (16000, 22050, 44100, 48000)
RATES = f"one of {', '.join(map(str, OUTPUT_RATES))} (Hz)"
DEVICE_PARAMETERS = ("outputSampleRate", "inputBufferSize")
SET_PARAMETERS = DEVICE_PARAMETERS[:1]
"""Those that can be set."""
SETTABLE = "parameter of ALAudioDevice that can be set"
SOUND_FILES = (".wav", ".ogg", ".flac", ".mp3")
"""What the robot plays."""


def require_file(field: str, name: str, suffixes: Sequence[str], folders: Sequence[str] = READ) -> str:
    """Check the name of a file on the robot, relative to the home of its user or in one of the folders.

    Whether the file is there is for the robot to say.

    Args:
        field: Of the message, for refusals.
        name: As it was given.
        suffixes: Allowed ends of the name, in lower case: ".wav".
        folders: Where absolute names may lead.

    Returns the name without blanks around it.

    Raises:
        BadGoal: It is no such name.
    """
    path = require_text(field, name, "the name of a file")
    allowed = allowed_files(suffixes, folders)
    if CONTROL.search(path):
        raise BadGoal(field, name, allowed, problem=f"{name!r} has characters that names do not have")
    if ".." in PurePosixPath(path).parts or not is_in(path, folders):
        raise BadGoal(field, name, allowed, problem=f"{name!r} leads out of the folders for sounds")
    if full_path(path).startswith(f"{HOME}/~") or "\\" in path:
        raise BadGoal(field, name, allowed, problem=f"{name!r} is not the name of a file")
    if max(map(len, PurePosixPath(path).parts)) > LONGEST_NAME:
        raise BadGoal(field, name, f"up to {LONGEST_NAME} characters", problem="the name is too long")
    if PurePosixPath(path).suffix.lower() not in suffixes:
        raise BadGoal(field, name, allowed, problem=f"{name!r} is not a file of a known kind")
    return path


def allowed_files(suffixes: Sequence[str], folders: Sequence[str] = READ) -> str:
    """What `require_file` takes, in words."""
    return f"a relative name or one in {' or '.join(folders)}, without '..', that ends in {', '.join(suffixes)}"


def require_rate(field: str, values: Sequence[float]) -> None:
    """A sample rate of the outputs, Hz."""
    if len(values) != 1 or values[0] not in OUTPUT_RATES:
        raise BadGoal(field, list(values), RATES)


def check_device_setting(str_param: str, values: Sequence[float]) -> None:
    """The sample rate of the outputs, which is all that can be set."""
    require_known("str_param", str_param, SET_PARAMETERS, SETTABLE)
    require_rate("values", values)


def file_of_kind(suffixes: Sequence[str], meaning: str, folders: Sequence[str] = READ) -> Field:
    """Name of a file on the robot, as `require_file` takes it."""
    allowed = allowed_files(suffixes, folders)
    return free(meaning, allowed=allowed, check=lambda name, value: require_file(name, value, suffixes, folders))


OutputVolume = Annotated[float, whole(0, 100, "volume of everything that sounds", "(%)").but(unit="%")]
Mute = Annotated[bool, flag("whether the loudspeakers are silent")]
Revert = Annotated[bool, flag("whether what the function sets goes back after `time`")]
DeviceParameter = Annotated[str, word(DEVICE_PARAMETERS, "parameter of the sound card", "parameter of ALAudioDevice")]
DeviceSetting = Annotated[str, word(SET_PARAMETERS, "parameter of the sound card", SETTABLE)]
OutputRate = Annotated[List[float], free("sample rate of the outputs", "Hz", allowed=RATES, check=require_rate)]


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

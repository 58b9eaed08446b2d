"""What the fields of both audio modules mean and may hold. Pure; checks raise BadGoal."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import PurePosixPath
from typing import List

from ..base.errors import BadGoal
from ..base.field_checks import CONTROL, LONGEST_NAME, require_known, require_text
from ..functions.fields import Annotated, Field, flag, free, whole, word
from ..nao.robot_files import HOME, READ, full_path, is_in

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

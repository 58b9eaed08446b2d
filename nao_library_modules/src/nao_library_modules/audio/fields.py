"""What the fields mean that functions of both audio modules have."""

from __future__ import annotations

from collections.abc import Sequence
from typing import List

from ..functions.fields import Annotated, Field, flag, free, whole, word
from .checks import DEVICE_PARAMETERS, RATES, SET_PARAMETERS, SETTABLE, allowed_files, require_file, require_rate


def file_of_kind(suffixes: Sequence[str], meaning: str) -> Field:
    """Name of a file on the robot, as `require_file` takes it."""
    return free(meaning, allowed=allowed_files(suffixes), check=lambda name, value: require_file(name, value, suffixes))


OutputVolume = Annotated[float, whole(0, 100, "volume of everything that sounds", "(%)").but(unit="%")]
Mute = Annotated[bool, flag("whether the loudspeakers are silent")]
Revert = Annotated[bool, flag("whether what the function sets goes back after `time`")]
DeviceParameter = Annotated[str, word(DEVICE_PARAMETERS, "parameter of the sound card", "parameter of ALAudioDevice")]
DeviceSetting = Annotated[str, word(SET_PARAMETERS, "parameter of the sound card", SETTABLE)]
OutputRate = Annotated[List[float], free("sample rate of the outputs", "Hz", allowed=RATES, check=require_rate)]

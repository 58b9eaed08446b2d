"""Sound files that clients name: found, checked and read."""

from __future__ import annotations

from pathlib import Path

import soundfile

from nao_sim_bridge.record_dir import ClientFiles
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.sim.sound.files import SoundFileError, read_sound
from nao_sim_bridge.sim.sound.samples import RATE, Sound

# Sounds are kept in memory as a whole: a quarter of an hour in stereo takes 350 MB.
LONGEST = 900.0
FORMATS = "allowed are wav, ogg, flac and mp3"


def read_client_file(files: ClientFiles, name: str) -> Sound:
    """The sound in a file that a client names, at the rate of the simulated world.

    Raises:
        ValueError: The name leads out of the folder for recordings, or there is no such file.
        NaoqiError: The file holds no sound that can be played.
    """
    return read_checked(files.to_read(name), name)


def read_checked(path: Path, name: str) -> Sound:
    """The sound in a file, at the rate of the simulated world.

    Args:
        path: The file.
        name: What to call it in errors.

    Raises:
        NaoqiError: It holds no sound that can be played.
    """
    try:
        facts = soundfile.info(str(path))
        if facts.frames > LONGEST * facts.samplerate:
            raise NaoqiError(f"{name!r} is {facts.duration:.0f} s long, allowed are {LONGEST:.0f} s")
        return read_sound(path).at_rate(RATE)
    except soundfile.LibsndfileError as error:
        raise NaoqiError(f"{name!r} cannot be read as sound ({error.error_string.strip()}); {FORMATS}") from error
    except SoundFileError as error:
        raise NaoqiError(f"{name!r} cannot be played: {str(error).replace(str(path), name)}") from error

"""Sounds in files: wav, flac, ogg and mp3."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from nao_sim_bridge.sim.errors import SimulationError
from nao_sim_bridge.sim.sound.samples import LONGEST, Sound

KINDS = {".wav": ("WAV", "PCM_16"), ".flac": ("FLAC", "PCM_16"), ".ogg": ("OGG", "VORBIS"), ".mp3": ("MP3", None)}


class SoundFileError(SimulationError):
    """A sound file that cannot be read or written; the text names it and says why."""


def read_sound(path: Path | str) -> Sound:
    """The sound in a file, at its own rate and with its own channels.

    Raises:
        SoundFileError: There is no such file, or it holds no sound that can be read.
    """
    import soundfile  # takes a moment, and a silent simulation does without

    path = Path(path)
    if not path.exists():
        raise SoundFileError(f"sound file {path}: there is no such file")
    if not path.is_file():
        raise SoundFileError(f"sound file {path}: is not a file")
    try:
        with soundfile.SoundFile(str(path)) as file:
            if file.frames > LONGEST * file.samplerate:
                length = file.frames / file.samplerate
                raise SoundFileError(f"sound file {path}: is {length:.0f} s long, at most {LONGEST:.0f} s are allowed")
            samples, rate = file.read(dtype="float32", always_2d=True), file.samplerate
    except (RuntimeError, OSError, ValueError) as error:
        if isinstance(error, SoundFileError):
            raise
        raise SoundFileError(f"sound file {path}: cannot be read: {error}") from error
    if not len(samples):
        raise SoundFileError(f"sound file {path}: holds no sound (0 frames)")
    return Sound(np.nan_to_num(samples, copy=False), rate)


def write_sound(path: Path | str, sound: Sound) -> None:
    """Write a sound; the ending of the name says of which kind the file is.

    Raises:
        SoundFileError: The kind is unknown, or the file cannot be written.
    """
    import soundfile

    path = Path(path)
    if path.suffix.lower() not in KINDS:
        raise SoundFileError(f"sound file {path}: the name has to end with {', '.join(KINDS)}")
    kind, coding = KINDS[path.suffix.lower()]
    try:
        with soundfile.SoundFile(str(path), "w", sound.rate, sound.channels, coding, format=kind) as file:
            # In pieces: the encoder of Vorbis keeps all that it is given at once on its stack.
            for first in range(0, sound.frames, sound.rate):
                file.write(np.clip(sound.samples[first : first + sound.rate], -1.0, 1.0))
    except (RuntimeError, OSError, ValueError) as error:
        raise SoundFileError(f"sound file {path}: cannot be written: {error}") from error

"""Sounds written to files: wav, flac, ogg and mp3. What reads them is in `reader`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.whole_file import WholeFile

KINDS = {".wav": ("WAV", "PCM_16"), ".flac": ("FLAC", "PCM_16"), ".ogg": ("OGG", "VORBIS"), ".mp3": ("MP3", None)}


class SoundFileError(SimulationError):
    """A sound file that cannot be read or written; the text names it and says why."""


def write_sound(path: Path | str, sound: Sound) -> None:
    """Write a sound; the ending of the name says of which kind the file is.

    Raises:
        SoundFileError: The kind is unknown, or there can be no such sound.
        FileTrouble: The file cannot be written.
    """
    import soundfile  # takes a moment, and a silent simulation does without

    path = Path(path)
    if path.suffix.lower() not in KINDS:
        raise SoundFileError(f"sound file {path}: the name has to end with {', '.join(KINDS)}")
    kind, coding = KINDS[path.suffix.lower()]
    try:
        with WholeFile(path) as target:
            with soundfile.SoundFile(target, "w", sound.rate, sound.channels, coding, format=kind) as file:
                # In pieces: the encoder of Vorbis keeps all that it is given at once on its stack.
                for first in range(0, sound.frames, sound.rate):
                    file.write(np.clip(sound.samples[first : first + sound.rate], -1.0, 1.0))
    except (soundfile.LibsndfileError, ValueError) as error:
        raise SoundFileError(f"sound file {path}: cannot be written: {error}") from error

"""Sounds for clients: files that they name, sound sets (folders of short sounds), and tones."""

from __future__ import annotations

from pathlib import Path
from typing import Callable, Iterable, Mapping

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.base.samples import sine as tone
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.sound.files import SoundFileError, SoundReader

ENDINGS = (".wav", ".ogg", ".flac", ".mp3")
# Of a tone: Hz and s.
HIGHEST, LONGEST = 20000.0, 600.0
# It swells and fades in this time, s: cut off hard it would click.
EDGE = 0.002


class SoundFiles:
    """Reads sounds for clients."""

    def __init__(self, files: ClientFiles, reader: SoundReader) -> None:
        self.files = files
        self.reader = reader

    def read(self, name: str) -> Sound:
        """The sound in a file that a client names, at the rate of the simulated world.

        A ValueError when the name leads out of the folder for recordings, or there is no such file; a NaoqiError when
        the file holds no sound that can be played, or too much of it.
        """
        return self.read_path(self.files.to_read(name), name)

    def read_path(self, path: Path | str, name: str) -> Sound:
        """As `read`, of any file, which errors call by `name`."""
        try:
            return self.reader.read(path, self.reader.sizes.sound.client_s).at_rate(RATE)
        except SoundFileError as error:
            raise NaoqiError(str(error).replace(f"sound file {path}:", repr(name))) from error


class SoundSets:
    """Part of ALAudioPlayer: installed and loaded sound sets, subfolders of `folders`; the first of a name counts.

    `check_room` is called with a name and bytes before a sound of that name is kept; it raises an error if they are too
    many.
    """

    def __init__(self, sounds: SoundFiles, check_room: Callable[[str, int], None], *folders: Path) -> None:
        self._sounds = sounds
        self._check_room = check_room
        self._folders = folders
        self._loaded: dict[str, Mapping[str, Sound]] = {}

    def getInstalledSoundSetsList(self) -> list[str]:
        found = {path.name for folder in self._folders if folder.is_dir() for path in folder.iterdir() if path.is_dir()}
        return sorted(found)

    def isSoundSetInstalled(self, name: str) -> bool:
        return name in self.getInstalledSoundSetsList()

    def getLoadedSoundSetsList(self) -> list[str]:
        """In the order of loading."""
        return list(self._loaded)

    def isSoundSetLoaded(self, name: str) -> bool:
        return name in self._loaded

    def getSoundSetFileNames(self, name: str) -> list[str]:
        return sorted(self._files(name))

    def isSoundSetFileInstalled(self, name: str, file: str) -> bool:
        return self.isSoundSetInstalled(name) and _without_ending(file) in self._files(name)

    def _files(self, name: str) -> dict[str, Path]:
        """Sounds of a set: name without ending to file; a NaoqiError when there is no such set."""
        installed = self.getInstalledSoundSetsList()
        if name not in installed:
            raise NaoqiError(f"no sound set {name!r}; installed are {_listed(installed)}")
        folder = next(path for path in (folder / name for folder in self._folders) if path.is_dir())
        return {path.stem: path for path in sorted(folder.iterdir()) if path.suffix.lower() in ENDINGS}

    def loadSoundSet(self, name: str) -> None:
        """Read all sounds of a set into memory.

        A NaoqiError when there is no such set, one of its files cannot be read, or there is no room for it.
        """
        if name in self._loaded:
            return
        sounds: dict[str, Sound] = {}
        for key, path in self._files(name).items():
            sounds[key] = self._sounds.read_path(path, path.name)
            self._check_room(f"sound set {name}", sum(sound.samples.nbytes for sound in sounds.values()))
        self._loaded[name] = sounds

    def kept(self) -> list[tuple[str, int]]:
        """Names of the loaded sets and their bytes."""
        loaded = dict(self._loaded)
        return [
            (f"sound set {name}", sum(sound.samples.nbytes for sound in sounds.values()))
            for name, sounds in loaded.items()
        ]

    def unloadSoundSet(self, name: str) -> None:
        """Forget a set; a NaoqiError when it is not loaded."""
        if name not in self._loaded:
            raise NaoqiError(f"sound set {name!r} is not loaded; loaded are {_listed(self._loaded)}")
        del self._loaded[name]

    def sound(self, file: str, name: str | None = None) -> Sound:
        """A sound by its name, with or without ending, of a set, which is loaded if need be, or of all loaded ones.

        A NaoqiError when there is no such set or sound, or no set is loaded.
        """
        if name is not None:
            self.loadSoundSet(name)
        sets = self._loaded if name is None else {name: self._loaded[name]}
        if not sets:
            raise NaoqiError(f"no sound set is loaded; installed are {_listed(self.getInstalledSoundSetsList())}")
        key = _without_ending(file)
        for sounds in sets.values():
            if key in sounds:
                return sounds[key]
        known = [f"{of_set}/{sound}" for of_set, sounds in sets.items() for sound in sounds]
        raise NaoqiError(f"no sound {file!r}; there are {_listed(known)}")


def _without_ending(file: str) -> str:
    return Path(file).stem if Path(file).suffix.lower() in ENDINGS else file


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "none"


def sine(frequency: float, gain: float, duration: float) -> Sound:
    """A tone of one channel.

    Args:
        frequency: Hz, 1 to 20000.
        gain: Amplitude in percent of full scale, 0 to 100.
        duration: s, above 0 to 600.

    Raises:
        BadValue: An argument outside of this.
    """
    pitch = number(frequency, "frequence", 1.0, HIGHEST)
    amplitude = number(gain, "gain", 0.0, 100.0) / 100.0
    frames = round(number(duration, "duration", 0.0, LONGEST) * RATE)
    if frames == 0:
        raise BadValue("duration", duration, f"above 0 to {LONGEST:g}")
    samples = tone(pitch, frames / RATE, amplitude).samples[:, 0].copy()
    edge = min(round(EDGE * RATE), frames // 2)
    ramp = np.sin(0.5 * np.pi * np.arange(edge) / max(edge, 1)) ** 2
    samples[:edge] *= ramp
    samples[frames - edge :] *= ramp[::-1]
    return Sound(samples[:, np.newaxis], RATE)


def side(pan: int) -> float:
    """Panorama of playSine: -1 left, 0 both, 1 right; a BadValue for anything else."""
    if pan not in (-1, 0, 1):
        raise BadValue("pan", pan, "-1 (left), 0 (both) or 1 (right)")
    return float(pan)

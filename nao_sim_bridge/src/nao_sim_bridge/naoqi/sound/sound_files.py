"""Sound files that clients name: found, checked and read."""

from __future__ import annotations

from pathlib import Path

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.samples import RATE, Sound
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.sound.files import SoundFileError
from nao_sim_bridge.sound.reader import SoundReader


class SoundFiles:
    """Reads sounds for clients."""

    def __init__(self, files: ClientFiles, reader: SoundReader) -> None:
        self.files = files
        self.reader = reader

    def read(self, name: str) -> Sound:
        """The sound in a file that a client names, at the rate of the simulated world.

        Raises:
            ValueError: The name leads out of the folder for recordings, or there is no such file.
            NaoqiError: The file holds no sound that can be played, or too much of it.
        """
        return self.read_path(self.files.to_read(name), name)

    def read_path(self, path: Path | str, name: str) -> Sound:
        """The sound in a file, at the rate of the simulated world.

        Args:
            name: What to call it in errors.

        Raises:
            NaoqiError: As above.
        """
        try:
            return self.reader.read(path, self.reader.sizes.sound.client_s).at_rate(RATE)
        except SoundFileError as error:
            raise NaoqiError(str(error).replace(f"sound file {path}:", repr(name))) from error

"""ALAudioPlayer of the simulated robot; `SoundSets` has its methods about sound sets."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.samples import Sound
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import limited, number
from nao_sim_bridge.naoqi.binding.background import Background, Wanted
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.sound.player import LoadedSound, Player
from nao_sim_bridge.naoqi.sound.sound_files import SoundFiles, SoundSets, side, sine
from nao_sim_bridge.naoqi.sound.web_stream import WebStreams
from nao_sim_bridge.sound.pitch import HIGHEST, LOWEST, shifted

# Folder of sound sets that clients bring along, inside the folder for recordings.
OWN_SETS = "soundsets"
TIMES = "NaoSimulation/SoundTimes"
"""A key that no robot has: [onset, end] of the sound that was played last, s: its first and its last sample."""


class ALAudioPlayer:
    """ALAudioPlayer as the simulated robot offers it. Playing takes simulated time: a call ends with its sound."""

    def __init__(
        self,
        runner: RobotRunner,
        sounds: SoundFiles,
        background: Background,
        memory: MemoryStore,
        allow_private_streams: bool,
    ) -> None:
        memory.insert(TIMES, [])
        self._runner = runner
        self._background = background
        self._sounds = sounds
        self._streams = WebStreams(sounds, allow_private_streams)
        # It may take so long that time does not wait for it.
        self._fetching = Background(threads=self._streams.sizes.at_once)
        folders = (sounds.files.folder / OWN_SETS, *sounds.files.shipped)
        self._sets = SoundSets(sounds, lambda name, size: self._player.check_room(name, size), *folders)
        self._player = Player(
            runner.simulation,
            lambda onset, end: memory.insert(TIMES, [onset, end]),
            lambda: sounds.reader.sizes.loaded_sounds,
            self._sets.kept,
        )

    def parts(self) -> list[Any]:
        return [self, self._sets]

    # --- files ----------------------------------------------------------------------------------------------------

    def loadFile(self, name: str) -> Task:
        load = lambda _: self._player.load(name, self._sounds.read(name)).number  # noqa: E731
        return self._background.in_turn(load, "loadFile")

    def unloadFile(self, sound_id: int) -> Task:
        loaded = self._player.find(sound_id)
        return self._do(lambda: self._player.unload(loaded), "unloadFile")

    def unloadAllFiles(self) -> Task:
        return self._do(self._player.unload_all, "unloadAllFiles")

    def getLoadedFilesIds(self) -> list[str]:
        return [str(loaded.number) for loaded in self._player.loaded()]

    def getLoadedFilesNames(self) -> list[str]:
        return [loaded.name for loaded in self._player.loaded()]

    def getFileLength(self, sound_id: int) -> float:
        return self._player.find(sound_id).sound.duration

    # --- playing --------------------------------------------------------------------------------------------------

    def play(self, sound_id: int, *volume_and_pan: float) -> Task:
        return self._play(self._player.find(sound_id), volume_and_pan, "play")

    def playInLoop(self, sound_id: int, *volume_and_pan: float) -> Task:
        return self._play(self._player.find(sound_id), volume_and_pan, "playInLoop", loop=True)

    def playFile(self, name: str, *volume_and_pan: float) -> Task:
        return self._play_file(name, volume_and_pan, "playFile")

    def playFileInLoop(self, name: str, *volume_and_pan: float) -> Task:
        return self._play_file(name, volume_and_pan, "playFileInLoop", loop=True)

    def playFileFromPosition(self, name: str, position: float, *volume_and_pan: float) -> Task:
        return self._play_file(name, volume_and_pan, "playFileFromPosition", position)

    def playSine(self, frequency: int, gain: int, pan: int, duration: float) -> Task:
        sound, pan = sine(frequency, gain, duration), side(pan)
        return self._play_once(f"{frequency} Hz", sound, (1.0, pan), "playSine")

    def playWebStream(self, address: str, volume: float, pan: float) -> Task:
        name, checked = "playWebStream", _volume_and_pan((volume, pan))

        def play(wanted: Wanted) -> Task:
            sound = self._streams.fetch(address, wanted)
            return self._do(lambda: self._begin_once(address, sound, checked, name) if wanted() else None, name)

        return self._fetching.in_turn(play, name)

    def pause(self, sound_id: int) -> Task:
        loaded = self._player.find(sound_id)
        return self._do(lambda: self._player.pause(loaded), "pause")

    def goTo(self, sound_id: int, position: float) -> Task:
        loaded = self._player.find(sound_id)
        place = _position(position, loaded.sound)
        return self._do(lambda: self._player.go_to(loaded, place), "goTo")

    def getCurrentPosition(self, sound_id: int) -> Task:
        loaded = self._player.find(sound_id)
        return self._do(lambda: self._player.position(loaded), "getCurrentPosition")

    def stopAll(self) -> Task:
        # At once, so that what is asked for right after this call is played.
        self._background.stop()
        self._fetching.stop()
        return self._do(self._player.stop_all, "stopAll")

    # --- volume, panorama, pitch ----------------------------------------------------------------------------------

    def setVolume(self, sound_id: int, volume: float) -> Task:
        loaded, checked = self._player.find(sound_id), limited(volume, "volume", 0.0, 1.0)
        return self._do(lambda: self._player.set_volume(loaded, checked), "setVolume")

    def getVolume(self, sound_id: int) -> float:
        return self._player.find(sound_id).volume

    def setMasterVolume(self, volume: float) -> Task:
        checked = limited(volume, "volume", 0.0, 1.0)
        return self._do(lambda: self._player.set_all(volume=checked), "setMasterVolume")

    def getMasterVolume(self) -> float:
        return self._player.volume

    def setPanorama(self, pan: float) -> Task:
        checked = number(pan, "pan", -1.0, 1.0)
        return self._do(lambda: self._player.set_all(panorama=checked), "setPanorama")

    def setPitch(self, sound_id: int, level: float) -> Task:
        return self._change_pitch(sound_id, number(level, "level", LOWEST, HIGHEST))

    def disablePitch(self, sound_id: int) -> Task:
        return self._change_pitch(sound_id, 1.0)

    def playSoundSetFile(self, *args: Any) -> Task:
        names = [argument for argument in args if isinstance(argument, str)]
        file, of_set = names[-1], names[0] if len(names) == 2 else None
        sound = self._sets.sound(file, of_set)
        position, volume, pan, loop = args[len(names) :] or (0.0, 1.0, 0.0, False)
        return self._play_once(file, sound, (volume, pan), "playSoundSetFile", position, loop)

    def _do(self, action: Callable[[], Any], name: str) -> Task:
        return self._runner.execute(action, name)

    def _change_pitch(self, sound_id: int, factor: float) -> Task:
        loaded = self._player.find(sound_id)
        if factor != 1.0 and loaded.altered is None:
            self._player.check_room(loaded.name, loaded.sound.samples.nbytes)

        def change(_: Wanted) -> Task:
            sound = loaded.sound
            altered = None if factor == 1.0 else Sound(shifted(sound.samples, factor, sound.rate), sound.rate)
            return self._do(lambda: self._player.exchange(loaded, altered), "setPitch")

        return self._background.in_turn(change, "setPitch")

    def _play(self, loaded: LoadedSound, volume_and_pan: Any, name: str, loop: bool = False) -> Task:
        checked = _volume_and_pan(volume_and_pan) if volume_and_pan else None

        def start() -> Task:
            if checked is not None:
                self._player.set_volume(loaded, *checked)
            return self._player.play(loaded, name, loop)

        return self._do(start, name)

    def _play_file(self, file: str, volume_and_pan: Any, name: str, position: float = 0.0, loop: bool = False) -> Task:
        checked = _volume_and_pan(volume_and_pan)

        def play(wanted: Wanted) -> Task:
            sound = self._sounds.read(file)
            begin = lambda: self._begin_once(file, sound, checked, name, _position(position, sound), loop)  # noqa: E731
            return self._do(lambda: begin() if wanted() else None, name)

        return self._background.in_turn(play, name)

    def _play_once(
        self, label: str, sound: Sound, volume_and_pan: Any, name: str, position: float = 0.0, loop: bool = False
    ) -> Task:
        checked, place = _volume_and_pan(volume_and_pan), _position(position, sound)
        return self._do(lambda: self._begin_once(label, sound, checked, name, place, loop), name)

    def _begin_once(
        self, label: str, sound: Sound, volume_and_pan: Any, name: str, position: float = 0.0, loop: bool = False
    ) -> Task:
        """Play a sound that is forgotten afterwards. Simulation thread only."""
        loaded = self._player.load(label, sound, temporary=True)
        loaded.volume, loaded.pan = volume_and_pan
        loaded.begins = position
        return self._player.play(loaded, name, loop)


def _volume_and_pan(values: Any) -> tuple[float, float]:
    volume, pan = values or (1.0, 0.0)
    return limited(volume, "volume", 0.0, 1.0), number(pan, "pan", -1.0, 1.0)


def _position(position: float, sound: Sound) -> float:
    if not 0.0 <= number(position, "position") <= sound.duration:
        raise BadValue("position", position, f"0 to {sound.duration:g}, the length of the sound in s")
    return float(position)

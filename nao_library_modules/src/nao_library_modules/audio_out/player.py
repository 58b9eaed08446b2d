"""Functions that play sounds: files, tones, streams, sound sets."""

from __future__ import annotations

from typing import Any

from ..audio.fields import Revert
from ..audio.sound_card import decimal, put_back
from ..base.errors import BadGoal, Preempted
from ..base.field_checks import require_known
from ..base.suggestion import did_you_mean
from ..functions.chain import checked_by
from ..functions.parts import Part
from ..nao.robot_files import without_sign
from ..server.nao_basic import NaoBasic
from .fields import (
    Address,
    Background,
    EndTime,
    Frequency,
    FullVolume,
    LoadedFile,
    Loop,
    LoopTime,
    MasterVolume,
    OptionalSet,
    Pan,
    Panorama,
    PitchLevel,
    Position,
    SetFile,
    SetFileTime,
    SetVolume,
    SoundFile,
    SoundId,
    SoundSet,
    SoundVolume,
    StartPosition,
    ToneLength,
    TonePan,
    VolumeFile,
    VolumeId,
)
from .sounds import PLAYER, SPEECH, LoadedSounds, Sounds


class PlayerFunctions(Part):
    """Functions of ALAudioPlayer. Parameters are fields of AudioOutFunction.

    `loaded`: sounds that this server has loaded.
    """

    left_by_goals = frozenset({"loaded"})

    def __init__(self, module: NaoBasic, sounds: Sounds) -> None:
        self._module = module
        self._sounds = sounds
        self.loaded = LoadedSounds(module.robot)

    # Files

    def _check_background(self, duration: float, background: bool) -> None:
        if background and duration > 0.0:
            # Somebody has to wait for its end, to end it.
            raise BadGoal("duration", duration, "0 for a sound in the background; stopAll ends it")

    @checked_by(_check_background)
    def play_file(
        self, str_param: SoundFile, volume: SoundVolume, pan: Pan, duration: EndTime, background: Background
    ) -> None:
        """Play a file, and wait until it is over."""
        name = str_param.strip()
        self._play(name, "playFile", without_sign(name), *_level(volume, pan), duration=duration, background=background)

    @checked_by(_check_background)
    def play_file_in_loop(
        self, str_param: SoundFile, volume: SoundVolume, pan: Pan, duration: LoopTime, background: Background
    ) -> None:
        """Play a file again and again, for `duration` or, with 0, until it is stopped."""
        name, endless = str_param.strip(), background or duration == 0.0
        self._play(
            name, "playFileInLoop", without_sign(name), *_level(volume, pan), duration=duration, background=endless
        )

    @checked_by(_check_background)
    def play_file_from_position(
        self,
        str_param: SoundFile,
        position: StartPosition,
        volume: SoundVolume,
        pan: Pan,
        duration: EndTime,
        background: Background,
    ) -> None:
        """Play a file from a time on, and wait until it is over."""
        name, level = str_param.strip(), _level(volume, pan)
        self._play(
            name, "playFileFromPosition", without_sign(name), position, *level, duration=duration, background=background
        )

    @checked_by(_check_background)
    def play_web_stream(
        self, str_param: Address, volume: FullVolume, pan: Pan, duration: EndTime, background: Background
    ) -> None:
        """Play a stream of the network, and wait until it is over."""
        address = str_param.strip()
        level = (volume or 1.0, pan)
        self._play(address, "playWebStream", address, *level, duration=duration, background=background)

    def play_sine(
        self, frequency: Frequency, volume: FullVolume, pan: TonePan, duration: ToneLength, background: Background
    ) -> None:
        """Play a tone, and wait until it is over."""
        gain = round(100.0 * (volume or 1.0))
        self._sounds.sound(PLAYER, "playSine", int(frequency), gain, int(pan), duration, background=background)

    # Sounds that are loaded

    def _check_load(self, str_param: str, context: dict[str, Any]) -> None:
        """Later functions of the chain may use the file by its name."""
        self._loaded_by_then(context).append(str_param.strip())

    @checked_by(_check_load)
    def load_file(self, str_param: SoundFile) -> int:
        """Load a file, so that it begins to play at once; answers the id of the sound."""
        name = str_param.strip()
        number = int(self.call("loadFile", without_sign(name)))
        self.loaded.add(name, number)
        return number

    def _check_loaded(self, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
        """A sound that is loaded, or that the chain has loaded by then."""
        if sound_id > 0:
            return  # others may have loaded it: the robot knows
        name, known = str_param.strip(), self._loaded_by_then(context)
        if name and name not in known:
            allowed = f"one of {', '.join(dict.fromkeys(known))}" if known else "loadFile comes first"
            raise BadGoal("str_param", str_param, allowed, problem=f"{name!r} is not loaded{did_you_mean(name, known)}")
        if not known:
            raise BadGoal("sound_id", sound_id, "loadFile comes first", problem="no sound is loaded")

    def _check_play(
        self, sound_id: int, str_param: str, duration: float, background: bool, context: dict[str, Any]
    ) -> None:
        self._check_loaded(sound_id, str_param, context)
        self._check_background(duration, background)

    @checked_by(_check_play)
    def play(
        self,
        sound_id: SoundId,
        str_param: LoadedFile,
        volume: SoundVolume,
        pan: Pan,
        duration: EndTime,
        background: Background,
    ) -> None:
        """Play a sound that is loaded, from where it was paused; and wait until it is over."""
        number = self._number(sound_id, str_param)
        name, level = self.loaded.name(number), _level(volume, pan)
        self._play(name, "play", number, *level, duration=duration, background=background)

    @checked_by(_check_play)
    def play_in_loop(
        self,
        sound_id: SoundId,
        str_param: LoadedFile,
        volume: SoundVolume,
        pan: Pan,
        duration: LoopTime,
        background: Background,
    ) -> None:
        """Play a sound that is loaded again and again, for `duration` or, with 0, until it is stopped."""
        number = self._number(sound_id, str_param)
        name, level, endless = self.loaded.name(number), _level(volume, pan), background or duration == 0.0
        self._play(name, "playInLoop", number, *level, duration=duration, background=endless)

    @checked_by(_check_loaded)
    def pause(self, sound_id: SoundId, str_param: LoadedFile) -> None:
        """Pause a sound; `play` goes on with it."""
        self.call("pause", self._number(sound_id, str_param))

    @checked_by(_check_loaded)
    def go_to(self, sound_id: SoundId, str_param: LoadedFile, position: Position) -> None:
        """Go to a time of a sound."""
        self.call("goTo", self._number(sound_id, str_param), position)

    @checked_by(_check_loaded)
    def get_current_position(self, sound_id: SoundId, str_param: LoadedFile) -> float:
        """Where a sound is, s from its beginning."""
        return decimal(self.call("getCurrentPosition", self._number(sound_id, str_param)))

    @checked_by(_check_loaded)
    def get_file_length(self, sound_id: SoundId, str_param: LoadedFile) -> float:
        """Length of a sound, s."""
        return decimal(self.call("getFileLength", self._number(sound_id, str_param)))

    @checked_by(_check_loaded)
    def set_pitch(self, sound_id: SoundId, str_param: LoadedFile, pitch: PitchLevel) -> None:
        """Change the pitch of a sound."""
        self.call("setPitch", self._number(sound_id, str_param), pitch)

    @checked_by(_check_loaded)
    def disable_pitch(self, sound_id: SoundId, str_param: LoadedFile) -> None:
        """Play a sound at its own pitch again."""
        self.call("disablePitch", self._number(sound_id, str_param))

    def _check_unload(self, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
        self._check_loaded(sound_id, str_param, context)
        known, name = self._loaded_by_then(context), str_param.strip()
        if sound_id == 0:
            known.remove(name or known[-1])

    @checked_by(_check_unload)
    def unload_file(self, sound_id: SoundId, str_param: LoadedFile) -> None:
        """Forget a sound that is loaded."""
        number = self._number(sound_id, str_param)
        self.call("unloadFile", number)
        self.loaded.remove(self.loaded.name(number))

    def _check_unload_all(self, context: dict[str, Any]) -> None:
        """Later functions of the chain have no sound any more."""
        self._loaded_by_then(context).clear()

    @checked_by(_check_unload_all)
    def unload_all_files(self) -> None:
        """Forget all sounds that are loaded."""
        self.call("unloadAllFiles")
        self.loaded.clear()

    def get_loaded_files_ids(self) -> list[Any]:
        """Ids of all sounds that are loaded."""
        return list(self.call("getLoadedFilesIds"))

    def get_loaded_files_names(self) -> list[str]:
        """Names of all files that are loaded."""
        return list(self.call("getLoadedFilesNames"))

    # Volume and direction

    def _check_volume_of(self, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
        if sound_id or str_param.strip():
            self._check_loaded(sound_id, str_param, context)

    @checked_by(_check_volume_of)
    def set_volume(self, sound_id: VolumeId, str_param: VolumeFile, volume: SetVolume, revert: Revert) -> None:
        """Set the volume of speech, or of a sound that is loaded, 0..1."""
        module, subject = self._volume_of(sound_id, str_param)
        if revert:
            before = decimal(self._module.call(self._module.robot.proxy(module), "getVolume", *subject))
            put_back(self._module, module, "setVolume", *subject, before)
        self._module.call(self._module.robot.proxy(module), "setVolume", *subject, volume)

    @checked_by(_check_volume_of)
    def get_volume(self, sound_id: VolumeId, str_param: VolumeFile) -> float:
        """Volume of speech, or of a sound that is loaded, 0..1."""
        module, subject = self._volume_of(sound_id, str_param)
        return decimal(self._module.call(self._module.robot.proxy(module), "getVolume", *subject))

    def set_master_volume(self, volume: MasterVolume, revert: Revert) -> None:
        """Set the volume of all sounds that are played, 0..1."""
        if revert:
            put_back(self._module, PLAYER, "setMasterVolume", decimal(self.call("getMasterVolume")))
        self.call("setMasterVolume", volume)

    def get_master_volume(self) -> float:
        """Volume of all sounds that are played, 0..1."""
        return decimal(self.call("getMasterVolume"))

    def set_panorama(self, pan: Panorama) -> None:
        """Have all sounds come from a direction, -1 (left) to 1 (right)."""
        self.call("setPanorama", pan)

    # Sound sets

    def _check_set(self, str_param: str) -> None:
        require_known("str_param", str_param, self.get_installed_sound_sets_list(), "sound set of the robot")

    def _check_set_file(self, str_param: str, duration: float, background: bool) -> None:
        if str_param.strip():
            self._check_set(str_param)
        self._check_background(duration, background)

    @checked_by(_check_set_file)
    def play_sound_set_file(
        self,
        str_param: OptionalSet,
        file_name: SetFile,
        position: StartPosition,
        volume: SoundVolume,
        pan: Pan,
        loop: Loop,
        duration: SetFileTime,
        background: Background,
    ) -> None:
        """Play a file of a sound set, or of any that is loaded; and wait until it is over."""
        names = [name for name in (str_param.strip(), file_name.strip()) if name]
        level: list[Any] = [position, volume or 1.0, pan, loop] if position or volume or pan or loop else []
        quiet = background or (loop and duration == 0.0)
        self._play("/".join(names), "playSoundSetFile", *names, *level, duration=duration, background=quiet)

    @checked_by(_check_set)
    def load_sound_set(self, str_param: SoundSet) -> None:
        """Load a sound set."""
        self.call("loadSoundSet", str_param.strip())

    @checked_by(_check_set)
    def unload_sound_set(self, str_param: SoundSet) -> None:
        """Forget a sound set that is loaded."""
        self.call("unloadSoundSet", str_param.strip())

    def is_sound_set_installed(self, str_param: SoundSet) -> bool:
        """Whether the robot has a sound set."""
        return bool(self.call("isSoundSetInstalled", str_param.strip()))

    def is_sound_set_loaded(self, str_param: SoundSet) -> bool:
        """Whether a sound set is loaded."""
        return bool(self.call("isSoundSetLoaded", str_param.strip()))

    def is_sound_set_file_installed(self, str_param: SoundSet, file_name: SetFile) -> bool:
        """Whether a sound set has a file."""
        return bool(self.call("isSoundSetFileInstalled", str_param.strip(), file_name.strip()))

    @checked_by(_check_set)
    def get_sound_set_file_names(self, str_param: SoundSet) -> list[str]:
        """Files of a sound set."""
        return list(self.call("getSoundSetFileNames", str_param.strip()))

    def get_installed_sound_sets_list(self) -> list[str]:
        """Sound sets that the robot has."""
        return list(self.call("getInstalledSoundSetsList"))

    def get_loaded_sound_sets_list(self) -> list[str]:
        """Sound sets that are loaded."""
        return list(self.call("getLoadedSoundSetsList"))

    # Inside

    def call(self, method: str, *args: Any) -> Any:
        """Call ALAudioPlayer; preemption ends the call."""
        return self._module.call(self._module.robot.proxy(PLAYER), method, *args)

    def _loaded_by_then(self, context: dict[str, Any]) -> list[str]:
        """Names of the sounds that are loaded when the chain comes to a function, the last one last."""
        return context.setdefault("loaded", self.loaded.names)

    def _play(self, name: str, method: str, *args: Any, duration: float, background: bool) -> None:
        """Play something, and note how long it was to be heard, unless it could not be played."""
        began = self._module.clock.now()
        try:
            sounded = self._sounds.sound(PLAYER, method, *args, duration=duration, background=background)
        except Preempted:
            self._sounds.note_file(name, self._module.clock.now() - began)
            raise
        self._sounds.note_file(name, sounded)

    def _number(self, sound_id: int, name: str) -> int:
        """Id of a sound: given, of a file that is loaded, or of the one loaded last."""
        return sound_id or self.loaded.number(name.strip())

    def _volume_of(self, sound_id: int, name: str) -> tuple[str, list[int]]:
        """Module that knows a volume, and what it is of: a sound, or speech where none is named."""
        return (PLAYER, [self._number(sound_id, name)]) if sound_id or name.strip() else (SPEECH, [])

    functions = {
        "playFile": play_file,
        "playFileInLoop": play_file_in_loop,
        "playFileFromPosition": play_file_from_position,
        "playSine": play_sine,
        "playWebStream": play_web_stream,
        "loadFile": load_file,
        "play": play,
        "playInLoop": play_in_loop,
        "pause": pause,
        "goTo": go_to,
        "getCurrentPosition": get_current_position,
        "getFileLength": get_file_length,
        "setPitch": set_pitch,
        "disablePitch": disable_pitch,
        "unloadFile": unload_file,
        "unloadAllFiles": unload_all_files,
        "getLoadedFilesIds": get_loaded_files_ids,
        "getLoadedFilesNames": get_loaded_files_names,
        "setVolume": set_volume,
        "getVolume": get_volume,
        "setMasterVolume": set_master_volume,
        "getMasterVolume": get_master_volume,
        "setPanorama": set_panorama,
        "playSoundSetFile": play_sound_set_file,
        "loadSoundSet": load_sound_set,
        "unloadSoundSet": unload_sound_set,
        "isSoundSetInstalled": is_sound_set_installed,
        "isSoundSetLoaded": is_sound_set_loaded,
        "isSoundSetFileInstalled": is_sound_set_file_installed,
        "getSoundSetFileNames": get_sound_set_file_names,
        "getInstalledSoundSetsList": get_installed_sound_sets_list,
        "getLoadedSoundSetsList": get_loaded_sound_sets_list,
    }


def _level(volume: float, pan: float) -> list[float]:
    """Volume and direction as arguments; none where the message leaves both to the robot."""
    return [volume or 1.0, pan] if volume or pan else []

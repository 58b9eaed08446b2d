"""Functions that play sounds (files, tones, streams, sound sets), and the account of what sounds now."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import CallCanceled, NaoError

from ..core.chain import Part, checked_by
from ..core.errors import BadGoal, Preempted, did_you_mean
from ..core.fields import require_known
from ..core.nao_facts import without_sign
from ..core.robot import QUICK_ANSWER, end_call, wait_for_call
from ..core.robot_events import SimulatedKey
from ..core.waiting import CancellationToken, OncePerConnection
from ..nao_audio import Revert, decimal, put_back
from ..nao_basic import NaoBasic
from .audio_out_fields import (
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

log = logging.getLogger(__name__)

PLAYER, SPEECH, ANIMATED = "ALAudioPlayer", "ALTextToSpeech", "ALAnimatedSpeech"
TIMES = "NaoSimulation/SoundTimes"
"""A key of simulated robots: [onset, end] of the sound that ALAudioPlayer played last, s of the robot."""
# Modules that have no `stopAll`, and the one whose it is.
SILENCED_BY = {ANIMATED: SPEECH}
FALSE_START = 0.05
"""s that a sound in the background has to fail, when it cannot begin: then the function fails."""


@dataclass(frozen=True)
class Sounding:
    """Something that sounds in the background."""

    module: str  # of NAOqi
    call: Any  # ends with the sound


class Sounds(Part):
    """Sounds of a module, each a call that ends with it, and account of the files that the chain played or wrote.

    The thread that executes goals begins sounds; the end of the node silences them from another. `file_names`: files
    that the chain played or wrote, in order. `durations`: how long each was to be heard, or of a file that was written,
    how long it is, s.
    """

    def __init__(self, module: NaoBasic) -> None:
        self._module = module
        self._player_times = SimulatedKey(module.robot, TIMES)
        self._lock = threading.Lock()  # guards the two lists
        self._begun: list[Sounding] = []  # in the background, by this chain
        self._left: list[Sounding] = []  # by chains that succeeded
        self.file_names: list[str] = []
        self.durations: list[float] = []

    def note_file(self, name: str, duration: float) -> None:
        """Note a file that was played or written."""
        self.file_names.append(name)
        self.durations.append(max(0.0, duration))

    def sound(
        self,
        module: str,
        method: str,
        *args: Any,
        duration: float = 0.0,
        background: bool = False,
        ended: Callable[[], None] = lambda: None,
    ) -> float:
        """Begin a sound, and wait until it is over; preemption silences it.

        Returns how long it sounded, s; 0 in the background. Raises NaoError if the call fails; Preempted, or whatever
        reason the interrupt has.

        Args:
            module: NAOqi module.
            method: Its method that takes as long as the sound.
            duration: s after which the sound is ended, if it is still there; 0: never.
            background: Whether it is not waited for.
            ended: Called when a sound in the background is over, from a thread of libqi.
        """
        self._module.interrupt.check()
        call = self._module.robot.proxy(module).call_async(method, *args)
        sounding = Sounding(module, call)
        if background:
            call.add_done_callback(lambda _: ended())
            self._leave(sounding)
            return 0.0
        began = self._module.clock.now()
        if not call.wait(QUICK_ANSWER):  # quicker than to set up the wait for both
            self._wait(call, began, duration)
        if not call.done():
            self._end(sounding)
            self._module.interrupt.check()
        else:
            call.result(timeout=0)
        ended = max(began, self._module.clock.now())
        if module == PLAYER:
            began, ended = self._module.happened = self._played(began, ended)
        return ended - began

    def wait_for_background(self) -> None:
        """Wait until nothing sounds that goals of this server have left in the background.

        Raises NaoError of a sound that failed; Preempted, or whatever reason the interrupt has.
        """
        with self._lock:
            background = [*self._left, *self._begun]
        for sounding in background:
            if not wait_for_call(sounding.call, self._module.interrupt):
                self._module.interrupt.check()
            sounding.call.result(timeout=0)

    def begin_chain(self) -> None:
        """Forget the files of the last chain; what it left in the background sounds on."""
        self.file_names, self.durations = [], []
        with self._lock:
            self._left = [sounding for sounding in self._left + self._begun if not sounding.call.done()]
            self._begun = []

    def silence_chain(self) -> None:
        """Silence what the chain has left in the background."""
        with self._lock:
            begun, self._begun = self._begun, []
        self._silence(begun)

    def silence(self) -> None:
        """Silence everything that goals of this server have left in the background; raises nothing."""
        with self._lock:
            sounding, self._left, self._begun = self._left + self._begun, [], []
        self._silence(sounding)

    # Inside

    def _played(self, began: float, ended: float) -> tuple[float, float]:
        """When a sound was played, ROS times, s: no robot reports that, so its call counts, with what loading takes."""
        onset = offset = 0.0
        if self._player_times.known(self._module.call):
            onset, offset = self._player_times.span(self._module.call, self._module.robot_clock, began)
        return onset or began, offset or ended

    def _leave(self, sounding: Sounding) -> None:
        """Let a sound go on; a file that is not there fails at once."""
        with self._lock:
            self._begun.append(sounding)
        if sounding.call.wait(FALSE_START):
            sounding.call.result(timeout=0)
        else:
            sounding.call.add_done_callback(_log_failure)

    def _wait(self, call: Any, began: float, duration: float) -> None:
        if duration <= 0.0:
            wait_for_call(call, self._module.interrupt)
            return
        news = CancellationToken()
        call.add_done_callback(lambda _: news.trigger())
        with self._module.interrupt.waking(news.trigger):
            left = began + duration - self._module.clock.now()
            self._module.clock.wait(min(duration, max(0.0, left)), news)  # not longer where the clock was set back

    def _silence(self, soundings: list[Sounding]) -> None:
        for sounding in soundings:
            if not sounding.call.done():
                self._end(sounding)

    def _end(self, sounding: Sounding) -> None:
        """Cancel the call and see it end; on a robot whose calls go on, everything of the module is silenced."""
        module = SILENCED_BY.get(sounding.module, sounding.module)
        end_call(sounding.call, lambda: self._module.call_now(self._module.robot.proxy(module), "stopAll"))


class LoadedSounds:
    """Ids of sounds that this server has loaded, by the names of their files; forgotten with the connection.

    A new connection may lead to a robot that has loaded nothing.
    """

    def __init__(self, robot: Any) -> None:
        self._ids: OncePerConnection[dict[str, int]] = OncePerConnection(robot, dict)

    @property
    def names(self) -> list[str]:
        """Names of the loaded files, the last one loaded last."""
        return list(self._ids())

    def add(self, name: str, number: int) -> None:
        """Add a file; of a name that was loaded before, the new id counts."""
        self.remove(name)
        self._ids()[name] = number

    def remove(self, name: str) -> None:
        self._ids().pop(name, None)

    def clear(self) -> None:
        self._ids().clear()

    def number(self, name: str) -> int:
        """Id of a loaded file; of the one loaded last without a name.

        Raises BadGoal if there is none: the chain was checked, but the robot may have been exchanged since.
        """
        names = self.names
        if not names or (name and name not in names):
            problem = f"{name!r} is not loaded any more" if name else "no sound is loaded any more"
            raise BadGoal("str_param", name, "loadFile comes first", problem=problem)
        return self._ids()[name or names[-1]]

    def name(self, number: int) -> str:
        """Name of the loaded file of an id; the id as text if others have loaded it."""
        return next((name for name, each in self._ids().items() if each == number), str(number))


def _log_failure(call: Any) -> None:
    """Say in the log that a sound in the background failed; runs in a thread of libqi."""
    try:
        call.result(timeout=0)
    except CallCanceled:
        pass
    except NaoError as error:
        log.warning("a sound in the background failed: %s", error)


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

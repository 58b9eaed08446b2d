"""Hearing functions for sounds: recording the microphones, measuring how loud it is, detecting and locating sounds."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Any

import soundfile
from genpy import Time
from geometry_msgs.msg import Point
from std_msgs.msg import Header

from nao_library_msgs.msg import HeardSound, RecordedFile
from naoqi.errors import NaoError, RobotError

from ..core.chain import Part, checked_by
from ..core.errors import BadGoal
from ..core.geometry import FOOTPRINT
from ..core.nao_facts import HOME, full_path, is_in
from ..core.robot_events import Event, same_clock
from ..nao_audio import DEVICE, NaoAudio
from ..nao_basic import NaoBasic
from .audio_in_fields import (
    MICROPHONES,
    SENSES,
    BetterTime,
    Channels,
    Confidence,
    FileType,
    HeardFile,
    Length,
    MeanTime,
    Overwrite,
    RecordingFile,
    RecordingRate,
    Sense,
    Sensitivity,
    Timeout,
    recording_file,
    recording_format,
    timeout_of,
)
from .hearing import Hearing, LeftGoing, LocatedSound, Recording, begun_sounds, located_sound, tells_later

log = logging.getLogger(__name__)

RECORDER = "ALAudioRecorder"
RECORDING = "recording"
"""Status in the feedback."""


def _further(path: PurePosixPath) -> PurePosixPath:
    """Name of the file that a recording goes on in."""
    return path.with_name(f"{path.stem}-2{path.suffix}")


def _arguments(recording: Recording) -> list[Any]:
    """Arguments of `ALAudioRecorder.startMicrophonesRecording`."""
    flags = [int(microphone in recording.channels) for microphone in MICROPHONES]
    return [full_path(recording.path), recording.file_type, recording.rate, flags]


def length_of(file: Path) -> float | None:
    """Length of a sound file, s: its frames by its rate; None if it cannot be read."""
    try:
        info = soundfile.info(str(file))
    except (OSError, RuntimeError):  # the second is what libsndfile's errors are
        return None
    return info.frames / info.samplerate


class SoundRecordingFunctions(Part):
    def __init__(self, module: NaoAudio, hearing: Hearing, left: LeftGoing, robot_home: Path | None) -> None:
        self._module = module
        self._hearing = hearing
        self._left = left
        self._robot_home = robot_home  # a folder of this computer; None: it is on the robot alone

    @property
    def running(self) -> list[str]:
        """Paths of the recordings that run: one, or none."""
        recording = self._left.recording
        return [] if recording is None else [recording.path]

    def _check_recording_begin(
        self,
        str_param: str,
        rate: int,
        channels: Sequence[str],
        file_type: str,
        overwrite: bool,
        context: dict[str, Any],
        goes_on: bool = True,
    ) -> None:
        """A file that is new or may be replaced, of its type, a format, and no recording that runs.

        `goes_on`: whether it still runs when the function is over.
        """
        path, _ = recording_file(str_param, file_type)
        self.require_new_file(path, overwrite)
        recording_format(rate, channels)
        if context.get("recording", self._left.recording):
            problem = "a recording of this server runs already"
            raise BadGoal("function", "startRecording", "stopRecording comes first", problem=problem)
        context["recording"] = goes_on

    @checked_by(partial(_check_recording_begin, goes_on=False))
    def record(
        self,
        str_param: RecordingFile,
        rate: RecordingRate,
        channels: Channels,
        file_type: FileType,
        duration: Length,
        overwrite: Overwrite,
    ) -> list[Any]:
        """Record for `duration`, and wait for the end; answers file and length (s). Interrupted, the file is valid."""
        self._begin_recording(str_param, rate, channels, file_type, overwrite)
        with self._hearing.ended_by(self._end_recording, "the recording may go on"):
            self._module.wait(duration)
        file = self._hearing.heard.files[-1]
        return [file.path, file.duration]

    @checked_by(_check_recording_begin)
    def start_recording(
        self,
        str_param: RecordingFile,
        rate: RecordingRate,
        channels: Channels,
        file_type: FileType,
        overwrite: Overwrite,
    ) -> None:
        """Begin to record, also beyond the end of the goal: until stopRecording or the end of the server."""
        self._begin_recording(str_param, rate, channels, file_type, overwrite)
        self._left.keep()

    @checked_by(tells_later(recording=False))
    def stop_recording(self) -> list[Any]:
        """End a recording; answers file and length (s) if it is one of this server."""
        if self._left.recording is None:
            self._module.call(self._module.robot.proxy(RECORDER), "stopMicrophonesRecording")  # another program's
            return []
        self._end_recording()
        self._left.keep()
        file = self._hearing.heard.files[-1]
        return [file.path, file.duration]

    def set_file_as_input(self, str_param: HeardFile) -> None:
        """Have the robot hear a file instead of its microphones."""
        self._module.device("setFileAsInput", full_path(str_param.strip()))

    def drop(self) -> None:
        """End the recording that runs, if one does; raises nothing."""
        if self._left.recording is None:
            return
        try:
            self._end_recording()
        except NaoError as error:
            log.warning("the recording may go on: %s", error)

    def renew(self, former: Recording) -> None:
        """Go on with a recording of this node before it died, in a further file.

        Raises NaoError if the robot refuses it.
        """
        path = _further(PurePosixPath(former.path))
        while (file := self._file_here(str(path))) is not None and file.exists():
            path = _further(path)
        recorder = self._module.robot.proxy(RECORDER)
        with suppress(RobotError):  # it has been stopped already
            self._module.call_now(recorder, "stopMicrophonesRecording")
        further = replace(former, path=str(path), began=self._module.clock.now())
        self._module.call_now(recorder, "startMicrophonesRecording", *_arguments(further))
        self._left.recording = further
        log.info("the recording %s goes on in %s", former.path, path)

    def require_new_file(self, path: str, overwrite: bool, field: str = "str_param") -> None:
        """Check that a file of the robot is not replaced unasked, as far as this computer can tell.

        Raises BadGoal if there is such a file.
        """
        file = self._file_here(path)
        if file is not None and file.exists() and not overwrite:
            raise BadGoal(field, path, "another name, or overwrite", problem=f"{file} is there already")

    def _file_here(self, path: str) -> Path | None:
        """A file of the robot as this computer has it; None where it has none of them, or not those of that folder."""
        if self._robot_home is None or not is_in(path, [HOME]):
            return None
        return self._robot_home / PurePosixPath(full_path(path)).relative_to(HOME)

    def _begin_recording(self, name: str, rate: int, channels: Sequence[str], file_type: str, overwrite: bool) -> None:
        path, kind = recording_file(name, file_type)
        self.require_new_file(path, overwrite)
        rate, channels = recording_format(rate, channels)
        recording = Recording(path, kind, rate, channels, self._module.clock.now())
        self._hearing.begin(RECORDER, "startMicrophonesRecording", _arguments(recording), "stopMicrophonesRecording")
        self._left.recording = replace(recording, began=self._module.clock.now())
        self._module.happened = (self._left.recording.began, 0.0)
        self._hearing.publish(RECORDING)

    def _end_recording(self) -> None:
        recording, self._left.recording = self._left.recording, None
        if recording is None:
            return
        end = self._module.clock.now()
        by_clock = max(0.0, end - recording.began)
        self._module.happened = (recording.began, end)
        # It is answered when the file is complete.
        self._module.call_now(self._module.robot.proxy(RECORDER), "stopMicrophonesRecording")
        file = self._file_here(recording.path)
        length = length_of(file) if file is not None else None
        self._hearing.heard.files.append(
            RecordedFile(
                path=recording.path,
                duration=by_clock if length is None else length,
                rate=recording.rate,
                channels=list(recording.channels),
                file_type=recording.file_type,
                file="" if length is None else str(file),
            )
        )

    functions = {
        "record": record,
        "startRecording": start_recording,
        "startMicrophonesRecording": start_recording,
        "stopRecording": stop_recording,
        "stopMicrophonesRecording": stop_recording,
        "setFileAsInput": set_file_as_input,
    }


BLOCK = 0.17
"""s of sound behind each energy, which is also how often it changes."""
NEXT_VALUE, FIRST_VALUE = 3, 6
"""So many blocks it takes at most until energies change that are computed, and until the first one is there."""


class EnergyFunctions(Part):
    """Energies of the microphones, 0..32768. Parameters are fields of AudioInFunction.

    The robot computes them on demand only; what a function switches on for itself, it switches off again.
    """

    def __init__(self, module: NaoAudio, hearing: Hearing, left: LeftGoing) -> None:
        self._module = module
        self._hearing = hearing
        self._left = left

    def get_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is: left, right, front, rear."""
        return self._energies(MICROPHONES, duration)

    def get_left_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is on the left."""
        return self._energies(["left"], duration)

    def get_right_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is on the right."""
        return self._energies(["right"], duration)

    def get_front_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is in front."""
        return self._energies(["front"], duration)

    def get_rear_mic_energy(self, duration: MeanTime) -> list[float]:
        """How loud it is at the rear."""
        return self._energies(["rear"], duration)

    def enable_energy_computation(self) -> None:
        """Have energies computed all the time, also beyond the end of the goal: they are there without a wait."""
        self._hearing.begin(DEVICE, "enableEnergyComputation", [], "disableEnergyComputation")
        self._left.computing = True
        self._left.keep()

    def disable_energy_computation(self) -> None:
        """Have energies computed no longer."""
        self._left.computing = False
        self._left.keep()
        self._module.device("disableEnergyComputation")

    def renew(self) -> None:
        """Have energies computed again. Raises NaoError if the robot does not answer."""
        self._call_now("enableEnergyComputation")
        self._left.computing = True

    def drop(self) -> None:
        """Switch off what a goal has left on; raises nothing."""
        if not self._left.computing:
            return
        self._left.computing = False
        try:
            self._call_now("disableEnergyComputation")
        except NaoError as error:
            log.warning("energies may be computed for nobody: %s", error)

    def _energies(self, microphones: Sequence[str], duration: float) -> list[float]:
        with self._computed():
            end = self._module.clock.now() + duration
            rows = [self._read(microphones)]
            while self._module.clock.now() + BLOCK <= end:
                self._module.wait(BLOCK)
                rows.append(self._read(microphones))
        means = [sum(values) / len(rows) for values in zip(*rows)]
        self._hearing.heard.microphones += microphones
        self._hearing.heard.energies += means
        return means

    @contextmanager
    def _computed(self) -> Iterator[None]:
        """Energies are computed in a block, the first one is there.

        The robot does not report whether another program has them computed; but noise is never the same twice.
        """
        before = [] if self._left.computing else self._read(MICROPHONES)
        if self._left.computing or self._changes(before, NEXT_VALUE):
            yield
            return
        self._hearing.begin(DEVICE, "enableEnergyComputation", [], "disableEnergyComputation")
        with self._hearing.ended_by(lambda: self._call_now("disableEnergyComputation"), "energies may go on"):
            self._changes(before, FIRST_VALUE)  # where there is no sound at all they never change
            yield

    def _changes(self, before: Sequence[float], blocks: int) -> bool:
        """Wait until energies are others than before, so many blocks at most; returns whether they are."""
        for _ in range(blocks):
            self._module.wait(BLOCK)
            if self._read(MICROPHONES) != before:
                return True
        return False

    def _read(self, microphones: Sequence[str]) -> list[float]:
        return [float(self._module.device(f"get{name.capitalize()}MicEnergy")) for name in microphones]

    def _call_now(self, method: str) -> None:
        self._module.call_now(self._module.robot.proxy(DEVICE), method)

    functions = {
        "getEnergy": get_energy,
        "getLeftMicEnergy": get_left_mic_energy,
        "getRightMicEnergy": get_right_mic_energy,
        "getFrontMicEnergy": get_front_mic_energy,
        "getRearMicEnergy": get_rear_mic_energy,
        "enableEnergyComputation": enable_energy_computation,
        "disableEnergyComputation": disable_energy_computation,
    }


DETECTED, LOCATED = "SoundDetected", "ALSoundLocalization/SoundLocated"
HEAD = "Head"
"""Frame of the robot, as its description names it."""


class SoundFunctions(Part):
    def __init__(self, module: NaoBasic, hearing: Hearing, frame_prefix: str) -> None:
        self._module = module
        self._hearing = hearing
        self._frame_prefix = frame_prefix  # with its slash; may be empty

    def detect_sound(self, timeout: Timeout, confidence: Confidence) -> list[float]:
        """Wait for a sound to begin; answers its confidence and after how long it came (s), nothing if none did."""
        with self._hearing.events_of(DETECTED) as events, self._hearing.subscribed(SENSES["detection"], "detect"):
            began = self._module.clock.now()
            for event in events.until(began + timeout_of(timeout)):
                sounds = [sound for sound in _parsed(begun_sounds, event.value, []) if sound.confidence >= confidence]
                if sounds:
                    sure, when = sounds[0].confidence, self._begin_of(sounds[0].time, event)
                    self._note(when, sure)
                    return [sure, max(0.0, when - began)]
        self._remark_silence(timeout)
        return []

    def localize_sound(self, timeout: Timeout, confidence: Confidence, duration: BetterTime) -> list[float]:
        """Wait for a sound and tell where it is, rad: azimuth, elevation of the head, confidence, both of the base."""
        module = SENSES["localization"]
        try:
            self._module.call(self._module.robot.proxy(module), "setParameter", "EnergyComputation", True)
        except NaoError as error:
            log.debug("sounds have no energies: %s", error)
        best: LocatedSound | None = None
        when = 0.0
        with self._hearing.events_of(LOCATED) as events, self._hearing.subscribed(module, "localize"):
            for event in events.until(self._module.clock.now() + timeout_of(timeout)):
                sound = _parsed(located_sound, event.value, None)
                if sound is not None and sound.confidence >= confidence:
                    best, when = sound, self._begin_of(sound.time, event)
                    break
            if best is not None and duration > 0.0:
                for later in events.until(event.arrived + duration):
                    sound = _parsed(located_sound, later.value, None)
                    if sound is not None and sound.confidence > best.confidence:
                        best, when = sound, self._begin_of(sound.time, later)
        if best is None:
            self._remark_silence(timeout)
            return []
        self._note(when, best.confidence, best)
        head, base = best.in_head, best.in_base
        return [head.azimuth, head.elevation, best.confidence, base.azimuth, base.elevation]

    def set_sensitivity(self, sensitivity: Sensitivity, str_param: Sense) -> None:
        """Make speech recognition, sound detection or localization more or less sensitive; all if none is named."""
        for sense in [str_param.strip()] if str_param.strip() else SENSES:
            proxy = self._module.robot.proxy(SENSES[sense])
            self._module.call(proxy, "setParameter", "Sensitivity", float(sensitivity))

    def _begin_of(self, robot_time: float, event: Event) -> float:
        """ROS time of a time in an event, s; that of the event itself where the time is of another clock."""
        raised = self._hearing.event_time(event)
        began = self._module.robot_clock.ros_time(self._module.call, robot_time)
        return began if same_clock(began, raised) else raised

    def _note(self, when: float, confidence: float, sound: LocatedSound | None = None) -> None:
        self._module.happened = (when, 0.0)
        header = Header(stamp=Time.from_sec(when), frame_id=self._frame_prefix + HEAD)
        message = HeardSound(header=header, confidence=confidence, base_frame=self._frame_prefix + FOOTPRINT)
        if sound is not None:
            message.located = True
            message.azimuth, message.elevation = sound.in_head.azimuth, sound.in_head.elevation
            message.base_azimuth, message.base_elevation = sound.in_base.azimuth, sound.in_base.elevation
            message.energy = sound.energy
            message.head = Point(*sound.head)
        self._hearing.heard.sounds.append(message)

    def _remark_silence(self, timeout: float) -> None:
        self._module.remark(f"no sound within {timeout_of(timeout):g} s")

    functions = {
        "detectSound": detect_sound,
        "localizeSound": localize_sound,
        "setSensitivity": set_sensitivity,
    }


def _parsed(parse: Callable[[Any], Any], value: Any, nothing: Any) -> Any:
    try:
        return parse(value)
    except ValueError as error:
        log.warning("%s", error)
        return nothing

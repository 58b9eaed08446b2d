"""Hearing functions that record the microphones in a file."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

import soundfile

from nao_library_msgs.msg import RecordedFile
from naoqi.errors import NaoError, RobotError

from ..audio.checks import HOME
from ..base.errors import BadGoal
from ..functions.chain import checked_by
from .base import AudioInBase
from .checks import (
    MICROPHONES,
    check_record,
    check_recording_begin,
    check_recording_end,
    recording_file,
    recording_format,
)
from .fields import Channels, FileType, HeardFile, Length, Overwrite, RecordingFile, RecordingRate

log = logging.getLogger(__name__)

RECORDER, DEVICE = "ALAudioRecorder", "ALAudioDevice"
RECORDING = "recording"
"""Status in the feedback."""


@dataclass(frozen=True)
class Recording:
    """A recording that runs.

    Attributes:
        path: Name of the file.
        file_type: wav or ogg.
        rate: Hz.
        channels: Microphones in it.
        began: ROS time, s.
    """

    path: str
    file_type: str
    rate: int
    channels: Sequence[str]
    began: float

    def wanted(self) -> list[Any]:
        """Arguments of `ALAudioRecorder.startMicrophonesRecording`."""
        flags = [int(microphone in self.channels) for microphone in MICROPHONES]
        return [robot_path(self.path), self.file_type, self.rate, flags]


def robot_path(name: str) -> str:
    """Path of a file on the robot: relative names are in the home folder of its user."""
    return name if name.startswith("/") else HOME + name


def _further(path: PurePosixPath) -> PurePosixPath:
    """Name of the file that a recording goes on in."""
    return path.with_name(f"{path.stem}-2{path.suffix}")


def length_of(file: Path) -> float | None:
    """Length of a sound file, s: its frames by its rate; None if it cannot be read."""
    try:
        info = soundfile.info(str(file))
    except (OSError, RuntimeError):  # the second is what libsndfile's errors are
        return None
    return info.frames / info.samplerate


class RecordingFunctions(AudioInBase):
    """Recordings. Parameters are fields of AudioInFunction."""

    device: Callable[..., Any]  # of NaoAudio: a call of ALAudioDevice
    robot_home: Path | None = None
    """Folder of this computer that is the home of the robot's user; None: it is on the robot alone."""
    keep_left: Callable[[], None]  # of NaoAudioInput
    _recording: Recording | None = None

    @property
    def recording_runs(self) -> bool:
        """Whether a recording runs that this server began."""
        return self._recording is not None

    @checked_by(check_record)
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
        with self.ended_by(self._end_recording, "the recording may go on"):
            self.wait(duration)
        file = self.heard.files[-1]
        return [file.path, file.duration]

    @checked_by(check_recording_begin)
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
        self.keep_left()

    @checked_by(check_recording_end)
    def stop_recording(self) -> list[Any]:
        """End a recording; answers file and length (s) if it is one of this server."""
        if self._recording is None:
            self.call(self.robot.proxy(RECORDER), "stopMicrophonesRecording")  # another program's
            return []
        self._end_recording()
        self.keep_left()
        file = self.heard.files[-1]
        return [file.path, file.duration]

    def set_file_as_input(self, str_param: HeardFile) -> None:
        """Have the robot hear a file instead of its microphones."""
        self.device("setFileAsInput", robot_path(str_param.strip()))

    def drop_recording(self) -> None:
        """End the recording that runs, if one does; raises nothing."""
        if self._recording is None:
            return
        try:
            self._end_recording()
        except NaoError as error:
            log.warning("the recording may go on: %s", error)

    def renew_recording(self, former: Recording) -> None:
        """Go on with a recording of this node before it died, in a further file.

        Raises:
            NaoError: The robot refuses it.
        """
        path = _further(PurePosixPath(former.path))
        while (file := self._file_here(str(path))) is not None and file.exists():
            path = _further(path)
        recorder = self.robot.proxy(RECORDER)
        with suppress(RobotError):  # it has been stopped already
            self.call_now(recorder, "stopMicrophonesRecording")
        further = replace(former, path=str(path), began=self.clock.now())
        self.call_now(recorder, "startMicrophonesRecording", *further.wanted())
        self._recording = further
        log.info("the recording %s goes on in %s", former.path, path)

    def require_new_file(self, path: str, overwrite: bool, field: str = "str_param") -> None:
        """Check that a file of the robot is not replaced unasked, as far as this computer can tell.

        Raises:
            BadGoal: There is such a file.
        """
        file = self._file_here(path)
        if file is not None and file.exists() and not overwrite:
            raise BadGoal(field, path, "another name, or overwrite", problem=f"{file} is there already")

    def _file_here(self, path: str) -> Path | None:
        """A file of the robot as this computer has it; None where it has none of them, or not those of that folder."""
        full = robot_path(path)
        if self.robot_home is None or not full.startswith(HOME):
            return None
        return self.robot_home / PurePosixPath(full).relative_to(HOME)

    def _begin_recording(self, name: str, rate: int, channels: Sequence[str], file_type: str, overwrite: bool) -> None:
        path, kind = recording_file(name, file_type)
        self.require_new_file(path, overwrite)
        rate, channels = recording_format(rate, channels)
        recording = Recording(path, kind, rate, channels, self.clock.now())
        self.begin(RECORDER, "startMicrophonesRecording", recording.wanted(), "stopMicrophonesRecording")
        self._recording = replace(recording, began=self.clock.now())
        self.happened = (self._recording.began, 0.0)
        self.tell(RECORDING)

    def _end_recording(self) -> None:
        recording, self._recording = self._recording, None
        if recording is None:
            return
        end = self.clock.now()
        by_clock = max(0.0, end - recording.began)
        self.happened = (recording.began, end)
        self.call_now(self.robot.proxy(RECORDER), "stopMicrophonesRecording")  # answered when the file is complete
        file = self._file_here(recording.path)
        length = length_of(file) if file is not None else None
        self.heard.files.append(
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

"""Hearing functions that record the microphones in a file."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Any

import soundfile

from nao_library_msgs.msg import RecordedFile
from naoqi.errors import NaoError, RobotError

from ..audio.sound_card import NaoAudio
from ..base.errors import BadGoal
from ..functions.chain import checked_by
from ..functions.parts import Part
from ..nao.robot_files import HOME, full_path, is_in
from .fields import (
    MICROPHONES,
    Channels,
    FileType,
    HeardFile,
    Length,
    Overwrite,
    RecordingFile,
    RecordingRate,
    recording_file,
    recording_format,
)
from .hearing import Hearing, LeftGoing, Recording, tells_later

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

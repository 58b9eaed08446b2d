"""Hearing functions that record the microphones in a file."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from nao_library_msgs.msg import RecordedFile
from naoqi.errors import NaoError

from .audio_checks import HOME
from .audio_in_base import AudioInBase
from .audio_in_checks import (
    MICROPHONES,
    check_input_file,
    check_record,
    check_recording_begin,
    check_recording_end,
    recording_file,
    recording_format,
)
from .function_chain import checked_by

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


def robot_path(name: str) -> str:
    """Path of a file on the robot: relative names are in the home folder of its user."""
    return name if name.startswith("/") else HOME + name


class RecordingFunctions(AudioInBase):
    """Recordings. Parameters are fields of AudioInFunction."""

    device: Callable[..., Any]  # of NaoAudio: a call of ALAudioDevice
    _recording: Recording | None = None

    @property
    def recording_runs(self) -> bool:
        """Whether a recording runs that this server began."""
        return self._recording is not None

    def recording_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "record": self.record,
            "startRecording": self.start_recording,
            "startMicrophonesRecording": self.start_recording,
            "stopRecording": self.stop_recording,
            "stopMicrophonesRecording": self.stop_recording,
            "setFileAsInput": self.set_file_as_input,
        }

    @checked_by(check_record)
    def record(self, str_param: str, rate: int, channels: Sequence[str], file_type: str, duration: float) -> list[Any]:
        """Record for `duration`, and wait for the end; answers file and length (s). Interrupted, the file is valid."""
        self._begin_recording(str_param, rate, channels, file_type)
        with self.ended_by(self._end_recording, "the recording may go on"):
            self.wait(duration)
        file = self.heard.files[-1]
        return [file.path, file.duration]

    @checked_by(check_recording_begin)
    def start_recording(self, str_param: str, rate: int, channels: Sequence[str], file_type: str) -> None:
        """Begin to record, also beyond the end of the goal: until stopRecording or the end of the server."""
        self._begin_recording(str_param, rate, channels, file_type)

    @checked_by(check_recording_end)
    def stop_recording(self) -> list[Any]:
        """End a recording; answers file and length (s) if it is one of this server."""
        if self._recording is None:
            self.call(self.robot.proxy(RECORDER), "stopMicrophonesRecording")  # another program's
            return []
        self._end_recording()
        file = self.heard.files[-1]
        return [file.path, file.duration]

    @checked_by(check_input_file)
    def set_file_as_input(self, str_param: str) -> None:
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

    def _begin_recording(self, name: str, rate: int, channels: Sequence[str], file_type: str) -> None:
        path, kind = recording_file(name, file_type)
        rate, channels = recording_format(rate, channels)
        flags = [int(microphone in channels) for microphone in MICROPHONES]
        self.begin(
            RECORDER,
            "startMicrophonesRecording",
            [robot_path(path), kind, rate, flags],
            "stopMicrophonesRecording",
        )
        self._recording = Recording(path, kind, rate, channels, self.clock.now())
        self.tell(RECORDING)

    def _end_recording(self) -> None:
        recording, self._recording = self._recording, None
        if recording is None:
            return
        duration = max(0.0, self.clock.now() - recording.began)
        self.call_now(self.robot.proxy(RECORDER), "stopMicrophonesRecording")  # answered when the file is complete
        self.heard.files.append(
            RecordedFile(recording.path, duration, recording.rate, list(recording.channels), recording.file_type)
        )

"""Records what the microphones hear to a file, from one moment of simulated time to another."""

from __future__ import annotations

import logging
import math
import threading
from pathlib import Path
from typing import Any, Callable

from nao_sim_bridge.base.errors import BadValue, SimulationStopped
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task, WorkThreads
from nao_sim_bridge.base.whole_file import FileTrouble
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.sound.microphone_formats import ALL, MicrophoneFormat, flags_to_channel, microphone_format
from nao_sim_bridge.sound.files import OggFile, WavFile

log = logging.getLogger("nao_sim.recorder")

# How long the end of the simulator waits for a file, s of wall time.
CLOSING = 10.0
KINDS: dict[str, Callable[[Path, int, int], Any]] = {"wav": WavFile, "ogg": OggFile}


class FilesInUse:
    """Files that are written to, by whichever recorder."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._paths: set[Path] = set()

    def take(self, path: Path, name: str) -> None:
        """Take a file, called `name` in errors; a NaoqiError when it is written to already."""
        with self._lock:
            if path in self._paths:
                raise NaoqiError(f"{name!r} is being written to by another recording")
            self._paths.add(path)

    def give_back(self, path: Path) -> None:
        with self._lock:
            self._paths.discard(path)


class Recorder:
    """One recording at a time; all recorders share the files that are `in_use`."""

    def __init__(self, runner: RobotRunner, files: ClientFiles, in_use: FilesInUse) -> None:
        self._runner = runner
        self._files = files
        self._in_use = in_use
        self._lock = threading.Lock()
        self._ending = WorkThreads("end of a recording")
        self._recording: _Recording | None = None

    def start(self, name: str, kind: str, heard: MicrophoneFormat) -> Task:
        """Record to a file, "wav" or "ogg", from the present moment of simulated time; the task ends when it has begun.

        A NaoqiError when a recording is under way, a FileTrouble when the file cannot be written, a ValueError when the
        file is not inside the folder for recordings.
        """
        path = self._files.to_write(name)
        with self._lock:
            if self._recording is not None:
                raise NaoqiError(f"a recording to {self._recording.name!r} is under way; stop it first")
            self._in_use.take(path, name)
            try:
                recording = self._recording = _Recording(name, KINDS[kind], heard, path)
            except Exception:
                self._in_use.give_back(path)
                raise
        log.info("recording to %s", path)
        ears = self._runner.simulation.sound.ears
        return self._runner.execute(lambda: recording.begin(ears), "startMicrophonesRecording")

    def stop(self) -> Task:
        """End at the present moment of simulated time; the task ends when the file is complete."""
        with self._lock:
            recording, self._recording = self._recording, None
        ended = Task("stopMicrophonesRecording", 0)
        if recording is None:
            ended.finish()
            return ended

        def end() -> None:
            try:
                recording.end()
            finally:
                self._in_use.give_back(recording.path)

        def mark() -> None:
            recording.until = self._runner.simulation.sound.time

        def marked(_: Task | None) -> None:  # what was heard last has still to be worked out
            self._ending.do(lambda: ended.finish_with(end))

        try:
            self._runner.execute(mark, "stopMicrophonesRecording").add_done_callback(marked)
        except SimulationStopped:
            marked(None)  # there is no more to hear than there is in the file
        return ended

    def close(self) -> None:
        """End the recording, if there is one; blocking. What goes wrong is logged."""
        try:
            self.stop().result(CLOSING)
        except (NaoqiError, TimeoutError) as error:
            log.error("%s", error)


class _Recording:
    """A file that grows with every block that the ears hear, until a simulated time, s, known once it is stopped."""

    def __init__(
        self, name: str, make_file: Callable[[Path, int, int], Any], heard: MicrophoneFormat, path: Path
    ) -> None:
        self.name, self.path = name, path
        self.until = math.inf
        self._heard = heard
        self._file = make_file(path, heard.rate, 4 if heard.channel == ALL else 1)
        self._listener: Any = None
        self._failure: Exception | None = None

    def begin(self, ears: Any) -> None:
        wants, channel = self._heard.wants, self._heard.channel_name
        self._listener = ears.listen(f"recording {self.name}", self._on_block, wants, channel, exact=True)

    def end(self) -> None:
        """Hear what is left, and end the file; a NaoqiError when the file could not be written."""
        if self._listener is not None:
            self._listener.close()
        try:
            self._file.close()
        except FileTrouble as error:
            self._failure = self._failure or error
        if self._failure is not None:
            raise NaoqiError(f"{self.name!r} is not complete: {self._failure}")

    def _on_block(self, block: Any) -> None:
        """Append a block; in the thread of the ears."""
        if self._failure is not None:
            return
        try:
            left = max(0, round(min(self.until - block.time, len(block.samples)) * block.rate))
            self._file.write(block.samples[:left])
        except RuntimeError as error:
            self._failure = error
            log.error("recording to %r ends early: %s", self.name, error)


def kind_of(name: str) -> str:
    """Wav or ogg, by the ending of a file name; a BadValue when it has another ending."""
    ending = Path(name).suffix.lower().lstrip(".")
    if ending not in KINDS:
        raise BadValue("filename", name, "a name that ends in .wav or .ogg")
    return ending


class ALAudioRecorder:
    """ALAudioRecorder as the simulated robot offers it."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder

    def startMicrophonesRecording(self, filename: str, kind: str, rate: int, channels: Any) -> Task:
        if kind not in KINDS:
            raise BadValue("type", kind, " or ".join(KINDS))
        if kind_of(filename) != kind:
            raise BadValue("filename", filename, f"a name that ends in .{kind}, as the type says")
        heard = microphone_format(rate, flags_to_channel(channels), 0)
        return self._recorder.start(filename, kind, heard)

    def stopMicrophonesRecording(self) -> Task:
        return self._recorder.stop()

"""Plays and records sound files of the robot, and waits for the end. No ROS."""

from __future__ import annotations

import threading
from typing import Any

from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT, FILE_LIMIT

from ...base.cancellation import CancellationToken
from ...robot.robot_task import run_task
from .audio_requests import RecordingRequest

PLAYER, RECORDER, DEVICE = "ALAudioPlayer", "ALAudioRecorder", "ALAudioDevice"


class AudioPlayer:
    """Sound files and volume of one robot. Any thread may call; all of it ends with `interrupt`.

    Methods raise NaoError if the robot refuses or cannot be asked.
    """

    def __init__(self, robot: Any, clock: Any, interrupt: CancellationToken) -> None:
        self._robot = robot
        self._clock = clock
        self._interrupt = interrupt
        self._recording = threading.Lock()

    def play(self, file: str) -> None:
        """Play a file to its end; raises Preempted if interrupted."""
        call = self._robot.proxy(PLAYER).call_async("playFile", file)
        run_task(call, self._interrupt, lambda: self._ask(PLAYER, "stopAll"))

    def record(self, request: RecordingRequest) -> None:
        """Record the microphones until the time is over.

        Raises:
            NaoError: If the robot cannot, or if a recording is under way.
            Preempted: If it was interrupted; the file holds what was recorded until then.
        """
        if not self._recording.acquire(blocking=False):
            raise NaoError("a recording is under way: one at a time")
        try:
            self._ask(
                RECORDER,
                "startMicrophonesRecording",
                request.file,
                request.kind,
                request.rate,
                list(request.channels),
                limit=FILE_LIMIT,
            )
            try:
                self._wait(request.seconds)
            finally:
                self._ask(RECORDER, "stopMicrophonesRecording", limit=FILE_LIMIT)
            self._interrupt.check()
        finally:
            self._recording.release()

    def _wait(self, seconds: float) -> None:
        """Let the robot's time pass, unless it is lost meanwhile."""
        ended = CancellationToken()
        connection = self._robot.connection

        def on_state(state: Any) -> None:
            if state != "connected":
                ended.trigger()

        connection.add_listener(on_state)
        try:
            with self._interrupt.waking(ended.trigger):
                self._clock.wait(seconds, ended)
        finally:
            connection.remove_listener(on_state)

    def volume(self) -> int:
        """0 to 100."""
        return int(self._ask(DEVICE, "getOutputVolume"))

    def set_volume(self, volume: int) -> None:
        self._ask(DEVICE, "setOutputVolume", volume)

    def _ask(self, module: str, method: str, *arguments: Any, limit: float = ANSWER_LIMIT) -> Any:
        return self._robot.proxy(module).call_async(method, *arguments).result(timeout=limit)

"""The node nao_audio: sound files, volume, recordings, and where sounds come from."""

from __future__ import annotations

import posixpath
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import rospy
from rospy.rostime import is_wallclock

from nao_library_msgs.msg import AudioSourceLocalization
from nao_library_msgs.srv import (
    AudioPlayback,
    AudioRecorder,
    GetAudioMasterVolume,
    GetAudioMasterVolumeResponse,
    SetAudioMasterVolume,
)
from naoqi.errors import NaoError, UnknownModule
from naoqi.limits import ANSWER_LIMIT, FILE_LIMIT

from ...core.errors import BadGoal
from ...core.fields import limit, number_parameter
from ...core.health import Report
from ...core.nao_facts import READ, WRITTEN, full_path, is_in
from ...core.robot import ask, run_task
from ...core.waiting import CancellationToken
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock, pose_of, tf_prefix
from ..base.driver_node import LazyTopic, name_for_robot, publish
from ..base.lazy_subscription import Extractor, ExtractorKind

FILE_KINDS = {0: "wav", 1: "ogg"}
RATES = (16000, 48000)
LONGEST = 3600
"""s of the longest recording."""
CHANNELS = ("left", "right", "front", "rear")


def file_on_robot(name: str, folders: Sequence[str] = READ) -> str:
    """Full name of a file on the robot, from one that is absolute or relative to the home of its user.

    Raises BadGoal if it leads out of the folders.
    """
    allowed = f"a name inside {' or '.join(folders)}"
    if not name.strip() or "\0" in name or name.endswith("/"):
        raise BadGoal("file_path", name, allowed)
    # Many a client writes "/music/a.ogg" for a file in the home, because that was put before the name as it is.
    full = full_path(name if is_in(name, folders) else name.lstrip("/"))
    if not is_in(full, folders):
        raise BadGoal("file_path", name, allowed, f"{name!r} leads out of it")
    return full


@dataclass(frozen=True)
class RecordingRequest:
    """A recording of the microphones."""

    file: str  # full name on the robot
    seconds: int  # duration
    kind: str  # wav or ogg
    rate: int  # Hz
    channels: tuple[int, ...]  # 0 or 1 for each of left, right, front, rear


def read_recording(file: str, seconds: int, kind: int, channels: Sequence[bool], rate: int) -> RecordingRequest:
    """Check a request.

    Args:
        file: Without an ending it gets that of its kind.
        seconds: Duration.
        kind: 0 wav, 1 ogg.
        channels: Whether left, right, front and rear are wanted.
        rate: Hz.

    Raises:
        BadGoal: For a bad value. Which channels go with which rate is up to the robot.
    """
    if kind not in FILE_KINDS:
        raise BadGoal("audio_type", kind, "0 (wav) or 1 (ogg)")
    if not 0 < seconds <= LONGEST:
        raise BadGoal("secs", seconds, f"1 to {LONGEST}")
    if rate not in RATES:
        raise BadGoal("samplerate", rate, "16000 (one channel) or 48000 (all four)")
    if not any(channels):
        raise BadGoal("channels", list(channels), f"at least one of {', '.join(CHANNELS)}", "none is chosen")
    full = file_on_robot(file, WRITTEN)
    if not posixpath.splitext(full)[1]:
        full = f"{full}.{FILE_KINDS[kind]}"
    return RecordingRequest(full, seconds, FILE_KINDS[kind], rate, tuple(int(flag) for flag in channels))


def read_volume(volume: int) -> int:
    """Check a volume in percent; raises BadGoal."""
    if not 0 <= volume <= 100:
        raise BadGoal("master_volume", volume, "0 to 100")
    return volume


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
        """Record the microphones for the time of the request.

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
        return ask(self._robot, module, method, *arguments, limit=limit)


STATES = ("no subscriber", "sounds are located", "sounds cannot be located")
LOCALISATION_KINDS = [
    ExtractorKind("sound localisation", module, f"{module}/SoundLocated", states=STATES)
    for module in ("ALSoundLocalization", "ALAudioSourceLocalization")
]
"""Newer name first."""
ENERGY = "EnergyComputation"


@dataclass(frozen=True)
class Direction:
    """Where a sound came from."""

    time: float  # s, the robot's clock
    azimuth: float  # rad, in the frame of the head, positive to the left
    elevation: float  # rad, positive upwards
    confidence: float  # 0 to 1
    energy: float  # as the robot reports it
    head_in_torso: tuple[float, ...]  # x, y, z in m, roll, pitch, yaw in rad, at that time


def read_direction(value: Any) -> Direction | None:
    """Direction from an event, [[s, us], [azimuth, elevation, confidence, energy], head in torso, head in robot].

    None for an event without one.
    """
    if not isinstance(value, (list, tuple)) or len(value) < 3 or len(value[1]) < 3 or len(value[2]) != 6:
        return None
    azimuth, elevation, confidence, *energy = (float(each) for each in value[1])
    stamp = value[0][0] + 1e-6 * value[0][1]
    pose = tuple(float(each) for each in value[2])
    return Direction(stamp, azimuth, elevation, confidence, energy[0] if energy else 0.0, pose)


class SoundDirections(Extractor):
    """Has the robot locate sounds while that is wanted, also after a lost connection."""

    answer_limit = 2.0

    def __init__(self, robot: Any, subscriber: str, sensitivity: float, sink: Callable[[Direction], None]) -> None:
        """Start idle; the robot need not be connected yet.

        Args:
            subscriber: Name of the subscriber at the robot.
            sensitivity: 0 to 1; below 0 leaves the robot's own.
            sink: Gets each direction, in a thread of libqi.
        """
        self._sensitivity = sensitivity
        self._on_direction = sink
        super().__init__(robot, LOCALISATION_KINDS[0], subscriber, self._take, self._set_up)

    def _set_up(self) -> None:
        self._choose_kind()
        self.call("setParameter", ENERGY, True)
        if self._sensitivity >= 0.0:
            self.call("setParameter", "Sensitivity", self._sensitivity)

    def _choose_kind(self) -> None:
        """Choose the module that this robot has; raises NaoError if it has neither, or cannot be asked."""
        missing = []
        for kind in LOCALISATION_KINDS:
            self.kind = kind
            try:
                self.call("ping")
                return
            except UnknownModule as error:
                missing.append(error)
        self.kind = LOCALISATION_KINDS[0]
        raise missing[0]

    def _take(self, value: Any) -> None:
        direction = read_direction(value)
        if direction is not None:
            self._on_direction(direction)


TORSO = "torso"
ROBOTS_OWN = -1.0
"""Sensitivity that leaves what the robot has."""


class NaoAudioServices:
    """Sound of one robot, under the names of nao_interaction.

    File names are relative to the home of the robot's user; for the simulator that is its `record_dir`. What goes
    wrong is the error of the service that was called: the others continue.

    ROS API (relative names):
        Services `nao_audio/play_file` (nao_library_msgs/AudioPlayback: answers when the file was played),
        `nao_audio/record` (nao_library_msgs/AudioRecorder: answers when it was recorded), `nao_audio/master_volume`
        (nao_library_msgs/SetAudioMasterVolume), `nao_audio/get_master_volume` (nao_library_msgs/GetAudioMasterVolume).
        Publishes `nao_audio/audio_source_localization` (nao_library_msgs/AudioSourceLocalization: direction in the
        frame of the head, and the pose of the head in the frame of the header, the torso); sounds are located only
        while it has subscribers.
        Parameter `~sensitivity` (-1): of the localisation, 0 to 1; -1: what the robot has.
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        sensitivity = node.param("~sensitivity", ROBOTS_OWN)
        sensitivity = number_parameter("~sensitivity", sensitivity, limit("share"), also=ROBOTS_OWN)
        self._interrupt = CancellationToken()
        self._frame = tf_prefix() + TORSO
        self._player = AudioPlayer(robot, RosClock(), self._interrupt)
        self._directions = SoundDirections(robot, name_for_robot(node.name), sensitivity, self._publish)
        node.if_it_fails(self._directions.close)
        name = "nao_audio/audio_source_localization"
        self._topic = node.publisher(name, AudioSourceLocalization, queue_size=10)
        self._lazy = LazyTopic(self._directions.want, self._topic)
        node.offer("nao_audio/play_file", AudioPlayback, self._play)
        node.offer("nao_audio/record", AudioRecorder, self._record)
        node.offer("nao_audio/master_volume", SetAudioMasterVolume, self._set_volume)
        node.offer("nao_audio/get_master_volume", GetAudioMasterVolume, self._volume)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"sound localisation": self._directions.report}

    def close(self) -> None:
        self._interrupt.stop()
        self._directions.close()

    # --- services -------------------------------------------------------------------------------------------------

    def _play(self, request: Any) -> None:
        self._player.play(file_on_robot(request.file_path.data))

    def _record(self, request: Any) -> None:
        flags = [getattr(request, f"{side}_channel").data for side in CHANNELS]
        file, rate = request.file_path.data, request.samplerate.data
        self._player.record(read_recording(file, request.secs.data, request.audio_type.data, flags, rate))

    def _set_volume(self, request: Any) -> None:
        self._player.set_volume(read_volume(request.master_volume.data))

    def _volume(self, _request: Any) -> GetAudioMasterVolumeResponse:
        response = GetAudioMasterVolumeResponse()
        response.master_volume.data = self._player.volume()
        return response

    # --- topic ----------------------------------------------------------------------------------------------------

    def _publish(self, direction: Direction) -> None:
        """Called in a thread of libqi."""
        message = AudioSourceLocalization()
        # The simulated robot's clock is the one on /clock; that of a real robot may be any.
        message.header.stamp = rospy.Time.now() if is_wallclock() else rospy.Time.from_sec(direction.time)
        message.header.frame_id = self._frame
        for field in ("azimuth", "elevation", "confidence", "energy"):
            getattr(message, field).data = getattr(direction, field)
        message.head_pose = pose_of(direction.head_in_torso)
        publish(self._topic, message)

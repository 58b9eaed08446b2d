"""The node nao_audio: sound files, volume, recordings, and where sounds come from."""

from __future__ import annotations

from collections.abc import Callable
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

from ...base.cancellation import CancellationToken
from ...base.field_checks import number_parameter
from ...base.limits import limit
from ...ros.health import Report
from ...ros.node_interface import NodeInterface
from ...ros.robot_frames import pose_of, tf_prefix
from ...ros.ros_clock import RosClock
from ..base.lazy_topic import LazyTopic
from ..base.node import name_for_robot, publish
from .audio_directions import Direction, SoundDirections
from .audio_player import AudioPlayer
from .audio_requests import CHANNELS, file_on_robot, read_recording, read_volume

TORSO = "torso"
ROBOTS_OWN = -1.0
"""Sensitivity that leaves what the robot has."""


class NaoAudioServices:
    """Sound of one robot, under the names of nao_interaction.

    File names are relative to the home of the robot's user; for the simulator that is its `record_dir`. What goes
    wrong is the error of the service that was called: the others go on.

    ROS API (relative names):
        Services `nao_audio/play_file` (nao_library_msgs/AudioPlayback: answers when the file was played),
        `nao_audio/record` (nao_library_msgs/AudioRecorder: answers when it was recorded), `nao_audio/master_volume`
        (nao_library_msgs/SetAudioMasterVolume), `nao_audio/get_master_volume` (nao_library_msgs/GetAudioMasterVolume).
        Publishes `nao_audio/audio_source_localization` (nao_library_msgs/AudioSourceLocalization: direction in the
        frame of the head, and the pose of the head in the frame of the header, the torso); sounds are located only
        while somebody listens.
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

"""Requests to nao_audio, checked and in NAOqi's terms. No ROS."""

from __future__ import annotations

import posixpath
from collections.abc import Sequence
from dataclasses import dataclass

from ...base.errors import BadGoal
from ...nao.robot_files import READ, WRITTEN, full_path, is_in

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

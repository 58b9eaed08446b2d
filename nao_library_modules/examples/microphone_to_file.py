#!/usr/bin/env python3
"""Writes what the robot's microphones hear to a file on this computer: `microphone_to_file.py heard.wav --seconds 5`.

How many microphones: `--frequency 16000` for the front one, 48000 for all four.

Needs a running driver, for example `roslaunch nao_library nao_sim.launch`.
"""

from __future__ import annotations

import argparse
import struct
import sys
import threading
import wave
from pathlib import Path

import rospy
from dynamic_reconfigure.client import Client

from nao_library_modules.ros.driver_types import spoken
from nao_library_modules.whole_file import NoPlaceForFile, WholeFile, require_new
from nao_library_msgs.msg import AudioBuffer

MICROPHONE = "nao_robot/microphone/naoqi_microphone"
LIMIT = 20.0


class Recording:
    """Blocks of the microphones, one after the other, until there are enough.

    Silence stands for blocks that are missing, so that what comes later is heard at its time.
    """

    def __init__(self, seconds: float, frequency: int) -> None:
        """Wait for the first block.

        Args:
            seconds: How long the recording is to be.
            frequency: Samples a second, Hz; blocks of another frequency are still under way from before.
        """
        self.channels = 0
        self.complete = threading.Event()
        self._wanted = round(seconds * frequency)
        self._frequency = frequency
        self._samples = bytearray()
        self._began = 0.0

    def take(self, block: AudioBuffer) -> None:
        """Append a block."""
        if block.frequency != self._frequency or self.complete.is_set():
            return
        stamp = block.header.stamp.to_sec()
        if not self.channels:
            self.channels, self._began = len(block.channelMap), stamp
        frame = 2 * self.channels
        missing = round((stamp - self._began) * self._frequency) * frame - len(self._samples)
        if missing > frame * self._frequency * 0.1:
            self._samples += bytes(missing)
        self._samples += struct.pack(f"<{len(block.data)}h", *block.data)
        if len(self._samples) >= self._wanted * frame:
            del self._samples[self._wanted * frame :]
            self.complete.set()

    def write(self, path: Path) -> float:
        """Write a WAV file; its length, s."""
        samples = bytes(self._samples)
        with WholeFile(path) as target, wave.open(target, "wb") as file:
            file.setnchannels(self.channels)
            file.setsampwidth(2)
            file.setframerate(self._frequency)
            file.writeframes(samples)
        return len(samples) / (2 * self.channels * self._frequency)


def main() -> int:
    """Record; the exit status tells whether there is a file."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="name of the WAV file")
    parser.add_argument("--seconds", type=float, default=5.0, help="how long (default: 5)")
    parser.add_argument("--frequency", type=int, choices=(16000, 48000), default=16000, help="Hz (default: 16000)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("microphone_to_file", anonymous=True)
    try:
        path = require_new(options.file, options.overwrite)
        Client(MICROPHONE, timeout=LIMIT).update_configuration({"frequency": options.frequency})
    except NoPlaceForFile as error:
        print(error)
        return 1
    except rospy.ROSException:
        print(f"there is no {MICROPHONE}: start it with roslaunch nao_library nao_sim.launch")
        return 1
    recording = Recording(options.seconds, options.frequency)
    rospy.Subscriber(f"{MICROPHONE}/audio_raw", spoken(AudioBuffer), recording.take, queue_size=100)
    rospy.on_shutdown(recording.complete.set)
    whole = recording.complete.wait(options.seconds + LIMIT) and not rospy.is_shutdown()
    if not whole:
        print("not all of it was heard; if the microphones cannot be heard, /diagnostics tells why")
    if recording.channels:
        seconds = recording.write(path)
        print(f"{path}: {seconds:g} s, {recording.channels} channel(s), {options.frequency} Hz")
    return 0 if whole else 1


if __name__ == "__main__":
    sys.exit(main())

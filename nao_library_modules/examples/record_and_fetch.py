#!/usr/bin/env python3
"""Records on the robot and fetches the file, as a program for the robot maker's SDK does: no ROS, only ALProxy.

The path is the robot's. A program that runs on a real robot opens it there; on another computer it fetches the file
first, as this one does from a robot and from a simulator: by what `nao files get` does, ssh or the simulator's own way.
Needs a robot or a simulator at `--ip` and `--port`, for example `python3 -m nao_sim_bridge`.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from pathlib import Path

from naoqi import ALProxy
from naoqi.errors import NaoError

ON_ROBOT = "/tmp/record_and_fetch.wav"
RATE, FRONT = 16000, (0, 0, 1, 0)
"""Samples a second, and which of the microphones left, right, front, rear."""


def record(recorder: ALProxy, seconds: float) -> None:
    """Record what the front microphone hears to a file of the robot."""
    recorder.stopMicrophonesRecording()  # one that a former program has left
    recorder.startMicrophonesRecording(ON_ROBOT, "wav", RATE, FRONT)
    try:
        time.sleep(seconds)
    finally:
        recorder.stopMicrophonesRecording()


def main() -> int:
    """Record and fetch; the exit status tells whether it worked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ip", default="127.0.0.1", help="address of the robot (127.0.0.1)")
    parser.add_argument("--port", type=int, default=9559, help="port of its NAOqi (9559)")
    parser.add_argument("--seconds", type=float, default=2.0, help="how long (2)")
    parser.add_argument("file", type=Path, nargs="?", default=Path("recorded.wav"), help="here (recorded.wav)")
    parser.add_argument("--overwrite", action="store_true", help="replace a file of that name")
    options = parser.parse_args()
    try:
        record(ALProxy("ALAudioRecorder", options.ip, options.port), options.seconds)
    except NaoError as error:
        print(error)
        return 1
    fetch = ["nao", "files", "get", ON_ROBOT, str(options.file), "--qi-url", f"tcp://{options.ip}:{options.port}"]
    return subprocess.run([*fetch, *["--overwrite"] * options.overwrite]).returncode


if __name__ == "__main__":
    sys.exit(main())

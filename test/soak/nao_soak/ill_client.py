"""A client of the robot that is ill: a program of its own, so that it can be stopped and killed. Prints "ready".

Arguments: address of the robot, port, and what it does: "listens" subscribes to all that comes fast and then does
nothing; "loads" has sounds read and forgotten, for ever.
"""

from __future__ import annotations

import os
import socket
import sys
import time
from typing import Any

import qi

EXTRACTORS = ("ALSonar", "ALSoundDetection", "ALFaceDetection")
FAST = "Soak/Fast"
"""An event that is raised all the time."""
VALUE = [0.5] * 250
SOUND = "ill_client.wav"


class Module:
    """What the robot calls."""

    def onEvent(self, name: str, value: Any, message: str) -> None:
        """An event."""

    def processRemote(self, channels: int, frames: int, stamp: Any, sound: Any) -> None:
        """A block of sound."""


def main() -> None:
    """Connect, and do it."""
    address, port, what = sys.argv[1:]
    session = qi.Session()
    session.connect(f"tcp://{address}:{port}")
    {"listens": listen, "loads": load}[what](session, address, port)


def listen(session: Any, address: str, port: str) -> None:
    """Subscribe to everything, and wait."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect((address, int(port)))
        session.listen(f"tcp://{probe.getsockname()[0]}:0")
    name = f"Ill{os.getpid()}"
    session.registerService(name, Module())
    memory = session.service("ALMemory")
    memory.subscribeToEvent(FAST, name, "onEvent")
    kept = [memory.subscriber(event) for event in (FAST, "SonarLeftDetected", "SoundDetected")]
    for subscriber in kept:
        subscriber.signal.connect(lambda value: None)
    for extractor in EXTRACTORS:
        session.service(extractor).subscribe(name)
    session.service("ALAudioDevice").subscribe(name)
    session.service("ALVideoDevice").subscribeCamera(name, 0, 1, 13, 5)
    memory.getDataOnChange("Soak/Never", 0, _async=True)
    print("ready", flush=True)
    time.sleep(1e6)


def load(session: Any, _address: str, _port: str) -> None:
    """Read sounds and forget them, and raise the event in between."""
    player, memory = session.service("ALAudioPlayer"), session.service("ALMemory")
    session.service("ALTextToSpeech").sayToFile("What is loaded again and again.", SOUND)
    memory.insertData("Soak/Never", 0)
    print("ready", flush=True)
    while True:
        player.unloadFile(player.loadFile(SOUND))
        for _ in range(10):
            memory.raiseEvent(FAST, VALUE)
            time.sleep(0.01)


if __name__ == "__main__":
    main()

"""What cameras cost and give: time of a frame, frames a second over libqi, and the pace of the physics meanwhile."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import Sequence

from ..errors import BenchmarkError
from ..row import Figures, Row, at_least, at_most
from ..simulator import Simulator
from ..stack import Stack
from ..stats import Sample
from ..timings import run_timings

FRAMES = 30
# s of wall time, of each look at something.
LOOK = 3.0
ROUNDS = 4
ROOM = ("--world", "lab", "--posture", "Stand")
TOP, BOTTOM = 0, 1
QVGA, VGA = 1, 2
RGB = 11
NAME = "benchmarks"


class CameraFrame(Row):
    """A frame of the robot's camera as its user gets it, next to PyBullet's own picture.

    Args:
        name: Of the row.
        size: Of the frame, pixels.
    """

    against = "bare getCameraImage of the same scene and size"
    unit = "ms"
    bound = at_most(1.3)

    def __init__(self, name: str, size: str) -> None:
        self.name = name
        self.subject = f"camera frame, {size}"
        self._size = size

    def measure(self, stack: Stack) -> Figures:
        """Measure in a process of its own."""
        return Figures.compared(*run_timings("camera_frames", FRAMES, "--size", self._size), scale=1e3)


@dataclass(frozen=True)
class Look:
    """One client's look through a camera."""

    camera: int
    resolution: int
    fps: int


# What a robot on two cores has to give in real time.
WAYS: Sequence[tuple[str, tuple[Look, ...]]] = (
    ("320x240 at 30", (Look(TOP, QVGA, 30),)),
    ("640x480 at 15", (Look(TOP, VGA, 15),)),
    ("both 320x240 at 15", (Look(TOP, QVGA, 15), Look(BOTTOM, QVGA, 15))),
)


class Client:
    """Takes one picture after the other in a thread of its own, until it is stopped."""

    def __init__(self, simulator: Simulator, look: Look) -> None:
        self._video = simulator.session.service("ALVideoDevice")
        self._look = look
        self._handle = self._video.subscribeCamera(NAME, look.camera, look.resolution, RGB, look.fps)
        self._video.getImageRemote(self._handle)
        self._stopped = threading.Event()
        self.pictures = 0
        self._error: RuntimeError | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            while not self._stopped.is_set():
                self._video.getImageRemote(self._handle)
                self.pictures += 1
        except RuntimeError as error:
            self._error = error

    def stop(self) -> None:
        """Take no more.

        Raises:
            BenchmarkError: There was none to take.
        """
        self._stopped.set()
        self._thread.join(LOOK)
        if self._error is not None:
            raise BenchmarkError(f"a picture could not be taken: {self._error}")
        self._video.unsubscribe(self._handle)


class CameraRate(Row):
    """Frames a second that clients over libqi get of those that they ask for, in real time; the worst of three ways."""

    name = "camera_rate"
    subject = "camera frames a second, got : asked for"
    unit = "x"
    bound = at_least(0.95)

    def measure(self, stack: Stack) -> Figures:
        """Count for a while, one way after the other."""
        shares = {}
        with Simulator.plain(*ROOM) as simulator:
            simulator.wake_up()
            for name, looks in WAYS:
                clients = [Client(simulator, look) for look in looks]
                counted = [client.pictures for client in clients]
                began = time.perf_counter()
                time.sleep(LOOK)
                taken = time.perf_counter() - began
                counted = [client.pictures - before for client, before in zip(clients, counted)]
                for client in clients:
                    client.stop()
                # One frame more or less may lie on the edge of the time that is looked at.
                shares[name] = min(count / (look.fps * taken) for count, look in zip(counted, looks))
        return Figures(min(shares.values()), details=shares, note=", ".join(f"{k}: {v:.2f}" for k, v in shares.items()))


class PhysicsWithCameras(Row):
    """Simulated seconds per wall second in real time while a client looks through both cameras."""

    name = "physics_with_cameras"
    subject = "simulated s per s in real time, both cameras 320x240 at 15"
    against = "the same with nobody looking"
    unit = "x"
    bound = at_least(0.98)

    def measure(self, stack: Stack) -> Figures:
        """Look at the clock of a robot that stands, with and without cameras in turns."""
        with Simulator.plain(*ROOM) as simulator:
            simulator.wake_up()
            seen, unseen = [], []
            for _ in range(ROUNDS):
                unseen.append(simulator.pace(LOOK))
                clients = [Client(simulator, look) for look in WAYS[-1][1]]
                seen.append(simulator.pace(LOOK))
                for client in clients:
                    client.stop()
        return Figures.compared(Sample(tuple(seen)), Sample(tuple(unseen)), scale=1.0)

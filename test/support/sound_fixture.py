"""What scenarios with sound share: what the robot's loudspeakers played, and what can be read from sound."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rospkg
import rospy
import soundfile
from camera_fixture import matrix

SOUND_FILE = "loudspeakers.wav"
"""Name that the scenarios' launch files give to the file with what the loudspeakers play."""
# The file follows the simulation with a delay, s of simulated time.
FILE_DELAY = 2.0
# Below this a loudspeaker is silent, where 1 is full scale.
SILENT = 1e-4


def recording(name: str) -> Path:
    """A file in the simulator's folder for recordings, which is under ROS_HOME if it is relative."""
    return Path(rospkg.get_ros_home()) / Path(rospy.get_param("nao_sim/record_dir")).expanduser() / name


def newest(name: str) -> Path:
    """The file that the simulator that runs now writes: the name, or name-2, name-3, ... after earlier ones."""
    first = recording(name)
    return max(first.parent.glob(f"{first.stem}*{first.suffix}"), key=lambda path: path.stat().st_mtime_ns)


class Loudspeakers:
    """What the simulated robot's loudspeakers played.

    Args:
        robot: The SimulatedRobot.
    """

    def __init__(self, robot) -> None:
        self._robot = robot

    def played(self, from_s: float, to_s: float) -> tuple[np.ndarray, int]:
        """Samples (frames, 2), 1 is full scale, between two simulated times that are past, s; and their rate, Hz."""
        self._robot.advance(FILE_DELAY)
        path = newest(SOUND_FILE)
        rate = soundfile.info(str(path)).samplerate
        samples, _ = soundfile.read(str(path), start=int(from_s * rate), stop=int(to_s * rate), always_2d=True)
        wanted = int(to_s * rate) - int(from_s * rate)
        assert len(samples) == wanted, f"{path} ends before {to_s:g} s"
        return samples, rate

    def level(self, from_s: float, to_s: float) -> float:
        """Root mean square of both loudspeakers, 1 is full scale."""
        return level(self.played(from_s, to_s)[0])

    def span(self, from_s: float, to_s: float) -> tuple[float, float]:
        """Simulated times of the first and of the last sound between two times, s.

        Raises:
            AssertionError: There was only silence.
        """
        samples, rate = self.played(from_s, to_s)
        loud = np.flatnonzero(np.abs(samples).max(axis=1) > SILENT)
        assert len(loud), f"only silence from {from_s:g} s to {to_s:g} s"
        return from_s + loud[0] / rate, from_s + loud[-1] / rate


def level(samples: np.ndarray) -> float:
    """Root mean square of samples."""
    return float(np.sqrt(np.mean(np.square(samples)))) if samples.size else 0.0


def strongest_frequency(samples: np.ndarray, rate: int) -> float:
    """Frequency of the strongest tone in samples, Hz; (frames,) or, mixed, (frames, channels)."""
    mono = samples.mean(axis=1) if samples.ndim == 2 else samples
    spectrum = np.abs(np.fft.rfft(mono * np.hanning(len(mono)), 4 * len(mono)))
    return float(np.argmax(spectrum) * rate / (4 * len(mono)))


class Room:
    """Sounds in the room of the simulated robot, at places seen from its head.

    Args:
        robot: The SimulatedRobot.
    """

    def __init__(self, robot) -> None:
        self._robot = robot
        self._simulation = robot.module("NaoSimulation")

    def around(self, distance: float, bearing: float, height: float = 0.0) -> list[float]:
        """A place in the world, m.

        Args:
            distance: From the head, on the level, m.
            bearing: rad to the left of where the head looks.
            height: Above the head, m.
        """
        head = self._head_in_world()
        heading = np.arctan2(head[1, 0], head[0, 0]) + bearing
        return [float(v) for v in head[:3, 3] + [distance * np.cos(heading), distance * np.sin(heading), height]]

    def in_head(self, place) -> np.ndarray:
        """A place of the world in the frame of the head, m."""
        return (np.linalg.inv(self._head_in_world()) @ [*place, 1.0])[:3]

    def place(self, name: str, samples: np.ndarray, place, level_db: float, loop: bool = False) -> None:
        """Have samples (frames,) at 48000 Hz sound at a place of the world, so loud at 1 m."""
        path = recording(f"{name}.wav")
        path.parent.mkdir(parents=True, exist_ok=True)
        soundfile.write(str(path), samples, 48000)
        self._simulation.addSound(name, f"{name}.wav", place, level_db, loop)

    def remove(self, name: str) -> None:
        """End a sound."""
        self._simulation.removeSound(name)

    def clear(self) -> None:
        """End all sounds."""
        for name in self._simulation.sounds():
            self.remove(name)

    def person_says(self, text: str, place, voice: str = "rms", level_db: float = 65.0) -> None:
        """Have somebody at a place of the world say something, and wait until it is said."""
        self._simulation.personSays(text, place, voice, level_db)

    def _head_in_world(self) -> np.ndarray:
        pose = self._robot.true_pose()
        head = np.array(self._robot.module("ALMotion").getTransform("Head", 0, True)).reshape(4, 4)
        return matrix(pose.position, pose.orientation) @ head


def noise(seconds):
    """White noise with a level that fits into a file, (frames,) at 48000 Hz."""
    return 0.2 * np.random.default_rng(3).standard_normal(int(48000 * seconds)).clip(-4, 4)


def bursts():
    """Noise for 0.3 s, silence for 0.7 s: something that begins again and again."""
    samples = noise(1.0)
    samples[int(0.3 * 48000) :] = 0.0
    return samples

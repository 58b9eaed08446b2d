"""The node naoqi_microphone: what the robot's microphones hear, as a topic."""

from __future__ import annotations

import logging
import sys
import threading
from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import rospy
from rospy.rostime import is_wallclock

from nao_library_msgs.msg import AudioBuffer
from naoqi import ALBroker, ALModule
from naoqi.errors import NaoError, UnknownModule
from naoqi.limits import STREAM_LIMIT

from ...core.health import Level, Report
from ...core.robot import ask
from ...ros.node_interface import NodeInterface
from ...ros.time_and_frames import RosClock
from ..base.driver_node import LazyTopic, frame_parameter, name_for_robot, publish
from ..base.lazy_subscription import LazySubscription
from ..base.reconfigure import ReconfigureField, serve

log = logging.getLogger(__name__)

# nao_library_msgs/AudioBuffer has the same numbers.
FRONT_LEFT, FRONT_CENTER, FRONT_RIGHT, REAR_LEFT, REAR_CENTER, REAR_RIGHT = range(6)
MAPS = {
    "V6": (REAR_LEFT, REAR_RIGHT, FRONT_LEFT, FRONT_RIGHT),
    "older": (FRONT_LEFT, FRONT_RIGHT, FRONT_CENTER, REAR_CENTER),
}
"""Head -> where its microphones are, in NAOqi's order: left, right, front, rear.

Source: the NAO pages of NAOqi 2.8 (V6: four corners of the head) and 2.1 (V4, V5: the sides, front and back), and how
the naoqi drivers number them.
"""
FIRST_OF_CORNERS = 6
ALL_CHANNELS, FRONT_CHANNEL = 0, 3
"""What ALAudioDevice calls the channels."""
FORMATS = {16000: (FRONT_CHANNEL, 1), 48000: (ALL_CHANNELS, 4)}
"""Rate in Hz -> what ALAudioDevice is asked for, and how many channels that are."""
RATES = {rate: f"{count} channel{'s' if count > 1 else ''}" for rate, (_, count) in FORMATS.items()}
"""Rate in Hz -> what comes at it, for people."""
FRONT = 2
DRIFT = 1e-4
"""How fast one clock may run away from the other: s a second."""
GAP = 0.5
"""Share of a block from which on a jump in time is a gap."""


def channel_map(channels: int, version: str) -> tuple[int, ...]:
    """Positions of the microphones that the channels of a block come from.

    `channels`: 4, or 1 for the front one. `version`: version of the head or body, such as "6.0.0"; anything else counts
    as V6.
    """
    major = version.lstrip("Vv").split(".")[0]
    older = major.isdigit() and int(major) < FIRST_OF_CORNERS
    places = MAPS["older" if older else "V6"]
    return places if channels == len(places) else (places[FRONT],)


def read_samples(sound: bytes, channels: int, frames: int) -> array:
    """Interleaved samples of a block of 16 bit little-endian sound.

    Raises NaoError unless there are `frames` samples of each of `channels`.
    """
    samples = array("h")
    if len(sound) != channels * frames * samples.itemsize:
        raise NaoError(f"a block of {channels} channels and {frames} frames has {len(sound)} bytes")
    samples.frombytes(sound)
    if sys.byteorder == "big":
        samples.byteswap()
    return samples


@dataclass(frozen=True)
class BlockTime:
    """Time of a block's first sample, s."""

    robot: float  # robot's clock
    ros: float  # ROS time


class BlockClock:
    """Times of the blocks of one stream, and the number lost. For one thread.

    A block arrives with a varying delay. The quickest ones give the offset from the robot's clock to ROS time.
    """

    def __init__(self) -> None:
        self.lost = 0
        self._expected: float | None = None
        self._offset: float | None = None

    def restart(self) -> None:
        """Begin another stream: the time until its first block is no gap, and its clock may differ."""
        self._expected = self._offset = None

    def take(self, stamp: Sequence[float], duration: float, now: float) -> BlockTime:
        """Time of the next block.

        `stamp`: robot's time of its first sample: [s, us]. `duration`: s. `now`: ROS time of its arrival, s.
        """
        robot = stamp[0] + 1e-6 * stamp[1]
        since = 0.0 if self._expected is None else robot - self._expected
        if since < -GAP * duration:
            self._offset = None  # the robot's clock was set back
        elif since > GAP * duration:
            self.lost += round(since / duration)
        self._expected = robot + duration
        latest = now - self._expected
        self._offset = latest if self._offset is None else min(latest, self._offset + DRIFT * duration)
        return BlockTime(robot, robot + self._offset)


DEVICE, MEMORY = "ALAudioDevice", "ALMemory"
VERSIONS = ("RobotConfig/Head/Version", "RobotConfig/Body/Version")


@dataclass(frozen=True)
class Block:
    """A block of sound; its time is that of the first sample."""

    time: BlockTime
    rate: int  # Hz, of each channel
    places: tuple[int, ...]  # of each channel's microphone, as numbered in nao_library_msgs/AudioBuffer
    samples: Sequence[int]  # 16 bit, interleaved


class SoundReceiver(ALModule):
    """The module that the robot calls with each block."""

    def __init__(self, name: str, take: Callable[[int, int, Any, bytes], None]) -> None:
        """Register with the newest broker.

        `name`: name at the robot. `take`: gets channels, frames, time ([s, us]) and sound of each block, in the thread
        of the module.
        """
        self.__take = take
        super().__init__(name)

    def processRemote(self, channels: int, frames: int, stamp: Any, sound: bytes) -> None:  # noqa: N802  NAOqi's name
        self.__take(channels, frames, stamp, sound)


class Microphone:
    """Blocks of sound while they are wanted, also after a lost connection.

    The robot has to reach this host for it. If it cannot, the report and the log say so.
    """

    def __init__(self, robot: Any, name: str, clock: Any, sink: Callable[[Block], None]) -> None:
        """Start idle; the robot need not be connected yet.

        Args:
            name: Name of the module at the robot.
            clock: ROS time: `now()`.
            sink: Gets each block, in the thread of the module.
        """
        self._robot = robot
        self._name = name
        self._clock = clock
        self._sink = sink
        self._rate = min(FORMATS)
        self._version = ""
        self._broker: ALBroker | None = None
        self._receiver: SoundReceiver | None = None
        self._lock = threading.Lock()  # guards the clock of the blocks and the times of the last one
        self._blocks = BlockClock()
        self._count = 0
        self._last = (0.0, 0.0)
        self._silent = False
        self._hearing = LazySubscription(robot, "microphones", self._begin, self._end, self._is_alive)

    def want(self, wanted: bool) -> None:
        self._hearing.want(wanted)

    def set_rate(self, rate: int) -> None:
        """Change the rate, Hz; raises NaoError if the robot does not have it."""
        if rate not in FORMATS:
            allowed = " or ".join(f"{each} ({channels})" for each, channels in RATES.items())
            raise NaoError(f"frequency is {rate!r}: {allowed}")
        if rate != self._rate:
            self._rate = rate
            self._hearing.restart()

    def report(self) -> Report:
        with self._lock:
            values = {
                "frequency (Hz)": str(self._rate),
                "blocks": str(self._count),
                "lost blocks": str(self._blocks.lost),
            }
        report = self._hearing.report("no subscriber", "heard", "the microphones cannot be heard", values)
        if self._silent and report.level is Level.OK and self._hearing.wanted:
            return Report(Level.ERROR, self._silence(), report.values)
        return report

    def close(self) -> None:
        self._hearing.close()
        if self._broker is not None:
            self._broker.shutdown()

    # --- in the thread of the demand ------------------------------------------------------------------------------

    def _begin(self) -> None:
        self._serve()
        self._version = self._read_version()
        rate = self._rate
        self._ask("setClientPreferences", self._name, rate, FORMATS[rate][0], 0)
        with self._lock:
            self._blocks.restart()
            self._note_life()
        self._ask("subscribe", self._name)

    def _end(self) -> None:
        self._ask("unsubscribe", self._name)

    def _serve(self) -> None:
        """Register the module that the robot calls.

        Raises NaoError if that fails or is not done yet: the broker registers again at a robot that was lost.
        """
        connection = self._robot.connection
        if self._broker is None:
            self._broker = ALBroker(f"{self._name}_broker", "", 0, connection.host, connection.port)
        if self._receiver is None:
            self._receiver = SoundReceiver(self._name, self._take)
        if self._name not in connection.module_names():
            raise NaoError(f"the robot does not know the module {self._name} yet")

    def _read_version(self) -> str:
        try:
            values = ask(self._robot, MEMORY, "getListData", list(VERSIONS))
        except UnknownModule:
            return ""
        return next((value for value in values if isinstance(value, str) and value), "")

    def _ask(self, method: str, *arguments: Any) -> None:
        ask(self._robot, DEVICE, method, *arguments)

    def _is_alive(self) -> bool:
        """Whether blocks come. On a simulation that stands still, none are due."""
        with self._lock:
            wall, ros = self._last
        quiet = min(self._robot.connection.answering_time() - wall, self._clock.now() - ros)
        if quiet < STREAM_LIMIT:
            return True
        if not self._silent:
            log.warning("%s", self._silence())
        self._silent = True
        return False

    def _silence(self) -> str:
        where = f"{self._broker.getIP()}:{self._broker.getPort()}" if self._broker is not None else "this host"
        return f"no sound comes from the microphones: the robot has to reach this program at {where}"

    def _note_life(self) -> None:
        self._last = (self._robot.connection.answering_time(), self._clock.now())

    # --- in the thread of the module ------------------------------------------------------------------------------

    def _take(self, channels: int, frames: int, stamp: Any, sound: bytes) -> None:
        rate = next((rate for rate, (_, count) in FORMATS.items() if count == channels), self._rate)
        samples = read_samples(sound, channels, frames)
        with self._lock:
            self._note_life()
            block_time = self._blocks.take(stamp, frames / rate, self._last[1])
            self._count += 1
        if self._silent:
            self._silent = False
            log.info("the microphones are heard again")
        if self._hearing.wanted:
            self._sink(Block(block_time, rate, channel_map(channels, self._version), samples))


QUEUE = 50


class NaoMicrophone:
    """Publishes blocks of 170 ms while it has subscribers; otherwise the robot sends nothing.

    ROS API:
        Publishes `~audio_raw` (nao_library_msgs/AudioBuffer), stamped with the time of its first sample.
        Parameters, also by dynamic_reconfigure: `~frequency` (16000 Hz: the front microphone; 48000 Hz: all four),
        `~use_ros_time` (true: stamps in ROS time; false: stamps of the robot's own clock. Default true; false on
        simulated time, which is the clock of the simulated robot). `~frame_id` (Head, after `tf_prefix`).
    """

    def __init__(self, robot: Any, node: NodeInterface) -> None:
        self._use_ros_time = True
        self._frame = frame_parameter(node, "~frame_id", "Head")
        self._microphone = Microphone(robot, name_for_robot(node.name), RosClock(), self._publish)
        node.if_it_fails(self._microphone.close)
        fields = (
            ReconfigureField(
                "frequency", min(FORMATS), "samples a second and channel", min(FORMATS), max(FORMATS), RATES
            ),
            ReconfigureField(
                "use_ros_time", is_wallclock(), "whether stamps are in ROS time, instead of the robot's own"
            ),
        )
        self._server = serve(node, fields, self._changed)
        self._audio = node.publisher("~audio_raw", AudioBuffer, queue_size=QUEUE)
        self._lazy = LazyTopic(self._microphone.want, self._audio)

    def reports(self) -> dict[str, Callable[[], Report]]:
        return {"microphones": self._microphone.report}

    def close(self) -> None:
        self._microphone.close()

    def _changed(self, _before: Mapping[str, Any], after: Mapping[str, Any]) -> Mapping[str, Any]:
        self._microphone.set_rate(after["frequency"])
        self._use_ros_time = after["use_ros_time"]
        return after

    def _publish(self, block: Block) -> None:
        message = AudioBuffer(frequency=block.rate, channelMap=bytes(block.places), data=block.samples)
        message.header.stamp = rospy.Time.from_sec(block.time.ros if self._use_ros_time else block.time.robot)
        message.header.frame_id = self._frame
        publish(self._audio, message)

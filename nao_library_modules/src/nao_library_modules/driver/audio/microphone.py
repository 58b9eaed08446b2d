"""The robot's microphones, heard while somebody listens. No ROS."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from naoqi import ALBroker, ALModule
from naoqi.errors import NaoError, UnknownModule
from naoqi.limits import ANSWER_LIMIT, STREAM_LIMIT

from ...ros.health import Level, Report
from ..base.lazy_subscription import LazySubscription
from .microphone_blocks import FORMATS, RATES, BlockClock, BlockTime, channel_map, read_samples

log = logging.getLogger(__name__)

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

    The robot has to reach this computer for it. If it cannot, the report and the log say so.
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
        report = self._hearing.report("nobody listens", "heard", "the microphones cannot be heard", values)
        if self._silent and report.message == "heard":
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
            values = self._robot.proxy(MEMORY).call_async("getListData", list(VERSIONS)).result(timeout=ANSWER_LIMIT)
        except UnknownModule:
            return ""
        return next((value for value in values if isinstance(value, str) and value), "")

    def _ask(self, method: str, *arguments: Any) -> None:
        self._robot.proxy(DEVICE).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)

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
        where = f"{self._broker.getIP()}:{self._broker.getPort()}" if self._broker is not None else "this computer"
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

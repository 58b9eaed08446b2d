"""Calls to the robot that last as long as something sounds: waited for, ended, left to go on."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import CallCanceled, NaoError

from ..audio.sound_card import NaoAudio
from ..base.cancellation import CancellationToken
from ..robot.robot import QUICK_ANSWER
from ..robot.robot_clock import RobotClock
from ..robot.robot_task import end_call, wait_for_call
from ..server.simulated_keys import SimulatedKey
from .voices import SPEECH

log = logging.getLogger(__name__)

PLAYER, ANIMATED = "ALAudioPlayer", "ALAnimatedSpeech"
TIMES = "NaoSimulation/SoundTimes"
"""A key of simulated robots: [onset, end] of the sound that ALAudioPlayer played last, s of the robot."""
# Modules that have no `stopAll`, and the one whose it is.
SILENCED_BY = {ANIMATED: SPEECH}
FALSE_START = 0.05
"""s that a sound in the background has to fail, when it cannot begin: then the function fails."""


@dataclass(frozen=True)
class Sounding:
    """Something that sounds in the background.

    Attributes:
        module: NAOqi module that it is of.
        call: The call that ends with it.
    """

    module: str
    call: Any


class Sounds(NaoAudio):
    """Sounds of a module, each a call that ends with it. To be mixed into NaoBasic.

    The thread that executes goals begins sounds; the end of the node silences them from another.
    """

    interrupt: CancellationToken  # of NaoBasic
    clock: Any  # of NaoBasic
    happened: tuple[float, float]  # of NaoBasic
    robot_clock: RobotClock  # of NaoBasic

    def start_sounds(self) -> None:
        """Nothing sounds yet: for the constructor of the module."""
        self._player_times = SimulatedKey(self.robot, TIMES)
        self._lock = threading.Lock()  # guards the two lists
        self._begun: list[Sounding] = []  # in the background, by this chain
        self._left: list[Sounding] = []  # by chains that succeeded

    def sound(
        self,
        module: str,
        method: str,
        *args: Any,
        duration: float = 0.0,
        background: bool = False,
        ended: Callable[[], None] = lambda: None,
    ) -> float:
        """Begin a sound, and wait until it is over; preemption silences it.

        Args:
            module: NAOqi module.
            method: Its method that takes as long as the sound.
            args: Its arguments.
            duration: s after which the sound is ended, if it is still there; 0: never.
            background: Whether it is not waited for.
            ended: Called when a sound in the background is over, from a thread of libqi.

        Returns:
            How long it sounded, s; 0 in the background.

        Raises:
            NaoError: If the call fails.
            Preempted: Or whatever reason the interrupt has.
        """
        self.interrupt.check()
        call = self.robot.proxy(module).call_async(method, *args)
        sounding = Sounding(module, call)
        if background:
            call.add_done_callback(lambda _: ended())
            self._leave(sounding)
            return 0.0
        began = self.clock.now()
        if not call.wait(QUICK_ANSWER):  # quicker than to set up the wait for both
            self._wait(call, began, duration)
        if not call.done():
            self._end(sounding)
            self.interrupt.check()
        else:
            call.result(timeout=0)
        ended = max(began, self.clock.now())
        if module == PLAYER:
            began, ended = self.happened = self._played(began, ended)
        return ended - began

    def wait_for_sounds(self) -> None:
        """Wait until nothing sounds that goals of this server have left in the background.

        Raises:
            NaoError: Of a sound that failed.
            Preempted: Or whatever reason the interrupt has.
        """
        for sounding in self._background():
            if not wait_for_call(sounding.call, self.interrupt):
                self.interrupt.check()
            sounding.call.result(timeout=0)

    def begin_sounds(self) -> None:
        """A chain begins: what earlier ones left sounds on."""
        with self._lock:
            self._left = [sounding for sounding in self._left + self._begun if not sounding.call.done()]
            self._begun = []

    def end_sounds(self, keep: bool) -> None:
        """A chain is over.

        Args:
            keep: Whether what it began in the background sounds on.
        """
        if not keep:
            with self._lock:
                begun, self._begun = self._begun, []
            self._silence(begun)

    def silence(self) -> None:
        """Silence everything that goals of this server have left in the background; raises nothing."""
        with self._lock:
            sounding, self._left, self._begun = self._left + self._begun, [], []
        self._silence(sounding)

    # Inside

    def _played(self, began: float, ended: float) -> tuple[float, float]:
        """When a sound was played, ROS times, s: no robot tells that, so its call counts, with what loading takes."""
        onset = offset = 0.0
        if self._player_times.known(self.call):
            onset, offset = self._player_times.span(self.call, self.robot_clock, began)
        return onset or began, offset or ended

    def _background(self) -> list[Sounding]:
        with self._lock:
            return [*self._left, *self._begun]

    def _leave(self, sounding: Sounding) -> None:
        """Let a sound go on; a file that is not there is told at once."""
        with self._lock:
            self._begun.append(sounding)
        if sounding.call.wait(FALSE_START):
            sounding.call.result(timeout=0)
        else:
            sounding.call.add_done_callback(_tell_failure)

    def _wait(self, call: Any, began: float, duration: float) -> None:
        if duration <= 0.0:
            wait_for_call(call, self.interrupt)
            return
        news = CancellationToken()
        call.add_done_callback(lambda _: news.trigger())
        with self.interrupt.waking(news.trigger):
            left = began + duration - self.clock.now()
            self.clock.wait(min(duration, max(0.0, left)), news)  # not longer where the clock was set back

    def _silence(self, soundings: list[Sounding]) -> None:
        for sounding in soundings:
            if not sounding.call.done():
                self._end(sounding)

    def _end(self, sounding: Sounding) -> None:
        """Cancel the call and see it end; on a robot whose calls go on, everything of the module is silenced."""
        module = SILENCED_BY.get(sounding.module, sounding.module)
        end_call(sounding.call, lambda: self.call_now(self.robot.proxy(module), "stopAll"))


def _tell_failure(call: Any) -> None:
    """Say in the log that a sound in the background failed; runs in a thread of libqi."""
    try:
        call.result(timeout=0)
    except CallCanceled:
        pass
    except NaoError as error:
        log.warning("a sound in the background failed: %s", error)

"""Calls to the robot that last as long as something sounds: waited for, ended, left to go on. Loaded sounds."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from naoqi.errors import CallCanceled, NaoError

from ..base.cancellation import CancellationToken
from ..base.errors import BadGoal
from ..base.once_per_connection import OncePerConnection
from ..functions.parts import Part
from ..robot.robot import QUICK_ANSWER
from ..robot.robot_task import end_call, wait_for_call
from ..server.nao_basic import NaoBasic
from ..server.simulated_keys import SimulatedKey

log = logging.getLogger(__name__)

PLAYER, SPEECH, ANIMATED = "ALAudioPlayer", "ALTextToSpeech", "ALAnimatedSpeech"
TIMES = "NaoSimulation/SoundTimes"
"""A key of simulated robots: [onset, end] of the sound that ALAudioPlayer played last, s of the robot."""
# Modules that have no `stopAll`, and the one whose it is.
SILENCED_BY = {ANIMATED: SPEECH}
FALSE_START = 0.05
"""s that a sound in the background has to fail, when it cannot begin: then the function fails."""


@dataclass(frozen=True)
class Sounding:
    """Something that sounds in the background."""

    module: str  # of NAOqi
    call: Any  # ends with the sound


class Sounds(Part):
    """Sounds of a module, each a call that ends with it, and account of the files that the chain played or wrote.

    The thread that executes goals begins sounds; the end of the node silences them from another. `file_names`: files
    that the chain played or wrote, in order. `durations`: how long each was to be heard, or of a file that was written,
    how long it is, s.
    """

    def __init__(self, module: NaoBasic) -> None:
        self._module = module
        self._player_times = SimulatedKey(module.robot, TIMES)
        self._lock = threading.Lock()  # guards the two lists
        self._begun: list[Sounding] = []  # in the background, by this chain
        self._left: list[Sounding] = []  # by chains that succeeded
        self.file_names: list[str] = []
        self.durations: list[float] = []

    def note_file(self, name: str, duration: float) -> None:
        """Note a file that was played or written."""
        self.file_names.append(name)
        self.durations.append(max(0.0, duration))

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

        Returns how long it sounded, s; 0 in the background. Raises NaoError if the call fails; Preempted, or whatever
        reason the interrupt has.

        Args:
            module: NAOqi module.
            method: Its method that takes as long as the sound.
            duration: s after which the sound is ended, if it is still there; 0: never.
            background: Whether it is not waited for.
            ended: Called when a sound in the background is over, from a thread of libqi.
        """
        self._module.interrupt.check()
        call = self._module.robot.proxy(module).call_async(method, *args)
        sounding = Sounding(module, call)
        if background:
            call.add_done_callback(lambda _: ended())
            self._leave(sounding)
            return 0.0
        began = self._module.clock.now()
        if not call.wait(QUICK_ANSWER):  # quicker than to set up the wait for both
            self._wait(call, began, duration)
        if not call.done():
            self._end(sounding)
            self._module.interrupt.check()
        else:
            call.result(timeout=0)
        ended = max(began, self._module.clock.now())
        if module == PLAYER:
            began, ended = self._module.happened = self._played(began, ended)
        return ended - began

    def wait_for_background(self) -> None:
        """Wait until nothing sounds that goals of this server have left in the background.

        Raises NaoError of a sound that failed; Preempted, or whatever reason the interrupt has.
        """
        with self._lock:
            background = [*self._left, *self._begun]
        for sounding in background:
            if not wait_for_call(sounding.call, self._module.interrupt):
                self._module.interrupt.check()
            sounding.call.result(timeout=0)

    def begin_chain(self) -> None:
        """Forget the files of the last chain; what it left in the background sounds on."""
        self.file_names, self.durations = [], []
        with self._lock:
            self._left = [sounding for sounding in self._left + self._begun if not sounding.call.done()]
            self._begun = []

    def silence_chain(self) -> None:
        """Silence what the chain has left in the background."""
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
        """When a sound was played, ROS times, s: no robot reports that, so its call counts, with what loading takes."""
        onset = offset = 0.0
        if self._player_times.known(self._module.call):
            onset, offset = self._player_times.span(self._module.call, self._module.robot_clock, began)
        return onset or began, offset or ended

    def _leave(self, sounding: Sounding) -> None:
        """Let a sound go on; a file that is not there fails at once."""
        with self._lock:
            self._begun.append(sounding)
        if sounding.call.wait(FALSE_START):
            sounding.call.result(timeout=0)
        else:
            sounding.call.add_done_callback(_log_failure)

    def _wait(self, call: Any, began: float, duration: float) -> None:
        if duration <= 0.0:
            wait_for_call(call, self._module.interrupt)
            return
        news = CancellationToken()
        call.add_done_callback(lambda _: news.trigger())
        with self._module.interrupt.waking(news.trigger):
            left = began + duration - self._module.clock.now()
            self._module.clock.wait(min(duration, max(0.0, left)), news)  # not longer where the clock was set back

    def _silence(self, soundings: list[Sounding]) -> None:
        for sounding in soundings:
            if not sounding.call.done():
                self._end(sounding)

    def _end(self, sounding: Sounding) -> None:
        """Cancel the call and see it end; on a robot whose calls go on, everything of the module is silenced."""
        module = SILENCED_BY.get(sounding.module, sounding.module)
        end_call(sounding.call, lambda: self._module.call_now(self._module.robot.proxy(module), "stopAll"))


class LoadedSounds:
    """Ids of sounds that this server has loaded, by the names of their files; forgotten with the connection.

    A new connection may lead to a robot that has loaded nothing.
    """

    def __init__(self, robot: Any) -> None:
        self._ids: OncePerConnection[dict[str, int]] = OncePerConnection(robot, dict)

    @property
    def names(self) -> list[str]:
        """Names of the loaded files, the last one loaded last."""
        return list(self._ids())

    def add(self, name: str, number: int) -> None:
        """Add a file; of a name that was loaded before, the new id counts."""
        self.remove(name)
        self._ids()[name] = number

    def remove(self, name: str) -> None:
        self._ids().pop(name, None)

    def clear(self) -> None:
        self._ids().clear()

    def number(self, name: str) -> int:
        """Id of a loaded file; of the one loaded last without a name.

        Raises BadGoal if there is none: the chain was checked, but the robot may have been exchanged since.
        """
        names = self.names
        if not names or (name and name not in names):
            problem = f"{name!r} is not loaded any more" if name else "no sound is loaded any more"
            raise BadGoal("str_param", name, "loadFile comes first", problem=problem)
        return self._ids()[name or names[-1]]

    def name(self, number: int) -> str:
        """Name of the loaded file of an id; the id as text if others have loaded it."""
        return next((name for name, each in self._ids().items() if each == number), str(number))


def _log_failure(call: Any) -> None:
    """Say in the log that a sound in the background failed; runs in a thread of libqi."""
    try:
        call.result(timeout=0)
    except CallCanceled:
        pass
    except NaoError as error:
        log.warning("a sound in the background failed: %s", error)

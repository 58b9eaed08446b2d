"""ALFrameManager of the simulated robot: behaviours and timelines of Choregraphe by number. Only NAOqi methods."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass

from nao_sim_bridge.base.errors import NotAllowed, UnknownName
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.packages import read_package
from nao_sim_bridge.behaviors.reader import checked_name
from nao_sim_bridge.behaviors.steps import Behavior, Step, length_of
from nao_sim_bridge.behaviors.xar import xar_step
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors

NAME = "ALFrameManager"
# What Choregraphe calls the project that it has sent to the robot last.
UPLOADED = ".lastUploadedChoregrapheBehavior"
# A timeline alone becomes that of a box.
WRAPPED = '<ChoregrapheProject><Box name="timeline" id="1">{}</Box></ChoregrapheProject>'


@dataclass(frozen=True)
class _Made:
    behavior: Behavior
    path: str


class ALFrameManager:
    """ALFrameManager as the simulated robot offers it, without what NAOqi has had no use for since 1.14.

    The behaviours that it makes are run under their ids. Their memory counts with that of the installed ones.
    """

    def __init__(self, running: RunningBehaviors, runner: RobotRunner, files: ClientFiles) -> None:
        self._running = running
        self._runner = runner
        self._files = files
        self._lock = threading.Lock()
        self._ids = itertools.count(1)
        self._made: dict[str, _Made] = {}

    # --- making ---------------------------------------------------------------------------------------------------

    def createBehavior(self, package: str, path: str, name: str) -> str:
        return self.newBehaviorFromFile(f"{package.rstrip('/')}/{path.lstrip('/')}", name)

    def newBehavior(self, path: str, xml: str) -> str:
        """From the text of a behavior.xar."""
        return self._make(xar_step(xml.encode(), path or "text"), path)

    def newBehaviorFromFile(self, path: str, name: str) -> str:
        checked_name(name, "behName")
        return self._make(read_package(self._files.to_read(path))[0].step, path)

    def newBehaviorFromChoregraphe(self) -> str:
        """Of the project that Choregraphe has sent last, which is installed under a name of its own."""
        behavior = self._running.installed.resolve(UPLOADED)
        return self._make(behavior.step, behavior.name)

    def createTimeline(self, content: str) -> str:
        """From a Timeline element with its ActuatorList."""
        return self._make(xar_step(WRAPPED.format(content).encode(), "timeline"), "timeline")

    def deleteBehavior(self, number: str) -> Task:
        made = self._of(number)
        with self._lock:
            self._made.pop(number, None)
            self._running.installed.release([f"/{number}"])
        return self._stop([made.behavior.name], "deleteBehavior")

    def cleanBehaviors(self) -> Task:
        with self._lock:
            names = list(self._made)
            self._made.clear()
            self._running.installed.release([f"/{name}" for name in names])
        return self._stop(names, "cleanBehaviors")

    # --- playing --------------------------------------------------------------------------------------------------

    def playBehavior(self, number: str) -> Task:
        behavior = self._of(number).behavior
        return self._runner.execute(lambda: self._running.start(behavior), "playBehavior").then(lambda _: None)

    playTimeline = playBehavior

    def completeBehavior(self, number: str) -> Task:
        """Ends with the behaviour."""
        behavior = self._of(number).behavior
        return self._runner.execute(lambda: self._running.start(behavior), "completeBehavior")

    def exitBehavior(self, number: str) -> Task:
        return self._stop([self._of(number).behavior.name], "exitBehavior")

    stopTimeline = exitBehavior

    # --- looking --------------------------------------------------------------------------------------------------

    def behaviors(self) -> list[str]:
        return list(self._made)

    def isBehaviorRunning(self, number: str) -> bool:
        return self._of(number).behavior.name in self._running.names

    def getBehaviorPath(self, number: str) -> str:
        return self._of(number).path

    def getMotionLength(self, number: str) -> float:
        return length_of(self._of(number).behavior.step)

    def _make(self, step: Step, path: str) -> str:
        most = load_sizes().behaviors.made
        with self._lock:
            if len(self._made) >= most:
                raise NotAllowed(f"there are {most} behaviors already: deleteBehavior or cleanBehaviors first")
            number = f"FrameManager/{next(self._ids)}"
            self._running.installed.hold(f"/{number}", step)
            self._made[number] = _Made(Behavior(number, step, path), path)
        return number

    def _of(self, number: str) -> _Made:
        with self._lock:
            if number not in self._made:
                raise UnknownName("behavior id", number, self._made)
            return self._made[number]

    def _stop(self, names: list[str], call: str) -> Task:
        return self._runner.execute(lambda: self._running.stop_those(names), call)

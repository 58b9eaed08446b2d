"""ALBehaviorManager of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

import logging
import threading
from pathlib import Path
from typing import Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles, IsFolder, NoSuchFile
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.packages import BEHAVIOR_FILE, MANIFEST, read_package, renamed
from nao_sim_bridge.behaviors.steps import Behavior, Refused
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.behaviors.running import RUN, RunningBehaviors
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALBehaviorManager"
ADDED, REMOVED, UPDATED = (f"{NAME}/Behavior{what}" for what in ("Added", "Removed", "Updated"))
log = logging.getLogger("nao_sim.behaviors")
SEVERAL_ADDED = f"{NAME}/BehaviorsAdded"


class ALBehaviorManager:
    """ALBehaviorManager as the simulated robot offers it.

    Behaviours that are installed, and the list of default behaviours, are kept as long as the simulator runs.
    """

    def __init__(self, running: RunningBehaviors, runner: RobotRunner, memory: MemoryStore, files: ClientFiles) -> None:
        self._running = running
        self._installed = running.installed
        self._runner = runner
        self._memory = memory
        self._files = files
        self._lock = threading.Lock()
        self._preloaded: list[str] = []
        self._defaults: list[str] = []
        for event in (RUN, ADDED, REMOVED, UPDATED, SEVERAL_ADDED):
            memory.declare_event(event, NAME)

    # --- what there is --------------------------------------------------------------------------------------------

    def getBehaviorNames(self) -> list[str]:
        return list(self._installed.all)

    getInstalledBehaviors = getBehaviorNames

    def getSystemBehaviorNames(self) -> list[str]:
        return sorted(self._installed.system)

    def getUserBehaviorNames(self) -> list[str]:
        return sorted(self._installed.user)

    def isBehaviorInstalled(self, name: str) -> bool:
        return self._installed.knows(name)

    isBehaviorPresent = isBehaviorInstalled

    def resolveBehaviorName(self, name: str) -> str:
        return self._installed.resolve(name).name

    def getBehaviorNature(self, name: str) -> str:
        return self._installed.resolve(name).nature

    def getBehaviorTags(self, name: str) -> list[str]:
        return list(self._installed.resolve(name).tags)

    def getBehaviorsByTag(self, tag: str) -> list[str]:
        return [b.name for b in self._installed.all.values() if tag.lower() in map(str.lower, b.tags)]

    def getTagList(self) -> list[str]:
        return sorted({tag for behavior in self._installed.all.values() for tag in behavior.tags})

    # --- coming and going -----------------------------------------------------------------------------------------

    def installBehavior(
        self, path: str, name: str | None = None, overwrite: bool = True, gone: Sequence[str] = ()
    ) -> bool:
        """A file, or the folder of a package, in the folder for files of clients; see docs/robot_behaviors.md.

        Args:
            gone: Names in full of behaviours that are removed if all goes well.
        """
        behaviors = read_package(self._file(path))
        if name:
            behaviors = renamed(behaviors, name)
        added, updated = self._installed.install(behaviors, overwrite, gone)
        for behavior in behaviors:
            if isinstance(behavior.step, Refused):
                log.warning(
                    "%s is installed with the others, but it fails when it runs: %s",
                    behavior.name,
                    behavior.step.reason,
                )
        if gone:
            self._end(gone)
        for event, names in ((ADDED, added), (UPDATED, updated)):
            for one in names:
                self._memory.raise_event(event, one)
        if added:
            self._memory.raise_event(SEVERAL_ADDED, added)
        return True

    def removeBehavior(self, name: str) -> Task:
        """Stops it, too."""
        return self._end(self._installed.remove(name))

    def preloadBehavior(self, name: str) -> bool:
        full = self._installed.resolve(name).name
        with self._lock:
            if full not in self._preloaded:
                self._preloaded.append(full)
        return True

    def getLoadedBehaviors(self) -> list[str]:
        with self._lock:
            return list(dict.fromkeys([*self._preloaded, *self._running.names]))

    def isBehaviorLoaded(self, name: str) -> bool:
        return self._installed.resolve(name).name in self.getLoadedBehaviors()

    # --- running --------------------------------------------------------------------------------------------------

    def runBehavior(self, name: str) -> Task:
        """Ends with the behaviour, also when somebody stops it."""
        behavior = self._installed.resolve(name)
        return self._runner.execute(lambda: self._running.start(behavior), "runBehavior")

    def startBehavior(self, name: str) -> Task:
        return self._start([self._installed.resolve(name)], "startBehavior")

    def stopBehavior(self, name: str) -> Task:
        full = self._installed.resolve(name).name
        return self._runner.execute(lambda: self._running.stop(full), "stopBehavior")

    def stopAllBehaviors(self) -> Task:
        return self._runner.execute(self._running.stop_all, "stopAllBehaviors")

    def getRunningBehaviors(self) -> list[str]:
        return self._running.names

    def isBehaviorRunning(self, name: str) -> bool:
        return self._installed.resolve(name).name in self._running.names

    # --- default behaviours ---------------------------------------------------------------------------------------

    def addDefaultBehavior(self, name: str) -> None:
        full = self._installed.resolve(name).name
        with self._lock:
            if full not in self._defaults:
                self._defaults.append(full)

    def removeDefaultBehavior(self, name: str) -> None:
        full = self._installed.resolve(name).name
        with self._lock:
            if full not in self._defaults:
                raise BadValue("behavior", name, f"one of the default behaviors: {', '.join(self._defaults) or 'none'}")
            self._defaults.remove(full)

    def getDefaultBehaviors(self) -> list[str]:
        with self._lock:
            return list(self._defaults)

    def playDefaultProject(self) -> Task:
        behaviors = [self._installed.resolve(name) for name in self.getDefaultBehaviors()]
        return self._start([b for b in behaviors if b.name not in self._running.names], "playDefaultProject")

    def _end(self, gone: Sequence[str]) -> Task:
        """Stop and forget behaviours that are installed no more."""
        with self._lock:
            self._preloaded = [one for one in self._preloaded if one not in gone]
            self._defaults = [one for one in self._defaults if one not in gone]

        def stop() -> bool:
            self._running.stop_those(gone)
            for one in gone:
                self._memory.raise_event(REMOVED, one)
            return True

        return self._runner.execute(stop, "removeBehavior")

    def _start(self, behaviors: Sequence[Behavior], call: str) -> Task:
        def start() -> None:
            for behavior in behaviors:
                self._running.start(behavior)

        return self._runner.execute(start, call)

    def _file(self, path: str) -> Path:
        try:
            return self._files.to_read(path)
        except IsFolder as error:  # the folder of a package is known by its manifest
            manifest = f"{path.rstrip('/')}/{MANIFEST}"
            try:
                return self._files.to_read(manifest)
            except NoSuchFile:
                raise NoSuchFile(
                    f"folder {path!r} has no {MANIFEST}, which the folder of a package has; install a single behavior "
                    f"by its file: {path.rstrip('/')}/{BEHAVIOR_FILE}"
                ) from error

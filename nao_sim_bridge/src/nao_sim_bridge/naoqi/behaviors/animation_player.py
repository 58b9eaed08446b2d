"""ALAnimationPlayer of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

import random
import threading
from typing import Mapping, Sequence

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.steps import Behavior
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.speech.animations import ANIMATIONS, FOLDERS, folder_of, is_for, paths_of

NAME = "ALAnimationPlayer"


class ALAnimationPlayer:
    """ALAnimationPlayer as the simulated robot offers it: an animation is a behaviour whose name says its posture."""

    def __init__(self, running: RunningBehaviors, runner: RobotRunner) -> None:
        self._running = running
        self._runner = runner
        self._chance = random.Random(runner.simulation.scene.seed)
        self._tags: dict[str, dict[str, None]] = {}
        self._lock = threading.Lock()
        self._paths: list[str] = [ANIMATIONS]

    def run(self, path: str) -> Task:
        """Ends with the animation; [posture] in the path stands for that of the robot, [robot] for NAO."""
        installed, paths = self._running.installed, paths_of(path, self._posture())
        known = next((each for each in paths if installed.knows(each)), paths[0])
        return self._play(installed.resolve(known), "run")

    def runTag(self, first: str, second: str | None = None) -> Task:
        """(tag) or (path, tag): one of the animations of a tag, for the posture of the robot or of a path.

        A path may also be a posture: Stand, Sit or SitOnPod.
        """
        posture, tag = self._posture(), first if second is None else second
        if second is None:
            place, fitting = f"for the posture {posture}", self._tagged_for(posture, tag)
        elif first in FOLDERS.values():
            place, fitting = f"for the posture {first}", self._tagged_for(first, tag)
        else:
            place, fitting = f"in {first!r}", self._tagged(tag, paths_of(first, posture))
        if not fitting:
            raise NaoqiError(f"there is no animation with the tag {tag!r} {place}")
        return self._play(self._chance.choice(fitting), "runTag")

    def addTagForAnimations(self, tags: Mapping[str, Sequence[str]]) -> None:
        resolved = {tag: [self._running.installed.resolve(name).name for name in names] for tag, names in tags.items()}
        with self._lock:
            tagged = {tag: dict(names) for tag, names in self._tags.items()}
            for tag, names in resolved.items():
                tagged.setdefault(tag.lower(), {}).update(dict.fromkeys(names))
            _require_few(sum(map(len, tagged.values())), load_sizes().speech.tags, "tags of animations")
            self._tags = tagged

    def declarePathForTags(self, path: str) -> None:
        """Animations of the path are found by their tags, too; [posture] in it stands for the one that is asked for."""
        with self._lock:
            if path not in self._paths:
                _require_few(len(self._paths) + 1, load_sizes().speech.paths, "paths")
                self._paths.append(path)

    def reset(self) -> None:
        with self._lock:
            self._tags = {}
            self._paths = [ANIMATIONS]

    def _tagged_for(self, posture: str, tag: str) -> list[Behavior]:
        """Those below the declared paths that are made for a posture."""
        paths = [each for path in self._paths for each in paths_of(path, posture)]
        return [behavior for behavior in self._tagged(tag, paths) if is_for(behavior.name, posture)]

    def _tagged(self, tag: str, paths: Sequence[str]) -> list[Behavior]:
        added = self._tags.get(tag.lower(), ())
        return [
            behavior
            for name, behavior in self._running.installed.all.items()
            if name.startswith(tuple(paths)) and (name in added or tag.lower() in map(str.lower, behavior.tags))
        ]

    def _posture(self) -> str:
        return folder_of(recognise(self._runner.simulation.model, self._runner.snapshot).family)

    def _play(self, behavior: Behavior, call: str) -> Task:
        return self._runner.execute(lambda: self._running.start(behavior), call)


def _require_few(count: int, most: int, what: str) -> None:
    if count > most:
        raise NaoqiError(f"there would be {count} {what}, {most} at most: reset forgets them")

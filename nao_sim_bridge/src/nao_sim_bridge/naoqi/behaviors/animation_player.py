"""ALAnimationPlayer of the simulated robot. Only NAOqi methods live here."""

from __future__ import annotations

import random
from typing import Any, Mapping

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.steps import Behavior
from nao_sim_bridge.control.balance.posture_recognition import CROUCHING, ON_CHAIR, SITTING, STANDING, recognise
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.behaviors.running import RunningBehaviors
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.speech.animations import POSTURE_PATTERN

NAME = "ALAnimationPlayer"
# The folder of animations for each family of postures; NAOqi has none for crouching.
FOLDERS = {STANDING: "Stand", CROUCHING: "Stand", SITTING: "Sit", ON_CHAIR: "SitOnPod"}
ANIMATIONS = "animations/"


class ALAnimationPlayer:
    """ALAnimationPlayer as the simulated robot offers it: an animation is a behaviour whose name says its posture."""

    def __init__(self, running: RunningBehaviors, runner: RobotRunner) -> None:
        self._running = running
        self._runner = runner
        self._chance = random.Random(runner.simulation.scene.seed)
        self._tags: dict[str, list[str]] = {}
        self._paths: list[str] = [ANIMATIONS]

    def run(self, path: str) -> Task:
        """Ends with the animation; "[posture]" in the path stands for the posture that the robot is in."""
        behavior = self._running.installed.resolve(path.replace(POSTURE_PATTERN, self._posture()))
        return self._play(behavior, "run")

    def runTag(self, first: str, second: str | None = None) -> Task:
        """(tag) or (posture, tag): one of the animations of a tag, for the posture of the robot or for another one."""
        posture, tag = (self._posture(), first) if second is None else (first, second)
        fitting = self._tagged(tag, posture)
        if not fitting:
            raise NaoqiError(f"there is no animation with the tag {tag!r} for the posture {posture}")
        return self._play(self._chance.choice(fitting), "runTag")

    def addTagForAnimations(self, tags: Any) -> None:
        if not isinstance(tags, Mapping):
            raise BadValue("tagsToAnimations", tags, "a map of tags to lists of animations")
        resolved = {tag: [self._running.installed.resolve(name).name for name in names] for tag, names in tags.items()}
        for tag, names in resolved.items():
            self._tags.setdefault(tag.lower(), []).extend(names)

    def declarePathForTags(self, path: str) -> None:
        """Animations of the path are found by their tags, too."""
        if path not in self._paths:
            self._paths.append(path)

    def reset(self) -> None:
        self._tags.clear()
        self._paths = [ANIMATIONS]

    def _tagged(self, tag: str, posture: str) -> list[Behavior]:
        added = self._tags.get(tag.lower(), ())
        return [
            behavior
            for name, behavior in self._running.installed.all.items()
            if any(name.startswith(path) for path in self._paths)
            and (name in added or tag.lower() in map(str.lower, behavior.tags))
            and (not name.startswith(ANIMATIONS) or f"/{posture}/" in name)
        ]

    def _posture(self) -> str:
        family = recognise(self._runner.simulation.model, self._runner.snapshot).family
        return FOLDERS.get(family, FOLDERS[STANDING])

    def _play(self, behavior: Behavior, call: str) -> Task:
        return self._runner.execute(lambda: self._running.start(behavior), call)

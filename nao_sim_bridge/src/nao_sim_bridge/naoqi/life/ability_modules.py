"""The modules of single abilities: ALAutonomousBlinking, ALBackgroundMovement, ALListeningMovement, ALSpeakingMovement.

Life switches abilities by its state; each of these modules switches one at once, also while life is disabled.
"""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import lists_by_tag, one_of
from nao_sim_bridge.naoqi.life import abilities as ability_names
from nao_sim_bridge.naoqi.life.abilities import Abilities
from nao_sim_bridge.naoqi.life.movements import SpeakingMovement
from nao_sim_bridge.speech.animations import AnimationLibrary
from nao_sim_bridge.speech.body_language import CONTEXTUAL, RANDOM, BodyLanguage


class AbilityModule:
    """An ability that is switched on and off. Only NAOqi methods are public."""

    def __init__(self, abilities: Abilities, runner: RobotRunner, name: str) -> None:
        self._name = name
        self._abilities = abilities
        self._runner = runner

    def setEnabled(self, enabled: bool) -> Task:
        return self._runner.execute(lambda: self._switch(bool(enabled)), "setEnabled")

    def isEnabled(self) -> bool:
        return self._abilities.runs(self._name)

    def _switch(self, on: bool) -> None:
        self._abilities.switch(self._name, on)


class MovementModule(AbilityModule):
    """An ability that moves joints."""

    def __init__(self, abilities: Abilities, runner: RobotRunner, name: str, movement: Any) -> None:
        super().__init__(abilities, runner, name)
        self._movement = movement

    def isRunning(self) -> Task:
        """Whether the robot moves because of it now."""
        return self._runner.execute(lambda: self._movement.moves, "isRunning")


class ALSpeakingMovement(MovementModule):
    """Body language: of ALAnimatedSpeech, enabled at the start, and of ALTextToSpeech while it is switched on."""

    def __init__(
        self,
        abilities: Abilities,
        runner: RobotRunner,
        movement: SpeakingMovement,
        body_language: BodyLanguage,
        library: AnimationLibrary,
    ) -> None:
        super().__init__(abilities, runner, ability_names.SPEAKING, movement)
        self._body_language = body_language
        self._library = library

    def isEnabled(self) -> bool:
        return self._body_language.enabled

    def setMode(self, mode: str) -> None:
        self._body_language.way = one_of(mode, "mode", (RANDOM, CONTEXTUAL))

    def getMode(self) -> str:
        return self._body_language.way

    def addTagsToWords(self, tags: Any) -> None:
        for tag, words in lists_by_tag(tags, "tagsToWords").items():
            self._library.add_words(tag, words)

    def resetTagsToWords(self) -> None:
        self._library.forget_words()

    def _switch(self, on: bool) -> None:
        self._body_language.enabled = on
        super()._switch(on)

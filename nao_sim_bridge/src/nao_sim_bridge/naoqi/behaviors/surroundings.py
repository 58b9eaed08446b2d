"""What behaviours of Choregraphe need of the robot beside its body: languages, and events of ALMemory."""

from __future__ import annotations

import itertools
from typing import Any, Callable, Protocol

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.memory.store import MemoryStore


class Voice(Protocol):
    """Who has a language, by NAOqi's names: ALTextToSpeech, ALSpeechRecognition."""

    def getLanguage(self) -> str: ...

    def setLanguage(self, name: str) -> Any: ...


class BehaviorSurroundings:
    """See `Surroundings` of the player. Simulation thread only."""

    def __init__(
        self, runner: RobotRunner, memory: MemoryStore, speech: Voice, recognition: Callable[[], Voice]
    ) -> None:
        self._runner = runner
        self._memory = memory
        self._speech = speech
        self._recognition = recognition
        self._numbers = itertools.count(1)

    def language(self) -> str:
        return self._speech.getLanguage()

    def set_language(self, name: str) -> None:
        try:
            self._speech.setLanguage(name)
            self._recognition().setLanguage(name)
        except RuntimeError as error:
            raise SimulationError(str(error)) from error

    def listen(self, key: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        module, heard = f"behavior input {next(self._numbers)}", True

        def hear(_: str, value: Any, __: str) -> None:
            self._runner.execute(lambda: listener(value) if heard else None, "behavior")

        def silence() -> None:
            nonlocal heard
            if heard:
                heard = False
                self._memory.unsubscribe(key, module)

        try:
            self._memory.subscribe(key, module, hear)
        except RuntimeError as error:
            raise SimulationError(str(error)) from error
        return silence

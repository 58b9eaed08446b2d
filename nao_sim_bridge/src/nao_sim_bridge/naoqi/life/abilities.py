"""The autonomous abilities: each works while life does and it is enabled, or its own module says so.

Simulation thread only, but for what is read.
"""

from __future__ import annotations

from typing import Any, Callable, Mapping

from nao_sim_bridge.naoqi.binding.arguments import known

BLINKING, BACKGROUND, AWARENESS, LISTENING, SPEAKING = NAMES = (
    "AutonomousBlinking",
    "BackgroundMovement",
    "BasicAwareness",
    "ListeningMovement",
    "SpeakingMovement",
)
ALL = "All"


class Abilities:
    """Part of ALAutonomousLife: which abilities are enabled, and run; by name, what begins (True) and ends each."""

    def __init__(self, abilities: Mapping[str, Callable[[bool], Any]]) -> None:
        self._abilities = dict(abilities)
        self._enabled = dict.fromkeys(abilities, True)
        self._running = dict.fromkeys(abilities, False)
        self._alive = False

    def getAutonomousAbilitiesStatus(self) -> list[tuple[str, bool, bool]]:
        """Name, whether it is enabled, and whether it runs, of each."""
        return [(name, enabled, self._running[name]) for name, enabled in self._enabled.items()]

    def getAutonomousAbilityEnabled(self, name: str) -> bool:
        """Of "All": whether all are enabled."""
        return all(self._enabled[one] for one in self.named(name))

    def enable(self, name: str, enabled: bool) -> None:
        """Let an ability, or all of them, work while life does; an UnknownName when there is no such ability."""
        for one in self.named(name):
            self._enabled[one] = enabled
            self._run(one, self._alive and enabled)

    def switch(self, name: str, on: bool) -> None:
        """Switch an ability on or off, whether there is life or not; the next state of life decides anew."""
        self._enabled[name] = on
        self._run(name, on)

    def runs(self, name: str) -> bool:
        """Whether an ability is switched on, by life or by itself."""
        return self._running[name]

    def live(self, alive: bool) -> None:
        """Life begins or ends."""
        if alive != self._alive:
            self._alive = alive
            self.decide()

    def decide(self) -> None:
        """What is enabled works if there is life, and nothing else does."""
        for name, enabled in self._enabled.items():
            self._run(name, self._alive and enabled)

    def named(self, name: str) -> list[str]:
        """The ability of a name; "All": all of them. An UnknownName when there is no such ability."""
        if name == ALL:
            return list(self._abilities)
        return [known(name, "autonomous ability", [*self._abilities, ALL])]

    def _run(self, name: str, wanted: bool) -> None:
        if wanted != self._running[name]:
            self._running[name] = wanted
            self._abilities[name](wanted)

"""The autonomous abilities: each may be enabled, and works while life does. Simulation thread only."""

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
        """Switch an ability, or all of them; an UnknownName when there is no such ability."""
        for one in self.named(name):
            self._enabled[one] = enabled
        self._update()

    def live(self, alive: bool) -> None:
        """Life begins or ends."""
        self._alive = alive
        self._update()

    def named(self, name: str) -> list[str]:
        """The ability of a name; "All": all of them. An UnknownName when there is no such ability."""
        if name == ALL:
            return list(self._abilities)
        return [known(name, "autonomous ability", [*self._abilities, ALL])]

    def _update(self) -> None:
        for name, switch in self._abilities.items():
            wanted = self._alive and self._enabled[name]
            if wanted != self._running[name]:
                self._running[name] = wanted
                switch(wanted)

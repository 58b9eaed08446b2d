"""The autonomous abilities: each may be enabled, and works while life does. Simulation thread only."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Mapping

from nao_sim_bridge.base.errors import UnknownName

BLINKING, BACKGROUND, AWARENESS, LISTENING, SPEAKING = NAMES = (
    "AutonomousBlinking",
    "BackgroundMovement",
    "BasicAwareness",
    "ListeningMovement",
    "SpeakingMovement",
)
ALL = "All"


@dataclass(frozen=True)
class Ability:
    start: Callable[[], Any]
    stop: Callable[[], Any]


class Abilities:
    """Which abilities are enabled, and which run."""

    def __init__(self, abilities: Mapping[str, Ability]) -> None:
        self._abilities = dict(abilities)
        self._enabled = dict.fromkeys(abilities, True)
        self._running = dict.fromkeys(abilities, False)
        self._alive = False

    @property
    def status(self) -> list[tuple[str, bool, bool]]:
        """Name, whether it is enabled, and whether it runs, of each."""
        return [(name, enabled, self._running[name]) for name, enabled in self._enabled.items()]

    def enabled(self, name: str) -> bool:
        """Whether an ability is enabled; "All": whether all are.

        Raises:
            UnknownName: There is no such ability.
        """
        return all(self._enabled[one] for one in self._named(name))

    def check(self, name: str) -> None:
        """Whether there is such an ability.

        Raises:
            UnknownName: There is none.
        """
        self._named(name)

    def enable(self, name: str, enabled: bool) -> None:
        """Switch an ability, or all of them.

        Raises:
            UnknownName: There is no such ability.
        """
        for one in self._named(name):
            self._enabled[one] = enabled
        self._update()

    def live(self, alive: bool) -> None:
        """Life begins or ends."""
        self._alive = alive
        self._update()

    def _named(self, name: str) -> list[str]:
        if name == ALL:
            return list(self._abilities)
        if name not in self._abilities:
            raise UnknownName("autonomous ability", name, [*self._abilities, ALL])
        return [name]

    def _update(self) -> None:
        for name, ability in self._abilities.items():
            wanted = self._alive and self._enabled[name]
            if wanted != self._running[name]:
                self._running[name] = wanted
                (ability.start if wanted else ability.stop)()

"""The launch pad of autonomous life: facts about the robot and its surroundings, as keys of the memory."""

from __future__ import annotations

from typing import Any, Callable, Mapping

from nao_sim_bridge.base.errors import UnknownName
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.naoqi.life.life import DISABLED, FOCUSED, NEXT, Life
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.time_zone import TimeZone

PREFIX = "Launchpad/"
SUGGESTIONS = "AutonomousLife/LaunchSuggestions"
# The keys are written so often, s of simulated time.
PERIOD = 1.0
# A fall is recent for so long, s.
RECENT = 60.0
GROUPS = ("", "All")
Fact = Callable[[Snapshot], Any]


class Launchpad:
    """Part of ALAutonomousLife: writes the keys while it monitors and the robot lives.

    Simulation thread only, but for NAOqi's methods. `tracked` gives the person who is followed, -1 for nobody.
    """

    def __init__(
        self, simulation: Simulation, life: Life, memory: MemoryStore, tracked: Callable[[], int], zone: TimeZone
    ) -> None:
        self._monitors = True
        self._simulation = simulation
        self._life = life
        self._memory = memory
        self._tracked = tracked
        self._zone = zone
        self._previous_state = DISABLED
        self._previous_activity = ""
        self._fell: float | None = None
        self._next = 0.0
        self._at_focus: dict[str, Any] = {}
        self._plugins: Mapping[str, Mapping[str, Fact]] = self._facts()
        self._enabled = dict.fromkeys(self._plugins, True)
        memory.declare_event(SUGGESTIONS, "ALAutonomousLife")
        memory.listen("robotHasFallen", self._note_fall)
        memory.listen(NEXT, self._note_facts)
        memory.listen(FOCUSED, self._note_focus)
        life.entered.append(self._note_state)
        simulation.after_tick.append(self._tick)

    def getEnabledLaunchpadPlugins(self) -> list[str]:
        return [name for name, on in self._enabled.items() if on]

    def setLaunchpadPluginEnabled(self, name: str, enabled: bool) -> None:
        self._enabled[known(name, "launch pad plugin", self._enabled)] = bool(enabled)

    def getLaunchpadPluginsForGroup(self, group: str) -> list[str]:
        """Plugins are groups of themselves, and there is one of all."""
        return list(self._plugins) if group in GROUPS else [name for name in self._plugins if name == group]

    def isMonitoringLaunchpadConditions(self) -> bool:
        return self._monitors

    def startMonitoringLaunchpadConditions(self) -> None:
        self._monitors = True

    def stopMonitoringLaunchpadConditions(self) -> None:
        self._monitors = False

    def getFocusContext(self, key: str) -> Any:
        """What a key was when an activity was about to get the focus last."""
        name = key if key.startswith(PREFIX) else PREFIX + key
        if name not in self._at_focus:
            raise UnknownName("condition at the last focus", key, self._at_focus)
        return self._at_focus[name]

    def _facts(self) -> Mapping[str, Mapping[str, Fact]]:
        life = self._life
        recent = lambda now: self._fell is not None and now.time - self._fell < RECENT  # noqa: E731
        return {
            "Life": {
                "State": lambda _: life.state,
                "PreviousState": lambda _: self._previous_state,
                "LifeTime": lambda _: life.record.getLifeTime(),
            },
            "Activity": {
                "FocusedActivity": lambda _: life.focused,
                "PreviousActivity": lambda _: self._previous_activity,
            },
            "Posture": {
                "Posture": lambda now: recognise(self._simulation.model, now).posture,
                "PostureFamily": lambda now: recognise(self._simulation.model, now).family,
                "RobotFellRecently": recent,
            },
            "Temperature": {"HighestTemperature": lambda now: max(now.temperatures)},
            "Robot": {"RobotType": lambda _: "Nao"},
            "People": {"TrackedHumanIsLookingAtRobot": lambda _: self._tracked() >= 0},
            "Time": {
                unit.capitalize(): lambda _, unit=unit: getattr(self._zone.now(), unit)
                for unit in ("hour", "minute", "day", "month", "year")
            },
        }

    def _values(self, now: Snapshot) -> dict[str, Any]:
        on = (facts for name, facts in self._plugins.items() if self._enabled[name])
        return {PREFIX + key: fact(now) for facts in on for key, fact in facts.items()}

    def _tick(self, now: Snapshot) -> None:
        if not self._monitors or self._life.state == DISABLED or now.time < self._next:
            return
        self._next = now.time + PERIOD
        for key, value in self._values(now).items():
            self._memory.insert(key, value)

    def _note_fall(self, fallen: Any) -> None:
        if fallen:
            self._fell = self._simulation.time

    def _note_state(self, before: str) -> None:
        self._previous_state = before

    def _note_focus(self, activity: str) -> None:
        self._previous_activity = activity or self._previous_activity

    def _note_facts(self, _: str) -> None:
        self._at_focus = self._values(self._simulation.snapshot)

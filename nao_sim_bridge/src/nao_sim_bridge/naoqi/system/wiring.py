"""The modules that keep things for programs, put together. Each is made, and its code read, when it is first called."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Callable, Mapping

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.behaviors.behavior_manager import ALBehaviorManager
from nao_sim_bridge.naoqi.binding.api import qi_type
from nao_sim_bridge.naoqi.binding.later import Later
from nao_sim_bridge.naoqi.binding.signals import Signals
from nao_sim_bridge.naoqi.memory.store import MemoryStore

PREFERENCE_SIGNALS = {
    "preferenceAdded": "(ssm)",
    "preferenceUpdated": "(ssm)",
    "preferenceRemoved": "(ss)",
    "preferenceDomainRemoved": "(s)",
    "preferencesSynchronized": "()",
}
"""Signals by name, with libqi's letters of their values."""
PACKAGE_SIGNALS = {
    name.format(what): f"({qi_type('PackageInfo2')})"
    for what in ("Installed", "Removed")
    for name in ("onPackage{}2", "onPackage{}", "package{}")
}


class SystemModules:
    """ALPreferenceManager, ALKnowledge and their like of one robot."""

    def __init__(
        self,
        simulation: Simulation,
        broker: Any,
        files: ClientFiles,
        memory: MemoryStore,
        say: Callable[[str], Task],
        manager: ALBehaviorManager,
    ) -> None:
        self.modules: dict[str, Later] = {}
        self._add("ALPreferenceManager", "preference_manager", files, memory, signals=PREFERENCE_SIGNALS)
        self._add("ALPreferences", "preference_files", files, memory)
        self._add("ALKnowledge", "knowledge", files)
        self._add("ALLogger", "logger", files)
        self._add("ALNotificationManager", "notification_manager", memory, say)
        self._add("PackageManager", "package_manager", manager, files, signals=PACKAGE_SIGNALS)
        self._add("ALConnectionManager", "connection_manager", memory)
        self._add("ALLauncher", "launcher", broker)
        self._add("ALStore", "store", self._packages)
        self._add("ALResourceManager", "resource_manager", simulation, broker)

    def _add(self, module: str, file: str, *arguments: Any, signals: Mapping[str, str] | None = None) -> None:
        """Add a module, the class of its name in a file beside this one; it is given its signals last, if any."""
        raised = None if signals is None else Signals(signals)
        given = arguments if raised is None else (*arguments, raised)
        make = lambda: [getattr(import_module(f"{__package__}.{file}"), module)(*given)]  # noqa: E731
        self.modules[module] = Later(make, raised)

    def _packages(self) -> list[tuple[str, str]]:
        """Uuid and version of each that is installed."""
        return [package[:2] for package in self.modules["PackageManager"][0].packages2()]

"""The modules that keep things for programs, put together. Each is made, and its code read, when it is first called."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.core.simulation import Simulation
from nao_sim_bridge.naoqi.behaviors.behavior_manager import ALBehaviorManager
from nao_sim_bridge.naoqi.binding.api import qi_type
from nao_sim_bridge.naoqi.binding.later import Later, later
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
        preferences, packages = Signals(PREFERENCE_SIGNALS), Signals(PACKAGE_SIGNALS)
        self.modules: dict[str, Later] = {
            "ALPreferenceManager": later(
                "naoqi.system.preference_manager:ALPreferenceManager", files, memory, preferences, signals=preferences
            ),
            "ALPreferences": later("naoqi.system.preference_files:ALPreferences", files, memory),
            "ALKnowledge": later("naoqi.system.knowledge:ALKnowledge", files),
            "ALLogger": later("naoqi.system.logger:ALLogger", files),
            "ALNotificationManager": later("naoqi.system.notification_manager:ALNotificationManager", memory, say),
            "PackageManager": later(
                "naoqi.system.package_manager:PackageManager", manager, files, packages, signals=packages
            ),
            "ALConnectionManager": later("naoqi.system.connection_manager:ALConnectionManager", memory),
            "ALLauncher": later("naoqi.system.launcher:ALLauncher", broker),
            "ALStore": later("naoqi.system.store:ALStore", self._packages),
            "ALResourceManager": later("naoqi.system.resource_manager:ALResourceManager", simulation, broker),
        }

    def _packages(self) -> list[tuple[str, str]]:
        """Uuid and version of each that is installed."""
        return [package[:2] for package in self.modules["PackageManager"][0].packages2()]

"""ALSystem of the simulated robot: name, version, and what a driver asks of the computer in the head."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any, Callable

from nao_sim_bridge.services.common import VERSION
from nao_sim_bridge.services.errors import NaoqiError
from nao_sim_bridge.services.memory_store import MemoryStore

NAME_CHANGED = "ALSystem/RobotNameChanged"
MIB = 1024 * 1024
ZONES = Path("/usr/share/zoneinfo")


class ALSystem:
    """ALSystem as the simulated robot offers it.

    What would flash the robot's disk or change its users (upgrade, factoryReset, changePassword...) is not offered:
    a simulation has neither.

    Args:
        memory: Where events go.
        reboot: Puts robot and world to the start.
        shutdown: Ends the simulator.
    """

    def __init__(self, memory: MemoryStore, reboot: Callable[[], Any], shutdown: Callable[[], None]) -> None:
        self._memory = memory
        self._reboot = reboot
        self._shutdown = shutdown
        self._name = "nao"
        self._timezone = os.environ.get("TZ", "UTC") or "UTC"
        memory.declare_event(NAME_CHANGED, "ALSystem")

    def robotName(self) -> str:
        return self._name

    def setRobotName(self, name: str) -> bool:
        if not name or not name.replace("-", "").isalnum():
            raise NaoqiError(f"name is {name!r}, allowed are letters, digits and hyphens")
        self._name = name
        self._memory.raise_event(NAME_CHANGED, name)
        return True

    def systemVersion(self) -> str:
        return VERSION

    def previousSystemVersion(self) -> str:
        return VERSION

    def systemInfo(self) -> list:
        return [["name", self._name], ["version", VERSION], ["simulated", True], ["cpus", os.cpu_count() or 1]]

    def timezone(self) -> str:
        return self._timezone

    def setTimezone(self, name: str) -> bool:
        parts = Path(name).parts
        if not parts or ".." in parts or not ZONES.joinpath(*parts).is_file() or Path(name).is_absolute():
            return False
        self._timezone = name
        return True

    def freeMemory(self) -> int:
        return os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // MIB

    def totalMemory(self) -> int:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // MIB

    def diskFree(self, _all: bool) -> list:
        usage = shutil.disk_usage("/")
        return [["/", usage.total // MIB, usage.used // MIB, usage.free // MIB]]

    def reboot(self) -> Any:
        return self._reboot()

    def shutdown(self) -> None:
        self._shutdown()

"""ALSystem of the simulated robot: name, version, and what a driver asks of the computer in the head."""

from __future__ import annotations

import os
import shutil
from typing import Any, Callable

from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.naoqi.binding.arguments import text, whole_number
from nao_sim_bridge.naoqi.binding.common import VERSION
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.store import MemoryStore
from nao_sim_bridge.naoqi.system.time_zone import TimeZone

NAME_CHANGED = "ALSystem/RobotNameChanged"
MIB = 1024 * 1024
# Pixels.
ICON_SIZE, SMALLEST_ICON, LARGEST_ICON = 128, 16, 1024
AS_AT_START = "puts robot and world to where they started"


class ALSystem:
    """ALSystem as the simulated robot offers it; `icon` draws a PNG picture of it, so many pixels wide and high.

    What would flash the robot's disk or change its users is refused, with what to do instead: a simulation has neither.
    """

    def __init__(
        self,
        memory: MemoryStore,
        reboot: Callable[[], Any],
        shutdown: Callable[[], None],
        icon: Callable[[int], bytes] = lambda size: b"",
        name: str = "nao",
        zone: TimeZone | None = None,
    ) -> None:
        self._memory = memory
        self._reboot = reboot
        self._shutdown = shutdown
        self._icon = icon
        self._name = name
        self._zone = zone or TimeZone()
        memory.declare_event(NAME_CHANGED, "ALSystem")

    def robotName(self) -> str:
        return self._name

    def setRobotName(self, name: str) -> bool:
        if not name or not name.replace("-", "").isalnum():
            raise NaoqiError(f"name is {name!r}, allowed are letters, digits and hyphens")
        text(name, "name", load_sizes().kept.robot_name_characters)
        self._name = name
        self._memory.raise_event(NAME_CHANGED, name)
        return True

    def systemVersion(self) -> str:
        return VERSION

    previousSystemVersion = systemVersion

    def systemInfo(self) -> list:
        return [["name", self._name], ["version", VERSION], ["simulated", True], ["cpus", os.cpu_count() or 1]]

    def timezone(self) -> str:
        return self._zone.name

    def setTimezone(self, name: str) -> bool:
        return self._zone.change(name)

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

    def robotIcon(self, size: int = ICON_SIZE) -> bytes:
        return self._icon(whole_number(size, "size", SMALLEST_ICON, LARGEST_ICON))

    def setRobotIcon(self, _file: Any) -> int:
        raise NaoqiError("the icon of a simulated robot is its picture; what it looks like is in its model")

    def appBackupInfo(self) -> list:
        return []  # there are no applications to back up

    def changePassword(self, _old: str, _new: str) -> None:
        raise NaoqiError("a simulated robot has no users and needs no password")

    def factoryReset(self, _image: str, _checksum: str) -> None:
        raise NaoqiError(f"a simulated robot has no disk to flash; reboot, or NaoSimulation.reset, {AS_AT_START}")

    def upgrade(self, _image: str, _checksum: str) -> None:
        raise NaoqiError(f"a simulated robot has no system image; it offers what NAOqi {VERSION} does")

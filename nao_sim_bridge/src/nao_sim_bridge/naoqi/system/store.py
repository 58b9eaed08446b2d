"""ALStore of the simulated robot, which has no store to fetch applications from."""

from __future__ import annotations

from typing import Any, Callable

from nao_sim_bridge.naoqi.binding.errors import NaoqiError

UNKNOWN_STATUS, NOT_TOLD = 0, -1


class ALStore:
    """ALStore as the simulated robot offers it; `packages` gives the uuid and the version of each that is installed."""

    def __init__(self, packages: Callable[[], list[tuple[str, str]]]) -> None:
        self._packages = packages

    def status(self) -> list[list[list[Any]]]:
        """[[key, value], ...] of each package that is installed."""
        return [
            [
                ["uuid", uuid],
                ["version", version],
                ["onlineVersion", ""],
                ["status", UNKNOWN_STATUS],
                ["percent", NOT_TOLD],
                ["size", 0],
            ]
            for uuid, version in self._packages()
        ]

    def update(self) -> None:
        raise NaoqiError("there is no store: PackageManager.install takes packages from files of the robot")

    def stopUpdate(self) -> None:
        raise NaoqiError("nothing is being updated, as there is no store")

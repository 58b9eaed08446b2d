"""PackageManager of the simulated robot: applications of Choregraphe, of which it has the behaviours."""

from __future__ import annotations

import hashlib
import logging
from dataclasses import dataclass
from typing import Any, Callable

from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.errors import BadValue, ConfigError
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.behaviors.packages import PACKAGES, PackageInfo, package_info, read_package
from nao_sim_bridge.naoqi.behaviors.behavior_manager import ALBehaviorManager
from nao_sim_bridge.naoqi.binding.arguments import known
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

INSTALLED, REMOVED = (
    tuple(name.format(what) for name in ("onPackage{}2", "onPackage{}", "package{}"))
    for what in ("Installed", "Removed")
)
"""Signals, the last two for older programs."""
log = logging.getLogger("nao_sim.packages")


@dataclass(frozen=True)
class _Installed:
    info: PackageInfo
    path: str

    def as_value(self) -> tuple[Any, ...]:
        """A PackageInfo2."""
        info = self.info
        elements = {
            "names": dict(info.names),
            "descriptions": dict(info.descriptions),
            "supportedLanguages": list(info.languages),
        }
        return (info.uuid, info.version, "", "", "", "", "", "", self.path, elements)

    def as_pairs(self) -> list[list[Any]]:
        """[[key, value], ...], as the older methods give it."""
        uuid, version, *_, path, elements = self.as_value()
        return [["uuid", uuid], ["version", version], ["path", path], *(list(pair) for pair in elements.items())]


class PackageManager:
    """PackageManager as the simulated robot offers it: packages are installed as long as the simulator runs.

    Their behaviours are those of ALBehaviorManager, called uuid/path. Services and other programs of a package are not
    started: they would run on this computer.
    """

    def __init__(self, manager: ALBehaviorManager, files: ClientFiles, signals: Callable[..., None]) -> None:
        self._manager = manager
        self._files = files
        self._signals = signals
        self._packages: dict[str, _Installed] = {}

    def install(self, path: str) -> bool:
        """A .pkg file of the robot; one of the same uuid is replaced."""
        file = self._files.to_read(path)
        if file.suffix.lower() not in PACKAGES:
            raise ConfigError(file.name, f"is no package: known are {', '.join(PACKAGES)}")
        info = package_info(file)
        most = load_sizes().behaviors.packages
        if len({*self._packages, info.uuid}) > most:
            raise NaoqiError(f"{most} packages are installed at most: removePkg first")
        names = {behavior.name for behavior in read_package(file)}
        self._manager.installBehavior(path, gone=[name for name in self._behaviors(info.uuid) if name not in names])
        self._packages[info.uuid] = package = _Installed(info, path)
        if info.programs:
            log.warning("%s: %s are not started, as they would run on this computer", path, ", ".join(info.programs))
        for signal in INSTALLED:
            self._signals(signal, package.as_value())
        return True

    def installCheckMd5(self, path: str, md5: str) -> bool:
        file = self._files.to_read(path)
        try:
            found = hashlib.md5(read_bounded(file, load_sizes().archive.file_bytes)).hexdigest()
        except TooLarge as error:
            raise ConfigError(file.name, str(error)) from error
        if found != md5.strip().lower():
            raise BadValue("md5", md5, f"that of {path}, {found}")
        return self.install(path)

    def removePkg(self, uuid: str) -> Task | None:
        """Its behaviours stop."""
        package = self._get(uuid)

        def removed(_: Any) -> None:
            if self._packages.pop(uuid, None) is not None:
                for signal in REMOVED:
                    self._signals(signal, package.as_value())

        if self._behaviors(uuid):
            return self._manager.removeBehavior(uuid).then(removed)
        removed(None)  # they have been removed one by one
        return None

    def hasPackage(self, uuid: str) -> bool:
        return uuid in self._packages

    def packages2(self) -> list[tuple[Any, ...]]:
        return [package.as_value() for package in self._packages.values()]

    packages = packages2

    def package2(self, uuid: str) -> tuple[Any, ...]:
        return self._get(uuid).as_value()

    package = package2

    def packageIcon(self, uuid: str) -> bytes:
        icon = self._get(uuid).info.icon
        if not icon:
            raise NaoqiError(f"package {uuid} has no icon.png")
        return icon

    getPackageIcon = packageIcon

    def getPackages(self) -> list[list[list[Any]]]:
        return [package.as_pairs() for package in self._packages.values()]

    def getPackage(self, uuid: str) -> list[list[Any]]:
        return self._get(uuid).as_pairs()

    def _get(self, uuid: str) -> _Installed:
        return self._packages[known(uuid, "package", self._packages)]

    def _behaviors(self, uuid: str) -> list[str]:
        names = self._manager.getUserBehaviorNames()
        return [name for name in names if name == uuid or name.startswith(f"{uuid}/")]

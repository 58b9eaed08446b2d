"""ALLauncher of the simulated robot: which modules there are. It starts nothing, as that would run on this computer."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

INSTEAD = "start it yourself: a program that connects to the simulator registers its modules"


class ALLauncher:
    """ALLauncher as the simulated robot offers it; the broker lists the `names` of all services."""

    def __init__(self, broker: Any) -> None:
        self._broker = broker

    def getGlobalModuleList(self) -> list[str]:
        return self._broker.names()

    def isModulePresent(self, part: str) -> bool:
        """Whether there is a module with this in its name."""
        if not part:
            raise BadValue("strPartOfModuleName", part, "a part of the name of a module")
        return any(part in name for name in self._broker.names())

    def launchLocal(self, name: str) -> list[str]:
        """Nothing is new when the module is there."""
        if name in self._broker.names():
            return []
        raise _refusal(name, "the library of a module")

    def launchExecutable(self, name: str) -> bool:
        raise _refusal(name, "a program")

    def launchScript(self, name: str) -> bool:
        raise _refusal(name, "a script")

    def launchPythonModule(self, name: str) -> bool:
        raise _refusal(name, "a Python module")


def _refusal(name: str, what: str) -> NaoqiError:
    return NaoqiError(f"{name!r}: {what} of a robot is not run on this computer; {INSTEAD}")

"""DCM of the simulated robot: timed commands straight to joints, stiffnesses and LEDs, and their form on the wire."""

from __future__ import annotations

import threading
from typing import Any, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.base.timed_commands import MERGE, Point
from nao_sim_bridge.core.device_commands import DeviceCommands, index_of
from nao_sim_bridge.core.robot_runner import RobotRunner
from nao_sim_bridge.naoqi.binding.arguments import number, vector, whole_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError
from nao_sim_bridge.naoqi.memory.live_keys import key_prefix
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "DCM"
SAVE, ADD, LOAD, REMOVE = ACTIONS = ("Save", "Add", "Load", "Remove")
DONE = 0
SEPARATE, MIXED = "time-separate", "time-mixed"
LATEST = 2**31 - 1


class DCM:
    """DCM as the simulated robot offers it.

    Commands go past ALMotion: a task of it that moves one of the joints ends.
    """

    def __init__(self, runner: RobotRunner, memory: MemoryStore) -> None:
        self._runner = runner
        self._prefix = key_prefix()
        self._commands = DeviceCommands(lambda: runner.simulation.robot, self._milliseconds)
        self._aliases: dict[str, Sequence[str]] = {}
        self._memory = memory
        self._saved: dict[tuple[str, str], Any] = {}
        self._lock = threading.Lock()

    def getTime(self, offset: int) -> int:
        return round(1000.0 * self._runner.snapshot.time) + offset

    def getPrefix(self) -> str:
        return self._prefix

    def createAlias(self, alias: Any) -> list:
        if not isinstance(alias, (list, tuple)) or len(alias) != 2 or not isinstance(alias[1], (list, tuple)):
            raise BadValue("alias", alias, "[name, [devices]]")
        name, devices = str(alias[0]), [self._device(str(device)) for device in alias[1]]
        if not name or not devices:
            raise BadValue("alias", alias, "[name, [devices]], with at least one device")
        require_few("alias[1]", len(devices), "devices")
        with self._lock:
            require_few("alias", len({*self._aliases, name}), "aliases")
            self._aliases[name] = devices
        return [name, devices]

    def set(self, commands: Any) -> Task:
        name, update, points = command(commands)
        devices = self._aliases.get(name) or [self._device(name)]
        return self._run(dict.fromkeys(devices, points), update)

    def setAlias(self, *arguments: Any) -> Task:
        if len(arguments) == 1:
            return self._run(*alias_command(arguments[0], self._aliases))
        alias, moment, values = arguments
        devices = members(alias, self._aliases)
        wanted = vector(values, "commands", len(devices), f"a value for each of {len(devices)} devices")
        return self._run({device: [(value, moment)] for device, value in zip(devices, wanted)}, MERGE)

    def preferences(self, action: str, target: str, key: str, value: Any) -> int:
        """Preferences are keys of ALMemory: those of a board are saved there, and can be brought back from it."""
        if action not in ACTIONS:
            raise BadValue("action", action, ", ".join(ACTIONS))
        if not key:
            raise BadValue("keyName", key, "the name of a key of ALMemory")
        with self._lock:
            if action in (LOAD, REMOVE) and (target, key) not in self._saved:
                raise BadValue("keyName", key, f"one that was saved for {target!r}")
            if action == REMOVE:
                del self._saved[target, key]
                self._memory.release(key, (NAME, target))
                return DONE
            new = self._saved[target, key] if action == LOAD else value
            self._memory.insert(key, new, by_client=True)
            if action == SAVE:
                self._memory.hold(key, (NAME, target), target, new)
                self._saved[target, key] = new
        return DONE

    def calibration(self, _values: Any) -> None:
        raise NaoqiError("the joints of a simulated robot are exact: there is nothing to calibrate")

    def special(self, what: str) -> None:
        raise NaoqiError(f"special command {what!r}: a simulated robot has no boards to be restarted or flashed")

    def _run(self, commands: dict, update: str) -> Task:
        return self._runner.execute(lambda: self._commands.set(commands, update), "set")

    def _device(self, name: str) -> str:
        """A device without the prefix; there is none of another name."""
        short = name[len(self._prefix) :] if name.startswith(self._prefix) else name
        index_of(self._runner.simulation.robot, short)
        return short

    def _milliseconds(self) -> int:
        return round(1000.0 * self._runner.simulation.time)


def timed_points(values: Any, field: str) -> list[Point]:
    """[[value, moment in ms], ...]; what else an entry holds is of no meaning."""
    rows = _rows(values, field)
    for i, row in enumerate(rows):
        if not isinstance(row, (list, tuple)) or len(row) < 2:
            raise BadValue(f"{field}[{i}]", row, "[value, moment in ms]")
    return [(number(row[0], f"{field}[{i}][0]"), _moment(row[1], f"{field}[{i}][1]")) for i, row in enumerate(rows)]


def command(values: Any) -> tuple[str, str, list[Point]]:
    """Device or alias, update type and commands of `set`."""
    if not isinstance(values, (list, tuple)) or len(values) != 3:
        raise BadValue("commands", values, "[device or alias, update type, [[value, moment in ms], ...]]")
    return str(values[0]), str(values[1]), timed_points(values[2], "commands[2]")


def alias_command(values: Any, aliases: Mapping[str, Sequence[str]]) -> tuple[dict[str, list[Point]], str]:
    """Commands of each device and the update type of `setAlias`."""
    kind = values[2] if isinstance(values, (list, tuple)) and len(values) > 2 else None
    if (kind, len(values) if kind else 0) not in ((SEPARATE, 6), (MIXED, 4)):
        allowed = (
            f'[alias, update type, "{MIXED}", [[[value, moment], ...], ... one for each device]] or '
            f'[alias, update type, "{SEPARATE}", 0, [moment, ...], [[value, ...], ... one for each device]]'
        )
        raise BadValue("commands", values, allowed)
    devices = members(str(values[0]), aliases)
    if kind == MIXED:
        rows = _one_each(values[3], devices, "commands[3]")
        return {d: timed_points(row, f"commands[3][{i}]") for i, (d, row) in enumerate(zip(devices, rows))}, values[1]
    moments = [_moment(value, f"commands[4][{i}]") for i, value in enumerate(_rows(values[4], "commands[4]"))]
    commands = {}
    for i, (device, row) in enumerate(zip(devices, _one_each(values[5], devices, "commands[5]"))):
        row = _rows(row, f"commands[5][{i}]")
        if len(row) != len(moments):
            raise BadValue(f"commands[5][{i}]", row, f"a value for each of {len(moments)} moments")
        commands[device] = [(number(value, f"commands[5][{i}]"), moment) for value, moment in zip(row, moments)]
    return commands, str(values[1])


def members(alias: str, aliases: Mapping[str, Sequence[str]]) -> Sequence[str]:
    if alias not in aliases:
        known = ", ".join(sorted(aliases)) or "none, createAlias makes one"
        raise BadValue("alias", alias, known)
    return aliases[alias]


def _one_each(values: Any, devices: Sequence[str], field: str) -> Sequence[Any]:
    rows = _rows(values, field)
    if len(rows) != len(devices):
        raise BadValue(field, values, f"one entry for each of {len(devices)} devices")
    return rows


def _rows(values: Any, field: str) -> Sequence[Any]:
    if not isinstance(values, (list, tuple)) or not values:
        raise BadValue(field, values, "a list of at least one entry")
    require_few(field, len(values), "commands")
    return values


def _moment(value: Any, field: str) -> int:
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    return whole_number(value, field, -LATEST, LATEST)

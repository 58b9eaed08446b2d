"""What the DCM's commands look like on the wire. Pure."""

from __future__ import annotations

from typing import Any, Mapping, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import require_few
from nao_sim_bridge.base.timed_commands import Point
from nao_sim_bridge.naoqi.binding.arguments import number, whole_number

SEPARATE, MIXED = "time-separate", "time-mixed"
LATEST = 2**31 - 1


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
    """The devices of an alias."""
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

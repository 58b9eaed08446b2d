"""What feels on a NAO and what it is called: short names, NAOqi's events, devices, groups. Pure."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ..base.errors import BadGoal
from ..base.suggestion import did_you_mean
from .body_devices import sensor_key


@dataclass(frozen=True)
class Sensor:
    """Something that can be touched."""

    name: str  # its short name
    event: str  # the event of the robot's memory that tells of it
    devices: tuple[str, ...]  # its switches or plates, by their names in the robot's memory
    groups: tuple[str, ...]  # groups that it is in

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of its devices: it is touched while one of them is not 0."""
        return tuple(sensor_key(device) for device in self.devices)


def _hand(side: str, part: str) -> Sensor:
    name, letter = side.lower(), side[0]
    return Sensor(
        f"{name} hand {part.lower()}",
        f"Hand{side}{part}Touched",
        (f"{letter}Hand/Touch/{part}",),
        (f"{name} hand", "hands", "any"),
    )


def _bumper(side: str) -> Sensor:
    foot = f"{side[0]}Foot/Bumper"
    return Sensor(
        f"{side.lower()} bumper", f"{side}BumperPressed", (f"{foot}/Left", f"{foot}/Right"), ("bumpers", "any")
    )


SENSORS = (
    *(
        Sensor(f"{part.lower()} head", f"{part}TactilTouched", (f"Head/Touch/{part}",), ("head", "any"))
        for part in ("Front", "Middle", "Rear")
    ),
    *(_hand(side, part) for side in ("Left", "Right") for part in ("Back", "Left", "Right")),
    *(_bumper(side) for side in ("Left", "Right")),
    Sensor("chest", "ChestButtonPressed", ("ChestBoard/Button",), ("any",)),
)
"""All of them, from head to foot."""

BUMPERS = tuple(sensor for sensor in SENSORS if "bumpers" in sensor.groups)
GROUPS = ("head", "left hand", "right hand", "hands", "bumpers", "any")
BY_EVENT = {sensor.event: sensor for sensor in SENSORS}


def names_of(sensors: Iterable[Sensor]) -> list[str]:
    return [sensor.name for sensor in sensors]


def sensors_of(words: Sequence[str], field: str = "sensors") -> tuple[Sensor, ...]:
    """Sensors behind short names, events, devices and groups; each once, in the order of `SENSORS`.

    `words`: the names; none stands for all sensors. `field`: of the message that holds them. Raises BadGoal if
    something has none of these names.
    """
    if not words:
        return SENSORS
    wanted = [sensor for word in words for sensor in _behind(word, field)]
    return tuple(sensor for sensor in SENSORS if sensor in wanted)


def devices_of(words: Sequence[str]) -> list[str]:
    """Devices behind words as `sensors_of` takes them, each once; a device means itself alone.

    Raises BadGoal if something has none of these names.
    """
    found: dict[str, None] = {}
    for word in words:
        sensors = _behind(word, "sensors")
        devices = [device for sensor in sensors for device in sensor.devices]
        found.update(dict.fromkeys([word] if word in devices else devices))
    return list(found)


def _behind(word: str, field: str) -> list[Sensor]:
    plain = " ".join(word.replace("_", " ").split())
    lower = plain.lower()
    words = sorted(lower.split())  # in any order: head front, front head
    found = [
        s
        for s in SENSORS
        if any(words == sorted(name.split()) for name in (s.name, *s.groups)) or word.strip() in (s.event, *s.devices)
    ]
    if not found:
        known = [*GROUPS, *names_of(SENSORS)]
        events = ", ".join(sensor.event for sensor in SENSORS)
        devices = [device for sensor in SENSORS for device in sensor.devices]
        hint = did_you_mean(lower, known) or did_you_mean(word, devices)
        problem = f"{word!r} is nothing that can be touched{hint}"
        raise BadGoal(field, word, f"one of {', '.join(known)}, or an event: {events}", problem=problem)
    return found

"""The robot's lights: groups, the lights in them, and the LEDs (devices) behind each light. Pure look-up."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from naoqi.errors import NaoError

from .suggestion import closest

COLOUR_PARTS = ("Red", "Green", "Blue")


class UnknownLight(NaoError):  # noqa: N818  named like the errors of the proxy layer
    """No light or group has that name.

    Attributes:
        name: The name that was asked for.
        hint: The closest names, or where to find the names.
    """

    def __init__(self, name: str, known: Iterable[str]) -> None:
        """Compose the text with the closest names."""
        self.name = name
        matches = ", ".join(map(repr, closest(name, known)))
        self.hint = f"did you mean {matches}?" if matches else "listLEDs and listGroups tell the names"
        super().__init__(f"unknown light {name!r}: {self.hint}")


def colour_part(device: str) -> str:
    """Red, Green or Blue: the colour of an LED of a coloured light; empty for an LED of one colour."""
    return next((part for part in COLOUR_PARTS if f"/{part}/" in device), "")


@dataclass(frozen=True)
class LightNames:
    """Names of lights as a robot knows them.

    A single light has a short name (`LeftFaceLed1`), or is one LED under its device name
    (`Face/Led/Red/Left/0Deg/Actuator/Value`). Groups are used like single lights everywhere.

    Attributes:
        lights: Short name -> device names.
        groups: Name of a group -> single lights in it, groups in groups resolved.
    """

    lights: Mapping[str, tuple[str, ...]]
    groups: Mapping[str, tuple[str, ...]]

    @classmethod
    def from_listings(cls, lights: Mapping[str, Sequence[str]], groups: Mapping[str, Sequence[str]]) -> LightNames:
        """Make the dictionary from what the robot lists.

        Args:
            lights: Short name -> device names.
            groups: Name of a group -> members: short names, device names or groups.
        """
        names = cls({name: tuple(devices) for name, devices in lights.items()}, {})
        return cls(names.lights, {name: names._resolve(name, groups, frozenset()) for name in groups})

    def _resolve(self, name: str, groups: Mapping[str, Sequence[str]], parents: frozenset[str]) -> tuple[str, ...]:
        if name in self.lights or name not in groups:
            return (name,)
        if name in parents:  # a group that contains itself adds nothing
            return ()
        inner = (self._resolve(member, groups, parents | {name}) for member in groups[name])
        return tuple(dict.fromkeys(light for lights in inner for light in lights))

    @property
    def all_names(self) -> list[str]:
        """Groups and short names."""
        return [*self.groups, *self.lights]

    def knows(self, name: str) -> bool:
        """Whether there is a light, group or device of that name."""
        return name in self.groups or name in self.lights or name in self._devices()

    def _devices(self) -> frozenset[str]:
        return frozenset(device for devices in self.lights.values() for device in devices)

    def expand(self, names: Iterable[str]) -> list[str]:
        """Single lights behind names of lights and groups, each once, in order.

        Raises:
            UnknownLight: If a name is unknown.
        """
        expanded: dict[str, None] = {}
        for name in names:
            if name in self.groups:
                expanded.update(dict.fromkeys(self.groups[name]))
            elif self.knows(name):
                expanded[name] = None
            else:
                raise UnknownLight(name, self.all_names)
        return list(expanded)

    def devices(self, names: Iterable[str]) -> list[str]:
        """LEDs behind names of lights and groups, each once, in order.

        Raises:
            UnknownLight: If a name is unknown.
        """
        found: dict[str, None] = {}
        for light in self.expand(names):
            found.update(dict.fromkeys(self.lights.get(light, (light,))))
        return list(found)

    def is_coloured(self, name: str) -> bool:
        """Whether a light or group can show any colour: it has red, green and blue LEDs."""
        return {colour_part(device) for device in self.devices([name])} >= set(COLOUR_PARTS)

    def with_group(self, name: str, members: Sequence[str]) -> LightNames:
        """The same names and one more group."""
        return LightNames(self.lights, {**self.groups, name: tuple(self.expand(members))})

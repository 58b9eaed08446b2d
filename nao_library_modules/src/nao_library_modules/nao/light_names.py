"""The robot's lights: groups, the lights in them, and the LEDs (devices) behind each light. Pure look-up."""

from __future__ import annotations

import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass

from naoqi.errors import NaoError

from ..base.suggestion import closest

COLOUR_PARTS = ("Red", "Green", "Blue")
PLAIN_WORDS = {
    "Eyes": "FaceLeds",
    "LeftEye": "LeftFaceLeds",
    "RightEye": "RightFaceLeds",
    "Ears": "EarLeds",
    "LeftEar": "LeftEarLeds",
    "RightEar": "RightEarLeds",
    "Chest": "ChestLeds",
    "Feet": "FeetLeds",
    "LeftFoot": "LeftFootLeds",
    "RightFoot": "RightFootLeds",
}
"""Names that ALLeds does not know -> those of its groups that they mean. A light or group of the robot comes before."""


class UnknownLight(NaoError):
    """No light or group has that name.

    `hint` has the closest names, or where to find the names.
    """

    def __init__(self, name: str, known: Iterable[str]) -> None:
        self.name = name
        in_its_words = re.sub("lights?", "Leds", name, flags=re.IGNORECASE)
        matches = ", ".join(map(repr, closest(in_its_words, known)))
        self.hint = f"did you mean {matches}?" if matches else "listLEDs and listGroups tell the names"
        super().__init__(f"unknown light {name!r}: {self.hint}")


def plain_words(groups: Container[str]) -> list[str]:
    return [word for word, group in PLAIN_WORDS.items() if group in groups]


def colour_part(device: str) -> str:
    """Red, Green or Blue: the colour of an LED of a coloured light; empty for an LED of one colour."""
    return next((part for part in COLOUR_PARTS if f"/{part}/" in device), "")


@dataclass(frozen=True)
class LightNames:
    """Names of lights as a robot knows them.

    A single light has a short name (`LeftFaceLed1`), or is one LED under its device name
    (`Face/Led/Red/Left/0Deg/Actuator/Value`). Groups are used like single lights everywhere, and so are the plain words
    for them: `Eyes` is `FaceLeds`.
    """

    lights: Mapping[str, tuple[str, ...]]  # short name -> device names
    groups: Mapping[str, tuple[str, ...]]  # name of a group -> single lights in it, groups in groups resolved

    @classmethod
    def from_listings(cls, lights: Mapping[str, Sequence[str]], groups: Mapping[str, Sequence[str]]) -> LightNames:
        """Make the dictionary from what the robot lists.

        `lights`: short name -> device names. `groups`: name of a group -> members: short names, device names or groups.
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
        """Groups, short names, and plain words for groups."""
        return list(dict.fromkeys([*self.groups, *self.lights, *plain_words(self.groups)]))

    def of_robot(self, name: str) -> str:
        """The name that ALLeds has for a light or group: `FaceLeds` for `Eyes`; any other stays as it is."""
        group = PLAIN_WORDS.get(name, name)
        return name if self._lists(name) or group not in self.groups else group

    def knows(self, name: str) -> bool:
        """Whether there is a light, group or device of that name, or a plain word for a group."""
        return self._lists(self.of_robot(name))

    def _lists(self, name: str) -> bool:
        return name in self.groups or name in self.lights or name in self._devices()

    def _devices(self) -> frozenset[str]:
        return frozenset(device for devices in self.lights.values() for device in devices)

    def expand(self, names: Iterable[str]) -> list[str]:
        """Single lights behind names of lights and groups, each once, in order.

        Raises UnknownLight if a name is unknown.
        """
        expanded: dict[str, None] = {}
        for name in map(self.of_robot, names):
            if name in self.groups:
                expanded.update(dict.fromkeys(self.groups[name]))
            elif self._lists(name):
                expanded[name] = None
            else:
                raise UnknownLight(name, self.all_names)
        return list(expanded)

    def devices(self, names: Iterable[str]) -> list[str]:
        """LEDs behind names of lights and groups, each once, in order. Raises UnknownLight if a name is unknown."""
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

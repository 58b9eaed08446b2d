"""Colours by name or as text, and the robot's lights: groups, their lights, and the LEDs of each light. Pure."""

from __future__ import annotations

import json
import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Tuple

from naoqi.errors import NaoError

from .errors import BadGoal, closest, did_you_mean
from .files import config_file

Colour = Tuple[float, float, float]
"""Red, green and blue, each 0..1."""

_HEX = re.compile(r"(?:#|0x)([0-9a-f]{6})")


def read_colours(path: Path) -> Mapping[str, Colour]:
    """Read a table of named colours. Raises ValueError if an entry is not three numbers within 0..1."""
    table = json.loads(path.read_text())
    table.pop("_source", None)
    for name, rgb in table.items():
        if len(rgb) != 3 or not all(0.0 <= part <= 1.0 for part in rgb):
            raise ValueError(f"{path}: {name}: {rgb} is not red, green and blue within 0..1")
    return {name: (float(red), float(green), float(blue)) for name, (red, green, blue) in table.items()}


@lru_cache(maxsize=None)
def named_colours() -> Mapping[str, Colour]:
    return read_colours(config_file("colours.json"))


ALLOWED = f"'#RRGGBB', '0xRRGGBB' or one of {', '.join(named_colours())}"
"""What a text for a colour may be."""


def parse_colour(text: str, field: str = "str_param") -> Colour:
    """A colour from its name, `#RRGGBB` or `0xRRGGBB`. Raises BadGoal if the text is none of these."""
    word = text.strip().lower()
    if word in named_colours():
        return named_colours()[word]
    match = _HEX.fullmatch(word)
    if match is None:
        raise BadGoal(
            field,
            text,
            ALLOWED,
            problem=f"unknown colour {text!r}{did_you_mean(word, named_colours())}",
        )
    return from_integer(int(match.group(1), 16))


def is_colour(text: str) -> bool:
    try:
        parse_colour(text)
    except BadGoal:
        return False
    return True


def from_integer(rgb: int) -> Colour:
    """A colour from 0x00RRGGBB."""
    return ((rgb >> 16 & 0xFF) / 255.0, (rgb >> 8 & 0xFF) / 255.0, (rgb & 0xFF) / 255.0)


def to_integer(colour: Colour) -> int:
    """A colour as 0x00RRGGBB."""
    red, green, blue = (round(255.0 * part) for part in colour)
    return red << 16 | green << 8 | blue


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

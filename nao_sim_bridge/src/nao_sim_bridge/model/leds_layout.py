"""Which LEDs the robot has, what they are called, where they sit and which devices one visible lamp mixes.

Three levels of names, as ALLeds knows them: a *device* is one colour of one LED (89 of them), a *short name*
stands for one or three devices, a *group* for short names, devices or other groups. A *lamp* is what an eye
sees: one segment of an eye ring, one LED of an ear; 51 of them.

The members of the groups called Top, Bottom, Internal and External of the face, and Front, Back, Even and Odd
of the ears, are published nowhere. They are filled in from where the LEDs sit; `guessed_groups` names them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache

from nao_sim_bridge.base.config import check_keys, config_file, read_json
from nao_sim_bridge.base.errors import ConfigError, UnknownName
from nao_sim_bridge.model.robot_model import VERSIONS, frozen_mapping

FILE = "nao_leds.json"
SECTIONS = (
    "_meta hardware color_names_fadeRGB rgb_int short_names groups groups_note eye_positions "
    "left_eye_numbering face_part_groups_guess ear_positions brain_positions chest_led_note alleds_only_blue"
).split()
SIDES = ("Right", "Left")
EYE_SEGMENTS = 8
EAR_LEDS = 10
BRAIN_LEDS = 12


@dataclass(frozen=True)
class Lamp:
    """One visible light.

    Attributes:
        name: Short name, or the group of three one-colour short names (`ChestLeds`, `LeftFootLeds`).
        part: `eye`, `ear`, `brain`, `chest` or `foot`.
        side: `Left`, `Right` or empty.
        devices: Device indices: red, green, blue; or the only one.
        color: (r, g, b) in 0..1 of a lamp with one device at full intensity; None for a three-colour lamp.
        angle: Where it sits on its circle, deg. Eye: from the top towards the nose. Ear: from the top to the
            front, as `earLedsSetAngle` counts. Head: from the front to the right, seen from above. Else 0.
    """

    name: str
    part: str
    side: str
    devices: tuple[int, ...]
    color: tuple[float, float, float] | None
    angle: float

    def rgb(self, values: Sequence[float]) -> tuple[float, float, float]:
        """The light it gives, (r, g, b) in 0..1, from the intensities of all devices."""
        if self.color is None:
            red, green, blue = self.devices
            return values[red], values[green], values[blue]
        level = values[self.devices[0]]
        return level * self.color[0], level * self.color[1], level * self.color[2]


@dataclass(frozen=True, eq=False)
class LedLayout:
    """All LED names and lamps of one robot version.

    Attributes:
        version: `V6` or `V5`; the left eye is numbered differently.
        devices: The 89 device names in a fixed order, the same for all versions.
        device_index: Device name to its index.
        channels: What each device contributes: `red`, `green`, `blue` (also the ears) or `white` (the head).
        short_names: Short name to the indices of its one or three devices (red, green, blue).
        groups: Group to its direct members: short names, device names or groups.
        guessed_groups: Groups whose members are not published.
        lamps: The 51 visible lights.
    """

    version: str
    devices: tuple[str, ...]
    device_index: Mapping[str, int]
    channels: tuple[str, ...]
    short_names: Mapping[str, tuple[int, ...]]
    groups: Mapping[str, tuple[str, ...]]
    guessed_groups: frozenset[str]
    lamps: tuple[Lamp, ...]
    _expanded: dict[str, tuple[int, ...]] = field(default_factory=dict, repr=False)

    def devices_of(self, name: str) -> tuple[int, ...]:
        """Indices of all devices behind a group, short name or device name, each once.

        Raises:
            UnknownName: If the robot has no such LED or group.
        """
        if name not in self._expanded:
            self._expanded[name] = self._expand(name)
        return self._expanded[name]

    def _expand(self, name: str) -> tuple[int, ...]:
        if name in self.device_index:
            return (self.device_index[name],)
        if name in self.short_names:
            return self.short_names[name]
        if name not in self.groups:
            raise UnknownName("LED or group", name, [*self.groups, *self.short_names, *self.devices])
        indices = (index for member in self.groups[name] for index in self.devices_of(member))
        return tuple(dict.fromkeys(indices))

    def lamps_of(self, part: str, side: str = "") -> tuple[Lamp, ...]:
        """Lamps of a part of the robot, all sides unless one is given, in rising order of angle."""
        chosen = (lamp for lamp in self.lamps if lamp.part == part and side in ("", lamp.side))
        return tuple(sorted(chosen, key=lambda lamp: (lamp.side, lamp.angle)))


@lru_cache(maxsize=None)
def load_leds(version: str = "V6") -> LedLayout:
    """The LED layout of a robot version, read once.

    Raises:
        ConfigError: If the version is unknown or the file has a wrong, unknown or missing entry.
    """
    if version not in VERSIONS:
        raise ConfigError(FILE, f"no robot version {version!r} (allowed: {', '.join(VERSIONS)})")
    tables = check_keys(read_json(config_file(FILE)), FILE, SECTIONS)
    names_of_short = {name: tuple(members) for name, members in tables["short_names"].items()}
    devices = tuple(dict.fromkeys(device for members in names_of_short.values() for device in members))
    index = {name: number for number, name in enumerate(devices)}
    if version == "V5":
        names_of_short.update(_left_eye_of_v5(tables["eye_positions"]["left_device_angle_deg_by_index_2_5"]))
    short_names = {name: tuple(index[device] for device in members) for name, members in names_of_short.items()}
    groups, guessed = _groups(tables)
    layout = LedLayout(
        version=version,
        devices=devices,
        device_index=frozen_mapping(index),
        channels=tuple(_channel(device) for device in devices),
        short_names=frozen_mapping(short_names),
        groups=frozen_mapping(groups),
        guessed_groups=frozenset(guessed),
        lamps=tuple(_lamps(short_names)),
    )
    for name in groups:
        try:
            layout.devices_of(name)
        except UnknownName as error:
            raise ConfigError(f"{FILE}: groups.{name}", str(error)) from error
    return layout


def _left_eye_of_v5(angles: Sequence[int]) -> dict[str, tuple[str, ...]]:
    """Short names of the left eye as the V5 numbers them."""
    return {
        f"LeftFaceLed{number}": tuple(
            f"Face/Led/{color}/Left/{angle}Deg/Actuator/Value" for color in ("Red", "Green", "Blue")
        )
        for number, angle in enumerate(angles, start=1)
    }


def _channel(device: str) -> str:
    """Colour of a device; the LEDs of the ears are blue, those of the head white."""
    if device.startswith("Ears/"):
        return "blue"
    if device.startswith("Head/"):
        return "white"
    return device.split("/")[2].lower()


def _groups(tables: Mapping) -> tuple[dict[str, tuple[str, ...]], list[str]]:
    """Groups with their direct members, and which of them are guessed."""
    guesses = _guessed_members(tables)
    groups, guessed = {}, []
    for name, entry in tables["groups"].items():
        check_keys(entry, f"{FILE}: groups.{name}", ("members", "confidence", "basis"))
        members = entry["members"]
        if members is None:
            if name not in guesses:
                raise ConfigError(f"{FILE}: groups.{name}", "has no members and no guess")
            members = guesses[name]
            guessed.append(name)
        groups[name] = tuple(members)
    return groups, guessed


def _guessed_members(tables: Mapping) -> dict[str, tuple[str, ...]]:
    """Members of the unpublished groups, from where the LEDs sit."""
    guess = {}
    for side in SIDES:
        for part, indices in tables["face_part_groups_guess"]["indices"].items():
            guess[f"FaceLeds{side}{part}"] = tuple(_eye_short_name(side, index) for index in indices)
        ears = {
            "Front": tables["ear_positions"]["front_half"],
            "Back": tables["ear_positions"]["back_half"],
            "Even": range(2, EAR_LEDS + 1, 2),
            "Odd": range(1, EAR_LEDS + 1, 2),
        }
        for part, numbers in ears.items():
            guess[f"{side}EarLeds{part}"] = tuple(f"{side}EarLed{number}" for number in numbers)
    return guess


def _eye_short_name(side: str, index: int) -> str:
    """Short name of the eye segment 45 * index deg from the top towards the nose."""
    return f"{side}FaceLed{index + 1 if side == 'Left' else EYE_SEGMENTS - index}"


def _lamps(short_names: Mapping[str, tuple[int, ...]]) -> list[Lamp]:
    blue, white = (0.1, 0.35, 1.0), (1.0, 1.0, 1.0)
    lamps = []
    for side in SIDES:
        for index in range(EYE_SEGMENTS):
            name = _eye_short_name(side, index)
            lamps.append(Lamp(name, "eye", side, short_names[name], None, 45.0 * index))
        for number in range(1, EAR_LEDS + 1):
            name = f"{side}EarLed{number}"
            lamps.append(Lamp(name, "ear", side, short_names[name], blue, 18.0 + 36.0 * (number - 1)))
    for number in range(BRAIN_LEDS):
        name = f"Brain{number}"
        side = "Right" if number < BRAIN_LEDS / 2 else "Left"
        lamps.append(Lamp(name, "brain", side, short_names[name], white, 15.0 + 30.0 * number))
    for name, part, side in (
        ("ChestLeds", "chest", ""),
        ("LeftFootLeds", "foot", "Left"),
        ("RightFootLeds", "foot", "Right"),
    ):
        devices = tuple(short_names[f"{name}{color}"][0] for color in ("Red", "Green", "Blue"))
        lamps.append(Lamp(name, part, side, devices, None, 0.0))
    return lamps

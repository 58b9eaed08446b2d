"""Worlds: what surrounds the robot, the same for the physics and for pictures.

A world file (YAML) has `floor`, and may have `description`, `light`, `background`, `objects`, `sounds` and `robots`;
the readers (`reader.py`, `sounds.py`) say what each of them may hold.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Tuple, Union

from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.rotations import Quaternion, Vector3, from_roll_pitch_yaw
from nao_sim_bridge.model.shapes import Shape
from nao_sim_bridge.world.places import RobotPlace

if TYPE_CHECKING:
    from nao_sim_bridge.world.pictures import WorldPicture

FLOOR = "floor"
"""A name that no object may have."""
MOST_PARTS = 16
"""PyBullet silently leaves out what goes beyond in one body that can be touched."""

Color = tuple  # (r, g, b) in 0..1
Content = Union[str, Path, Tuple[float, ...]]


class WorldError(ConfigError):
    """A world file cannot be used, or there is none of that name."""


@dataclass(frozen=True)
class Rug:
    """A rectangle of another colour, too thin to be felt; in the frame of the floor, m, yaw in rad, colour 0..1."""

    center: tuple[float, float]
    size: tuple[float, float]
    yaw: float
    color: Color


@dataclass(frozen=True)
class Floor:
    """The floor, a plane through the origin of the world.

    Its frame has the origin of the world and Z along its normal; without a slope it is the world.

    Attributes:
        friction: Coefficient. The engine multiplies it with that of what touches the floor.
        color: Of every other tile.
        tile_color: Of the tiles between; equal to `color` for a plain floor.
        tile_size: Edge of a tile, m.
        slope: Angles by which the floor rises along X and along Y of the world, rad.
        rugs: What lies on it without being felt.
        bumps: Boxes that stick out of it, in its frame; they have its friction.
        bump_color: Colour of the bumps.
    """

    friction: float
    color: Color
    tile_color: Color
    tile_size: float
    slope: tuple[float, float] = (0.0, 0.0)
    rugs: tuple[Rug, ...] = ()
    bumps: tuple[Shape, ...] = ()
    bump_color: Color = (0.6, 0.6, 0.6)

    @property
    def normal(self) -> Vector3:
        """Unit vector out of the floor, in world."""
        x, y = (-math.tan(angle) for angle in self.slope)
        length = math.sqrt(x * x + y * y + 1.0)
        return (x / length, y / length, 1.0 / length)

    @property
    def orientation(self) -> Quaternion:
        """Of the floor's frame in world; its X axis stays above that of the world."""
        x, y, z = self.normal
        return from_roll_pitch_yaw(-math.asin(y), math.atan2(x, z), 0.0)

    def height_at(self, x: float, y: float, above: float = 0.0) -> float:
        """Height z in world of the point over (x, y) that is `above` m over the floor along its normal."""
        nx, ny, nz = self.normal
        return (above - nx * x - ny * y) / nz


@dataclass(frozen=True)
class Light:
    """The lamp of the pictures.

    Attributes:
        direction: From the scene towards the light, any length.
        color: (r, g, b) in 0..1.
        ambient: Share of the light that comes from everywhere, 0..1.
    """

    direction: tuple[float, float, float]
    color: Color
    ambient: float


@dataclass(frozen=True)
class Background:
    """What fills a picture where nothing is.

    Attributes:
        top: (r, g, b) at the upper edge.
        horizon: (r, g, b) in the middle and below.
        haze: Distance in m at which most of the floor's colour has gone over into that of the horizon.
    """

    top: Color
    horizon: Color
    haze: float


@dataclass(frozen=True)
class Part:
    """What is to be seen of an object: a shape in the frame of the object, and how it looks.

    Attributes:
        shape: Of any kind that pictures know.
        color: (r, g, b) in 0..1.
        picture: What covers its front instead of the colour: the +X face of a box, the +X half of a round shape.
        shining: It is a lamp that is on: its colour is that of its light, whatever falls on it.
    """

    shape: Shape
    color: Color
    picture: WorldPicture | None = None
    shining: bool = False


@dataclass(frozen=True)
class WorldObject:
    """A thing in the world, in one piece.

    Attributes:
        name: Unique in the world.
        position: Of its frame, whose origin is its centre of mass, in the frame of the floor, m.
        rpy: Of its frame in that of the floor, rad.
        parts: What is to be seen of it.
        mass: kg; 0 is immovable.
        rolling_friction: m; keeps balls from rolling for ever.
        restitution: 0..1.
        body: What is to be felt of it, of the kinds that the physics knows; None for the shapes of its parts.
        kind: What it is, for people: `ball`, `landmark`, `person`...
        origin: Where in its frame the point is that its entry calls `position`: between the feet of a person, m.
    """

    name: str
    position: Vector3
    rpy: Vector3
    parts: tuple[Part, ...]
    mass: float
    friction: float
    rolling_friction: float
    restitution: float
    body: tuple[Shape, ...] | None = None
    kind: str = "thing"
    origin: Vector3 = (0.0, 0.0, 0.0)

    @property
    def touched(self) -> tuple[Shape, ...]:
        """The shapes that the physics knows of it."""
        return tuple(part.shape for part in self.parts) if self.body is None else self.body


@dataclass(frozen=True)
class WorldSound:
    """A sound of the world.

    Attributes:
        name: Unique among the sounds.
        kind: `file`, `tone`, `noise` or `say`.
        content: Path of the file, frequencies in Hz, kind of noise, or text.
        position: In the frame of the floor, or of the object that it rides on, m.
        on: Name of that object; None when it stands by itself.
        voice: Who says the text; empty for the voice that the robot has at the start.
        level_db: At 1 m, dB SPL.
        start: When it begins, s after the start or a reset.
        pause: Silence between repetitions, s.
        duration: Of a tone or noise, s; None when it does not end.
    """

    name: str
    kind: str
    content: Content
    position: Vector3
    on: str | None
    voice: str
    level_db: float
    start: float
    loop: bool
    pause: float
    duration: float | None


@dataclass(frozen=True)
class World:
    """A world: its file's name without ending, a line for people, what it has, and where the first robots start."""

    name: str
    description: str
    floor: Floor
    light: Light
    background: Background
    objects: tuple[WorldObject, ...]
    sounds: tuple[WorldSound, ...] = ()
    robots: tuple[RobotPlace, ...] = ()

"""What a simulation starts with: world, robot, and how far both are from ideal."""

from __future__ import annotations

from dataclasses import dataclass, replace

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.limits import world_kind
from nao_sim_bridge.world.reader import load_world
from nao_sim_bridge.world.world import World

MAX_DELAY = 1.0


@dataclass(frozen=True)
class Scene:
    """What a simulation starts with.

    Attributes:
        world: Name of a world file, or its path.
        version: Robot version, "V6" or "V5".
        posture: Posture the robot starts in; all joints limp, as after boot.
        seed: Of all random numbers.
        friction: Coefficient of friction between the soles and the floor; None for what the world says.
        payload: Mass that the torso carries besides its own, at its centre of mass, kg; the robot does not know of it.
        sensor_noise: Scale of the sensors' errors: 0 for none, 1 for those of a real robot.
        sensor_delay: How late joint angles, inertial unit and foot forces arrive, s, rounded to ticks.
        charger: Whether the charger is plugged in from the start, so that the robot does not tire.

    Raises:
        BadValue: A number is not in its range.
    """

    world: str = "empty"
    version: str = "V6"
    posture: str = "Crouch"
    seed: int = 0
    friction: float | None = None
    payload: float = 0.0
    sensor_noise: float = 0.0
    sensor_delay: float = 0.0
    charger: bool = False

    def __post_init__(self) -> None:
        for name in ("friction", "payload", "sensor_noise", "sensor_delay"):
            value = getattr(self, name)
            bounds = world_kind(name)
            most = MAX_DELAY if name == "sensor_delay" else bounds.highest
            if value is not None and not 0.0 <= value <= most:
                unit = "" if bounds.unit == "none" else f" {bounds.unit}"
                raise BadValue(name, value, f"0 to {most:g}{unit}")

    def load_world(self, sole_friction: float) -> World:
        """The world, with the friction asked for.

        Args:
            sole_friction: Coefficient of the soles. The engine multiplies those of the two that touch, so the floor
                gets what makes the product right.

        Raises:
            WorldError: There is no such world, or its file is wrong.
        """
        world = load_world(self.world)
        if self.friction is None:
            return world
        return replace(world, floor=replace(world.floor, friction=self.friction / sole_friction))

"""What of the robot's health decides whether it may move: motors' heat, battery, ground under its feet."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from naoqi.errors import NaoError

from ..base.errors import CannotWalk, NotFit
from ..functions.memory_functions import MEMORY
from ..nao.body_devices import CHARGE, CURRENT, FOOT_CONTACT, HOT_MOTOR, TOO_HOT_MOTOR, temperature_key

log = logging.getLogger(__name__)

HOT_SPEED = 0.5
"""Largest fraction of the top speed that goals give hot motors."""
EMPTY, TOO_LOW_TO_WALK = 0.02, 0.05
"""Charge, 0..1: the robot rests, and a walk might not get to its end."""


@dataclass(frozen=True)
class Health:
    """How the robot was when it was asked; what it does not tell is no hindrance."""

    temperatures: Mapping[str, float] = field(default_factory=dict)  # joint -> degC of its motor
    charge: float | None = None  # of the battery, 0..1
    charging: bool = False
    on_ground: bool | None = None  # whether a foot touches the ground

    def require_fit(self, joints: Iterable[str]) -> None:
        """See that joints may be moved. Raises NotFit if a motor is too hot, or the battery empty."""
        if self.charge is not None and self.charge <= EMPTY and not self.charging:
            raise NotFit(f"the battery is empty ({self.charge:.0%} left)", "plug the charger in")
        hot = self._warmer(joints, TOO_HOT_MOTOR)
        if hot:
            raise NotFit(f"too hot to move: {_list(hot)}", f"rest until they are below {TOO_HOT_MOTOR:g} degC")

    def require_walk(self, joints: Iterable[str], moved: bool) -> None:
        """See that the robot may walk.

        `joints`: what the walk moves. `moved`: whether something moves the robot before: where its feet are then is not
        known. Raises NotFit if a motor is too hot, or the battery empty; CannotWalk if the battery is too low for it,
        or no foot touches the ground.
        """
        self.require_fit(joints)
        if self.charge is not None and self.charge <= TOO_LOW_TO_WALK and not self.charging:
            raise CannotWalk(f"the battery is too low to walk ({self.charge:.0%} left)", "plug the charger in")
        if self.on_ground is False and not moved:
            raise CannotWalk("no foot touches the ground", "put the robot on its feet first")

    def careful(self, joints: Iterable[str], fraction: float) -> float:
        """A fraction of the top speed, or less where one of the joints is hot."""
        if fraction <= HOT_SPEED or not self._warmer(joints, HOT_MOTOR):
            return fraction
        return HOT_SPEED

    def _warmer(self, joints: Iterable[str], limit: float) -> dict[str, float]:
        degrees = {joint: self.temperatures.get(joint, 0.0) for joint in joints}
        return {joint: celsius for joint, celsius in degrees.items() if celsius >= limit}


def read_health(call: Callable[..., Any], joints: Sequence[str]) -> Health:
    """The health of now, with one call; all is well if a robot cannot tell.

    `call`: calls a module of the robot: its name, a method, arguments. `joints`: those whose motors are of interest.
    """
    keys = [CHARGE, CURRENT, FOOT_CONTACT, *map(temperature_key, joints)]
    try:
        values = list(call(MEMORY, "getListData", keys))
    except NaoError as error:
        log.debug("the robot does not tell its health: %s", error)
        return Health()
    numbers = [float(v) if isinstance(v, (int, float)) else None for v in values]
    if len(numbers) != len(keys):
        return Health()
    charge, current, contact, *degrees = numbers
    return Health(
        {joint: celsius for joint, celsius in zip(joints, degrees) if celsius is not None},
        charge,
        current is not None and current > 0.0,
        None if contact is None else contact > 0.0,
    )


def in_chain(joint: str, chain: str) -> bool:
    """Whether a joint rests with a chain of ALMotion's protection: Head, LArm, RArm, LLeg, RLeg, Legs, Body."""
    if chain in ("Body", "Legs"):  # without its legs the whole robot rests
        return True
    if chain == "Head":
        return joint.startswith("Head")
    of_leg = any(part in joint for part in ("Hip", "Knee", "Ankle"))
    return joint[:1] == chain[:1] and chain[1:] == ("Leg" if of_leg else "Arm")


def _list(hot: Mapping[str, float]) -> str:
    return ", ".join(f"{joint} {celsius:.0f} degC" for joint, celsius in sorted(hot.items(), key=lambda row: -row[1]))

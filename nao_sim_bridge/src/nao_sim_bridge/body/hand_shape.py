"""What a simulated hand looks like, and what is felt of it: the tip of its finger."""

from __future__ import annotations

import numpy as np

from nao_sim_bridge.model.shapes import Shape, rod
from nao_sim_bridge.world.world import Part, WorldObject

TIP_RADIUS = 0.008
MASS = 0.02
SKIN, SLEEVE = (0.87, 0.66, 0.53), (0.25, 0.35, 0.55)
# In a frame at the tip of the forefinger, which points along X; the palm looks along -Z. Ends of fingers, m.
_FOREFINGER = ((-0.068, 0.0, 0.004), (0.0, 0.0, 0.0))
_BENT = tuple(((-0.070, y, 0.002), (-0.052, y, -0.018)) for y in (0.017, 0.034, 0.050))
_THUMB = ((-0.100, -0.016, -0.004), (-0.062, -0.034, -0.012))
_PALM = Shape("box", (0.072, 0.070, 0.024), (-0.105, 0.025, 0.004))
_SLEEVE = ((-0.245, 0.025, 0.004), (-0.155, 0.025, 0.004))


def make_hand(name: str) -> WorldObject:
    """A hand as a thing of the world, whose frame is at the tip of the finger that it points with along X."""
    fingers = [_rod(*ends, TIP_RADIUS) for ends in (_FOREFINGER, *_BENT, _THUMB)]
    parts = [Part(shape, SKIN) for shape in (*fingers, _PALM)]
    parts.append(Part(_rod(*_SLEEVE, 0.034), SLEEVE))
    return WorldObject(
        name=name,
        position=(0.0, 0.0, -1.0),  # out of the way until it is put somewhere
        rpy=(0.0, 0.0, 0.0),
        parts=tuple(parts),
        mass=MASS,
        friction=0.05,
        rolling_friction=0.0,
        restitution=0.0,
        body=(Shape("sphere", (TIP_RADIUS,), (0.0, 0.0, 0.0)),),
        kind="hand",
    )


def _rod(start: tuple, end: tuple, radius: float) -> Shape:
    return rod("capsule", radius, np.array(start), np.array(end))

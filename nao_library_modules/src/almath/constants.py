"""Angles and axis masks. The masks are the ones ALMotion takes in its Cartesian calls."""

from __future__ import annotations

import math

PI = math.pi
PI_2 = math.pi / 2.0
PI_4 = math.pi / 4.0
TO_RAD = math.pi / 180.0
TO_DEG = 180.0 / math.pi

AXIS_MASK_NONE = 0
AXIS_MASK_X = 1
AXIS_MASK_Y = 2
AXIS_MASK_Z = 4
AXIS_MASK_WX = 8
AXIS_MASK_WY = 16
AXIS_MASK_WZ = 32
AXIS_MASK_XY = AXIS_MASK_X | AXIS_MASK_Y
AXIS_MASK_WYWZ = AXIS_MASK_WY | AXIS_MASK_WZ
AXIS_MASK_PLANEZ = AXIS_MASK_Z | AXIS_MASK_WX | AXIS_MASK_WY
AXIS_MASK_VEL = AXIS_MASK_X | AXIS_MASK_Y | AXIS_MASK_Z
AXIS_MASK_ROT = AXIS_MASK_WX | AXIS_MASK_WY | AXIS_MASK_WZ
AXIS_MASK_ALL = AXIS_MASK_VEL | AXIS_MASK_ROT


def isAxisMask(mask: int) -> bool:
    """Tell whether `mask` selects at least one of the six axes and nothing else."""
    return AXIS_MASK_NONE < mask <= AXIS_MASK_ALL

"""Constants of the NAO SDK for ALMotion: frames, axis masks and angles.

The last three groups belong to the ALMotion of SDK 1.2 to 1.6. They are kept for scripts that name them; the
methods they were made for are gone from NAOqi 2.
"""

from __future__ import annotations

import math

# Frames of Cartesian calls.
FRAME_TORSO = 0
FRAME_WORLD = 1
FRAME_ROBOT = 2

# Names of the frames in SDK 1.8 to 1.12.
SPACE_TORSO = FRAME_TORSO
SPACE_WORLD = FRAME_WORLD
SPACE_NAO = FRAME_ROBOT

# Degrees of freedom that a Cartesian call controls.
AXIS_MASK_NONE = 0
AXIS_MASK_X = 1
AXIS_MASK_Y = 2
AXIS_MASK_XY = 3
AXIS_MASK_Z = 4
AXIS_MASK_VEL = 7
AXIS_MASK_WX = 8
AXIS_MASK_WY = 16
AXIS_MASK_WZ = 32
AXIS_MASK_WYWZ = 48
AXIS_MASK_ROT = 56
AXIS_MASK_ALL = 63

# Where angles and positions come from, and what they are relative to.
COMMANDS = 0
SENSORS = 1
MVT_RELATIVE = 0
MVT_ABSOLUTE = 1

# Radians in a degree, degrees in a radian.
TO_RAD = math.pi / 180.0
TO_DEG = 180.0 / math.pi

# Frames.
SPACE_BODY = 0
SPACE_SUPPORT_LEG = 1

# Interpolations.
INTERPOLATION_LINEAR = 0
INTERPOLATION_SMOOTH = 1

# Balance and support.
BALANCE_MODE_OFF = 0
BALANCE_MODE_AUTO = 1
BALANCE_MODE_COM_CONTROL = 2
SUPPORT_MODE_LEFT = 0
SUPPORT_MODE_DOUBLE_LEFT = 1
SUPPORT_MODE_RIGHT = 2
SUPPORT_MODE_DOUBLE_RIGHT = 3
SUPPORT_MODE_NONE = 4

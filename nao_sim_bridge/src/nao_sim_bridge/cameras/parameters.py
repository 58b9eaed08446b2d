"""NAOqi's numbers of the parameters of cameras."""

from __future__ import annotations

BRIGHTNESS = 0
CONTRAST = 1
SATURATION = 2
HUE = 3
GAIN = 6
H_FLIP = 7
V_FLIP = 8
AUTO_EXPOSURE = 11
AUTO_WHITE_BALANCE = 12
EXPOSURE = 17
EXPOSURE_ALGORITHM = 22
SHARPNESS = 24
WHITE_BALANCE = 33
BACKLIGHT = 34
KEEP_ALIVE = 35
LUMINANCE = 39
AUTO_FOCUS = 40
FOCUS = 43

FOCUS_ONCE = 250
"""This value of the focus makes the camera focus once; it is sharp then."""

"""Devices of the body: their keys in the robot's memory, and what is known of their values. No ROS."""

from __future__ import annotations

import math
from typing import Any

PREFIX = "Device/SubDeviceList/"
"""What all keys of devices begin with."""


def sensor_key(device: str, part: str = "Value") -> str:
    """Key of what a device measures; its `Status` is another part."""
    return f"{PREFIX}{device}/Sensor/{part}"


def temperature_key(device: str) -> str:
    """Key of the temperature in degC of a joint's motor, of the `Head` or the `Battery`."""
    return sensor_key(f"{device}/Temperature")


# --- battery ----------------------------------------------------------------------------------------------------------

CHARGE = sensor_key("Battery/Charge")
"""0..1."""
CURRENT = sensor_key("Battery/Current")
"""A, above 0 while the battery is charged."""
BATTERY_STATUS = sensor_key("Battery/Charge", "Status")
"""A word of bits."""
FULL_BIT, CHARGING_BIT = 6, 7
"""Of the status, counted from 0."""

# Motors are at their limit from the first temperature on, degC, and very hot from the second: the robot itself puts
# their chain to rest then. Source: NAOqi's status of temperatures.
HOT_MOTOR, TOO_HOT_MOTOR = 68.0, 74.0

# --- sonars -----------------------------------------------------------------------------------------------------------

SIDES = ("left", "right")
SONARS = {name: sensor_key(f"US/{name.capitalize()}") for name in SIDES}
"""Side -> key of its echo."""
NEAREST, FARTHEST = 0.25, 2.55
"""m, between which sonars measure."""
SONAR_CONE = 1.05
"""rad, in which a sonar sees something: 60 degrees, as NAO's documentation has it."""


def echo_of(value: Any) -> float:
    """Distance of an echo, m.

    `value`: what the robot's memory says: m to the nearest echo, 0 for a sensor that failed, the farthest or more where
    nothing echoed. Returns infinity where there is nothing, not a number for a sensor that failed.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0.0:
        return math.nan
    return math.inf if value >= FARTHEST else float(value)


# --- feet -------------------------------------------------------------------------------------------------------------

CORNERS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")
"""Where the force sensors of a foot are."""
FOOT_CONTACT = "footContact"
"""Key that is above 0 while a foot touches the ground."""


def weight_keys(side: str) -> list[str]:
    """Keys of what rests on a foot, kg: on its corners, and in all."""
    return [sensor_key(f"{side[0].upper()}Foot/FSR/{part}") for part in (*CORNERS, "TotalWeight")]

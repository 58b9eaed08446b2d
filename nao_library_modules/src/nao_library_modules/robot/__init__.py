"""Calls to the robot's NAOqi, its clock and its events."""

from ..base.doors import door

__all__ = ["Robot"]
__getattr__ = door(__name__, {"Robot": "robot"})

"""The server NaoTactile: touch, sonars, feet, battery, and behaviours that begin when the robot is touched."""

from ..core.lazy import door

__all__ = ["NaoTactile"]
__getattr__ = door(__name__, {"NaoTactile": "tactile_server"})

"""The server NaoLights: LEDs."""

from ..base.doors import door

__all__ = ["NaoLights"]
__getattr__ = door(__name__, {"NaoLights": "server"})

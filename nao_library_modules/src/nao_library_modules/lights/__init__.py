"""The server NaoLights: LEDs."""

from ..core.lazy import door

__all__ = ["NaoLights"]
__getattr__ = door(__name__, {"NaoLights": "lights_server"})

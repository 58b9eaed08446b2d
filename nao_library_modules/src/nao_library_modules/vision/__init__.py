"""Vision: the module NaoVision, and its threads for pictures of any camera, which need neither a NAO nor NAOqi."""

from ..core.lazy import door

__all__ = ["CAMERAS", "PARAMETERS", "ImageThreads", "NaoVision"]
# Threads for another camera import nothing of the robot's.
__getattr__ = door(
    __name__,
    {
        "ImageThreads": "threads",
        "CAMERAS": "vision_server",
        "PARAMETERS": "vision_server",
        "NaoVision": "vision_server",
    },
)

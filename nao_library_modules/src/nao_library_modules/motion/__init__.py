"""The server NaoMotion: joints, postures, effectors, recorded motions, walks."""

from ..core.lazy import door

__all__ = ["NaoMotion"]
__getattr__ = door(__name__, {"NaoMotion": "motion_server"})

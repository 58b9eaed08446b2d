"""The physics engine, PyBullet: no other file imports it."""

from __future__ import annotations

from functools import partial
from typing import Any

import pybullet

LOAD_FLAGS = pybullet.URDF_USE_INERTIA_FROM_FILE | pybullet.URDF_USE_SELF_COLLISION
"""For `loadURDF` of a robot; `model.collision.apart` says which pairs to take out afterwards."""


class Engine:
    """One world of PyBullet: has its functions and constants by PyBullet's names.

    Functions work on this world; without its number PyBullet would silently take the first one of the process.

    Attributes:
        client: PyBullet's number of this world.
    """

    def __init__(self, gui: bool = False) -> None:
        """Begin an empty world; `gui`: with PyBullet's window."""
        self.client: int = pybullet.connect(pybullet.GUI if gui else pybullet.DIRECT)

    def __getattr__(self, name: str) -> Any:
        found = getattr(pybullet, name)
        if callable(found):
            found = partial(found, physicsClientId=self.client)
        self.__dict__[name] = found  # this method is called once for each name
        return found

"""Velocities in space, and one joint's angle with its velocity."""

from __future__ import annotations

import math

from almath._components import Components, Linear, as_number, unit


class Velocity3D(Linear):
    """A linear velocity.

    Attributes:
        xd: In m/s.
        yd: In m/s.
        zd: In m/s.
    """

    xd: float
    yd: float
    zd: float

    _names = ("xd", "yd", "zd")
    _defaults = (0.0, 0.0, 0.0)
    _one_number_fills_all = True

    def norm(self) -> float:
        """Speed, in m/s."""
        return math.sqrt(sum(value * value for value in self._values()))

    def normalize(self) -> Velocity3D:
        """Vector of length 1 in the same direction."""
        return unit(self, self.norm())


class Velocity6D(Linear):
    """A linear and an angular velocity.

    Attributes:
        xd: In m/s.
        yd: In m/s.
        zd: In m/s.
        wxd: In rad/s.
        wyd: In rad/s.
        wzd: In rad/s.
    """

    xd: float
    yd: float
    zd: float
    wxd: float
    wyd: float
    wzd: float

    _names = ("xd", "yd", "zd", "wxd", "wyd", "wzd")
    _defaults = (0.0,) * 6
    _one_number_fills_all = True

    def norm(self) -> float:
        """Root of the sum of the squares of all six numbers, m/s and rad/s alike."""
        return math.sqrt(sum(value * value for value in self._values()))

    def normalize(self) -> Velocity6D:
        """Divide all six numbers by the norm."""
        return unit(self, self.norm())


class PositionAndVelocity(Components):
    """Where one joint is and how fast it moves.

    Attributes:
        q: Position, in rad or m.
        dq: Velocity, in rad/s or m/s.
    """

    q: float
    dq: float

    _names = ("q", "dq")

    def __init__(self, q: float = 0.0, dq: float = 0.0) -> None:
        """Set position and velocity."""
        self._assign((as_number(q, "PositionAndVelocity.q"), as_number(dq, "PositionAndVelocity.dq")))

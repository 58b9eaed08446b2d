"""Velocities in space, and one joint's angle with its velocity."""

from __future__ import annotations

from almath._components import Components, Linear, Vector, as_number


class Velocity3D(Linear, Vector):
    """A linear velocity."""

    xd: float  # m/s
    yd: float  # m/s
    zd: float  # m/s


class Velocity6D(Linear, Vector):
    """A linear and an angular velocity."""

    xd: float  # m/s
    yd: float  # m/s
    zd: float  # m/s
    wxd: float  # rad/s
    wyd: float  # rad/s
    wzd: float  # rad/s


class PositionAndVelocity(Components):
    """Where one joint is and how fast it moves."""

    q: float  # position, rad or m
    dq: float  # velocity, rad/s or m/s

    def __init__(self, q: float = 0.0, dq: float = 0.0) -> None:
        self._assign((as_number(q, "PositionAndVelocity.q"), as_number(dq, "PositionAndVelocity.dq")))

"""Pairs of values: a point with a quaternion, a transform with a velocity."""

from __future__ import annotations

from almath._components import require
from almath.positions import Position3D, Velocity6D
from almath.quaternion import Quaternion
from almath.transform import Transform


class Displacement:
    """A translation and a rotation. `P`: the translation, in m. `Q`: the rotation."""

    def __init__(self, P: Position3D | None = None, Q: Quaternion | None = None) -> None:
        """Copy the parts; one that is left out is the identity."""
        self.P = Position3D() if P is None else Position3D(P)
        self.Q = Quaternion() if Q is None else Quaternion(Q)

    def __mul__(self, other: Displacement) -> Displacement:
        """Chain two displacements."""
        if not isinstance(other, Displacement):
            return NotImplemented
        return Displacement(self.P + self.Q * other.P, self.Q * other.Q)

    def __imul__(self, other: Displacement) -> Displacement:
        """Chain another displacement to this one, in place."""
        product = self * other
        self.P, self.Q = product.P, product.Q
        return self

    def isNear(self, other: Displacement, epsilon: float = 0.0001) -> bool:
        """Tell whether translation and rotation differ by no more than `epsilon` in each number."""
        require(other, Displacement, "Displacement.isNear")
        return self.P.isNear(other.P, epsilon) and self.Q.isNear(other.Q, epsilon)

    def __repr__(self) -> str:
        return f"Displacement(P={self.P!r}, Q={self.Q!r})"


class TransformAndVelocity6D:
    """Where a frame is and how it moves. `T`: the frame. `V`: its velocity."""

    def __init__(self, T: Transform | None = None, V: Velocity6D | None = None) -> None:
        """Copy the parts; without them the frame is the identity, at rest."""
        self.T = Transform() if T is None else Transform(T)
        self.V = Velocity6D() if V is None else Velocity6D(V)

    def isNear(self, other: TransformAndVelocity6D, epsilon: float = 0.0001) -> bool:
        """Tell whether frame and velocity differ by no more than `epsilon` in each number."""
        require(other, TransformAndVelocity6D, "TransformAndVelocity6D.isNear")
        return self.T.isNear(other.T, epsilon) and self.V.isNear(other.V, epsilon)

    def __repr__(self) -> str:
        return f"TransformAndVelocity6D(T={self.T!r}, V={self.V!r})"

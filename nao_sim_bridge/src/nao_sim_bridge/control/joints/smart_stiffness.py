"""Smart stiffness: motors of a robot that keeps still give no more torque than its posture needs, and some to spare.

As soon as anything moves, by command or because something pushes, all motors have what the caller's stiffness gives.

Source: the rule is ALMotion's ("reflexes, smart stiffness"): static torque alone, the lower of both values applies.
"""

from __future__ import annotations

from typing import Sequence

# A posture is static when no command has changed for this time, s.
SETTLING = 1.0
# What motors have beyond the torque that the posture needs: this factor, and this share of their full torque.
FACTOR, SPARE = 1.5, 0.25
# A joint that turns away from where it settled by this, rad, moves.
MOVED = 0.01
ALL: tuple[float, ...] = ()


class SmartStiffness:
    """Watches whether the robot keeps still; the motors have (26,) `max_torques`, N m.

    Attributes:
        enabled: Whether the torque of a static posture is limited.
    """

    def __init__(self, max_torques: Sequence[float]) -> None:
        self.enabled = True
        self._max_torques = tuple(max_torques)
        self._still = 0.0
        self._settled: Sequence[float] = ()
        self._shares = ALL

    def shares(
        self, commanded: bool, positions: Sequence[float], torques: Sequence[float], dt: float
    ) -> tuple[float, ...]:
        """Share of the full torque that each motor may give at this tick of `dt` s; empty for all of it.

        Args:
            commanded: Whether the motors were told to move in the last tick.
            positions: (26,) measured, rad.
            torques: (26,) measured, N m.
        """
        if commanded or not self.enabled:
            self._still, self._shares = 0.0, ALL
        elif self._shares is not ALL:
            if max([abs(now - then) for now, then in zip(positions, self._settled)]) > MOVED:
                self._still, self._shares = 0.0, ALL
        else:
            self._still += dt
            if self._still >= SETTLING:
                self._settled = positions
                self._shares = tuple(
                    min(1.0, SPARE + FACTOR * abs(torque) / most) for torque, most in zip(torques, self._max_torques)
                )
        return self._shares

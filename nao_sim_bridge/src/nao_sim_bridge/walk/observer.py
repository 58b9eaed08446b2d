"""Place and speed of the centre of mass along one axis: a pendulum that is corrected by what is measured."""

from __future__ import annotations


class PendulumObserver:
    """Knows between two measurements how a body over its feet moves, so that noise need not be filtered by waiting.

    Attributes:
        place: m.
        speed: m/s.

    Args:
        omega: Frequency of the pendulum, rad/s.
        place_gain: Share of the difference to the measured place that is taken over at a tick.
        speed_gain: Share of that difference over the time of a tick that is added to the speed.
    """

    def __init__(self, omega: float, place_gain: float, speed_gain: float) -> None:
        self._omega = omega
        self._place_gain = place_gain
        self._speed_gain = speed_gain
        self.place = 0.0
        self.speed = 0.0

    @property
    def divergent(self) -> float:
        """Divergent component of motion, m."""
        return self.place + self.speed / self._omega

    def reset(self, place: float, speed: float) -> None:
        self.place, self.speed = place, speed

    def update(self, measured: float, pressure: float, dt: float) -> None:
        """Take in a measurement.

        Args:
            measured: Place of the centre of mass, m.
            pressure: Place of the zero moment point that is planned, m.
            dt: Since the last measurement, s.
        """
        acceleration = self._omega * self._omega * (self.place - pressure)
        self.place += dt * (self.speed + 0.5 * dt * acceleration)
        self.speed += dt * acceleration
        off = measured - self.place
        self.place += self._place_gain * off
        self.speed += self._speed_gain * off / dt

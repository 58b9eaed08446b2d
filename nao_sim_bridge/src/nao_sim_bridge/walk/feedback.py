"""What keeps a walk on its feet: the body as encoders and inertial unit see it, held against the plan."""

from __future__ import annotations

from math import atan2, cos, hypot, sin
from typing import Tuple

from nao_sim_bridge.walk.body import LegPose, WalkingBody
from nao_sim_bridge.walk.legs import LEFT
from nao_sim_bridge.walk.matrices import Vector, about_y, then_about_x, turned
from nao_sim_bridge.walk.pattern import PendulumObserver
from nao_sim_bridge.walk.plan import WalkPlan
from nao_sim_bridge.walk.settings import WalkSettings

Vector2 = Tuple[float, float]


class WalkFeedback:
    """Answers to what the body does beside the plan.

    Attributes:
        error: Of the divergent component, ahead and to the left as the foot that carries points, m.
        shift: Of the centre of mass in the plan's frame, m.
        ankle: What the ankles of legs that carry get, roll and pitch, rad.

    Args:
        omega: Frequency of the pendulum, rad/s.
    """

    def __init__(self, settings: WalkSettings, body: WalkingBody, omega: float) -> None:
        self._settings = settings
        self._body = body
        gains = (omega, settings.observer_place, settings.observer_speed)
        self._x, self._y = PendulumObserver(*gains), PendulumObserver(*gains)
        self._support: int | None = None
        # Divergent component and pressure that were planned when the readings were taken: at the end of the last tick.
        self._planned: Tuple[Vector2, Vector2] | None = None
        self._own: Vector2 = (0.0, 0.0)
        self._usual: Vector2 = (0.0, 0.0)
        self.error: Vector2 = (0.0, 0.0)
        self.shift: Vector2 = (0.0, 0.0)
        self.ankle: Vector2 = (0.0, 0.0)

    def update(
        self, plan: WalkPlan, pose: LegPose, upper: Vector, tilt: Vector2, gyro: Vector2, dt: float, share: float
    ) -> None:
        """Take in the readings of a tick.

        Args:
            plan: Advanced to now.
            pose: Measured angles of the legs, rad.
            upper: Mass moment of what is above them, kg m.
            tilt: Roll and pitch of the torso by the inertial unit, rad.
            gyro: Turn rate of the torso about its X and Y axis, rad/s.
            dt: Of the tick, s.
            share: How much of the answers counts, 0..1.
        """
        settings = self._settings
        x, y = self._measured(plan, pose, upper, tilt)
        observers = (self._x, self._y)
        now = (plan.divergent, plan.pressure)
        divergent, pressure = self._planned or now
        self._planned = now
        if self._support != plan.support:
            # What was measured from one foot does not meet what is measured from the other; the speed does.
            for observer, place in zip(observers, (x, y)):
                observer.reset(place, observer.speed if self._support is not None else 0.0)
            self._support = plan.support
        else:
            self._x.update(x, pressure[0], dt)
            self._y.update(y, pressure[1], dt)
        off_x, off_y = self._x.divergent - divergent[0], self._y.divergent - divergent[1]
        off_x, off_y = self._beside_habit(off_x, off_y, dt)
        yaw = plan.feet[plan.support].yaw
        c, s = cos(yaw), sin(yaw)
        self.error = (c * off_x + s * off_y, c * off_y - s * off_x)
        keep, limit = settings.shift_smoothing, settings.shift_limit
        ahead, aside = (
            old + keep * (min(max(share * settings.shift_gain * off, -limit), limit) - old)
            for old, off in zip(self._own, self.error)
        )
        self._own = (ahead, aside)
        self.shift = (s * aside - c * ahead, -(s * ahead + c * aside))
        damping = share * settings.ankle_damping
        self.ankle = (damping * gyro[0], damping * gyro[1])

    def _beside_habit(self, x: float, y: float, dt: float) -> Vector2:
        """What is unusual of an error, m; the usual one is learned: it comes from a slope, a load, a tilted sensor."""
        settings = self._settings
        usual_x, usual_y = self._usual
        if hypot(x - usual_x, y - usual_y) < settings.habit_within:
            share = dt / settings.habit_time
            usual_x, usual_y = usual_x + share * (x - usual_x), usual_y + share * (y - usual_y)
            size = hypot(usual_x, usual_y)
            most = settings.habit_limit / size if size > settings.habit_limit else 1.0
            self._usual = (most * usual_x, most * usual_y)
        return (x - usual_x, y - usual_y)

    def _measured(self, plan: WalkPlan, pose: LegPose, upper: Vector, tilt: Vector2) -> Vector2:
        """Place of the centre of mass in the plan's frame, seen from the foot that carries."""
        com, legs = self._body.center_of_mass(upper, pose)
        ankle, foot = legs[0 if plan.support == LEFT else 1]
        level = then_about_x(about_y(tilt[1]), tilt[0])
        up_x, up_y, _ = turned(level, (foot[2], foot[5], foot[8]))
        ahead_x, ahead_y, _ = turned(level, (foot[0], foot[3], foot[6]))
        height = self._body.legs.sole_height
        x, y, _ = turned(level, (com[0] - ankle[0], com[1] - ankle[1], com[2] - ankle[2]))
        x, y = x + up_x * height, y + up_y * height
        stands = plan.feet[plan.support]
        turn = stands.yaw - atan2(ahead_y, ahead_x)
        c, s = cos(turn), sin(turn)
        return (stands.x + c * x - s * y, stands.y + s * x + c * y)

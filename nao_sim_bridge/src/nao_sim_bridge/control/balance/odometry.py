"""Where the robot believes that it is: dead reckoning of the foot that carries it, headings from the inertial unit.

Its world is where the robot stood at the start: the origin on the ground between the feet, X where they pointed. The
ground is taken for level, and the point of the sole below the ankle of the foot that carries for a fixed point on it,
also while the foot rolls over an edge; slips go unnoticed, as on a real robot. A foot that lands may bounce: while no
foot carries for a moment, the torso goes on at the velocity it had.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Sequence

from nao_sim_bridge.base.readings import Pose
from nao_sim_bridge.base.rotations import Quaternion, Vector3, from_roll_pitch_yaw, plus, rotate
from nao_sim_bridge.control.balance.stance import stance_reader
from nao_sim_bridge.model.robot_model import RobotModel

LEFT, RIGHT = 0, 1
# The other foot takes over when it carries so many times the load of the one before.
TAKE_OVER = 2.0
# A bounce at a landing lasts 2 or 3 ticks; a robot that lies, or is lifted, has no load for longer.
COAST_TICKS = 6
# The velocity of the torso is that over so many ticks: a landing shakes the body, and encoders are noisy.
VELOCITY_TICKS = 4


class Odometry:
    """Follows the torso from encoders, inertial unit and foot sensors, a few microseconds a tick.

    Attributes:
        torso: Pose of the torso in the world of odometry.

    Args:
        positions: (26,) joint angles at the start, rad.
        tilt: Roll, pitch and yaw at the start by the inertial unit, rad.
    """

    def __init__(self, model: RobotModel, positions: Sequence[float], tilt: Sequence[float]) -> None:
        self._reader = stance_reader(model)
        level = from_roll_pitch_yaw(tilt[0], tilt[1], 0.0)
        ahead = [rotate(level, self._reader.toe_direction(side, positions)) for side in (LEFT, RIGHT)]
        heading = math.atan2(ahead[LEFT][1] + ahead[RIGHT][1], ahead[LEFT][0] + ahead[RIGHT][0])
        self._start_yaw = tilt[2] + heading
        turn = self._turn(tilt)
        left, right = (rotate(turn, self._reader.sole_center(side, positions)) for side in (LEFT, RIGHT))
        self._foot = LEFT if left[2] <= right[2] else RIGHT
        height = -min(left[2], right[2])
        self.torso = Pose((-(left[0] + right[0]) / 2, -(left[1] + right[1]) / 2, height), turn)
        self._anchor = plus(self.torso.position, (left, right)[self._foot])
        self._ticks_in_air = 0
        self._places = deque([self.torso.position], maxlen=VELOCITY_TICKS + 1)

    def update(self, positions: Sequence[float], tilt: Sequence[float], loads: Sequence[float]) -> Pose:
        """Take in the readings of a tick.

        Args:
            positions: (26,) measured joint angles, rad.
            tilt: Roll, pitch and yaw of the torso by the inertial unit, rad.
            loads: Upward force on the left and on the right foot, N.
        """
        turn = self._turn(tilt)
        sole = rotate(turn, self._reader.sole_center(self._foot, positions))
        loads = [max(load, 0.0) for load in loads]  # what presses from above carries nothing
        self._ticks_in_air = 0 if any(loads) else self._ticks_in_air + 1
        if self._ticks_in_air > COAST_TICKS:
            # Lifted or lying: nothing tells where it goes.
            self._anchor = plus(self.torso.position, sole)
        elif self._ticks_in_air:
            self._anchor = plus(plus(self.torso.position, self._step()), sole)
        x, y, z = self._anchor
        self.torso = Pose((x - sole[0], y - sole[1], z - sole[2]), turn)
        self._places.append(self.torso.position)
        other = RIGHT if self._foot == LEFT else LEFT
        if loads[other] > TAKE_OVER * loads[self._foot]:
            self._foot = other
            x, y, _ = plus(self.torso.position, rotate(turn, self._reader.sole_center(other, positions)))
            self._anchor = (x, y, 0.0)
        return self.torso

    def _step(self) -> Vector3:
        """How far the torso has gone in a tick of late, m; on the level."""
        (x, y, _), (x_now, y_now, _) = self._places[0], self._places[-1]
        ticks = max(len(self._places) - 1, 1)
        return (x_now - x) / ticks, (y_now - y) / ticks, 0.0

    def _turn(self, tilt: Sequence[float]) -> Quaternion:
        return from_roll_pitch_yaw(tilt[0], tilt[1], tilt[2] - self._start_yaw)

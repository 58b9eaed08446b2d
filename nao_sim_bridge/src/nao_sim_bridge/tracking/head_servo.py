"""Turns the head to angles that may change at any time, at limited speed and acceleration. Simulation thread only."""

from __future__ import annotations

import math
from typing import Any, Tuple

from nao_sim_bridge.tracking.geometry import HEAD

# How near counts as there, rad.
THERE = 1e-4
# Somebody else has moved a command by more than this since, rad.
MOVED = 0.02


class HeadServo:
    """Moves HeadYaw and HeadPitch, a little at each tick, as long as nobody else has them.

    Attributes:
        velocity: rad/s, at most.
        acceleration: rad/s2, at most.
        resting: Whether the head has got to where it should be, or need not go anywhere.
    """

    def __init__(self, simulation: Any, velocity: float, acceleration: float) -> None:
        self.velocity = velocity
        self.acceleration = acceleration
        self._simulation = simulation
        self._indices = tuple(simulation.model.joint_index[name] for name in HEAD)
        self._target: Tuple[float, float] | None = None
        self._angles = [0.0, 0.0]
        self._speeds = [0.0, 0.0]
        self.resting = True

    @property
    def limp(self) -> bool:
        stiffnesses = self._simulation.robot.joints.stiffnesses
        return any(stiffnesses[i] == 0.0 for i in self._indices)

    def aim(self, target: Tuple[float, float]) -> None:
        """Turn to HeadYaw and HeadPitch, rad."""
        if self._target is None:
            self._take_up()
        self._target, self.resting = target, False

    def stop(self) -> None:
        """Leave the head where it is."""
        self._target, self.resting = None, True

    def tick(self, dt: float) -> None:
        """Move on by `dt` seconds."""
        if self._target is None or self.resting:
            return
        robot = self._simulation.robot
        if robot.motion.busy(self._indices) or self.limp:
            self._take_up()
            return
        if any(abs(robot.joints.commands[i] - a) > MOVED for i, a in zip(self._indices, self._angles)):
            self._take_up()
        there = [self._step(0, self._target[0], dt)]
        # How far the head can be lifted and lowered depends on where it is turned to.
        low, high = robot.joints.limits_beside(self._indices[1], self._angles[0])
        there.append(self._step(1, min(max(self._target[1], low), high), dt))
        self._angles[1] = min(max(self._angles[1], low), high)
        speeds = {i: robot.model.joints[i].max_velocity for i in self._indices}
        robot.motion.set_targets(dict(zip(self._indices, self._angles)), speeds)
        self.resting = all(there)

    def _take_up(self) -> None:
        """Begin from where the head is told to be now."""
        commands = self._simulation.robot.joints.commands
        self._angles = [commands[i] for i in self._indices]
        self._speeds = [0.0, 0.0]

    def _step(self, axis: int, target: float, dt: float) -> bool:
        """Move an axis; whether it is there."""
        away = target - self._angles[axis]
        if abs(away) < THERE and abs(self._speeds[axis]) < self.acceleration * dt * 2.0:
            self._angles[axis], self._speeds[axis] = target, 0.0
            return True
        # The speed from which it can still come to rest at the target.
        wanted = math.copysign(min(self.velocity, math.sqrt(2.0 * self.acceleration * abs(away)), abs(away) / dt), away)
        change = self.acceleration * dt
        speed = min(max(wanted, self._speeds[axis] - change), self._speeds[axis] + change)
        self._speeds[axis] = speed
        self._angles[axis] += speed * dt
        return False

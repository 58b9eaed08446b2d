"""What the motors of the robot are told: command angles and stiffnesses, in ALMotion's Body order.

Only the simulation thread writes. Readers in other threads take the tuples `commands` and `stiffnesses`, which are
replaced as a whole and never changed.
"""

from __future__ import annotations

from typing import Container, Sequence

from nao_sim_bridge.sim.model import RobotModel

# How far a limp joint is moved before the friction of its gears slips, in rad: teeth give a little, then slide.
STICTION = 0.002


class JointCommands:
    """Command angle and stiffness of each of the 26 joints.

    Attributes:
        commands: (26,) command angles, rad (hands 0..1).
        stiffnesses: (26,) fraction of the full torque, 0 (limp) to 1.
        velocities: (26,) change of the command in the last tick, rad/s.
        rests: (26,) angle at which the gears of a limp joint stick, rad; of no meaning for stiff ones.
        changed: True when the motors must be told anew.
    """

    # Both joints turn with the one motor of the left hip.
    COUPLED = ("LHipYawPitch", "RHipYawPitch")

    def __init__(self, model: RobotModel, angles: Sequence[float]) -> None:
        self._lower = tuple(j.lower for j in model.joints)
        self._upper = tuple(j.upper for j in model.joints)
        self._left, self._right = (model.joint_index[name] for name in self.COUPLED)
        self._max_velocity = tuple(j.max_velocity for j in model.joints)
        self.commands: tuple[float, ...] = tuple(float(a) for a in angles)
        self.stiffnesses: tuple[float, ...] = (0.0,) * len(self.commands)
        self.velocities: tuple[float, ...] = (0.0,) * len(self.commands)
        self.rests: tuple[float, ...] = self.commands
        self.changed = True

    def clamp(self, index: int, angle: float) -> float:
        """`angle` moved into the limits of joint `index`."""
        return min(max(angle, self._lower[index]), self._upper[index])

    def step(self, wanted: dict[int, float], dt: float) -> None:
        """Move commands towards `wanted` (index -> rad) by at most what the motors can do within `dt` seconds."""
        if not wanted:
            if any(self.velocities):
                self.velocities = (0.0,) * len(self.commands)
                self.changed = True
            return
        commands = list(self.commands)
        velocities = [0.0] * len(commands)
        for index, angle in wanted.items():
            reach = self._max_velocity[index] * dt
            before = commands[index]
            angle = self.clamp(index, angle)
            angle = min(max(angle, before - reach), before + reach)
            commands[index] = angle
            velocities[index] = (angle - before) / dt
        if self._left in wanted:
            self._mirror(commands, velocities, self._left, self._right)
        elif self._right in wanted:
            self._mirror(commands, velocities, self._right, self._left)
        self.commands, self.velocities, self.changed = tuple(commands), tuple(velocities), True

    @staticmethod
    def _mirror(commands: list[float], velocities: list[float], source: int, target: int) -> None:
        commands[target], velocities[target] = commands[source], velocities[source]

    def overruled(self, index: int, wanted: Container[int]) -> bool:
        """Whether joint `index` goes where another one of `wanted` goes: the left hip wins over the right."""
        return index == self._right and self._left in wanted

    def slip(self, measured: Sequence[float]) -> None:
        """Let the rests of limp joints follow where something has moved them to; `measured` in rad."""
        if all(self.stiffnesses):
            return
        rests = tuple(min(max(rest, angle - STICTION), angle + STICTION) for rest, angle in zip(self.rests, measured))
        if rests != self.rests:
            self.rests, self.changed = rests, True

    def hold(self, angles: Sequence[float], indices: Sequence[int]) -> None:
        """Take measured `angles` as commands of `indices`, so that stiffening them makes no jump."""
        commands = list(self.commands)
        for index in indices:
            commands[index] = self.clamp(index, angles[index])
        self.commands, self.changed = tuple(commands), True

    def set_stiffness(self, values: dict[int, float]) -> None:
        """Set stiffness, 0..1, of joints by index; both HipYawPitch take the newer one's."""
        stiffnesses = list(self.stiffnesses)
        for index, value in values.items():
            stiffnesses[index] = min(max(value, 0.0), 1.0)
            if index in (self._left, self._right):
                stiffnesses[self._left] = stiffnesses[self._right] = stiffnesses[index]
        self.stiffnesses, self.changed = tuple(stiffnesses), True

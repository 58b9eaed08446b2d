"""What the motors of the robot are told: command angles and stiffnesses, in ALMotion's Body order.

Only the simulation thread writes. Readers in other threads take the tuples `commands` and `stiffnesses`, which are
replaced as a whole and never changed.
"""

from __future__ import annotations

import math
from typing import Callable, Collection, Container, Mapping, Sequence

from nao_sim_bridge.model.robot_model import RobotModel

# How far a limp joint is moved before the friction of its gears slips, in rad: teeth give a little, then slide.
STICTION = 0.002

# (commands of the last tick, commands that are about to be given) -> joints that must stay where they are.
Guard = Callable[[Sequence[float], Sequence[float]], Collection[int]]


class JointCommands:
    """Command angle and stiffness of each of the 26 joints.

    Attributes:
        names: (26,) names of the joints.
        commands: (26,) command angles, rad (hands 0..1).
        stiffnesses: (26,) fraction of the full torque, 0 (limp) to 1.
        velocities: (26,) change of the command in the last tick, rad/s.
        rests: (26,) angle at which the gears of a limp joint stick, rad; of no meaning for stiff ones.
        efforts: (26,) fraction of the full torque that the motors give: the stiffness, or less when something saves
            or protects them.
        corrections: Joint index to what balance adds to its command, rad; nobody who asks for commands sees it.
        speed_shares: Joint index to the share of its top speed that it may use, for those that may not use all.
        guard: Who keeps joints from where they must not go; None when nobody does.
        blocked: Joints that the guard kept in their place in the last step.
        kept_limp: Joints whose stiffness stays 0 whatever anybody wants.
        changed: True when the motors must be told anew.
    """

    # Both joints turn with the one motor of the left hip.
    COUPLED = ("LHipYawPitch", "RHipYawPitch")

    def __init__(self, model: RobotModel, angles: Sequence[float]) -> None:
        self.names = tuple(j.name for j in model.joints)
        self._lower = tuple(j.lower for j in model.joints)
        self._upper = tuple(j.upper for j in model.joints)
        self._left, self._right = (model.joint_index[name] for name in self.COUPLED)
        self._max_velocity = tuple(j.max_velocity for j in model.joints)
        self.commands: tuple[float, ...] = tuple(float(a) for a in angles)
        self.stiffnesses: tuple[float, ...] = (0.0,) * len(self.commands)
        self.velocities: tuple[float, ...] = (0.0,) * len(self.commands)
        self.rests: tuple[float, ...] = self.commands
        self.efforts: tuple[float, ...] = self.stiffnesses
        self.corrections: Mapping[int, float] = {}
        self.speed_shares: Mapping[int, float] = {}
        self.guard: Guard | None = None
        self.blocked: Collection[int] = ()
        self.kept_limp: frozenset[int] = frozenset()
        self._couplings = tuple(model.coupled_limits.values())
        self._coupling_of = {coupling.joint: coupling for coupling in self._couplings}
        # Joints that the speed of their motor keeps out of a limit which has moved.
        self._late: set[int] = set()
        self._effort_shares: Sequence[float] = ()
        self._correction_speeds: Mapping[int, float] = {}
        self.changed = True

    @property
    def aims(self) -> Sequence[float]:
        """(26,) where the motors are told to go: commands and corrections, within the limits, rad (hands 0..1)."""
        if not self.corrections:
            return self.commands
        aims = list(self.commands)
        for index, correction in self.corrections.items():
            aims[index] = self.clamp(index, aims[index] + correction)
        return aims

    @property
    def aim_velocities(self) -> Sequence[float]:
        """(26,) how fast the aims moved in the last tick, rad/s."""
        if not self._correction_speeds:
            return self.velocities
        velocities = list(self.velocities)
        for index, speed in self._correction_speeds.items():
            velocities[index] += speed
        return velocities

    def limits(self, index: int) -> tuple[float, float]:
        """Lower and upper limit of joint `index` where the other joints are now, rad (hands 0..1)."""
        coupling = self._coupling_of.get(index)
        if coupling is None:
            return self._lower[index], self._upper[index]
        return self.limits_beside(index, self.commands[coupling.by])

    def limits_alone(self, index: int) -> tuple[float, float]:
        """Lower and upper limit that joint `index` has wherever the other joints are, rad."""
        return self._lower[index], self._upper[index]

    def coupled_by(self, index: int) -> int | None:
        """The joint that the limits of joint `index` depend on, if any."""
        coupling = self._coupling_of.get(index)
        return None if coupling is None else coupling.by

    def limits_beside(self, index: int, other: float) -> tuple[float, float]:
        """Lower and upper limit of a coupled joint when the joint it depends on is at `other`, all in rad."""
        lower, upper = self._coupling_of[index].limits_at(other)
        return max(lower, self._lower[index]), min(upper, self._upper[index])

    def top_speed(self, index: int) -> float:
        """How fast the motor of joint `index` turns it, rad/s."""
        return self._max_velocity[index]

    def clamp(self, index: int, angle: float) -> float:
        """`angle` moved into the limits of joint `index`, see `limits`."""
        lower, upper = self.limits(index)
        return min(max(angle, lower), upper)

    def clamp_alone(self, index: int, angle: float) -> float:
        """`angle` moved into the limits that joint `index` has wherever the other joints are."""
        return min(max(angle, self._lower[index]), self._upper[index])

    def step(self, wanted: Mapping[int, float], dt: float) -> None:
        """Move commands towards `wanted` (index -> rad) by at most what the motors can do within `dt` seconds."""
        if not (wanted or self._late):
            self.blocked = ()
            if any(self.velocities):
                self.velocities = (0.0,) * len(self.commands)
                self.changed = True
            return
        before, commands = self.commands, list(self.commands)
        lower, upper, top, shares = self._lower, self._upper, self._max_velocity, self.speed_shares
        for index, angle in wanted.items():
            reach = top[index] * dt
            if shares:
                reach *= shares.get(index, 1.0)
            old = before[index]
            # Chains of comparisons: this runs for every joint at every tick.
            if angle > upper[index]:
                angle = upper[index]
            elif angle < lower[index]:
                angle = lower[index]
            if angle > old + reach:
                angle = old + reach
            elif angle < old - reach:
                angle = old - reach
            commands[index] = angle
        if self._left in wanted:
            commands[self._right] = commands[self._left]
        elif self._right in wanted:
            commands[self._left] = commands[self._right]
        self._keep_coupled(wanted, commands, dt)
        self.blocked = self.guard(before, commands) if self.guard is not None else ()
        for index in self.blocked:
            commands[index] = before[index]
        self.velocities = tuple([(new - old) / dt for new, old in zip(commands, before)])
        self.commands, self.changed = tuple(commands), True

    def _keep_coupled(self, wanted: Container[int], commands: list[float], dt: float) -> None:
        """Bring joints into the limits that the others' new commands leave them, as fast as their motors can."""
        for coupling in self._couplings:
            joint = coupling.joint
            if not (joint in wanted or coupling.by in wanted or joint in self._late):
                continue
            lower, upper = self.limits_beside(joint, commands[coupling.by])
            angle = min(max(commands[joint], lower), upper)
            reach = self._max_velocity[joint] * dt
            old = self.commands[joint]
            commands[joint] = min(max(angle, old - reach), old + reach)
            if commands[joint] == angle:
                self._late.discard(joint)
            else:
                self._late.add(joint)

    def overruled(self, index: int, wanted: Container[int]) -> bool:
        """Whether joint `index` goes where another one of `wanted` goes: the left hip wins over the right."""
        return index == self._right and self._left in wanted

    def slip(self, measured: Sequence[float]) -> None:
        """Let the rests of limp joints follow where something has moved them to; `measured` in rad."""
        if all(self.efforts):
            return
        rests = tuple(min(max(rest, angle - STICTION), angle + STICTION) for rest, angle in zip(self.rests, measured))
        if rests != self.rests:
            self.rests, self.changed = rests, True

    def put_right(self, measured: Sequence[float]) -> list[int]:
        """Replace what is not finite: commands by `measured` angles (rad), stiffnesses by 0; the joints it was."""
        bad = [
            index
            for index, numbers in enumerate(zip(self.commands, self.stiffnesses, self.rests))
            if not math.isfinite(sum(numbers))
        ]
        self.stiffnesses = tuple(value if math.isfinite(value) else 0.0 for value in self.stiffnesses)
        self._tell_efforts()
        self.velocities = (0.0,) * len(self.commands)
        self.corrections, self._correction_speeds = {}, {}
        self.rests = tuple(angle if i in bad else rest for i, (rest, angle) in enumerate(zip(self.rests, measured)))
        self.hold(measured, bad)
        return bad

    def hold(self, angles: Sequence[float], indices: Sequence[int]) -> None:
        """Take measured `angles` as commands of `indices`, so that stiffening them makes no jump."""
        commands = list(self.commands)
        for index in indices:
            commands[index] = self.clamp_alone(index, angles[index])
        self.commands, self.changed = tuple(commands), True

    def correct(self, wanted: Mapping[int, float], dt: float) -> None:
        """Move the corrections towards `wanted` (index -> rad), as far as the motors can within `dt` seconds.

        A joint that is not in `wanted` goes back to its command.
        """
        if not (wanted or self.corrections or self._correction_speeds):
            return
        before, after, speeds = self.corrections, {}, {}
        for index in {**before, **wanted}:
            old = before.get(index, 0.0)
            reach = self._max_velocity[index] * dt
            new = min(max(wanted.get(index, 0.0), old - reach), old + reach)
            if new != old:
                speeds[index] = (new - old) / dt
            if new != 0.0:
                after[index] = new
        self.corrections, self._correction_speeds, self.changed = after, speeds, True

    def set_stiffness(self, values: dict[int, float]) -> None:
        """Set stiffness, 0..1, of joints by index; both HipYawPitch take the newer one's."""
        stiffnesses = list(self.stiffnesses)
        for index, value in values.items():
            stiffnesses[index] = min(max(value, 0.0), 1.0)
            if index in (self._left, self._right):
                stiffnesses[self._left] = stiffnesses[self._right] = stiffnesses[index]
        for index in self.kept_limp:
            stiffnesses[index] = 0.0
        self.stiffnesses = tuple(stiffnesses)
        self._tell_efforts()

    def share_efforts(self, shares: Sequence[float]) -> None:
        """Let the motors give at most these shares of the full torque, one each; nothing limits them when empty."""
        if shares != self._effort_shares:
            self._effort_shares = shares
            self._tell_efforts()

    def _tell_efforts(self) -> None:
        self.efforts = self.stiffnesses
        if self._effort_shares:
            self.efforts = tuple(map(min, self.stiffnesses, self._effort_shares))
        self.changed = True

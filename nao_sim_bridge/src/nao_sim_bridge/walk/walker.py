"""The walk of one robot: plan, feedback and legs put together. Numbers in, joint angles out."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import Dict, NamedTuple, Sequence

from nao_sim_bridge.walk.body import WalkingBody
from nao_sim_bridge.walk.feedback import Vector2, WalkFeedback
from nao_sim_bridge.walk.footsteps import FootPose, middle
from nao_sim_bridge.walk.legs import LEFT, RIGHT, Sole
from nao_sim_bridge.walk.matrices import (
    Matrix,
    Vector,
    about_y,
    about_z,
    product,
    then_about_x,
    then_about_y,
    turned,
)
from nao_sim_bridge.walk.plan import Phase, WalkPlan
from nao_sim_bridge.walk.settings import WalkSettings

# From this share of its way on a foot may land.
LANDING = 0.6
# It has landed when it has felt the ground within this time, s: one that bounces a little, or, when the body is far off
# the plan, one that a toe has touched with.
BOUNCE, TOUCH = 0.12, 0.02
# Of a leg's five angles below the hip's yaw.
ANKLE_PITCH, ANKLE_ROLL = 3, 4


class Readings(NamedTuple):
    """What the robot senses at a tick.

    Attributes:
        positions: (26,) joint angles, rad.
        tilt: Roll and pitch of the torso by the inertial unit, rad.
        gyro: Turn rate of the torso about its X and Y axis, rad/s.
        loads: Force under the left and the right foot, N.
    """

    positions: Sequence[float]
    tilt: Vector2
    gyro: Vector2
    loads: Vector2


class _Stance(NamedTuple):
    """How a robot stands on flat feet, left and right, seen from the middle between them.

    `height` is that of the centre of mass over the ground, m, `turn` roll, pitch and yaw of the torso, rad.
    """

    feet: tuple[FootPose, FootPose]
    com: tuple[float, float]
    height: float
    turn: Vector


class Walker:
    """See the module.

    Attributes:
        plan: Where feet and body are to be.
        feedback: What is done about where they are not.

    Args:
        commands: (26,) commanded angles to start from, rad.
    """

    def __init__(self, body: WalkingBody, settings: WalkSettings, gravity: float, commands: Sequence[float]) -> None:
        self._body = body
        self._settings = settings
        self._upper_of: Sequence[float] = commands
        self._upper = body.upper_moment(commands)
        self._hip = body.leg_pose(commands)[0]
        self._start = _stance(body, self._upper, commands)
        left, right = self._start.feet
        self.plan = WalkPlan(settings, gravity, {LEFT: left, RIGHT: right}, self._start.com)
        self.feedback = WalkFeedback(settings, body, self.plan.omega)
        com, _ = body.center_of_mass(self._upper, body.leg_pose(commands))
        self._com_in_torso = com
        self._in_air = 0.0
        self._unsettled = 1.0
        # How far commands are from flat soles and bent knees at the start, rad by index; None before the first tick.
        self._off: Dict[int, float] | None = None

    def tick(self, readings: Readings, commands: Sequence[float], dt: float) -> Dict[int, float]:
        """Advance by one tick of `dt` s; joint index to command, rad, of both legs.

        Readings are those of the last tick; the (26,) commanded angles, rad, tell where arms and head are.
        """
        plan, body = self.plan, self._body
        if commands is not self._upper_of:
            self._upper_of = commands
            self._upper = body.upper_moment(commands)
        plan.advance(dt, self._landed(readings.loads, dt))
        measured = body.leg_pose(readings.positions)
        begun = self._begun()
        counts = begun * self._share_that_counts()
        self.feedback.update(plan, measured, self._upper, readings.tilt, readings.gyro, dt, counts)
        feet = {side: plan.foot(side) for side in (LEFT, RIGHT)}
        turn = self._torso_turn(middle(feet[LEFT].pose, feet[RIGHT].pose).yaw, begun)
        shift, offset = self.feedback.shift, turned(turn, self._com_in_torso)
        height = self._start.height + begun * (self._settings.com_height - self._start.height)
        torso = (plan.com[0] + shift[0] - offset[0], plan.com[1] + shift[1] - offset[1], height - offset[2])
        soles = [
            Sole((feet[s].pose.x, feet[s].pose.y, feet[s].height), about_z(feet[s].pose.yaw)) for s in (LEFT, RIGHT)
        ]
        self._hip, left, right = body.legs.solve(torso, turn, soles[0], soles[1], self._hip)
        self._com_in_torso, _ = body.center_of_mass(self._upper, (self._hip, left, right))
        angles = self._angles(list(left), list(right))
        return angles if begun >= 1.0 else self._joined(angles, commands, begun)

    @property
    def haste(self) -> float:
        """Share of its speed that the walk may use while the body is off the plan, 0..1."""
        settings = self._settings
        beyond = hypot(*self.feedback.error) - settings.calm_from
        return min(max(1.0 - beyond / settings.calm_range, 0.0), 1.0)

    def _joined(self, angles: Dict[int, float], commands: Sequence[float], begun: float) -> Dict[int, float]:
        """`angles`, less and less off by what the robot's own stance differs from the walk's: legs do not jump."""
        if self._off is None:
            self._off = {i: commands[i] - angle for i, angle in angles.items()}
        return {i: angle + (1.0 - begun) * self._off[i] for i, angle in angles.items()}

    def _landed(self, loads: Vector2, dt: float) -> bool:
        """Whether the foot in the air feels the ground: one that lands bounces, and carries little at first."""
        plan = self.plan
        felt = loads[0 if plan.support == RIGHT else 1] > self._settings.loaded
        self._in_air = 0.0 if felt and plan.swing_share > LANDING else self._in_air + dt
        return self._in_air < (BOUNCE if self.haste > 0.0 else TOUCH)

    def _begun(self) -> float:
        """How far the walk's stance is taken, 0..1."""
        if self.plan.phase is not Phase.STANCE:
            return 1.0
        return _eased(self.plan.time / self._settings.stance_time)

    def _share_that_counts(self) -> float:
        """How much of the answers counts, 0..1: less and less at the end, for what is left of them the robot keeps."""
        plan, settings = self.plan, self._settings
        if plan.phase is Phase.SETTLE:
            self._unsettled = 1.0 - _eased((plan.time - settings.settle_time) / settings.stand_time)
        elif plan.phase is not Phase.STAND:
            self._unsettled = 1.0
        return self._unsettled

    def _torso_turn(self, yaw: float, begun: float) -> Matrix:
        settings, plan = self._settings, self.plan
        roll, pitch = 0.0, settings.lean
        if plan.step is not None and (plan.step.gait.torso_wx or plan.step.gait.torso_wy):
            bump = 0.5 * (1.0 - cos(2.0 * pi * plan.swing_share))
            roll += bump * plan.step.gait.torso_wx
            pitch += bump * plan.step.gait.torso_wy
        if begun < 1.0:
            start_roll, start_pitch, start_yaw = self._start.turn
            roll += (1.0 - begun) * (start_roll - roll)
            pitch += (1.0 - begun) * (start_pitch - pitch)
            yaw += (1.0 - begun) * start_yaw
        turn = then_about_y(about_z(yaw), pitch)
        return then_about_x(turn, roll) if roll else turn

    def _angles(self, left: list[float], right: list[float]) -> Dict[int, float]:
        roll, pitch = self.feedback.ankle
        plan = self.plan
        for side, leg in ((LEFT, left), (RIGHT, right)):
            if plan.phase is not Phase.STEP or side == plan.support:
                leg[ANKLE_PITCH] += pitch
                leg[ANKLE_ROLL] += roll
        indices = self._body.legs.indices
        angles = {indices[LEFT][0]: self._hip, indices[RIGHT][0]: self._hip}
        angles.update(zip(indices[LEFT][1:], left))
        angles.update(zip(indices[RIGHT][1:], right))
        return angles


def _eased(share: float) -> float:
    """From 0 to 1 with neither jump nor kink."""
    share = min(max(share, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)


def _stance(body: WalkingBody, upper: Vector, angles: Sequence[float]) -> _Stance:
    """How the robot stands with these joint angles, both soles taken for flat on the ground."""
    com, legs = body.center_of_mass(upper, body.leg_pose(angles))
    up = [legs[0][1][i] + legs[1][1][i] for i in (2, 5, 8)]
    roll, pitch = atan2(up[1], up[2]), atan2(-up[0], hypot(up[1], up[2]))
    level = then_about_x(about_y(pitch), roll)
    feet = [product(level, foot) for _, foot in legs]
    yaws = [atan2(foot[3], foot[0]) for foot in feet]
    soles = []
    for (ankle, _), foot in zip(legs, feet):
        at = turned(level, ankle)
        soles.append(tuple(a - body.legs.sole_height * foot[i] for a, i in zip(at, (2, 5, 8))))
    between = middle(*(FootPose(sole[0], sole[1], yaw) for sole, yaw in zip(soles, yaws)))
    left, right = (FootPose(sole[0], sole[1], yaw).seen_from(between) for sole, yaw in zip(soles, yaws))
    x, y, z = turned(level, com)
    place = FootPose(x, y, 0.0).seen_from(between)
    height = z - (soles[0][2] + soles[1][2]) / 2.0
    return _Stance((left, right), (place.x, place.y), height, (roll, pitch, atan2(sin(place.yaw), cos(place.yaw))))

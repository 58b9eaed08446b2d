"""One step of whole body control: joint changes that keep feet and balance, serve effectors, hold the posture. Pure.

By rank: feet that must stay; the centre of mass, on its way or within its region; effectors; an upright torso; the
posture. Each has what those before it leave free.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Sequence

import numpy as np

from nao_sim_bridge.control.whole_body.body_kinematics import BodyKinematics
from nao_sim_bridge.control.whole_body.footholds import BalanceRegion
from nao_sim_bridge.control.whole_body.grounded_pose import TORSO, GroundedPose
from nao_sim_bridge.control.whole_body.inverse_kinematics import Goal
from nao_sim_bridge.control.whole_body.task_solver import Wish, ranked_step

FEET_DAMPING, COM_DAMPING, EFFECTOR_DAMPING, TORSO_DAMPING = 1e-8, 1e-6, 1e-3, 1e-4
# The centre of mass comes back into its region at this speed, m/s, and follows its path at up to twice that.
COM_SPEED = 0.12
# m/s2; a lower centre of mass than this, m, is no pendulum over feet.
GRAVITY, LEAST_HEIGHT = 9.81, 0.05
# What an edge is overstepped by, m, when it is not.
NEGLIGIBLE = 1e-9
# Errors of effectors and of the torso are made up for at up to these speeds, m/s and rad/s.
EFFECTOR_SPEED, TORSO_SPEED = 0.6, 0.5
# Joints that nobody moves go back to their posture at up to this speed, rad/s, and end softly at this rate, 1/s.
RETURN_SPEED, RETURN_RATE = 0.5, 3.0
# Joints move at this share of their top speed at most; the rest is for the motors to follow.
SPEED_SHARE = 0.8
# A joint that is outside its limits comes back at this speed, rad/s.
COME_BACK = 0.1
# Feet that are not where they should be get there at this speed, m/s: no jerk when soles become flat.
FEET_SPEED = 0.02


@dataclass(frozen=True, eq=False)
class Demands:
    """What is asked for at one tick.

    Attributes:
        now: The body as it is, on the foot that stays.
        feet: What the other foot must keep.
        effectors: Goals of effectors.
        com: (2,) where the centre of mass should be over the ground, m; None when it only has to stay in `region`.
        region: Where the centre of mass may be; None for anywhere.
        upright: (3, 3) orientation in the ground frame that the torso should keep as far as `lean_axes` go.
        lean_axes: 0 for the roll of the torso, 1 for its pitch.
        anchor: (2,) where the centre of mass should stay if nothing else is against it, m; None for anywhere.
    """

    now: GroundedPose
    feet: Sequence[Goal] = ()
    effectors: Sequence[Goal] = ()
    com: np.ndarray | None = None
    region: BalanceRegion | None = None
    upright: np.ndarray = field(default_factory=lambda: np.eye(3))
    lean_axes: Sequence[int] = ()
    anchor: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Freedom:
    """What the joints may do in one tick.

    Attributes:
        preferred: (26,) change that the posture asks for, rad.
        lower: (26,) least change, rad.
        upper: (26,) largest change, rad.
        mobility: (26,) how readily a joint helps.
    """

    preferred: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    mobility: np.ndarray


def joint_freedom(
    body: BodyKinematics,
    angles: np.ndarray,
    posture: np.ndarray,
    moved: Sequence[int],
    mobility: np.ndarray,
    dt: float,
) -> Freedom:
    """What the joints may do in a tick of `dt` s.

    Args:
        angles: (26,) where the joints are, rad.
        posture: (26,) where they should be, rad.
        moved: Joints that go there with all their speed; the others drift.
        mobility: (26,) how readily a joint helps.
    """
    away = posture - angles
    preferred = np.clip(away * min(1.0, RETURN_RATE * dt), -RETURN_SPEED * dt, RETURN_SPEED * dt)
    preferred[moved] = away[moved]
    reach = SPEED_SHARE * body.max_velocities * dt
    bounds = (np.clip(limit - angles, -reach, reach) for limit in body.limits(angles))
    lower, upper = (np.where(body.movable, bound, 0.0) for bound in bounds)
    # A joint outside its limits comes back slowly: postures go a little beyond those that depend on other joints.
    lower, upper = np.minimum(lower, COME_BACK * dt), np.maximum(upper, -COME_BACK * dt)
    return Freedom(preferred, lower, upper, mobility)


def whole_body_step(demands: Demands, freedom: Freedom, dt: float) -> np.ndarray:
    """(26,) change of the joints in one tick of `dt` s, rad."""
    now = demands.now
    center = now.center_of_mass()
    place, rows = center[:2], now.com_jacobian()[:2]
    first = [_goals(demands.feet, now, FEET_DAMPING, FEET_SPEED * dt)] if demands.feet else []
    last = [_goals(demands.effectors, now, EFFECTOR_DAMPING, EFFECTOR_SPEED * dt)] if demands.effectors else []
    if demands.anchor is not None:
        last.append(Wish(rows, _at_most(demands.anchor - place, COM_SPEED * dt), TORSO_DAMPING))
    if demands.lean_axes:
        last.append(_upright(demands, TORSO_SPEED * dt))

    def step_with(*balance: Wish) -> np.ndarray:
        wishes = [*first, *balance, *last]
        return ranked_step(wishes, freedom.preferred, freedom.lower, freedom.upper, freedom.mobility)

    if demands.com is not None:
        return step_with(Wish(rows, _at_most(demands.com - place, 2.0 * COM_SPEED * dt), COM_DAMPING))
    step = step_with()
    if demands.region is None:
        return step
    # Edges that the centre of mass would come too close to become wishes: two at most, as in a corner.
    allowed = _allowed(demands.region, center, dt)
    held: list[int] = []
    for _ in range(2):
        excess = demands.region.normals @ (rows @ step) - allowed
        excess[held] = 0.0
        worst = int(np.argmax(excess))
        if excess[worst] <= NEGLIGIBLE:
            break
        held.append(worst)
        step = step_with(Wish(demands.region.normals[held] @ rows, allowed[held], COM_DAMPING))
    return step


def _allowed(region: BalanceRegion, center: np.ndarray, dt: float) -> np.ndarray:
    """(n,) how far the (3,) centre of mass may move towards each edge in a tick, m; negative where it must come back.

    Near an edge it moves no faster than a pendulum may that should come to rest over it.
    """
    outside = region.excess(center[:2])
    turn = math.sqrt(GRAVITY / max(center[2], LEAST_HEIGHT)) * dt
    return np.where(outside > 0.0, -np.minimum(outside, COM_SPEED * dt), -outside * turn / (1.0 + turn))


def _goals(goals: Sequence[Goal], now: GroundedPose, damping: float, reach: float) -> Wish:
    parts = [goal.rows(now) for goal in goals]
    return Wish(
        np.concatenate([rows for rows, _ in parts]), np.concatenate([_at_most(e, reach) for _, e in parts]), damping
    )


def _upright(demands: Demands, reach: float) -> Wish:
    """Keep the lean of the torso: its vertical axis tells, whatever the heading."""
    up, wanted = demands.now.torso[:3, 2], demands.upright[:, 2]
    turn = np.array([up[1] * wanted[2] - up[2] * wanted[1], up[2] * wanted[0] - up[0] * wanted[2]])
    axes = list(demands.lean_axes)
    rows = demands.now.jacobian(TORSO)[3:5]
    return Wish(rows[axes], _at_most(turn[axes], reach), TORSO_DAMPING)


def _at_most(change: np.ndarray, reach: float) -> np.ndarray:
    length = math.sqrt(change @ change)
    return change if length <= reach else change * (reach / length)

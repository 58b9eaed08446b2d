"""What keeps a robot from walking, and what ends a walk: soft legs, no ground, a fall, the wrong posture, obstacles."""

from __future__ import annotations

from typing import NamedTuple, Sequence

from nao_sim_bridge.base.rotations import Vector3, plus, rotate
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.posture_recognition import CROUCHING, STANDING, recognise
from nao_sim_bridge.control.balance.reflexes import Reflexes
from nao_sim_bridge.control.balance.stability import Stability
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.gait import parameters

STIFFNESS_SWITCH, CONTACT_SWITCH = "ENABLE_STIFFNESS_PROTECTION", "ENABLE_FOOT_CONTACT_PROTECTION"
# Legs at this stiffness or below do not walk; a robot that feels no ground for this time, s, does not either.
LEAST_STIFFNESS = 0.6
LIFTED_TIME = 0.2
# Both feet together carry less than this of the weight when somebody holds the robot.
LIFTED_SHARE = 0.1


class Obstacle(NamedTuple):
    """Something in the way: what, in words, and where, in the world of the robot's odometry, m."""

    cause: str
    place: Vector3


class WalkGuard:
    """Looks after one robot's walks; `gravity` in m/s2."""

    def __init__(
        self,
        model: RobotModel,
        gravity: float,
        joints: JointCommands,
        legs: Sequence[int],
        stability: Stability,
        reflexes: Reflexes,
    ) -> None:
        self._model = model
        self._least_load = LIFTED_SHARE * model.total_mass * gravity
        self._joints = joints
        self._legs = legs
        self._stability = stability
        self._reflexes = reflexes
        self._lifted = 0.0
        self._echoes: Sequence[float] = ()

    def begin(self) -> None:
        self._lifted = 0.0

    def hindrance(self, now: Snapshot) -> str:
        """Why the robot cannot walk now; empty when it can."""
        if self._stability.falls.falling:
            return "the robot is falling"
        soft = self._soft_joints()
        if soft:
            return f"stiffness of {soft} is {LEAST_STIFFNESS} or less: wakeUp first"
        if self._reflexes.switches[CONTACT_SWITCH] and not self._on_ground(now):
            return "the feet feel no ground"
        family = recognise(self._model, now).family
        if family not in (STANDING, CROUCHING):
            return f"the robot is {family}, it walks only from standing or crouching: goToPosture first"
        return ""

    @property
    def too_soft(self) -> bool:
        """Whether too little stiffness of the legs is what keeps the robot from walking; falling robots let go."""
        return not self._stability.falls.falling and bool(self._soft_joints())

    def danger(self, now: Snapshot, dt: float) -> str:
        """Why a walk must end at once; empty when it need not. Called at every tick of `dt` s."""
        self._lifted = 0.0 if self._on_ground(now) else self._lifted + dt
        if self._lifted > LIFTED_TIME and self._reflexes.switches[CONTACT_SWITCH]:
            return "the feet have lost the ground"
        soft = self._soft_joints()
        return f"stiffness of {soft} is {LEAST_STIFFNESS} or less" if soft else ""

    def new_obstacle(self, now: Snapshot, ahead: float) -> Obstacle | None:
        """As `obstacle`; each echo is looked at once."""
        if now.sonars is self._echoes:
            return None
        self._echoes = now.sonars
        return self.obstacle(now, ahead)

    def obstacle(self, now: Snapshot, ahead: float) -> Obstacle | None:
        """What the sonars see in the way of a robot that goes `ahead` m in a step."""
        guard = self._reflexes.external_collision
        if not guard.blocks(ahead / parameters()["MaxStepX"].default, now.sonars):
            return None
        seen = rotate(now.odometry.orientation, guard.obstacle_ahead(now.sonars).tolist())
        return Obstacle(f"an obstacle {min(now.sonars):.2f} m ahead", plus(now.odometry.position, seen))

    def _soft_joints(self) -> str:
        stiffnesses = self._joints.stiffnesses
        least = LEAST_STIFFNESS if self._reflexes.switches[STIFFNESS_SWITCH] else 0.0
        return ", ".join(self._model.joints[i].name for i in self._legs if stiffnesses[i] <= least)

    def _on_ground(self, now: Snapshot) -> bool:
        return sum(now.foot_loads) > self._least_load

"""What ALMotion does to motion and motors on its own, put together: reflexes that protect the robot."""

from __future__ import annotations

from typing import Callable

from nao_sim_bridge.body.faults import Faults
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.body.temperatures import heat_shares
from nao_sim_bridge.control.balance.external_collision import ExternalCollision
from nao_sim_bridge.control.balance.posture_recognition import STANDING, UNKNOWN, Recognition, recognise
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.control.joints.idle import Idle
from nao_sim_bridge.control.joints.self_collision import SelfCollision
from nao_sim_bridge.control.joints.smart_stiffness import SmartStiffness
from nao_sim_bridge.model.robot_model import RobotModel

# The sonars measure ten times a second; the hands are looked at this often, in ticks.
LOOK_EVERY = 6
# Switches that ALMotion.setMotionConfig knows, and how they are at the start.
SWITCHES = {
    "ENABLE_FOOT_CONTACT_PROTECTION": True,
    "ENABLE_STIFFNESS_PROTECTION": True,
    "ENABLE_FALL_MANAGER_PROTECTION": True,
    "ENABLE_DEACTIVATION_OF_FALL_MANAGER": False,
}


class Reflexes:
    """Collision protection, smart stiffness, heat protection and idle motion of one robot.

    Attributes:
        self_collision: Keeps the arms from the rest of the robot.
        external_collision: Slows arms down before what the sonars see.
        smart_stiffness: Saves torque while the robot keeps still.
        idle: Moves chains that nobody else moves.
        diagnosis_enabled: Whether chains with motors that are too hot, or broken, are put to rest.
        wake_forbidden: Why the robot must not wake up now; empty when it may.
        faults: What is broken; None while nothing can be.
        switches: Of `SWITCHES`, those of whoever walks among them.
    """

    def __init__(
        self, model: RobotModel, joints: JointCommands, motion: MotionEngine, snapshot: Callable[[], Snapshot | None]
    ) -> None:
        self._model = model
        self._joints = joints
        self._motion = motion
        self._snapshot = snapshot
        self.self_collision = SelfCollision(model)
        joints.guard = self.self_collision
        self.external_collision = ExternalCollision(model)
        self.smart_stiffness = SmartStiffness([joint.max_torque for joint in model.joints])
        self.idle = Idle(model, joints, self._reference, lambda: self._recognised().family == STANDING)
        self.diagnosis_enabled = True
        self.wake_forbidden = ""
        self.faults: Faults | None = None
        self.switches = dict(SWITCHES)
        self._ticks = 0

    def prepare(self, sensed: Snapshot | None, getting_up: bool, on_feet: bool) -> None:
        """Before the joints get their commands: what may move, and how fast.

        Args:
            sensed: At the last tick.
            getting_up: Moves between lying and standing have been tried with all their contacts, and falls are no time
                for manners: nothing keeps arms from the body then.
            on_feet: Whether the robot is on its feet; lying on its belly, the sonars see the floor.
        """
        self.self_collision.suspended = getting_up
        self.idle.suspended = getting_up
        self._motion.idle = self.idle if self.idle.active else None
        self._ticks += 1
        if sensed is not None and self._ticks % LOOK_EVERY == 0:
            shares = self.external_collision.speed_shares(sensed.positions, sensed.sonars) if on_feet else {}
            self._joints.speed_shares = shares

    def limit_efforts(self, sensed: Snapshot, dt: float) -> None:
        """After the joints got their commands: what their motors may give for it in this tick of `dt` s."""
        joints = self._joints
        still = self.smart_stiffness.shares(joints.changed, sensed.positions, sensed.torques, dt)
        hot = heat_shares(sensed.temperatures)
        shares = tuple(map(min, still, hot)) if still and hot else still or hot
        broken = self.faults.motors if self.faults is not None else ()
        if broken:
            shares = tuple(0.0 if i in broken else (shares[i] if shares else 1.0) for i in range(len(joints.names)))
        joints.share_efforts(shares)

    def _recognised(self) -> Recognition:
        sensed = self._snapshot()
        return Recognition(UNKNOWN, UNKNOWN) if sensed is None else recognise(self._model, sensed)

    def _reference(self) -> str | None:
        """The posture to go back to: the one the robot is in or nearly in; none for one that is in no posture."""
        seen = self._recognised()
        if seen.posture != UNKNOWN:
            return seen.posture
        return "Stand" if seen.family == STANDING else None

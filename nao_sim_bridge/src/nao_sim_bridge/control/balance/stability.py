"""What keeps a robot on its feet, put together: balance while it stands still, fall manager, and whether it stands.

A robot that stands quietly costs next to nothing here: the body is followed only while something moves it.
"""

from __future__ import annotations

import math
from typing import Callable, Mapping, Sequence, Tuple

from nao_sim_bridge.base.settings import Settings
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.balance import NO_CORRECTION, Balance, load_balance
from nao_sim_bridge.control.balance.capture_point import BodyMotion, BodyTracker
from nao_sim_bridge.control.balance.fall_manager import FallManager, load_fall_settings
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.model.robot_model import RobotModel

# Legs below this stiffness do not carry the robot.
STIFF = 0.4
# Who gets on its feet or off them stands with this share of the weight on them at least, who stays on them may have
# less for a while: the soles feel less when the body goes up. All lean less than this, rad.
STANDING_UP_SHARE, STANDING_SHARE, UPRIGHT = 0.5, 0.15, 0.6
# The feet of a quiet robot are looked at only this often, in ticks.
LOOK_EVERY = 12
# A robot counts as standing, or not any more, when it has been so for this time, s: a step is no fall.
STEADY_TIME = 0.1

# How far ahead and to the left of where it should be the divergent component of a walking body's motion is, m.
WalkError = Callable[[], Tuple[float, float]]


class Stability:
    """Balance and fall manager of one robot.

    Attributes:
        balance: Corrects the stance.
        falls: Watches for falls.
        tracker: Follows the body's motion; only while something moves.
        walk: Set by who walks, and takes the place of balance: a walk keeps its feet under the body by itself. The
            fall manager goes on watching, and asks it how far the body is off.
        on_feet: Whether the weight is on the feet.
    """

    def __init__(self, model: RobotModel, settings: Settings, joints: JointCommands, motion: MotionEngine) -> None:
        self._settings = load_balance(model)
        self.tracker = BodyTracker(model, settings.gravity_m_s2, self._settings.velocity_smoothing)
        self.balance = Balance(self._settings, self.tracker.reader)
        self.falls = FallManager(model, load_fall_settings(model), self.tracker.reader, motion)
        self.walk: WalkError | None = None
        self.on_feet = False
        self._joints = joints
        self._motion = motion
        self._weight = model.total_mass * settings.gravity_m_s2
        self._legs = [model.joint_index[name] for leg in ("LLeg", "RLeg") for name in model.chains[leg]]
        self._stiffnesses: Sequence[float] = ()
        self._stiff = False
        self._velocities: Sequence[float] = ()
        self._move = False
        self._moved = 0.0
        self._settled_lean = (math.inf, math.inf)
        self._engaged = self._dozing = False
        self._differs_since: float | None = None
        self._count = 0

    def act(self, snapshot: Snapshot, getting_up: bool, dt: float) -> None:
        """Correct the joints' commands for this tick, from what was sensed at the end of the last one.

        Args:
            snapshot: Of the last tick.
            getting_up: Leaning is no fall, and needs no balance.
            dt: Length of a tick, s.
        """
        self._count += 1
        if self._dozes(snapshot, getting_up):
            return
        able = self._legs_stiff() and not getting_up
        if getting_up:
            self.falls.end()
        if not able:
            self.falls.rest()
        elif self.walk is not None:
            self._watch_walk(self.walk(), snapshot, dt)
            return
        moving = self._legs_move()
        at_rest = self._at_rest(snapshot) and not (moving or self.balance.acting or self.falls.falling)
        if at_rest or not able:
            self._stand_by(snapshot, able, dt)
            self._dozing = at_rest and able
        else:
            self._keep_standing(snapshot, moving, dt)

    def _dozes(self, snapshot: Snapshot, getting_up: bool) -> bool:
        """Whether there is still nothing to do: the body was at rest, and nothing has happened since."""
        joints = self._joints
        self._dozing = (
            self._dozing
            and not getting_up
            and joints.velocities is self._velocities
            and joints.stiffnesses is self._stiffnesses
            and self._count % LOOK_EVERY > 0
            and self.walk is None
            and not self._motion.tasks()
            and self._at_rest(snapshot)
        )
        return self._dozing

    def _stand_by(self, snapshot: Snapshot, able: bool, dt: float) -> None:
        """Correct nothing, and look at the feet now and then."""
        if self.falls.falling:
            self.falls.go_on(snapshot)
        if self._count % LOOK_EVERY == 0:
            self._note_feet(snapshot, able)
        self._leave_legs(dt, at_rest=able)

    def _watch_walk(self, off: Tuple[float, float], snapshot: Snapshot, dt: float) -> None:
        """Look whether a walking body falls; all else is the walk's."""
        if self._count % LOOK_EVERY == 0 or not self.on_feet:
            self._note_feet(snapshot, able=True)
        self.falls.look_at_walk(off, snapshot)
        self._leave_legs(dt, at_rest=True)

    def _leave_legs(self, dt: float, at_rest: bool) -> None:
        self.tracker.forget()
        self.balance.release()
        if at_rest:
            self.balance.settle()
        self._engaged = False
        self._joints.correct(NO_CORRECTION, dt)

    def _keep_standing(self, snapshot: Snapshot, moving: bool, dt: float) -> None:
        """Follow the body, look whether it falls, and correct the legs when that is needed."""
        self._note_feet(snapshot, able=True)
        left, right = snapshot.left_foot.total, snapshot.right_foot.total
        least = self._settings.loaded_share * self._weight
        loaded = (left > least, right > least)
        body = self.tracker.follow(snapshot, left / (left + right) if left + right > 0.0 else 0.5, dt)
        self.falls.look(body, snapshot, loaded)
        if self.falls.falling:
            self.falls.go_on(snapshot)
        # Once at it, balance goes on while a push has a foot in the air.
        standing = self.on_feet and (all(loaded) or self._engaged)
        self._engaged = standing and not moving and not self.falls.falling
        self._joints.correct(self._corrections(body, dt), dt)

    def _corrections(self, body: BodyMotion, dt: float) -> Mapping[int, float]:
        if self._engaged and self.balance.enabled:
            return self.balance.corrections(body, self._joints.commands, dt)
        self.balance.release()
        return NO_CORRECTION

    def _legs_stiff(self) -> bool:
        stiffnesses = self._joints.stiffnesses
        if stiffnesses is not self._stiffnesses:  # replaced as a whole and never changed
            self._stiffnesses = stiffnesses
            self._stiff = min(stiffnesses[i] for i in self._legs) >= STIFF
        return self._stiff

    def _legs_move(self) -> bool:
        velocities = self._joints.velocities
        if velocities is not self._velocities:  # replaced as a whole and never changed
            self._velocities = velocities
            self._move = any(velocities[i] for i in self._legs)
        return self._move or self._motion.busy(self._legs)

    def _at_rest(self, snapshot: Snapshot) -> bool:
        """Whether the body has been at rest for a while."""
        settings, imu = self._settings, snapshot.imu
        turn_x, turn_y, _ = imu.gyroscope
        roll, pitch, _ = imu.angles
        limit, (settled_roll, settled_pitch) = settings.quiet_lean, self._settled_lean
        if abs(turn_x) > settings.quiet_turn or abs(turn_y) > settings.quiet_turn:
            self._moved = snapshot.age
            return False
        if abs(roll - settled_roll) > limit or abs(pitch - settled_pitch) > limit:
            self._settled_lean = (roll, pitch)
            self._moved = snapshot.age
            return False
        return snapshot.age - self._moved >= settings.quiet_time

    def _note_feet(self, snapshot: Snapshot, able: bool) -> None:
        """See whether the robot is on its feet, and tell the fall manager."""
        roll, pitch, _ = snapshot.imu.angles
        load = snapshot.left_foot.total + snapshot.right_foot.total
        least = self._weight * (STANDING_SHARE if self.on_feet and able else STANDING_UP_SHARE)
        on_feet = load > least and abs(roll) < UPRIGHT and abs(pitch) < UPRIGHT
        now = snapshot.age
        if able:
            self.falls.note_feet(on_feet, now)
        if on_feet == self.on_feet:
            self._differs_since = None
        elif self._differs_since is None:
            self._differs_since = now
        elif now - self._differs_since >= STEADY_TIME:
            self.on_feet = on_feet
            self._differs_since = None

"""Follows a place that may move, with head, whole body, arms or legs. Simulation thread only."""

from __future__ import annotations

import math
from enum import Enum
from typing import Any, Tuple

import numpy as np

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.whole_body.aims import TargetAim
from nao_sim_bridge.control.whole_body.cartesian_move import EffectorMove
from nao_sim_bridge.control.whole_body.inverse_kinematics import rotation_vector
from nao_sim_bridge.control.whole_body.tasks import lead_to
from nao_sim_bridge.model.frames import ROBOT, TORSO, Placement, space_in_torso
from nao_sim_bridge.model.kinematics import rpy_matrix, transform
from nao_sim_bridge.tracking import geometry
from nao_sim_bridge.tracking.approach import Approach
from nao_sim_bridge.tracking.geometry import HEAD, Point

# The place is looked at again so often, s: the robot itself may move.
LOOK_TIME = 0.1
# How fast arms go to where they point, rad/s, and the head under whole body control, m/s and rad/s.
ARM_SPEED = 1.5
WHOLE_BODY_SPEED = (0.15, 0.6)
ROTATION = 56
# A single look has come to its end when the head has this way to go, rad.
THERE = 0.01
# Where the head looks for something, HeadYaw and HeadPitch, rad, one after the other.
SEARCH = ((0.0, -0.1), (0.8, -0.1), (0.8, 0.25), (0.0, 0.25), (-0.8, 0.25), (-0.8, -0.1))
# How near counts as there, rad.
ARRIVED = 1e-4
# Somebody else has moved a command by more than this since, rad.
MOVED = 0.02


class HeadServo:
    """Moves HeadYaw and HeadPitch, a little at each tick, as long as nobody else has them.

    The velocity, rad/s, and the acceleration, rad/s2, are limits. The head is resting when it has got to where it
    should be, or need not go anywhere.
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
        if robot.motion.busy(self._indices) or any(robot.joints.stiffnesses[i] == 0.0 for i in self._indices):
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
        if abs(away) < ARRIVED and abs(self._speeds[axis]) < self.acceleration * dt * 2.0:
            self._angles[axis], self._speeds[axis] = target, 0.0
            return True
        # The speed from which it can still come to rest at the target.
        wanted = math.copysign(min(self.velocity, math.sqrt(2.0 * self.acceleration * abs(away)), abs(away) / dt), away)
        change = self.acceleration * dt
        speed = min(max(wanted, self._speeds[axis] - change), self._speeds[axis] + change)
        self._speeds[axis] = speed
        self._angles[axis] += speed * dt
        return False


class Mode(Enum):
    """What follows."""

    HEAD = "Head"
    WHOLE_BODY = "WholeBody"
    MOVE = "Move"


EFFECTORS = {"None": (), "LArm": ("LArm",), "RArm": ("RArm",), "Arms": ("LArm", "RArm")}
"""Names of NAOqi to the arms that point, too."""


class Follower:
    """Follows one place, with arms too by the name of an effector.

    The velocity is that of the head at most, rad/s; while it searches, it has `search_share` of that.
    """

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self.head = HeadServo(simulation, velocity=3.0, acceleration=15.0)
        self.approach = Approach(simulation)
        self.effector = "None"
        self.search_share = 0.3
        self._mode = Mode.HEAD
        self._place: Point | None = None
        self._searching: int | None = None
        self._next_look = 0.0
        self.velocity = self.head.velocity
        self._switched_whole_body = False
        self._once: Task | None = None
        simulation.after_tick.append(self._tick)
        simulation.after_reset.append(self._forget)

    @property
    def mode(self) -> Mode:
        return self._mode

    @mode.setter
    def mode(self, mode: Mode) -> None:
        if mode is not self._mode:
            self._release()
        self._mode = mode

    def follow(self, place: Point) -> None:
        """The place is there now, in the world of the robot's odometry, m."""
        self._place, self._searching = place, None
        self._next_look = 0.0

    def search(self) -> None:
        """Look around for it."""
        if self._searching is None:
            self._place, self._searching = None, 0
            self.approach.stop()

    def lose(self) -> None:
        """There is no place any more; everything stays as it is, a walk ends."""
        self._place = self._searching = None
        self.head.stop()
        self.approach.stop()

    def stop(self) -> None:
        """Follow nothing any more."""
        self.lose()
        self._release()

    def look_once(self, in_torso: Point) -> Task:
        """Turn the head to a place in the frame of the torso with the whole body behind it, and end there."""
        placed = geometry.placement(self._simulation.model, self._simulation.snapshot)
        self._lead_head(placed, in_torso)
        task = self._simulation.task_ids.make("lookAt", on_kill=lambda _: self._release())
        self._once = task
        return task

    # --- inside ---------------------------------------------------------------------------------------------------

    def _tick(self, now: Snapshot) -> None:
        if self._once is not None:
            self._end_look()
        if self._searching is not None:
            self._look_around()
        elif self._place is None:
            return
        elif now.time >= self._next_look:
            self._next_look = now.time + LOOK_TIME
            self._aim(now, self._place)
        self.head.velocity = self.velocity * (self.search_share if self._searching is not None else 1.0)
        self.head.tick(self._simulation.settings.tick_s)

    def _aim(self, now: Snapshot, place: Point) -> None:
        model = self._simulation.model
        placed = geometry.placement(model, now)
        in_torso = geometry.in_frame(model, placed, place, TORSO)
        if self._mode is Mode.WHOLE_BODY and self._simulation.robot.stability.on_feet:
            self._lead_head(placed, in_torso)
        else:
            self.head.aim(geometry.head_angles(model, in_torso))
        if self._mode is Mode.MOVE:
            self.approach.go(geometry.robot_pose(model, placed), place, now.time)
        for arm in EFFECTORS[self.effector]:
            self._point(arm, in_torso)

    def _point(self, arm: str, in_torso: Point) -> None:
        robot = self._simulation.robot
        if self.effector == "Arms" and (in_torso[1] >= 0.0) != (arm == "LArm"):
            return  # of two arms the nearer one points
        index = robot.model.joint_index
        angles = geometry.arm_angles(robot.model, arm, in_torso)
        indices = [index[name] for name in angles]
        if robot.motion.busy(indices) or not all(robot.joints.stiffnesses[i] for i in indices):
            return
        robot.motion.set_targets(dict(zip(indices, angles.values())), dict.fromkeys(indices, ARM_SPEED))

    def _lead_head(self, placed: Placement, in_torso: Point) -> None:
        """Turn the head as its joints would, with the whole body behind it: it keeps its balance and may lean."""
        control, model = self._simulation.robot.whole_body, self._simulation.model
        if "Head" not in control.controlled:
            self._switched_whole_body = not control.enabled
            control.enable(True)
            control.enable_effector("Head", True)
        yaw, pitch = geometry.head_angles(model, in_torso)
        robot_in_torso = space_in_torso(model, ROBOT, placed)
        turn = robot_in_torso[:3, :3].T @ rpy_matrix((0.0, pitch, yaw))
        pose = transform(turn, (0.0, 0.0, 0.0))
        lead_to(control, [EffectorMove("Head", ROBOT, ROTATION, lambda _: pose)], WHOLE_BODY_SPEED, placed)

    def _end_look(self) -> None:
        """End a single look when the head is there, or when nobody leads it any more."""
        aim = self._simulation.robot.whole_body.aim_of("Head")
        if aim is None or self._once.finished or _turn_left(aim) < THERE:
            task, self._once = self._once, None
            if self._place is None:
                self._release()
            task.finish()

    def _look_around(self) -> None:
        if self.head.resting:
            self.head.aim(SEARCH[self._searching % len(SEARCH)])
            self._searching += 1

    def _release(self) -> None:
        """Leave whole body control as it was."""
        control = self._simulation.robot.whole_body
        if self._switched_whole_body and control.enabled:
            control.enable(False)
        self._switched_whole_body = False

    def _forget(self) -> None:
        """The robot is another one."""
        self._place = self._searching = None
        self._switched_whole_body = False
        if self._once is not None:
            self._once.finish()
        self._once = None
        self.head.stop()
        self.approach.forget()


def _turn_left(aim: TargetAim) -> float:
    """How far whole body control still leads the head to its target, rad."""
    turn = rotation_vector(aim.target[:3, :3] @ aim.goal.pose[:3, :3].T)
    return float(np.sqrt(turn @ turn))

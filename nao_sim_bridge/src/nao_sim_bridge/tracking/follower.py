"""Follows a place that may move, with head, whole body, arms or legs. Simulation thread only."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, Sequence

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
from nao_sim_bridge.tracking.geometry import Point
from nao_sim_bridge.tracking.head_servo import HeadServo

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


class Mode(Enum):
    """What follows."""

    HEAD = "Head"
    WHOLE_BODY = "WholeBody"
    MOVE = "Move"


@dataclass(frozen=True)
class Effector:
    """Which arms point, too."""

    name: str
    arms: Sequence[str]


EFFECTORS = {
    "None": Effector("None", ()),
    "LArm": Effector("LArm", ("LArm",)),
    "RArm": Effector("RArm", ("RArm",)),
    "Arms": Effector("Arms", ("LArm", "RArm")),
}


class Follower:
    """Follows one place.

    Attributes:
        head: Turns the head.
        approach: Walks to the place.
        effector: Which arms point at the place.
        velocity: Of the head at most, rad/s.
        search_share: Of the head's velocity while it searches.
    """

    def __init__(self, simulation: Any) -> None:
        self._simulation = simulation
        self.head = HeadServo(simulation, velocity=3.0, acceleration=15.0)
        self.approach = Approach(simulation)
        self.effector = EFFECTORS["None"]
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
        for arm in self.effector.arms:
            self._point(arm, in_torso)

    def _point(self, arm: str, in_torso: Point) -> None:
        robot = self._simulation.robot
        if len(self.effector.arms) > 1 and (in_torso[1] >= 0.0) != (arm == "LArm"):
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

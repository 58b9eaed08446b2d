"""Whole body control as tasks: ways of the centre of mass and paths of effectors, which take time and joints."""

from __future__ import annotations

import logging
from dataclasses import dataclass, replace
from typing import Callable, Iterable, Mapping, Sequence

import numpy as np

from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.control.joints.engine import MotionEngine
from nao_sim_bridge.control.whole_body.aims import PathAim, TargetAim
from nao_sim_bridge.control.whole_body.cartesian_move import BASE, EffectorMove, moving_joints
from nao_sim_bridge.control.whole_body.com_path import ComPath
from nao_sim_bridge.control.whole_body.inverse_kinematics import Goal
from nao_sim_bridge.control.whole_body.whole_body import WholeBody
from nao_sim_bridge.model.frames import FEET, TORSO, Placement, space_in_torso

log = logging.getLogger("nao_sim.whole_body")


@dataclass(frozen=True, eq=False)
class LedJoint:
    """Stands for a joint's curve while whole body control moves the joint: it has no wish of its own."""

    joints: JointCommands
    index: int
    duration: float

    def value(self, elapsed: float) -> float:
        """Where the joint is, rad."""
        return self.joints.commands[self.index]


def led_joints(joints: JointCommands, indices: Sequence[int], duration: float) -> Mapping[int, LedJoint]:
    """Curves of joints that whole body control moves for `duration` s."""
    return {index: LedJoint(joints, index, duration) for index in indices}


def go_to_balance(
    whole_body: WholeBody, motion: MotionEngine, joints: JointCommands, name: str, feet: Sequence[str], duration: float
) -> Task:
    """A task `name` that brings the centre of mass over `feet` and ends with whether it is there."""
    legs = moving_joints(whole_body.model, FEET)
    ways: list[ComPath] = []
    ends: list[bool] = []

    def start(_: Sequence[float]) -> Mapping[int, LedJoint]:
        way = whole_body.go_to_balance(feet, duration)
        if way is None:
            log.warning("%s: the robot cannot balance over %s as it stands", name, " and ".join(feet))
            return {}
        ways.append(way)
        whole_body.hold(way, legs)
        return led_joints(joints, legs, way.duration)

    def end(_: Task) -> None:
        for way in ways:
            ends.append(whole_body.end_way(way))
            whole_body.let_go(way)

    task = motion.follow(name, legs, start)
    task.add_done_callback(end)
    return task.then(lambda _: ends == [True])


def start_paths(
    whole_body: WholeBody, owner: object, moves: Sequence[EffectorMove], durations: Sequence[float], placed: Placement
) -> None:
    """Lead effectors along paths of durations in s, from where the commands have `placed` the robot now.

    `owner` holds their joints until `end_paths`.
    """
    whole_body.hold(owner, moving_joints(whole_body.model, [move.name for move in moves]))
    for move, duration in zip(moves, durations):
        ground, goal = _in_ground(whole_body, move, placed)
        whole_body.lead(move.name, PathAim(goal, _poses(ground, move), duration))


def end_paths(whole_body: WholeBody, owner: object, names: Iterable[str], killed: bool) -> None:
    """`owner` holds no joints any more; effectors stay at the end of their paths, or where they were killed."""
    whole_body.let_go(owner)
    if killed:
        whole_body.stop(moving_joints(whole_body.model, names))


def lead_to(
    whole_body: WholeBody, moves: Sequence[EffectorMove], max_speed: tuple[float, float], placed: Placement
) -> None:
    """Lead effectors to where `moves` have them at time 0, at up to `max_speed` (m/s, rad/s)."""
    for move in moves:
        ground, goal = _in_ground(whole_body, move, placed)
        target = ground @ move.pose_at(0.0)
        aim = whole_body.aim_of(move.name)
        if isinstance(aim, TargetAim) and (aim.goal.mask, aim.goal.grounded) == (goal.mask, goal.grounded):
            # On its way already: it bends the way and keeps its speed.
            aim.goal = replace(aim.goal, axes=goal.axes)
            aim.max_speed = max_speed
            aim.aim(target)
        else:
            aim = TargetAim(goal, target, max_speed)
        whole_body.lead(move.name, aim)


def _in_ground(whole_body: WholeBody, move: EffectorMove, placed: Placement) -> tuple[np.ndarray, Goal]:
    """(4, 4) pose of a move's space in the frame of its goal, and a goal where the effector is now."""
    here = whole_body.goal_here(move.name, move.mask)
    space = space_in_torso(whole_body.model, move.space, placed)
    torso = whole_body.torso_in_ground()
    if move.space == TORSO and move.name != BASE:
        return space, replace(here, pose=np.linalg.inv(torso) @ here.pose, grounded=False)
    return torso @ space, replace(here, axes=(torso @ space)[:3, :3])


def _poses(ground: np.ndarray, move: EffectorMove) -> Callable[[float], np.ndarray]:
    return lambda elapsed: ground @ move.pose_at(elapsed)

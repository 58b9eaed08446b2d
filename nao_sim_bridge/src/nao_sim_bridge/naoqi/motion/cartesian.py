"""Parts of ALMotion about places: where effectors are, moving them there, the centre of mass."""

from __future__ import annotations

from typing import Any, Callable, Sequence

import numpy as np

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.tasks import Task
from nao_sim_bridge.control.whole_body.body_kinematics import body_kinematics
from nao_sim_bridge.control.whole_body.cartesian_move import CartesianMove, EffectorMove, moving_joints
from nao_sim_bridge.control.whole_body.cartesian_path import PosePath, joint_curves
from nao_sim_bridge.control.whole_body.inverse_kinematics import solve
from nao_sim_bridge.control.whole_body.tasks import end_paths, lead_to, led_joints, start_paths
from nao_sim_bridge.model.body_mass import center_of_links, convex_hull, links_of, mass_of
from nao_sim_bridge.model.frames import EVEN, TORSO, Placement, frame_of, sensor_places
from nao_sim_bridge.naoqi.binding.arguments import number
from nao_sim_bridge.naoqi.motion.arguments import (
    as_position,
    as_transform,
    effectors,
    mask_of,
    one_each,
    paths_of,
    pose_of_position,
    pose_of_transform,
    space_of,
)
from nao_sim_bridge.naoqi.motion.part import MotionPart

# Top speeds of an effector under whole body control, m/s and rad/s.
LEAD_SPEED = (0.5, 3.0)
PoseReader = Callable[[Any], np.ndarray]


def _moves(form: str, pose: PoseReader) -> tuple[Callable[..., Task], ...]:
    """NAOqi's methods that move effectors by poses of one form: set one or several, change, follow one or several."""
    noun = form.capitalize()

    def set_one(part: Cartesian, name: str, space: int, target: Any, fraction: float, mask: int) -> Task:
        return part._set(f"set{noun}", [name], space, [pose(target)], fraction, mask)

    def set_several(part: Cartesian, names: Any, spaces: Any, targets: Any, fraction: float, masks: Any) -> Task:
        poses = [pose(target) for target in one_each(targets, len(effectors(names)), "targets", nested=True)]
        return part._set(f"set{noun}s", names, spaces, poses, fraction, masks)

    def change(part: Cartesian, name: str, space: int, by: Any, fraction: float, mask: int) -> Task:
        now = part._pose(name, space, part._placement(False))
        return part._set(f"change{noun}", [name], space, [_moved(now, pose(by))], fraction, mask)

    def follow(part: Cartesian, name: str, space: int, path: Any, mask: int, times: Any, absolute: bool) -> Task:
        return part._interpolate(f"{form}Interpolation", [name], space, [path], mask, [times], absolute, pose)

    def follow_several(
        part: Cartesian, names: Any, spaces: Any, paths: Any, masks: Any, times: Any, absolute: bool = True
    ) -> Task:
        return part._interpolate(f"{form}Interpolations", names, spaces, paths, masks, times, absolute, pose)

    return set_one, set_several, change, follow, follow_several


class Cartesian(MotionPart):
    """Positions (x, y, z, wx, wy, wz) and transforms of effectors, joints and sensors."""

    def getSensorNames(self) -> list[str]:
        return list(sensor_places(self._model))

    def getPosition(self, name: str, space: int, use_sensors: bool) -> list[float]:
        return as_position(self._pose(name, space, self._placement(use_sensors)))

    def getTransform(self, name: str, space: int, use_sensors: bool) -> list[float]:
        return as_transform(self._pose(name, space, self._placement(use_sensors)))

    setPosition, setPositions, changePosition, positionInterpolation, positionInterpolations = _moves(
        "position", pose_of_position
    )
    setTransform, setTransforms, changeTransform, transformInterpolation, transformInterpolations = _moves(
        "transform", pose_of_transform
    )

    def _pose(self, name: str, space: int, placed: Placement) -> np.ndarray:
        frame = frame_of(self._model, name)
        return self._torso_in(space, placed) @ placed.in_torso(frame)

    def _set(
        self, call: str, names: Any, spaces: Any, poses: Sequence[np.ndarray], fraction: float, masks: Any
    ) -> Task:
        names = effectors(names)
        fraction = number(fraction, "fractionMaxSpeed", 0.01, 1.0)
        masks, spaces = one_each(masks, len(names), "axisMask"), one_each(spaces, len(names), "spaces")
        moves = [
            EffectorMove(name, space_of(space), mask_of(mask), lambda _, pose=pose: pose)
            for name, space, pose, mask in zip(names, spaces, poses, masks)
        ]
        if self._robot.whole_body.active:
            speed = (fraction * LEAD_SPEED[0], fraction * LEAD_SPEED[1])
            return self._runner.execute(
                lambda: lead_to(self._robot.whole_body, moves, speed, self._placement(False)), call
            )
        commands = self._robot.joints.commands
        body = body_kinematics(self._model)
        move = CartesianMove(body, moves, self._placement(False))
        found = solve(body, move.indices, move.goals_at(0.0), commands, move.footing_at(0.0))
        targets = {i: float(found[i]) for i in move.indices}
        top = {i: fraction * self._model.joints[i].max_velocity for i in targets}
        # All joints arrive together, so that the effector goes about straight.
        duration = max(abs(angle - commands[i]) / top[i] for i, angle in targets.items())
        speeds = {i: abs(angle - commands[i]) / duration if duration else 0.0 for i, angle in targets.items()}
        speeds = {i: speed or top[i] for i, speed in speeds.items()}
        return self._runner.execute(lambda: self._robot.motion.set_targets(targets, speeds), call)

    def _interpolate(
        self, call: str, names: Any, spaces: Any, paths: Any, masks: Any, times: Any, absolute: bool, pose: PoseReader
    ) -> Task:
        names = effectors(names)
        masks = [mask_of(mask) for mask in one_each(masks, len(names), "axisMasks")]
        spaces = [space_of(space) for space in one_each(spaces, len(names), "spaces")]
        keys = paths_of(paths, times, len(names), pose)
        indices = moving_joints(self._model, names)
        durations = [at[-1] for at, _ in keys]

        def moves_from(placed: Placement) -> list[EffectorMove]:
            moves = []
            for name, space, mask, (at, poses) in zip(names, spaces, masks, keys):
                now = self._pose(name, space, placed)
                ahead = poses if absolute else [_moved(now, change) for change in poses]
                moves.append(EffectorMove(name, space, mask, PosePath((0.0, *at), [now, *ahead]).pose))
            return moves

        def start() -> Task:
            robot, owner = self._robot, object()

            def curves(commands: Sequence[float]) -> dict:
                placed = self._placement(False)
                moves = moves_from(placed)
                if robot.whole_body.active:
                    start_paths(robot.whole_body, owner, moves, durations, placed)
                    return dict(led_joints(robot.joints, indices, max(durations)))
                body = body_kinematics(self._model)
                move = CartesianMove(body, moves, placed)
                moments = sorted({moment for at, _ in keys for moment in at})
                return joint_curves(body, indices, move.goals_at, moments, commands, move.footing_at)

            task = robot.motion.follow(call, indices, curves)
            task.add_done_callback(lambda done: end_paths(robot.whole_body, owner, names, done.killed))
            return task

        return self._runner.execute(start, call)


def _moved(pose: np.ndarray, change: np.ndarray) -> np.ndarray:
    """`pose` shifted and turned by `change`, both along the axes of the space."""
    moved = pose.copy()
    moved[:3, :3] = change[:3, :3] @ pose[:3, :3]
    moved[:3, 3] += change[:3, 3]
    return moved


# A sole this much higher than the other one, m, carries nothing.
LIFTED = 0.005


class Mass(MotionPart):
    """What follows from the masses of the links and the soles on the ground."""

    def getMass(self, name: str) -> float:
        return mass_of(links_of(self._model, name))

    def getCOM(self, name: str, space: int, use_sensors: bool) -> list[float]:
        links = links_of(self._model, name)
        now = self._runner.snapshot
        center = center_of_links(self._model, links, now.positions if use_sensors else self._robot.joints.commands)
        return (self._torso_in(space, self._placement(use_sensors, now)) @ np.append(center, 1.0))[:3].tolist()

    def getSupportPolygon(self, space: int, use_sensors: bool) -> list[list[float]]:
        if space_of(space) == TORSO:
            raise BadValue("space", space, "1 (FRAME_WORLD) or 2 (FRAME_ROBOT)")
        placed = self._placement(use_sensors)
        to_space = self._torso_in(space, placed)
        soles = []
        for side in ("L", "R"):
            contour = self._model.sole_polygon(side)
            corners = np.column_stack((contour, np.full((len(contour), 2), (-self._model.sole_height, 1.0))))
            soles.append((to_space @ placed.links[f"{side}AnkleRoll"] @ corners.T).T)
        ground = min(sole[:, 2].min() for sole in soles) + EVEN
        standing = [sole for sole in soles if sole[:, 2].min() <= ground + LIFTED]
        return [list(corner) for corner in convex_hull(np.vstack(standing)[:, :2])]

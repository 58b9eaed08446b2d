"""Motions of the whole body as a few curves: arms and head by joint, the legs by where torso and weight are to be.

A motion is a table: channel -> key points (time in s, value). Channels are joints (rad, hands 0..1) and the `BODY` of
the robot, which the joints of both legs follow so that the feet stay where they are to be. Whatever has no channel
stays as in the posture StandInit.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Tuple

from nao_sim_bridge.control.joints.curves import SmoothCurve
from nao_sim_bridge.model.body_mass import center_of_links
from nao_sim_bridge.model.kinematics import rpy_matrix
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.legs import JOINTS, LEFT, RIGHT, Legs, Sole
from nao_sim_bridge.walk.matrices import IDENTITY

BASE = "StandInit"
BODY = ("height", "pitch", "roll", "com_x", "com_y", "left_x", "left_y", "left_z", "right_x", "right_y", "right_z")
"""Of torso: height over the soles (m), pitch (forward) and roll (to the right) in rad. Of the centre of mass: m ahead
and to the left of the middle between the feet in StandInit. Of the soles: m from where they are in StandInit."""
STEP = 0.1
"""s between samples: between them joints move as `SmoothCurve` does, and the feet slip by less than 1 mm."""
ROUNDS = 12
"""How often the torso is shifted until the centre of mass is where it is to be."""

Keys = Sequence[Tuple[float, float]]
Table = Mapping[str, Keys]


class Choreographer:
    """Turns tables into samples of joints."""

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._legs = Legs(model)
        self._base = posture(model, BASE)
        # The feet stand flat in StandInit: where they are in the frame of the torso tells how it is over them.
        (_, ankle, foot), (_, other, _) = (self._leg_state(side, self._base) for side in (LEFT, RIGHT))
        self._pitch = -math.atan2(foot[2], foot[8])
        turn = rpy_matrix((0.0, self._pitch, 0.0))
        x, y, z = turn @ ankle
        self._height = self._legs.sole_height - float(z)
        self._half_width = (ankle[1] - other[1]) / 2.0
        self._torso_x = -float(x)
        self._com_x = self._torso_x + float((turn @ center_of_links(model, model.links, self._base))[0])

    def samples(self, table: Table) -> tuple[list[str], list[tuple[float, list[float]]]]:
        """Names of the joints that a motion moves, and samples: time in s and angles in rad.

        Raises:
            ValueError: There is no such channel, its times do not begin with 0, or a joint would go beyond its limit.
        """
        curves = {name: self._curve(name, keys) for name, keys in table.items()}
        joints = [name for name in self._model.joint_index if name in table]
        if any(name in BODY for name in table):
            legs = {f"{side}{joint}" for side in "LR" for joint in JOINTS}
            joints = [name for name in self._model.joint_index if name in table or name in legs]
        end = max(keys[-1][0] for keys in table.values())
        rows = []
        for count in range(math.ceil(end / STEP - 1e-9) + 1):
            time = min(count * STEP, end)
            values = {name: curve.value(time) for name, curve in curves.items()}
            angles = self._pose(values)
            self._check(angles, time)
            rows.append((time, [angles[self._model.joint_index[name]] for name in joints]))
        return joints, rows

    def _curve(self, name: str, keys: Keys) -> SmoothCurve:
        if name not in BODY and name not in self._model.joint_index:
            raise ValueError(f"{name} is no joint and none of {', '.join(BODY)}")
        times, values = zip(*keys)
        if times[0] != 0.0:
            raise ValueError(f"{name} begins at {times[0]} s, not at 0")
        return SmoothCurve(times, values)

    def _pose(self, values: Mapping[str, float]) -> list[float]:
        """Angles of all joints at one time."""
        angles = list(self._base)
        for name, value in values.items():
            if name not in BODY:
                angles[self._model.joint_index[name]] = value
        body = dict.fromkeys(BODY, 0.0)
        body["height"], body["pitch"] = self._height, self._pitch
        body.update({name: value for name, value in values.items() if name in BODY})
        rotation = rpy_matrix((body["roll"], body["pitch"], 0.0))
        turn = tuple(float(v) for v in rotation.flatten())
        left = Sole((body["left_x"], body["left_y"] + self._half_width, body["left_z"]), IDENTITY)
        right = Sole((body["right_x"], body["right_y"] - self._half_width, body["right_z"]), IDENTITY)
        x, y = self._torso_x, 0.0
        for _ in range(ROUNDS):
            hip_yaw, l_leg, r_leg = self._legs.solve((x, y, body["height"]), turn, left, right, 0.0)
            for side, leg in ((LEFT, l_leg), (RIGHT, r_leg)):
                for index, angle in zip(self._legs.indices[side], (hip_yaw, *leg)):
                    angles[index] = float(angle)
            center = rotation @ center_of_links(self._model, self._model.links, angles)
            x += self._com_x + body["com_x"] - (x + float(center[0]))
            y += body["com_y"] - (y + float(center[1]))
        return angles

    def _leg_state(self, side: int, angles: Sequence[float]) -> tuple:
        yaw, *rest = (angles[index] for index in self._legs.indices[side])
        return self._legs.state(side, yaw, tuple(rest))

    def _check(self, angles: Sequence[float], time: float) -> None:
        for joint, angle in zip(self._model.joints, angles):
            if not joint.lower - 1e-6 <= angle <= joint.upper + 1e-6:
                raise ValueError(
                    f"at {time:g} s {joint.name} would be at {angle:.3f} rad: {joint.lower:.3f}..{joint.upper:.3f}"
                )

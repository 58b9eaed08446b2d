"""Kinematics of the two legs in closed form, with the one motor that turns both HipYawPitch joints."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, asin, atan2, cos, pi, sin, sqrt
from typing import Tuple

from nao_sim_bridge.model.robot_model import RobotModel
from nao_sim_bridge.walk.matrices import (
    Matrix,
    Vector,
    product,
    then_about_x,
    then_about_y,
    transposed,
    turned,
    turned_back,
)

# HipRoll, HipPitch, KneePitch, AnklePitch, AnkleRoll, rad.
LegAngles = Tuple[float, float, float, float, float]
LEFT, RIGHT = 1, -1
SIDES = {LEFT: "L", RIGHT: "R"}
JOINTS = ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
ROOT_HALF = sqrt(0.5)
# A knee never quite straight keeps the solution from jumping, m.
RESERVE = 1e-4
# The feet may be turned off unevenly by this, rad.
ENOUGH = 5e-4


@dataclass(frozen=True)
class Sole:
    """Where a sole is, or is to be: the point below the ankle, m, and the rotation of the foot."""

    position: Vector
    rotation: Matrix


class Legs:
    """Leg kinematics of one robot model."""

    def __init__(self, model: RobotModel) -> None:
        joints = {joint.name: joint for joint in model.joints}
        links = {link.name: link for link in model.links}
        _, self.hip_y, self.hip_z = (float(v) for v in joints["LHipYawPitch"].origin)
        self.thigh = -float(joints["LKneePitch"].origin[2])
        self.tibia = -float(joints["LAnklePitch"].origin[2])
        self.sole_height = float(model.sole_height)
        self._yaw_limits = (joints["LHipYawPitch"].lower, joints["LHipYawPitch"].upper)
        knee = joints["LKneePitch"]
        self._least_cos_knee = cos(min(knee.upper, pi))
        self._links = {
            side: tuple(
                (float(links[f"{letter}{name}"].mass), tuple(float(c) for c in links[f"{letter}{name}"].com))
                for name in JOINTS
            )
            for side, letter in SIDES.items()
        }
        self.mass = sum(mass for parts in self._links.values() for mass, _ in parts)
        self.indices = {
            side: tuple(model.joint_index[f"{letter}{name}"] for name in JOINTS) for side, letter in SIDES.items()
        }

    def solve(
        self, torso: Vector, rotation: Matrix, left: Sole, right: Sole, hip_yaw: float
    ) -> tuple[float, LegAngles, LegAngles]:
        """HipYawPitch and angles of both legs that put the soles where they are asked for, as far as one hip motor can.

        With the torso's pose given, each foot asks for a HipYawPitch of its own; the one in the middle leaves both
        feet turned off by the same small angle.

        Soles are in the same frame as the torso, m; `hip_yaw` is HipYawPitch to begin with, rad: that of the last tick.
        """
        l_ankle, l_turn = self._in_torso(torso, rotation, left)
        r_ankle, r_turn = self._in_torso(torso, rotation, right)
        low, high = self._yaw_limits
        for last in (False, False, True):
            l_leg, l_off = self.leg(LEFT, hip_yaw, l_ankle, l_turn)
            r_leg, r_off = self.leg(RIGHT, hip_yaw, r_ankle, r_turn)
            change = (r_off - l_off) * 0.5 / ROOT_HALF
            if last or abs(change) < ENOUGH:
                break
            hip_yaw = min(max(hip_yaw + change, low), high)
        return hip_yaw, l_leg, r_leg

    def _in_torso(self, torso: Vector, rotation: Matrix, sole: Sole) -> tuple[Vector, Matrix]:
        turn = product(transposed(rotation), sole.rotation)
        x, y, z = turned_back(
            rotation, (sole.position[0] - torso[0], sole.position[1] - torso[1], sole.position[2] - torso[2])
        )
        h = self.sole_height
        return (x + turn[2] * h, y + turn[5] * h, z + turn[8] * h), turn

    def leg(self, side: int, hip_yaw: float, ankle: Vector, foot: Matrix) -> tuple[LegAngles, float]:
        """One leg for a given HipYawPitch.

        Args:
            ankle: In the torso frame, m.
            foot: Rotation of the foot in the torso frame.

        Returns:
            The five angles below it, and by how much the foot is turned off about its own Z axis, rad.
        """
        hip = hip_rotation(side, hip_yaw)
        x, y, z = turned_back(hip, (ankle[0], ankle[1] - side * self.hip_y, ankle[2] - self.hip_z))
        roll = atan2(y, -z)
        z = -sqrt(y * y + z * z)
        length = sqrt(x * x + z * z)
        longest = self.thigh + self.tibia - RESERVE
        if length > longest:
            x, z, length = x * longest / length, z * longest / length, longest
        cos_knee = (length * length - self.thigh**2 - self.tibia**2) / (2.0 * self.thigh * self.tibia)
        knee = acos(min(max(cos_knee, self._least_cos_knee), 1.0))
        reach_x, reach_z = -self.tibia * sin(knee), -self.thigh - self.tibia * cos(knee)
        pitch = atan2(x * reach_z - z * reach_x, x * reach_x + z * reach_z)
        shank = then_about_y(then_about_x(hip, roll), pitch + knee)
        rest = product(transposed(shank), foot)
        ankle_roll = -asin(min(max(rest[5], -1.0), 1.0))
        ankle_pitch = atan2(rest[2], rest[8])
        # What the two ankle joints leave of the turn, a rotation about Z: its first column.
        sp, cp, sr, cr = sin(ankle_pitch), cos(ankle_pitch), sin(ankle_roll), cos(ankle_roll)
        off_x = cp * rest[0] - sp * rest[6]
        off_y = sr * (sp * rest[0] + cp * rest[6]) + cr * rest[3]
        return (roll, pitch, knee, ankle_pitch, ankle_roll), atan2(off_y, off_x)

    def state(self, side: int, hip_yaw: float, angles: LegAngles) -> tuple[Vector, Vector, Matrix]:
        """Mass moment (kg m), place of the ankle (m) and rotation of the foot of one leg in the torso frame."""
        roll, pitch, knee, ankle_pitch, ankle_roll = angles
        yaw_turn = hip_rotation(side, hip_yaw)
        roll_turn = then_about_x(yaw_turn, roll)
        thigh_turn = then_about_y(roll_turn, pitch)
        shank_turn = then_about_y(roll_turn, pitch + knee)
        ankle_turn = then_about_y(roll_turn, pitch + knee + ankle_pitch)
        foot = then_about_x(ankle_turn, ankle_roll)
        hip = (0.0, side * self.hip_y, self.hip_z)
        t, s = self.thigh, self.tibia
        knee_at = (hip[0] - t * thigh_turn[2], hip[1] - t * thigh_turn[5], hip[2] - t * thigh_turn[8])
        ankle = (knee_at[0] - s * shank_turn[2], knee_at[1] - s * shank_turn[5], knee_at[2] - s * shank_turn[8])
        mx = my = mz = 0.0
        turns = (yaw_turn, roll_turn, thigh_turn, shank_turn, ankle_turn, foot)
        for (mass, com), turn, at in zip(self._links[side], turns, (hip, hip, hip, knee_at, ankle, ankle)):
            x, y, z = turned(turn, com)
            mx += mass * (at[0] + x)
            my += mass * (at[1] + y)
            mz += mass * (at[2] + z)
        return (mx, my, mz), ankle, foot


def hip_rotation(side: int, angle: float) -> Matrix:
    """Rotation about the HipYawPitch axis, which lies slantwise between Y and Z, mirrored for the right leg."""
    c, s = cos(angle), sin(angle)
    t = (1.0 - c) * 0.5
    a, b = ROOT_HALF * s, ROOT_HALF * s * side
    return (c, b, a, -b, c + t, -t * side, -a, -t * side, c + t)

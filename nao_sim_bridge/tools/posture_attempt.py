"""One attempt at a move between postures under physics: a disturbed start, the move, and what came of it."""

from __future__ import annotations

import math
import random
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from nao_sim_bridge.base.settings import Settings, load_settings
from nao_sim_bridge.base.tasks import TaskIds
from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.body.physics import Physics
from nao_sim_bridge.body.sensors.snapshot import Snapshot
from nao_sim_bridge.control.balance.posture_recognition import recognise
from nao_sim_bridge.core.posture_moves import Move, play
from nao_sim_bridge.core.robot import SimulatedRobot
from nao_sim_bridge.core.scene import Scene
from nao_sim_bridge.model.kinematics import link_transforms, quaternion_matrix
from nao_sim_bridge.model.leds_layout import load_leds
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture, start_pitch
from nao_sim_bridge.model.robot_model import Joint
from nao_sim_bridge.world.reader import load_world

# How long the robot comes to rest before and after a move, s.
SETTLE_TIME = 1.0
# Families without a predefined posture: a robot laid down on that side. Roll of the torso, rad.
SIDES = {"LyingLeft": -math.pi / 2.0, "LyingRight": math.pi / 2.0}
# It stays there only with its limbs spread, most often in one of these postures. Noise of the torso, rad; trials.
SIDE_POSTURES = ("StandZero", "StandInit", "SitRelax", "Crouch")
SIDE_NOISE = 0.15
MOST_TRIALS = 50


class Mark(NamedTuple):
    """The body at one moment: height of the torso, m, cosine of its lean and of that of the feet (mean of both).

    `beside` is how far the torso is from the middle of the feet, horizontally, m.
    """

    height: float
    upright: float
    flat: float
    beside: float


@dataclass(frozen=True)
class Outcome:
    """What came of an attempt.

    Attributes:
        reached: Whether it ended in its goal.
        ended: Family, or posture where it is a predefined one, at the end.
        marks: The body at the end of every key frame, and at rest at the end.
        turn: Fastest turn of the torso, rad/s.
        impact: Largest force of one contact, N.
        speed: Largest share of its top speed that a command took.
        torque: Largest share of its torque that a motor gave.
    """

    reached: bool
    ended: str
    marks: tuple[Mark, ...]
    turn: float
    impact: float
    speed: float
    torque: float


class Attempts:
    """Makes attempts at moves that begin in the same posture or family.

    Args:
        start: Posture that the attempts begin in, or a family of those that lie on a side.
        noise: Largest deviation of a joint at the start, rad.
        friction: Of soles on the floor in place of the settings', None for these.
    """

    def __init__(self, start: str, noise: float = 0.05, friction: float | None = None) -> None:
        self._start = start
        self._noise = noise
        settings = load_settings()
        if friction is not None:
            settings = replace(settings, contact=replace(settings.contact, sole_friction=friction))
        self._settings: Settings = settings
        self._model = load_model()
        self._leds = load_leds(self._model.version)
        self._physics = Physics(self._model, load_world("empty"), settings, posture(self._model, "Stand"))
        self._tops = np.array([joint.max_velocity for joint in self._model.joints])
        self._torques = np.array([joint.max_torque for joint in self._model.joints])
        self._robot: SimulatedRobot
        self._snapshot: Snapshot

    def close(self) -> None:
        self._physics.close()

    def run(self, move: Move, seed: int) -> Outcome:
        """One attempt from rest; `seed` is that of the disturbance."""
        self._begin(random.Random(f"{self._start} {seed}"))
        self._robot.getting_up = True
        task = play(self._robot, "attempt", move)
        ends = np.cumsum([frame.duration for frame in move.frames])
        begun, marks, turn, impact, speed, torque = self._robot.time, [], 0.0, 0.0, 0.0, 0.0
        while not task.finished:
            snapshot = self._tick()
            turn = max(turn, math.hypot(*snapshot.angular_velocity))
            impact = max([impact, *(contact.force for contact in snapshot.contacts)])
            speed = max(speed, float(np.max(np.abs(self._robot.joints.velocities) / self._tops)))
            torque = max(torque, float(np.max(np.abs(snapshot.torques) / self._torques)))
            if len(marks) < len(ends) and self._robot.time - begun >= ends[len(marks)] - 1e-6:
                marks.append(self._mark())
        self._settle()
        marks.append(self._mark())
        seen = recognise(self._model, self._snapshot)
        reached = seen.posture == move.goal
        ended = move.goal if reached else seen.family
        return Outcome(reached, ended, tuple(marks), turn, impact, speed, torque)

    def _begin(self, chance: random.Random) -> None:
        """A stiff robot at rest, all joints a little off."""
        if self._start not in SIDES:
            self._lay(self._start, chance, start_pitch(self._start))
            return
        for _ in range(MOST_TRIALS):
            roll, pitch = (middle + chance.uniform(-SIDE_NOISE, SIDE_NOISE) for middle in (SIDES[self._start], 0.0))
            self._lay(chance.choice(SIDE_POSTURES), chance, pitch, roll)
            if recognise(self._model, self._snapshot).family == self._start:
                return
        raise RuntimeError(f"no robot out of {MOST_TRIALS} stayed in {self._start}")

    def _lay(self, name: str, chance: random.Random, pitch: float | None, roll: float = 0.0) -> None:
        aims = posture(self._model, name)
        angles = [self._off(joint, angle, chance) for joint, angle in zip(self._model.joints, aims)]
        left, right = (self._model.joint_index[joint] for joint in JointCommands.COUPLED)
        angles[right] = angles[left]
        self._physics.place(angles, pitch=pitch, roll=roll)
        self._robot = SimulatedRobot(self._model, self._leds, self._settings, self._physics, angles, Scene(), TaskIds())
        self._robot.getting_up = pitch is not None
        self._robot.motion.set_stiffness_now(dict.fromkeys(range(len(angles)), 1.0))
        self._settle()

    def _off(self, joint: Joint, angle: float, chance: random.Random) -> float:
        """The angle with noise, within the limits; hands are left alone."""
        if joint.is_hand:
            return angle
        return min(max(angle + chance.uniform(-self._noise, self._noise), joint.lower), joint.upper)

    def _settle(self) -> None:
        for _ in range(round(SETTLE_TIME / self._settings.tick_s)):
            self._tick()

    def _tick(self) -> Snapshot:
        self._robot.act()
        self._snapshot = self._robot.sense(round(self._robot.time / self._settings.tick_s), self._robot.time)
        return self._snapshot

    def _mark(self) -> Mark:
        snapshot = self._snapshot
        turned = quaternion_matrix(snapshot.torso.orientation)
        links = link_transforms(self._model, snapshot.positions)
        feet = [links[f"{side}AnkleRoll"] for side in "LR"]
        middle = turned @ ((feet[0][:3, 3] + feet[1][:3, 3]) / 2.0)
        flat = sum(float((turned @ foot[:3, 2])[2]) for foot in feet) / 2.0
        return Mark(snapshot.torso.position[2], float(turned[2, 2]), flat, math.hypot(middle[0], middle[1]))

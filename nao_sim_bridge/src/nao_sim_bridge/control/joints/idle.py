"""What the robot does with chains that nobody moves: nothing, go back to a posture, or breathe.

Any task or target on a joint of a chain ends what the chain does by itself; it starts again, softly, when the chain is
free. A limp chain stays as it is, and breathing is for a robot that stands.

Source: ALMotion's idle control; the ranges of the breath and how they depend on each other are NAOqi's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import AbstractSet, Callable, Mapping, Sequence

from nao_sim_bridge.body.joint_commands import JointCommands
from nao_sim_bridge.model.postures import posture
from nao_sim_bridge.model.robot_model import RobotModel, joint_kind

CHAINS = {"Head": ("Head",), "LArm": ("LArm",), "RArm": ("RArm",), "Legs": ("LLeg", "RLeg")}
GROUPS = {**{name: (name,) for name in CHAINS}, "Arms": ("LArm", "RArm"), "Body": tuple(CHAINS)}
STANDING_POSTURE = "Stand"
# A chain takes this time to join in, s, or as long as a way at this mean speed takes, rad/s.
EASE_TIME, EASE_SPEED = 2.0, 0.4
BPM, AMPLITUDE = (5.0, 30.0), (0.0, 1.0)
# What a breath adds at its fullest, rad at amplitude 0: by kind of joint, the left side's sign. Knees give way as hips
# and ankles do half as much each, so that the body goes down and up over its feet.
FIVE_DEGREES = math.radians(5.0)
BREATH = {
    "HeadPitch": 0.3 * FIVE_DEGREES,
    "ShoulderPitch": 0.6 * FIVE_DEGREES,
    "ShoulderRoll": 0.4 * FIVE_DEGREES,
    "ElbowRoll": -0.6 * FIVE_DEGREES,
    "HipPitch": -0.4 * FIVE_DEGREES,
    "KneePitch": 0.8 * FIVE_DEGREES,
    "AnklePitch": -0.4 * FIVE_DEGREES,
}
MIRRORED = ("ShoulderRoll", "ElbowRoll")
# Below this, rad, a chain is where it should be.
THERE = 1e-9


class Mode(Enum):
    """What a chain does while nobody moves it."""

    NOTHING = "nothing"
    POSTURE = "posture"
    BREATH = "breath"


@dataclass
class _Chain:
    indices: tuple[int, ...]
    mode: Mode = Mode.NOTHING
    start: Mapping[int, float] = field(default_factory=dict)
    reference: Sequence[float] = ()
    duration: float = EASE_TIME
    joined: float | None = None


class Idle:
    """Modes of the chains, and where they take the joints.

    Attributes:
        bpm: Breaths a minute, 5 to 30.
        amplitude: Of the breath, 0 to 1; at most what `bpm` allows.
        active: Whether any chain has something to do while nobody moves it.
        suspended: True while the robot falls or gets up: it is left alone.

    Args:
        reference: Name of the posture that a robot like now goes back to, None to stay as it is.
        stands: Whether the robot stands now.
    """

    def __init__(
        self,
        model: RobotModel,
        joints: JointCommands,
        reference: Callable[[], str | None],
        stands: Callable[[], bool],
    ) -> None:
        self._model = model
        self._joints = joints
        self._reference = reference
        self._stands = stands
        self._chains = {name: _Chain(indices) for name, indices in chain_indices(model).items()}
        self._breath = {i: amount for i, joint in enumerate(model.joints) if (amount := _breath_of(joint.name))}
        self._phase = 0.0
        self.bpm, self.amplitude = 12.0, 0.5
        self.active = False
        self.suspended = False

    def set_mode(self, group: str, mode: Mode) -> None:
        """Let the chains of a group do this while nobody moves them."""
        for name in GROUPS[group]:
            chain = self._chains[name]
            if chain.mode is not mode:
                chain.mode, chain.joined = mode, None
        self.active = any(chain.mode is not Mode.NOTHING for chain in self._chains.values())

    def has_mode(self, group: str, mode: Mode) -> bool:
        return all(self._chains[name].mode is mode for name in GROUPS[group])

    @property
    def breathes(self) -> bool:
        """Whether any chain breathes now: it is free, and the robot stands."""
        return any(chain.mode is Mode.BREATH and chain.joined is not None for chain in self._chains.values())

    def set_breath(self, bpm: float, amplitude: float) -> None:
        """Change the breath; fast breaths are flat: the amplitude is cut to what the frequency allows."""
        self.bpm = bpm
        self.amplitude = min(amplitude, (BPM[1] - bpm) / (BPM[1] - BPM[0]))

    def wishes(self, busy: AbstractSet[int], dt: float) -> dict[int, float]:
        """Where idle joints go at a tick of `dt` s, rad by index; none of `busy`, which somebody else moves."""
        wanted: dict[int, float] = {}
        if not self.active:
            return wanted
        self._phase = (self._phase + dt * self.bpm / 60.0) % 1.0
        for chain in self._chains.values():
            if chain.mode is not Mode.NOTHING:
                wanted.update(self._move(chain, busy, dt))
        return wanted

    def _move(self, chain: _Chain, busy: AbstractSet[int], dt: float) -> Mapping[int, float]:
        stiffnesses, commands = self._joints.stiffnesses, self._joints.commands
        if self.suspended or not busy.isdisjoint(chain.indices) or not all(stiffnesses[i] for i in chain.indices):
            chain.joined = None
            return {}
        if chain.joined is None and not self._join(chain):
            return {}
        chain.joined = min(chain.joined + dt, chain.duration)
        share = chain.joined / chain.duration
        share *= share * (3.0 - 2.0 * share)
        goals = self._goals(chain)
        wishes = {i: chain.start[i] + share * (goals[i] - chain.start[i]) for i in chain.indices}
        if chain.mode is Mode.POSTURE and all(abs(wishes[i] - commands[i]) < THERE for i in chain.indices):
            return {}
        return wishes

    def _join(self, chain: _Chain) -> bool:
        """Start from where the chain is; False when there is nothing for it to do."""
        breathes = chain.mode is Mode.BREATH
        if breathes and not self._stands():
            return False
        name = STANDING_POSTURE if breathes else self._reference()
        commands = self._joints.commands
        chain.reference = commands if name is None else posture(self._model, name)
        chain.start = {i: commands[i] for i in chain.indices}
        way = max(abs(chain.reference[i] - commands[i]) for i in chain.indices)
        chain.duration = max(EASE_TIME, way / EASE_SPEED)
        chain.joined = 0.0
        return True

    def _goals(self, chain: _Chain) -> Mapping[int, float]:
        if chain.mode is Mode.POSTURE:
            return {i: chain.reference[i] for i in chain.indices}
        fullness = (1.0 + self.amplitude) * (1.0 - math.cos(2.0 * math.pi * self._phase)) / 2.0
        return {i: chain.reference[i] + fullness * self._breath.get(i, 0.0) for i in chain.indices}


def chain_indices(model: RobotModel) -> dict[str, tuple[int, ...]]:
    """Joints of each of `CHAINS` by index."""
    return {
        name: tuple(model.joint_index[joint] for part in parts for joint in model.chains[part])
        for name, parts in CHAINS.items()
    }


def _breath_of(joint: str) -> float:
    kind = joint_kind(joint)
    amount = BREATH.get(kind, 0.0)
    return -amount if joint[0] == "R" and kind in MIRRORED else amount

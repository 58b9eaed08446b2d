"""What the environments share: the robot, its observations, what is random in it, and rendering."""

from __future__ import annotations

import inspect
import math
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Collection, Mapping, Sequence

import gymnasium
import numpy as np
from gymnasium import spaces

from nao_sim_bridge.base.errors import BadValue, UnknownName
from nao_sim_bridge.base.readings import UP
from nao_sim_bridge.base.rotations import rotate_back
from nao_sim_bridge.library.nao_sim import NaoSim
from nao_sim_bridge.model.model_reader import load_model
from nao_sim_bridge.model.postures import posture

SCALE_OF_SPEED, SCALE_OF_LOAD = 0.1, 0.02
"""Joint speeds are observed times this, s/rad, and the load of a foot times this, 1/N: both are then about 1."""

LARGEST = 100.0
"""What is observed is cut at this."""

OWN = ("self", "posture", "seed", "robots", "gui")
"""Arguments of `NaoSim` that an environment decides itself."""


@dataclass(frozen=True)
class Randomization:
    """What differs from episode to episode; each a width around the true robot, 0 for none.

    Attributes:
        payload: Up to so much more mass in the torso, kg.
        friction: Coefficient of soles and floor, a share of it up or down.
        delay: How late the sensors are at most, s.
        noise: Scale of the sensors' errors, 1 for those of a real robot.
        push: Momentum of pushes, N s, at most; they come from any side.
        push_every: s between pushes, on average.

    Raises:
        BadValue: A number is out of range.
    """

    payload: float = 0.0
    friction: float = 0.0
    delay: float = 0.0
    noise: float = 0.0
    push: float = 0.0
    push_every: float = 2.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name == "friction":
                fits, allowed = 0.0 <= value < 1.0, "0 to below 1"
            elif name == "push_every":
                fits, allowed = 0.0 < value < math.inf, "above 0, finite"
            else:
                fits, allowed = 0.0 <= value < math.inf, "0 or more, finite"
            if not fits:
                raise BadValue(f"randomization: {name}", value, allowed)

    @classmethod
    def of(cls, given: Randomization | Mapping[str, float] | None) -> Randomization:
        """From a mapping of some fields; None for nothing random.

        Raises:
            UnknownName: There is no such field.
        """
        if isinstance(given, Randomization):
            return given
        check_names("randomization", given or {}, [field.name for field in fields(cls)])
        return cls(**(given or {}))


class NaoEnv(gymnasium.Env):
    """A NAO whose joints are driven by an agent: actions are changes of the angles of `JOINTS` around a posture.

    Observation (float32), in this order: the direction of up in the torso's frame (3), the gyroscope in rad/s (3), the
    angles of all joints less those of the posture in rad (26), their speeds in rad/s times 0.1 (26), the loads of left
    and right foot in N times 0.02 (2), the last action (n), and what the environment adds.

    Action (float32, -1..1 each): target of a joint, less its angle in the posture, times `REACH` rad. The other joints
    keep the posture.

    One of your own is a subclass with `JOINTS` and `judge`, and maybe more of what follows: docs/environments.md.

    Attributes:
        POSTURE: In which episodes begin, and around which actions move the joints.
        JOINTS: Names of those that actions drive.
        REACH: Angle of an action of 1, rad.
        TICKS: Of 1/120 s in a step; 3 are 25 ms.
        EXTRA: How many numbers `extras` adds to the observation.
        OPTIONS: What `options` of `reset` may have.

    Args:
        render_mode: "rgb_array", "human" or None.
        randomization: What differs from episode to episode, as a `Randomization` or a mapping of its fields.
        drive: What the actions are sent to: "position", as above; "torque": N m, a share of what the motors give.
        options: Passed on to `NaoSim`: `world`, `places`, `version`, `noise`, `delay`, `friction`, `payload`.

    Raises:
        SimulationError: There is no such option, or a number is out of range.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array", "human"], "render_fps": 40}
    POSTURE: ClassVar[str] = "Stand"
    JOINTS: ClassVar[Sequence[str]] = ()
    REACH: ClassVar[float] = 0.5
    TICKS: ClassVar[int] = 3
    EXTRA: ClassVar[int] = 0
    OPTIONS: ClassVar[Sequence[str]] = ()

    def __init__(
        self,
        render_mode: str | None = None,
        randomization: Randomization | Mapping[str, float] | None = None,
        drive: str = "position",
        **options: Any,
    ) -> None:
        if drive not in ("position", "torque"):
            raise BadValue("drive", drive, "position or torque")
        self.render_mode = checked_render_mode(render_mode, self.metadata["render_modes"])
        self.randomization = Randomization.of(randomization)
        check_options(options)
        self._drive = drive
        self._options = options
        self._model = load_model(options.get("version", "V6"))
        self._reference = np.array(posture(self._model, self.POSTURE))
        self._driven = np.array([self._model.joint_index[name] for name in self.JOINTS])
        self._limits = np.array([self._model.joints[i].max_torque for i in self._driven])
        self._sim: NaoSim | None = None
        self._action = np.zeros(len(self._driven), np.float32)
        self._next_push = np.inf
        count = len(self._driven)
        self.action_space = spaces.Box(-1.0, 1.0, (count,), np.float32)
        size = 3 + 3 + 26 + 26 + 2 + count + self.EXTRA
        self.observation_space = spaces.Box(-LARGEST, LARGEST, (size,), np.float32)

    @property
    def sim(self) -> NaoSim:
        """The simulation; there is one from the first `reset` on."""
        if self._sim is None:
            raise RuntimeError("there is no simulation yet: call reset first")
        return self._sim

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[Any, dict]:
        """Begin an episode.

        Args:
            seed: Of all that is random from now on; None goes on with the one before.
            options: What the episode is about, where the environment has a word for it ("command" of NaoWalk-v0,
                "point" of NaoReach-v0); what is not given is drawn.

        Raises:
            UnknownName: The environment has no such option.
            BadValue: A number of the options is not finite, or there are too few or too many.
        """
        super().reset(seed=seed)
        check_names("option of reset", options or {}, self.OPTIONS)
        chance = self.np_random
        wide, number = self.randomization, int(chance.integers(1 << 30))
        drawn = {"payload": wide.payload * chance.uniform(), "delay": wide.delay * chance.uniform()}
        friction = 1.0 + wide.friction * chance.uniform(-1.0, 1.0)
        if self._sim is None:
            fixed = {"posture": self.POSTURE, "noise": wide.noise, "gui": self.render_mode == "human"}
            self._sim = NaoSim(seed=number, **{**fixed, **drawn, **self._options})
        else:
            self._sim.reset(number, **{name: value for name, value in drawn.items() if name not in self._options})
        if wide.friction:
            self._sim.robot.scale_friction(friction)
        self._action[:] = 0.0
        self._plan_push()
        self.begin(options or {})
        return self._observe(), {}

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict]:
        """Drive the joints for 25 ms; what an action has beyond -1..1 is cut.

        Raises:
            BadValue: The action has not a finite number for each joint.
        """
        action = checked_action(action, self.action_space.shape)
        if self.sim.time >= self._next_push:
            self._push()
        if self._drive == "position":
            values = self._reference.copy()
            values[self._driven] += self.REACH * action
        else:
            values = np.zeros(len(self._reference))
            values[self._driven] = self._limits * action
        self._sim.drive(values.tolist(), self._drive, self.TICKS)
        reward, over = self.judge(action)
        self._action = action
        return self._observe(), float(reward), bool(over), False, {}

    def render(self) -> np.ndarray | None:
        """A picture from outside, (480, 640, 3) uint8; None for "human", whose window shows each step by itself."""
        return self.sim.picture() if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """End the simulation."""
        if self._sim is not None:
            self._sim.close()
            self._sim = None

    # --- for the environments -----------------------------------------------------------------------------------------

    @property
    def last_action(self) -> np.ndarray:
        """The action of the step before; zeros in the first one."""
        return self._action

    def begin(self, options: Mapping[str, Any]) -> None:
        """Take from the options of `reset`, or draw, what an episode is about; robot and world are at their start."""

    def judge(self, action: np.ndarray) -> tuple[float, bool]:
        """Reward of the step that has just been made, and whether the episode has failed."""
        raise NotImplementedError

    def extras(self) -> Sequence[float]:
        """What is added to the observation: `EXTRA` numbers."""
        return ()

    # --- inside -------------------------------------------------------------------------------------------------------

    def _observe(self) -> np.ndarray:
        now = self._sim.snapshot
        seen = np.concatenate(
            (
                rotate_back(now.torso.orientation, UP),
                now.imu.gyroscope,
                np.array(now.positions) - self._reference,
                np.array(now.velocities) * SCALE_OF_SPEED,
                np.array(now.foot_loads) * SCALE_OF_LOAD,
                self._action,
                self.extras(),
            ),
            dtype=np.float32,
        )
        return np.clip(seen, -LARGEST, LARGEST)

    def _plan_push(self) -> None:
        wide = self.randomization
        self._next_push = self._sim.time + self.np_random.exponential(wide.push_every) if wide.push else np.inf

    def _push(self) -> None:
        angle, size = self.np_random.uniform(0.0, 2.0 * np.pi), self.randomization.push * self.np_random.uniform()
        force = (10.0 * size * np.cos(angle), 10.0 * size * np.sin(angle), 0.0)
        self._sim.push("Torso", force, 0.1)
        self._plan_push()


def check_names(kind: str, given: Collection[str], known: Collection[str]) -> None:
    """Refuse a name that is not known.

    Raises:
        UnknownName: The error says what there is.
    """
    for name in given:
        if name not in known:
            raise UnknownName(kind, name, known, "allowed")


def check_options(given: Collection[str]) -> None:
    """Refuse what an environment cannot pass on to `NaoSim`.

    Raises:
        UnknownName: The error says what there is.
    """
    known = [name for name in inspect.signature(NaoSim.__init__).parameters if name not in OWN]
    check_names("option of an environment", given, known)


def checked_render_mode(mode: str | None, known: Sequence[str]) -> str | None:
    """A mode that there is, or None.

    Raises:
        BadValue: There is no such mode.
    """
    if mode is not None and mode not in known:
        raise BadValue("render_mode", mode, ", ".join(map(repr, known)))
    return mode


def checked_action(action: Any, shape: tuple[int, ...]) -> np.ndarray:
    """An action as float32, cut at -1 and 1.

    Raises:
        BadValue: It has another shape, or not only finite numbers.
    """
    action = np.asarray(action, np.float32)
    if action.shape != shape or not np.isfinite(action).all():
        raise BadValue("action", action, f"finite numbers of shape {shape}")
    return np.clip(action, -1.0, 1.0)


def legs_of(*names: str) -> tuple[str, ...]:
    """Joints of both legs, from their names without the side."""
    return tuple(f"{side}{name}" for side in "LR" for name in names)


LEGS = legs_of("HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
ARMS = legs_of("ShoulderPitch", "ShoulderRoll")

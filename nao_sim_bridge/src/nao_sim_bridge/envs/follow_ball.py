"""NaoFollowBall-v0: keep a ball in the picture of the camera, and walk to it."""

from __future__ import annotations

from typing import Any, ClassVar, Mapping

import gymnasium
import numpy as np
from gymnasium import spaces

from nao_sim_bridge.base.errors import MoveRefused
from nao_sim_bridge.envs.base import check_names, check_options, checked_action, checked_render_mode
from nao_sim_bridge.library.nao_sim import NaoSim

WIDTH, HEIGHT = 80, 60
STEP = 0.2
"""s; the camera gives five pictures a second then."""
AHEAD, TURN, HEAD = 0.08, 0.3, 0.4
"""What an action of 1 is: m/s, rad/s, and rad in a step."""
NEAR = 0.25
"""Distance at which the ball is reached, m."""


class NaoFollowBallEnv(gymnasium.Env):
    """Find a red ball by the eyes alone, and walk to it; the walk is the robot's own.

    Observation: "image", (60, 80, 3) uint8 RGB of the top camera; "head", yaw and pitch in rad (2). Action (4, -1..1):
    walk ahead (0.08 m/s), turn (0.3 rad/s), turn the head, nod (0.4 rad each in a step). Reward of a step: how much
    nearer the robot has come, in m, times 10, 0.1 if the ball is in the picture, and 10 when it is 0.25 m away, with
    which the episode ends well. It fails when the robot has fallen, and is over after 60 s.

    Args:
        render_mode: "rgb_array" or None.
        options: Passed on to `NaoSim`, see `NaoEnv`.
    """

    metadata: ClassVar[dict[str, Any]] = {"render_modes": ["rgb_array"], "render_fps": 5}

    def __init__(self, render_mode: str | None = None, **options: Any) -> None:
        self.render_mode = checked_render_mode(render_mode, self.metadata["render_modes"])
        check_options(options)
        self._options = options
        self._sim: NaoSim | None = None
        self.action_space = spaces.Box(-1.0, 1.0, (4,), np.float32)
        self.observation_space = spaces.Dict(
            {
                "image": spaces.Box(0, 255, (HEIGHT, WIDTH, 3), np.uint8),
                "head": spaces.Box(-3.0, 3.0, (2,), np.float32),
            }
        )

    def reset(self, *, seed: int | None = None, options: Mapping[str, Any] | None = None) -> tuple[dict, dict]:
        """Begin an episode: the ball lies 0.6 to 1.5 m away, up to 1 rad aside; there are no `options`."""
        super().reset(seed=seed)
        check_names("option of reset", options or {}, ())
        number = int(self.np_random.integers(1 << 30))
        if self._sim is None:
            self._sim = NaoSim(seed=number, **self._options)
        else:
            self._sim.reset(number)
        far, aside = self.np_random.uniform(0.6, 1.5), self.np_random.uniform(-1.0, 1.0)
        # It lies still: a ball that is kicked away rolls for metres.
        self._ball = np.array((far * np.cos(aside), far * np.sin(aside)))
        if "ball" in self._sim.things:  # that of the world
            self._sim.remove("ball")
        self._sim.place("ball", at=(*self._ball, 0.04), ball=0.04, mass=0.0)
        self._head = np.zeros(2)
        self._far = self._distance()
        return self._observe(), {}

    def step(self, action: np.ndarray) -> tuple[dict, float, bool, bool, dict]:
        """Walk and look for 0.2 s; what an action has beyond -1..1 is cut.

        Raises:
            BadValue: The action is not four finite numbers.
        """
        ahead, turn, *head = checked_action(action, self.action_space.shape).tolist()
        self._head = np.clip(self._head + HEAD * np.array(head), (-1.5, -0.4), (1.5, 0.4))
        self._sim.set_angles(["HeadYaw", "HeadPitch"], self._head)
        refused = ""
        try:
            if abs(ahead) + abs(turn) > 0.05:
                self._sim.walk(AHEAD * ahead, 0.0, TURN * turn)
            else:
                self._sim.stop(wait=False)
        except MoveRefused as error:  # a robot that is falling
            refused = str(error)
        self._sim.step(STEP)
        before, self._far = self._far, self._distance()
        seen, there, fallen = self._observe(), self._far < NEAR, self._sim.fallen
        reward = 10.0 * (before - self._far) + 0.1 * _has_red(seen["image"]) + 10.0 * there
        return seen, float(reward), bool(there or fallen), False, {"distance": self._far, "refused": refused}

    def render(self) -> np.ndarray | None:
        """A picture from outside, (480, 640, 3) uint8."""
        return self._sim.picture("far") if self.render_mode == "rgb_array" and self._sim is not None else None

    def close(self) -> None:
        """End the simulation."""
        if self._sim is not None:
            self._sim.close()
            self._sim = None

    def _distance(self) -> float:
        here = self._sim.pose_on_ground
        return float(np.hypot(self._ball[0] - here.x, self._ball[1] - here.y))

    def _observe(self) -> dict[str, np.ndarray]:
        image = self._sim.camera("top").picture(WIDTH, HEIGHT)
        angles = self._sim.angles
        head = np.array((angles["HeadYaw"], angles["HeadPitch"]), np.float32)
        return {"image": image, "head": head}


def _has_red(image: np.ndarray) -> bool:
    red, green, blue = (image[..., channel].astype(int) for channel in range(3))
    return int(((red > 90) & (red > 2 * green) & (red > 2 * blue)).sum()) >= 4

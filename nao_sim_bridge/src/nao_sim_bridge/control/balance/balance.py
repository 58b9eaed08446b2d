"""Balance of a robot that stands still: small corrections of ankles, knees and hips that take the swing out of a push.

It stands on what the robot itself can know: joint encoders and inertial unit. The corrections go on top of the joint
commands (`JointCommands.correct`), grow with how far the body's capture point has left its place, and end when the body
is back: a robot that nobody disturbs gets none. Where it has come to rest is where it belongs: on a slope that is not
over the middle of its feet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Mapping, Sequence, Tuple

from nao_sim_bridge.base.config import check_keys, config_file, read_json, vector
from nao_sim_bridge.base.rotations import Vector3
from nao_sim_bridge.control.balance.capture_point import BodyMotion
from nao_sim_bridge.control.balance.stance import StanceReader
from nao_sim_bridge.model.robot_model import RobotModel

FILE = "balance.json"
PITCH, ROLL = 0, 1
NO_CORRECTION: Mapping[int, float] = {}
# The body may rest this far from where it would on a level floor, m; while it does not rest, the place is
# learned with this time constant, s.
FURTHEST_REST, LEARNING_TIME = 0.03, 1.0
# A correction that has shrunk to this, rad, is over: the gears have more play.
NEGLIGIBLE = 1e-4


@dataclass(frozen=True)
class Gain:
    """How one kind of joint answers; the joints of both legs do the same.

    Attributes:
        indices: Of the joints.
        plane: `PITCH` for swings ahead and back, `ROLL` for those sideways.
        place: rad for each m that the centre of mass is away from where it belongs.
        speed: rad for each m of its velocity over the frequency of the pendulum.
    """

    indices: Tuple[int, int]
    plane: int
    place: float
    speed: float


@dataclass(frozen=True)
class BalanceSettings:
    """All of `balance.json`, see its notes.

    Attributes:
        velocity_smoothing: Share of the old velocity in the new one at each tick.
        quiet_turn: A body that turns slower than this, rad/s, ...
        quiet_lean: ... and leans less than this, rad, away from how it settled ...
        quiet_time: ... for so long, s, stands quietly.
        loaded_share: Share of the weight from which a foot counts as standing.
        deadband: Swings up to here, m, get no answer.
        limit: Largest correction, rad.
        growing: Share of the old correction in the new one at each tick while it grows.
        shrinking: The same while it gets smaller.
        gains: One for each kind of joint.
    """

    velocity_smoothing: float
    quiet_turn: float
    quiet_lean: float
    quiet_time: float
    loaded_share: float
    deadband: float
    limit: float
    growing: float
    shrinking: float
    gains: Tuple[Gain, ...]


def load_balance(model: RobotModel) -> BalanceSettings:
    """The settings for a robot.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown, missing or of the wrong kind.
    """
    keys = ["velocity_smoothing", "quiet", "loaded_share", "deadband_m", "limit_rad", "smoothing", "pitch", "roll"]
    content = check_keys(read_json(config_file(FILE)), FILE, keys, ["_meta"])
    quiet = check_keys(content["quiet"], f"{FILE}: quiet", ["turn_rad_s", "lean_rad", "time_s"])
    smoothing = check_keys(content["smoothing"], f"{FILE}: smoothing", ["growing", "shrinking"])
    return BalanceSettings(
        velocity_smoothing=content["velocity_smoothing"],
        quiet_turn=quiet["turn_rad_s"],
        quiet_lean=quiet["lean_rad"],
        quiet_time=quiet["time_s"],
        loaded_share=content["loaded_share"],
        deadband=content["deadband_m"],
        limit=content["limit_rad"],
        growing=smoothing["growing"],
        shrinking=smoothing["shrinking"],
        gains=(*_gains(model, content, "pitch", PITCH), *_gains(model, content, "roll", ROLL)),
    )


def _gains(model: RobotModel, content: Mapping[str, Any], section: str, plane: int) -> list[Gain]:
    kinds = ("HipPitch", "KneePitch", "AnklePitch") if plane == PITCH else ("AnkleRoll",)
    entries = check_keys(content[section], f"{FILE}: {section}", kinds)
    gains = []
    for kind in kinds:
        place, speed = vector(entries[kind], f"{FILE}: {section}.{kind}", 2).tolist()
        gains.append(Gain((model.joint_index[f"L{kind}"], model.joint_index[f"R{kind}"]), plane, place, speed))
    return gains


class Balance:
    """Works out corrections from the body's motion.

    Attributes:
        enabled: False while somebody has switched push recovery off.
        acting: Whether there are corrections now.
    """

    def __init__(self, settings: BalanceSettings, reader: StanceReader) -> None:
        self.enabled = True
        self._settings = settings
        self._reader = reader
        self._values = [0.0] * len(settings.gains)
        self._commands: Sequence[float] = ()
        self._home: Vector3 = (0.0, 0.0, 0.0)
        self._rest = [0.0, 0.0]
        self._rested = True

    @property
    def acting(self) -> bool:
        return any(self._values)

    def release(self) -> None:
        """Drop the corrections: something else moves the legs."""
        if self.acting:
            self._values = [0.0] * len(self._values)

    def settle(self) -> None:
        """The body is at rest: where it is next, it belongs."""
        self._rested = True

    def corrections(self, motion: BodyMotion, commands: Sequence[float], dt: float) -> Mapping[int, float]:
        """What to add to commands (26, rad: where the body belongs) at a tick of `dt` s, by joint index in rad."""
        home = self._home_of(commands)
        place = motion.stance.com_from_feet
        away = [place[axis] - home[axis] for axis in (0, 1)]
        learned = 1.0 if self._rested else dt / LEARNING_TIME
        self._rested = False
        for axis in (0, 1):
            rest = self._rest[axis] + learned * (away[axis] - self._rest[axis])
            self._rest[axis] = min(max(rest, -FURTHEST_REST), FURTHEST_REST)
        swing = [(away[axis] - self._rest[axis], motion.velocity[axis] / motion.frequency) for axis in (0, 1)]
        shares = [self._share(*both) for both in swing]
        wanted = {}
        for number, gain in enumerate(self._settings.gains):
            away, speed = swing[gain.plane]
            value = self._smoothed(number, shares[gain.plane] * (gain.place * away + gain.speed * speed))
            if value != 0.0:
                wanted.update(dict.fromkeys(gain.indices, value))
        return wanted or NO_CORRECTION

    def _home_of(self, commands: Sequence[float]) -> Vector3:
        """Where the centre of mass belongs above the feet; commands are replaced as a whole and never changed."""
        if commands is not self._commands:
            self._commands = commands
            self._home = self._reader.read(commands, *self._reader.lean(commands)).com_from_feet
        return self._home

    def _share(self, away: float, speed: float) -> float:
        """How much of the full answer a swing gets: none in the dead band, nearly all far outside of it."""
        # Half the swing counts even when place and speed cancel: it is on its way through the middle then.
        size = max(abs(away + speed), 0.5 * math.hypot(away, speed))
        return max(0.0, 1.0 - self._settings.deadband / size) if size > 0.0 else 0.0

    def _smoothed(self, number: int, wanted: float) -> float:
        settings = self._settings
        wanted = min(max(wanted, -settings.limit), settings.limit)
        before = self._values[number]
        keep = settings.growing if abs(wanted) > abs(before) else settings.shrinking
        value = keep * before + (1.0 - keep) * wanted
        self._values[number] = value if abs(value) > NEGLIGIBLE else 0.0
        return self._values[number]

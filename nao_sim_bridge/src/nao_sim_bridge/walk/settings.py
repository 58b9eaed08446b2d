"""Settings of the walk engine, from `walk.json`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

from nao_sim_bridge.base.config import array, check_keys
from nao_sim_bridge.walk.gait import FILE, parameters, walk_file

# Entries of the section `engine`, and the fields of the settings that they are; then those of its groups.
PLAIN = {
    "com_height_m": "com_height",
    "lean_rad": "lean",
    "pressure_ahead_m": "pressure_ahead",
    "pressure_inward_m": "pressure_inward",
    "double_support_share": "double_support_share",
    "steps_ahead": "steps_ahead",
    "extra_lift_m": "extra_lift",
    "outer_turn_share": "outer_turn",
    "ankle_damping_s": "ankle_damping",
}
CHANGE = "change_per_step"
GROUPS = {
    "times": {name + "_s": name + "_time" for name in ("stance", "push", "shift", "settle", "stand")},
    CHANGE: dict.fromkeys(("x_m", "y_m", "yaw_rad"), "change"),  # all in one field
    "observer": {"place": "observer_place", "speed": "observer_speed"},
    "com_shift": {"gain": "shift_gain", "smoothing": "shift_smoothing", "limit_m": "shift_limit"},
    "landing": {"loaded_n": "loaded", "latest_s": "latest", "sink_m": "sink"},
    "habit": {"time_s": "habit_time", "within_m": "habit_within", "limit_m": "habit_limit"},
    "calm": {"from_m": "calm_from", "range_m": "calm_range"},
    "hold": {
        "turn": "turn_hold",
        "turn_limit_rad": "turn_hold_limit",
        "aside": "aside_hold",
        "aside_limit_m": "aside_hold_limit",
    },
    "arms": {"swing_rad": "arm_swing", "ease_s": "arm_ease"},
}


@dataclass(frozen=True)
class WalkSettings:
    """All of the section `engine`.

    Attributes:
        com_height: Of the centre of mass over the ground, m.
        lean: Pitch of the torso, rad.
        pressure_ahead: Where the planned pressure is in the sole of the foot that carries, ahead of the ankle, m.
        pressure_inward: The same towards the other foot, m.
        double_support_share: Share of a step in which both feet carry.
        steps_ahead: How many steps the plan goes beyond the one that is made.
        extra_lift: A foot is told to go higher than the gait says by this, m: legs lag.
        stance_time: To take the walk's stance, s.
        push_time: At the start, before the weight goes to the first foot that carries, s.
        shift_time: In which the weight goes there, s.
        settle_time: In which the weight comes to the middle at the end, s.
        stand_time: After that until the walk is over, s.
        change: By how much a step may differ from the one before: m, m, rad.
        outer_turn: Share of a turn that the foot on its inner side takes, the rest is the other one's; 0.5..1.
        observer_place: Share of the measured place of the centre of mass that is taken over at a tick.
        observer_speed: The same of the speed.
        shift_gain: m of shift of the centre of mass for each m that its divergent component is off.
        shift_smoothing: Share of the new shift at each tick.
        shift_limit: Largest shift, m.
        ankle_damping: rad of ankle for each rad/s that the body turns.
        loaded: A foot that carries this has landed, N.
        latest: A foot that has not landed is waited for so long, s.
        sink: It goes down by this meanwhile, m.
        habit_time: An error that is always there, from a slope for example, is learned with this time constant, s ...
        habit_within: ... as long as it differs by less than this from what is known of it, m ...
        habit_limit: ... up to this, m.
        calm_from: A body whose divergent component is off by more, m, walks slower ...
        calm_range: ... and on the spot when it is off by so much more, m.
        turn_hold: Share of the error of heading that one step makes up for.
        turn_hold_limit: And at most this, rad.
        aside_hold: The same for the error to the side.
        aside_hold_limit: m.
        arm_swing: rad of shoulder pitch for a step as long as the longest by default.
        arm_ease: Time in which arms join the swing or leave it, s.
    """

    com_height: float
    lean: float
    pressure_ahead: float
    pressure_inward: float
    double_support_share: float
    steps_ahead: int
    extra_lift: float
    stance_time: float
    push_time: float
    shift_time: float
    settle_time: float
    stand_time: float
    change: Tuple[float, float, float]
    outer_turn: float
    observer_place: float
    observer_speed: float
    shift_gain: float
    shift_smoothing: float
    shift_limit: float
    ankle_damping: float
    loaded: float
    latest: float
    sink: float
    habit_time: float
    habit_within: float
    habit_limit: float
    calm_from: float
    calm_range: float
    turn_hold: float
    turn_hold_limit: float
    aside_hold: float
    aside_hold_limit: float
    arm_swing: float
    arm_ease: float

    @property
    def foot_separation(self) -> float:
        """Between the ankles when the robot walks straight, m."""
        return parameters()["FootSeparation"].default

    @property
    def min_foot_separation(self) -> float:
        """Least between the ankles, m."""
        return parameters()["MinFootSeparation"].default

    @property
    def lead(self) -> float:
        """From the begin of a walk to that of its first step, s."""
        return self.stance_time + self.push_time + self.shift_time


@lru_cache(maxsize=1)
def load_walk_settings() -> WalkSettings:
    """The settings.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown, missing or of the wrong kind.
    """
    where = f"{FILE}: engine"
    content = check_keys(walk_file()["engine"], where, [*PLAIN, *GROUPS])
    values = {field: content[key] for key, field in PLAIN.items()}
    for group, fields in GROUPS.items():
        entry = check_keys(content[group], f"{where}.{group}", fields)
        numbers = array([entry[key] for key in fields], f"{where}.{group}", (len(fields),)).tolist()
        values.update({"change": tuple(numbers)} if group == CHANGE else zip(fields.values(), numbers))
    return WalkSettings(**values)

"""Settings of the walk engine, from `walk.json`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Tuple

from nao_sim_bridge.base.config import array, check_keys
from nao_sim_bridge.walk.gait import FILE, parameters, walk_file


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


@lru_cache(maxsize=1)
def load_walk_settings() -> WalkSettings:
    """The settings.

    Raises:
        ConfigError: The file cannot be read, or a key is unknown, missing or of the wrong kind.
    """
    where = f"{FILE}: engine"
    plain = ["com_height_m", "lean_rad", "pressure_ahead_m", "pressure_inward_m", "double_support_share"]
    plain += ["steps_ahead", "extra_lift_m", "outer_turn_share", "ankle_damping_s"]
    groups = {
        "times": ["stance_s", "push_s", "shift_s", "settle_s", "stand_s"],
        "change_per_step": ["x_m", "y_m", "yaw_rad"],
        "observer": ["place", "speed"],
        "com_shift": ["gain", "smoothing", "limit_m"],
        "landing": ["loaded_n", "latest_s", "sink_m"],
        "habit": ["time_s", "within_m", "limit_m"],
        "calm": ["from_m", "range_m"],
        "hold": ["turn", "turn_limit_rad", "aside", "aside_limit_m"],
        "arms": ["swing_rad", "ease_s"],
    }
    content = check_keys(walk_file()["engine"], where, [*plain, *groups])
    values = {}
    for group, keys in groups.items():
        entry = check_keys(content[group], f"{where}.{group}", keys)
        values[group] = array([entry[key] for key in keys], f"{where}.{group}", (len(keys),)).tolist()
    stance, push, shift, settle, stand = values["times"]
    return WalkSettings(
        com_height=content["com_height_m"],
        lean=content["lean_rad"],
        pressure_ahead=content["pressure_ahead_m"],
        pressure_inward=content["pressure_inward_m"],
        double_support_share=content["double_support_share"],
        steps_ahead=content["steps_ahead"],
        extra_lift=content["extra_lift_m"],
        stance_time=stance,
        push_time=push,
        shift_time=shift,
        settle_time=settle,
        stand_time=stand,
        change=tuple(values["change_per_step"]),
        outer_turn=content["outer_turn_share"],
        observer_place=values["observer"][0],
        observer_speed=values["observer"][1],
        shift_gain=values["com_shift"][0],
        shift_smoothing=values["com_shift"][1],
        shift_limit=values["com_shift"][2],
        ankle_damping=content["ankle_damping_s"],
        loaded=values["landing"][0],
        latest=values["landing"][1],
        sink=values["landing"][2],
        habit_time=values["habit"][0],
        habit_within=values["habit"][1],
        habit_limit=values["habit"][2],
        calm_from=values["calm"][0],
        calm_range=values["calm"][1],
        turn_hold=values["hold"][0],
        turn_hold_limit=values["hold"][1],
        aside_hold=values["hold"][2],
        aside_hold_limit=values["hold"][3],
        arm_swing=values["arms"][0],
        arm_ease=values["arms"][1],
    )

"""Single runs of walking robots, each in a world of its own, from a few numbers to a few numbers; for `check_walk.py`.

All of them are functions from plain values to named numbers, truth values and texts, as `sweep` takes them.
"""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any, Dict, Mapping, Union

from walk_trial import REAL, Trial

from nao_sim_bridge.walk.footsteps import FootPose

Result = Dict[str, Union[bool, float, str]]
# Until a walk has its speed, s.
RAMP = 4.0
# How often orders change and pushes come, s.
EVERY = 2.0
GOAL = (1.0, 0.3, 0.8)
POSTURES = ("Stand", "StandInit", "StandZero", "Crouch")
# Everything that a floor needs besides what a run is about.
FLOOR = "friction: 1.0, color: [1, 1, 1], tile_color: [1, 1, 1], tile_size: 1.0"


def straight(velocity: tuple[float, float, float], gait: Mapping[str, float], seconds: float, seed: int = 0) -> Result:
    """Walk at a velocity for so long, with ideal sensors; s.

    Returns:
        up: Whether it did not fall.
        x, y, theta: True velocity in its own frame, m/s, m/s, rad/s.
        aside, turn: Deviation to the side, m for each m of way, and of the heading, rad for each m of way.
        odometry: Error of the place that it thinks it is at, by the way.
        fastest, joint: Largest share of a joint's top speed, and which joint had it.
        above, longest: Longest time that a joint was over its top speed, s, and which one.
    """
    with Trial(seed) as trial:
        start, believed = trial.place, trial.believed
        trial.go(*velocity, gait=dict(gait))
        trial.run(RAMP)
        before, turned, way, yaw = trial.place, 0.0, 0.0, trial.place.yaw
        steps = round(seconds / 0.42)
        for _ in range(steps):
            # As long as a step: the sway of the body comes out nearly the same each time.
            last = trial.place
            if not trial.run(seconds / steps):
                break
            now = trial.place.seen_from(last)
            turned += now.yaw
            way += math.hypot(now.x, now.y)
        after = trial.place
        up = trial.stop()
        end = trial.place.seen_from(start)
        error = _apart(end, trial.believed.seen_from(believed))
        moved = after.seen_from(FootPose(before.x, before.y, yaw))
        length = math.hypot(end.x, end.y)
        sideways = end.x if abs(velocity[1]) > abs(velocity[0]) else end.y
        straight_on = velocity[2] == 0.0 and length > 0.0
        fastest, joint = max((share, name) for name, share in trial.fastest.items())
        above, longest = max((time, name) for name, time in trial.longest_above.items())
        return {
            "up": up,
            "x": moved.x / seconds,
            "y": moved.y / seconds,
            "theta": turned / seconds,
            "aside": abs(sideways) / length if straight_on else 0.0,
            "turn": abs(end.yaw) / length if straight_on else 0.0,
            "odometry": error / max(length, way, 1e-9),
            "fastest": fastest,
            "joint": joint,
            "above": above,
            "longest": longest,
        }


def wander(seed: int, seconds: float, impulse: float) -> Result:
    """Obey random orders, maybe pushed at random; whether it is still `up`, what `time` it was, s, and `why` not."""
    with Trial(seed, **REAL) as trial:
        begun = trial.time
        while trial.up and trial.time < begun + seconds:
            trial.wander()
            if not impulse:
                trial.run(EVERY)
                continue
            moment = trial.chance.uniform(0.0, EVERY)
            trial.run(moment)
            trial.push(impulse, trial.chance.uniform(-math.pi, math.pi))
            trial.run(EVERY - moment)
        fell = "fell" if trial.noticed is not None or trial.impact is not None else ""
        return {"up": trial.up, "time": trial.time - begun, "why": fell or trial.ended}


def push(seed: int, side: int, impulse: float, get_up: bool) -> Result:
    """Push a walking robot once, from the front, left, back or right (0..3), at any phase of its steps.

    Returns:
        fell: Whether the robot fell.
        impact: Whether torso, head or an upper arm hit the floor.
        early: How long before the impact the fall was noticed, s; not there when it was not, or nothing hit.
        stood_up: Whether the robot stands in the end.
    """
    with Trial(seed, **REAL) as trial:
        trial.go(0.07, 0.0, 0.0)
        trial.run(trial.chance.uniform(3.0, 3.84))
        trial.push(impulse, side * math.pi / 2.0 + trial.chance.uniform(-0.3, 0.3))
        if trial.run(4.0):
            return {"fell": False, "impact": False, "stood_up": True}
        trial.fall()
        noticed = trial.impact is not None and trial.noticed is not None
        early = {"early": trial.impact - trial.noticed} if noticed else {}
        return {"fell": True, "impact": trial.impact is not None, "stood_up": get_up and trial.get_up(), **early}


def arrive(seed: int) -> Result:
    """Walk to a place from a random posture, with a real robot's sensors.

    Returns:
        reached: Whether the walk says that it is there.
        distance, turn: True, from the place where it should be, m, and of the heading, rad.
        odometry: Error of the place that it thinks it is at, by the way.
    """
    with Trial(seed, POSTURES[seed % len(POSTURES)], **REAL) as trial:
        trial.run(trial.chance.uniform(0.0, 1.0))
        start, believed = trial.place, trial.believed
        task = trial.walk_to(*GOAL)
        trial.until(lambda: task.finished, 60.0)
        trial.run(0.5)
        there = trial.place.seen_from(start)
        off = FootPose(*GOAL).seen_from(there)
        error = _apart(there, trial.believed.seen_from(believed))
        reached = task.finished and task.value is True and trial.up
        distance, odometry = math.hypot(off.x, off.y), error / math.hypot(*GOAL[:2])
        return {"reached": reached, "distance": distance, "turn": abs(off.yaw), "odometry": odometry}


def on_ground(scene: Mapping[str, Any], seed: int, seconds: float) -> Result:
    """Walk a bow on another ground or with a load; whether it is `up` to the end, and its `way`, m."""
    with Trial(seed, **{**REAL, **scene}) as trial:
        start = trial.place
        trial.go(0.08, 0.0, 0.05)
        trial.run(seconds)
        end = trial.place.seen_from(start)
        return {"up": trial.stop(), "way": math.hypot(end.x, end.y)}


def on_slope(heading: float, degrees: float, seed: int, seconds: float) -> Result:
    """The same on a floor that rises in a direction, rad."""
    along, aside = (degrees * part for part in (math.cos(heading), math.sin(heading)))
    with tempfile.TemporaryDirectory() as folder:
        world = Path(folder) / "slope.yaml"
        world.write_text(f"floor: {{{FLOOR}, slope_deg: [{along:.3f}, {aside:.3f}]}}\n", encoding="utf-8")
        return on_ground({"world": str(world)}, seed, seconds)


def stop_somewhere(seed: int) -> bool:
    """Stop a walk, or cancel one to a place, at a random moment; whether the robot stands 2 s later."""
    with Trial(seed, **REAL) as trial:
        if seed % 2:
            task = trial.walk_to(*(trial.chance.uniform(-1.0, 1.0) for _ in range(3)))
            trial.run(trial.chance.uniform(0.0, 6.0))
            task.kill()
            return trial.stop()
        trial.wander()
        trial.run(trial.chance.uniform(0.0, 3.0))
        trial.wander()
        trial.run(trial.chance.uniform(0.0, 3.0))
        return trial.stop()


def total_mass() -> float:
    """Of the robot, kg."""
    with Trial(0) as trial:
        return trial.simulation.model.total_mass


def _apart(one: FootPose, other: FootPose) -> float:
    return math.hypot(one.x - other.x, one.y - other.y)

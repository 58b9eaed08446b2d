"""What the process modules of a NAO can achieve, as goals, and the functions of `low_level` that mean them. In ROS.

These are the same:

    achieve(opened_gripper("left"))
    achieve(open_gripper, "left")
    achieve(openGripper, "left")

The process modules have to run: `run_and_tell` and `start_process_modules` run them. `openGripper("left")` alone opens
the hand without them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from ..base.places import ODOM, wrapped
from .action_rules.values import a_place
from .core.registry import perform
from .designators.designator import action, an
from .designators.patterns import Mismatch
from .language.goals import Goal, achieved_by, declare_goal, def_goal
from .low_level import (  # noqa: F401  with the names of the thesis
    close_gripper,
    closeGripper,
    go_stable,
    goStable,
    move_arm,
    move_head,
    moveArm,
    moveHead,
    open_gripper,
    openGripper,
    text_to_speech,
    textToSpeech,
    this_robot,
    walk_to,
    walkTo,
)


def _there(reached: bool) -> bool | None:
    """True where nothing is to be done; otherwise None, unknown: what achieves the goal fails by itself."""
    return True if reached else None


def _hand_is(word: str, side: str) -> bool | None:
    robot = this_robot()
    opening = robot.angles().get(f"{str(side)[:1].upper()}Hand", math.inf)
    return _there(abs(opening - robot.settings.gripper[word]) < robot.settings.gripper_tolerance)


@declare_goal
def opened_gripper(side: str) -> bool | None:
    """A hand, left or right, is open."""
    return _hand_is("open", side)


@declare_goal
def closed_gripper(side: str) -> bool | None:
    """A hand is closed, around something or not."""
    return _hand_is("closed", side)


@declare_goal
def gripped(side: str) -> None:
    """There is something in a closed hand."""


@declare_goal
def moved_arm(target: Any, side: str) -> None:
    """A hand is at a point."""


@declare_goal
def looking_at(target: Any, y: float | None = None, z: float | None = None) -> None:
    """The head looks at a position, a thing, or in a direction by its word; or at x, y and z."""


@declare_goal
def stable() -> bool | None:
    """The robot is in the pose from which everything else can begin."""
    robot = this_robot()
    now, tolerance = robot.angles(), robot.settings.head_tolerance
    return _there(
        all(abs(now.get(name, math.inf) - angle) < tolerance for name, angle in robot.settings.stable.items())
    )


@declare_goal
def at_place(target: Any) -> bool | None:
    """The robot is at a place."""
    try:
        place, frame = a_place().take(target)
    except Mismatch:
        return None  # a designator
    robot = this_robot()
    here, (near, turn) = robot.place(frame or ODOM), robot.settings.walk_tolerance
    turned_well = math.isnan(place.yaw) or abs(wrapped(here.yaw - place.yaw)) < turn
    return _there(here.distance_to(place) < near and turned_well)


@declare_goal
def said(sentence: str) -> None:
    """A sentence has been said."""


def _by_action(goal: Goal, kind: str, values: Mapping[str, str]) -> Callable[..., Any]:
    """A plan that performs an action; `values` maps its keys to names of the goal's arguments."""

    def plan(*arguments: Any) -> Any:
        given = dict(zip(goal.parameters, arguments))
        return perform(an(action, type=kind, **{key: given[name] for key, name in values.items()}))

    return plan


for _goal, _kind, _values in (
    (opened_gripper, "opening", {"gripper": "side"}),
    (closed_gripper, "closing", {"gripper": "side"}),
    (gripped, "gripping", {"gripper": "side"}),
    (moved_arm, "reaching", {"side": "side", "target": "target"}),
    (stable, "standing", {}),
    (at_place, "going", {"target": "target"}),
):
    def_goal(_goal)(_by_action(_goal, _kind, _values))


@def_goal(said)
def _say(sentence: str) -> Any:
    return perform(an(action, type="saying", text=sentence, wait=True))


@def_goal(looking_at)
def _look(target: Any, y: float | None, z: float | None) -> Any:
    if y is not None:
        target = [target, y] if z is None else [target, y, z]
    return perform(an(action, type="looking", target=target))


turn_head = turnHead = move_head  # noqa: N816

for _function, _goal in (
    (open_gripper, opened_gripper),
    (close_gripper, closed_gripper),
    (move_arm, moved_arm),
    (move_head, looking_at),
    (go_stable, stable),
    (walk_to, at_place),
    (text_to_speech, said),
):
    achieved_by(_function, _goal)

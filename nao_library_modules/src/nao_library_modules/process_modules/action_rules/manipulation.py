"""Rules for manipulation: arms and the whole body, hands, the head."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import Mismatch, anything, number, one_of, text
from ..designators.rules import Command, command, rule
from ..language.failures import DesignatorError
from ..language.settings import numbers_of_nao
from ..language.space import Point3
from .values import BOTH, SIDE, a_point, a_position, points_of, rule_about

MANIPULATION = "manipulation"
HOW = one_of("open", "close", "grasp")
TO_LOOK = one_of("to look", "to move head", "move head", "to turn head", "turn head")


# --- arms and the whole body ------------------------------------------------------------------------------------------


def _arm_target(desig: Designator, side: str, target: Any) -> Point3:
    words = numbers_of_nao().arm_targets
    if isinstance(target, str) and target in words:
        x, y, z = words[target]
        return Point3(x, y if side == "left" else -y, z)
    if isinstance(target, Designator):
        return next(points_of(target))
    try:
        return a_point().take(target)
    except Mismatch:
        allowed = f"one of {', '.join(words)}, {a_point().wanted}, or a designator"
        raise DesignatorError(desig, f"the {side} hand is to get to {target!r}: not {allowed}") from None


def _reaching(side: str, desig: Designator, target: Any) -> Command:
    return command(MANIPULATION, "move_arm", side=side, target=_arm_target(desig, side, target))


for _side in ("left", "right"):
    rule_about(f"{_side}_target", partial(_reaching, _side), called=f"moving {_side} tcp", type="moving tcp")


@rule(action, name=one_of("to move arm", "to reach", "move arm"), side=SIDE, target=anything(), called="to reach")
@rule(BOTH, type=one_of("moving arm", "reaching"), side=SIDE, target=anything())
def moving_arm(side: str, target: Any, desig: Designator) -> Command:
    return _reaching(side, desig, target)


@rule(BOTH, type=one_of("moving joints", "moving arm joints"), angles=anything())
def moving_joints(angles: Any, desig: Designator) -> Command:
    if not isinstance(angles, Mapping) or not angles:
        raise DesignatorError(desig, f"its angles are {angles!r}, not angles in rad by the names of joints")
    return command(MANIPULATION, "move_joints", angles=dict(angles))


@rule(action, name=one_of("to stand", "go stable", "to go stable"), called="to stand")
@rule(BOTH, type=one_of("parking arms", "going stable", "standing"))
def going_stable() -> Command:
    return command(MANIPULATION, "go_stable")


@rule(BOTH, type=one_of("pointing"), at=anything(), side=one_of("left", "right", "").or_else(""))
def pointing(at: Any, side: str, desig: Designator) -> Iterator[Command]:
    """With the nearer arm, or that of a side."""
    targets = points_of(at) if isinstance(at, Designator) else [_arm_target(desig, side or "left", at)]
    for target in targets:
        yield command(MANIPULATION, "point_at", target=target, side=side)


# --- hands ------------------------------------------------------------------------------------------------------------


@rule(BOTH, type="opening", gripper=SIDE)
def opening(gripper: str) -> Command:
    return command(MANIPULATION, "open_gripper", side=gripper)


@rule(BOTH, type="closing", gripper=SIDE)
def closing(gripper: str) -> Command:
    return command(MANIPULATION, "close_gripper", side=gripper)


@rule(BOTH, type="gripping", gripper=SIDE)
def gripping(gripper: str) -> Command:
    """There is to be something in the hand."""
    return command(MANIPULATION, "close_gripper", side=gripper, grasp=True)


@rule(BOTH, type=one_of("moving gripper joint"), gripper=SIDE, joint_angle=number(0.0, 1.0))
def moving_gripper_joint(gripper: str, joint_angle: float) -> Command:
    return command(MANIPULATION, "move_gripper", side=gripper, opening=joint_angle)


@rule(action, type="trajectory", to="open", side=SIDE, called="trajectory to open")
@rule(action, name=one_of("open", "to open", "opening"), side=SIDE)
def to_open(side: str) -> Command:
    return command(MANIPULATION, "open_gripper", side=side)


@rule(action, type="trajectory", to="close", side=SIDE, called="trajectory to close")
@rule(action, name=one_of("close", "to close", "closing"), side=SIDE)
def to_close(side: str) -> Command:
    return command(MANIPULATION, "close_gripper", side=side)


@rule(BOTH, left=HOW)
def left_hand(left: str) -> Command:
    return _by_word("left", left)


@rule(BOTH, right=HOW)
def right_hand(right: str) -> Command:
    return _by_word("right", right)


def _by_word(side: str, word: str) -> Command:
    if word == "open":
        return command(MANIPULATION, "open_gripper", side=side)
    return command(MANIPULATION, "close_gripper", side=side, grasp=word == "grasp")


# --- head -------------------------------------------------------------------------------------------------------------


def _looking(desig: Designator, at: Any) -> Iterator[Command]:
    """Where to look: a word, a point, or a thing that has a place."""
    words = numbers_of_nao().head
    if isinstance(at, str) and at in words:
        yaw, pitch = words[at]
        yield command(MANIPULATION, "turn_head", yaw=yaw, pitch=pitch)
        return
    if isinstance(at, Designator):
        yield from (command(MANIPULATION, "move_head", target=point) for point in points_of(at))
        return
    try:
        yield command(MANIPULATION, "move_head", target=a_position().take(at))
    except Mismatch:
        allowed = f"one of {', '.join(words)}, {a_position().wanted}, or a designator"
        raise DesignatorError(desig, f"it looks at {at!r}: not {allowed}") from None


rule_about("target", _looking, called="looking at target", type="looking")
rule_about("direction", _looking, called="looking in direction", type="looking")


@rule(BOTH, type="looking", frame=text())
def looking_at_frame(frame: str) -> Command:
    return command(MANIPULATION, "move_head", target=Point3(0.0, 0.0, 0.0, frame))


rule_about("at", _looking, action, called="trajectory to see", type="trajectory", to=one_of("see", "look"))
rule_about("position", _looking, action, called="to look", name=TO_LOOK)

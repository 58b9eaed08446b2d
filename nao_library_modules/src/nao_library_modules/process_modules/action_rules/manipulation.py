"""Rules for manipulation: arms and the whole body, hands, the head."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..designators.designator import Designator, action
from ..designators.patterns import Mismatch, anything, number, one_of, text
from ..designators.rules import Command, command, rule
from ..language.failures import DesignatorError
from ..language.settings import numbers_of_nao
from ..language.space import Point3
from .values import BOTH, SIDE, a_point, a_position, points_of

MANIPULATION = "manipulation"
OPENING = ("open", "to open", "opening")
CLOSING = ("close", "to close", "closing")
HOW = one_of("open", "close", "grasp")


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


@rule(BOTH, type=one_of("moving tcp"), left_target=anything())
def moving_left_tcp(left_target: Any, desig: Designator) -> Command:
    """Resolve {type: moving-tcp, left-target: ...}."""
    return command(MANIPULATION, "move_arm", side="left", target=_arm_target(desig, "left", left_target))


@rule(BOTH, type=one_of("moving tcp"), right_target=anything())
def moving_right_tcp(right_target: Any, desig: Designator) -> Command:
    """Resolve {type: moving-tcp, right-target: ...}."""
    return command(MANIPULATION, "move_arm", side="right", target=_arm_target(desig, "right", right_target))


@rule(BOTH, type=one_of("moving arm", "reaching"), side=SIDE, target=anything())
def moving_arm(side: str, target: Any, desig: Designator) -> Command:
    """Resolve {type: reaching, side: left, target: ...}."""
    return command(MANIPULATION, "move_arm", side=side, target=_arm_target(desig, side, target))


@rule(BOTH, type=one_of("moving joints", "moving arm joints"), angles=anything())
def moving_joints(angles: Any, desig: Designator) -> Command:
    """Resolve {type: moving-joints, angles: {HeadYaw: 0.5}}."""
    if not isinstance(angles, Mapping) or not angles:
        raise DesignatorError(desig, f"its angles are {angles!r}, not angles in rad by the names of joints")
    return command(MANIPULATION, "move_joints", angles=dict(angles))


@rule(BOTH, type=one_of("parking arms", "going stable", "standing"))
def going_stable() -> Command:
    """Resolve {type: standing}."""
    return command(MANIPULATION, "go_stable")


@rule(action, name=one_of("to move arm", "to reach", "move arm"), side=SIDE, target=anything())
def to_reach(side: str, target: Any, desig: Designator) -> Command:
    """Resolve {name: to reach, side: left, target: [0.2, 0.1, 0.1]}."""
    return command(MANIPULATION, "move_arm", side=side, target=_arm_target(desig, side, target))


@rule(action, name=one_of("to stand", "go stable", "to go stable"))
def to_stand() -> Command:
    """Resolve {name: go stable}."""
    return command(MANIPULATION, "go_stable")


@rule(BOTH, type=one_of("pointing"), at=anything(), side=one_of("left", "right", "").or_else(""))
def pointing(at: Any, side: str, desig: Designator) -> Iterator[Command]:
    """Resolve {type: pointing, at: ...}: with the nearer arm, or that of a side."""
    targets = points_of(at) if isinstance(at, Designator) else [_arm_target(desig, side or "left", at)]
    for target in targets:
        yield command(MANIPULATION, "point_at", target=target, side=side)


# --- hands ------------------------------------------------------------------------------------------------------------


@rule(BOTH, type="opening", gripper=SIDE)
def opening(gripper: str) -> Command:
    """Resolve {type: opening, gripper: left}."""
    return command(MANIPULATION, "open_gripper", side=gripper)


@rule(BOTH, type="closing", gripper=SIDE)
def closing(gripper: str) -> Command:
    """Resolve {type: closing, gripper: left}."""
    return command(MANIPULATION, "close_gripper", side=gripper)


@rule(BOTH, type="gripping", gripper=SIDE)
def gripping(gripper: str) -> Command:
    """Resolve {type: gripping, gripper: left}: there is to be something in the hand."""
    return command(MANIPULATION, "close_gripper", side=gripper, grasp=True)


@rule(BOTH, type=one_of("moving gripper joint"), gripper=SIDE, joint_angle=number(0.0, 1.0))
def moving_gripper_joint(gripper: str, joint_angle: float) -> Command:
    """Resolve {type: moving-gripper-joint, gripper: left, joint-angle: 0.5}."""
    return command(MANIPULATION, "move_gripper", side=gripper, opening=joint_angle)


@rule(action, name=one_of(*OPENING), side=SIDE)
def to_open(side: str) -> Command:
    """Resolve {name: to open, side: left}."""
    return command(MANIPULATION, "open_gripper", side=side)


@rule(action, name=one_of(*CLOSING), side=SIDE)
def to_close(side: str) -> Command:
    """Resolve {name: to close, side: left}."""
    return command(MANIPULATION, "close_gripper", side=side)


@rule(BOTH, left=HOW)
def left_hand(left: str) -> Command:
    """Resolve the pair (left, open), or close, or grasp."""
    return _by_word("left", left)


@rule(BOTH, right=HOW)
def right_hand(right: str) -> Command:
    """Resolve the pair (right, open), or close, or grasp."""
    return _by_word("right", right)


def _by_word(side: str, word: str) -> Command:
    if word == "open":
        return command(MANIPULATION, "open_gripper", side=side)
    return command(MANIPULATION, "close_gripper", side=side, grasp=word == "grasp")


@rule(action, type="trajectory", to=one_of("open"), side=SIDE)
def trajectory_to_open(side: str) -> Command:
    """Resolve {type: trajectory, to: open, side: left}."""
    return command(MANIPULATION, "open_gripper", side=side)


@rule(action, type="trajectory", to=one_of("close"), side=SIDE)
def trajectory_to_close(side: str) -> Command:
    """Resolve {type: trajectory, to: close, side: left}."""
    return command(MANIPULATION, "close_gripper", side=side)


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


@rule(BOTH, type="looking", target=anything())
def looking_at_target(target: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: looking, target: ...}."""
    return _looking(desig, target)


@rule(BOTH, type="looking", direction=anything())
def looking_in_direction(direction: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: looking, direction: left}."""
    return _looking(desig, direction)


@rule(BOTH, type="looking", frame=text())
def looking_at_frame(frame: str) -> Command:
    """Resolve {type: looking, frame: l_gripper}."""
    return command(MANIPULATION, "move_head", target=Point3(0.0, 0.0, 0.0, frame))


@rule(action, type="trajectory", to=one_of("see", "look"), at=anything())
def trajectory_to_see(at: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {type: trajectory, to: see, at: ...}."""
    return _looking(desig, at)


@rule(action, name=one_of("to look", "to move head", "move head", "to turn head", "turn head"), position=anything())
def to_look(position: Any, desig: Designator) -> Iterator[Command]:
    """Resolve {name: to look, position: [2, 3]}."""
    return _looking(desig, position)

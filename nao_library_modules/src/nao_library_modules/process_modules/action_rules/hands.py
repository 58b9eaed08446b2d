"""Rules about hands: opening, closing, gripping."""

from __future__ import annotations

from ..designators.designator import action
from ..designators.patterns import number, one_of
from ..designators.rules import Command, command, rule
from .values import BOTH, SIDE

MANIPULATION = "manipulation"
OPENING = ("open", "to open", "opening")
CLOSING = ("close", "to close", "closing")
HOW = one_of("open", "close", "grasp")


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

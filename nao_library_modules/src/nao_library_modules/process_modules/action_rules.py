"""Rules for a NAO: what actions and motions are in numbers. Users add their own with `rule`.

Three ways of describing the same are understood: CRAM's motions, `{type: opening, gripper: left}`; the actions of older
plans, `{type: trajectory, to: open, side: left}`; and a name, `{name: to open, side: left}`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from numbers import Real
from typing import Any

from ..core.fields import limit
from ..core.geometry import ODOM, Place
from .designators.designator import Designator, action, motion
from .designators.objects_and_locations import TORSO, Point3, Position
from .designators.rules import (
    Command,
    Mismatch,
    Pattern,
    anything,
    command,
    described,
    number,
    numbers_of_nao,
    one_of,
    rule,
    text,
)
from .failures import DesignatorError

SIDE = one_of("left", "right")
BOTH = (action, motion)


def rule_about(
    key: str,
    solve: Callable[[Designator, Any], Any],
    kind: str | tuple[str, ...] = BOTH,
    *,
    called: str,
    **patterns: Any,
) -> None:
    """Register a rule by a function of the designator and of the value of one key, whatever that is; see `rule`."""
    rule(kind, called=called, **patterns, **{key: anything()})(lambda desig: solve(desig, desig[key]))


def a_point() -> Pattern:
    """A point: three numbers in m in the torso frame, with a frame behind them, or a `Point3`."""

    def take(value: Any) -> Point3:
        if isinstance(value, Point3):
            return value
        if isinstance(value, Position):
            if value.z is None:
                raise Mismatch
            return Point3(*_finite(value[:3]), value.frame or TORSO)
        if isinstance(value, Mapping) and set(value) <= {"x", "y", "z", "frame"}:
            value = [*(value.get(axis, 0.0) for axis in "xyz"), *([value["frame"]] if "frame" in value else [])]
        if isinstance(value, str) or not isinstance(value, Sequence) or not 3 <= len(value) <= 4:
            raise Mismatch
        return Point3(*_finite(value[:3]), *map(str, value[3:]))

    return Pattern("a point [x, y, z] in m, in the torso frame or with the name of a frame behind it", take)


def a_position() -> Pattern:
    """Two numbers, a point at the height of the eyes (as the head's target in older plans); or a point."""
    point = a_point()

    def take(value: Any) -> Point3:
        if isinstance(value, Position) and value.z is None:
            return Point3(*_finite(value[:2]), numbers_of_nao().eyes, value.frame or TORSO)
        if not isinstance(value, (str, Mapping)) and isinstance(value, Sequence) and len(value) == 2:
            return Point3(*_finite(value), numbers_of_nao().eyes)
        return point.take(value)

    return Pattern(f"two numbers [x, y] in m, at the height of the eyes, or {point.wanted}", take)


def a_place() -> Pattern:
    """A place: x, y in m and a heading in rad in odom, or in a frame that follows; a `Place`, or one with its frame.

    A `Position` or `Point3` is a point: the robot arrives with the heading of its way, which nan stands for.
    """

    def take(value: Any) -> tuple[Place, str]:
        if isinstance(value, Place):
            return value, ODOM
        if isinstance(value, (Position, Point3)):
            return Place(*_finite(value[:2]), math.nan), value.frame or ODOM
        if isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], Place):
            return value[0], str(value[1])
        if isinstance(value, Mapping) and {"x", "y"} <= set(value) <= {"x", "y", "yaw", "frame"}:
            listed = [value["x"], value["y"], value.get("yaw", 0.0)]
            return Place(*_finite(listed)), str(value.get("frame", ODOM))
        if isinstance(value, str) or not isinstance(value, Sequence) or not 2 <= len(value) <= 4:
            raise Mismatch
        *listed, frame = value if isinstance(value[-1], str) else (*value, ODOM)
        if not 2 <= len(listed) <= 3:
            raise Mismatch
        return Place(*_finite([*listed, 0.0][:3])), frame

    return Pattern("a place [x, y, yaw] in m and rad, in odom or with the name of a frame behind it", take)


def _finite(values: Sequence[Any]) -> list[float]:
    """The values as numbers; Mismatch if one is none, or out of the limits of places."""
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError, OverflowError):
        raise Mismatch from None
    lowest, highest, _ = limit("place")
    if not all(lowest <= value <= highest for value in found):  # also for what is not finite
        raise Mismatch
    return found


def points_of(desig: Designator) -> Iterator[Point3]:
    """Points of designators of things and of locations. Raises DesignatorError if a solution has no position."""
    for solution in desig.solutions():
        position = getattr(solution, "position", None)
        if position is not None:
            yield position
        elif isinstance(solution, tuple) and len(solution) == 2 and isinstance(solution[0], Place):
            yield Point3(solution[0].x, solution[0].y, 0.0, solution[1])
        else:
            raise DesignatorError(desig, f"it stands for {solution!r}, which has no place")


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


# --- walking ----------------------------------------------------------------------------------------------------------

NAVIGATION = "navigation"


def _going(desig: Designator, target: Any) -> Iterator[Command]:
    if isinstance(target, Designator):
        for place, frame in target.solutions():
            yield command(NAVIGATION, "walk_to", target=place, frame=frame)
        return
    try:
        place, frame = a_place().take(target)
    except Mismatch:
        allowed = f"{a_place().wanted}, or a designator of a location"
        raise DesignatorError(desig, f"it goes to {target!r}: not {allowed}") from None
    yield command(NAVIGATION, "walk_to", target=place, frame=frame)


rule_about("target", _going, called="going", type=one_of("going", "walking"))
rule_about("goal", _going, action, called="navigation", type="navigation")
rule_about("target", _going, action, called="to walk", name=one_of("to walk", "to go", "walk to", "walkTo"))


SPEECH, LIGHTS, VISION = "speech", "lights", "vision"
WAIT = one_of(True, False).or_else(False)
"""Whether to wait for the end of a text, by the action; else it goes to the topic /speech, and that is all."""


@rule(BOTH, type=one_of("saying", "speaking"), text=text(), wait=WAIT)
def saying(desig: Designator, wait: bool) -> Command:
    return _saying(desig["text"], wait)


@rule(BOTH, type=one_of("lighting", "colouring"), color=text(), lights=anything().or_else(("FaceLeds",)))
def lighting(color: str, lights: Any) -> Command:
    return command(LIGHTS, "set_color", color=color, lights=(lights,) if isinstance(lights, str) else tuple(lights))


@rule(BOTH, type="detecting", object=described("object"), timeout=number(0.0, 3600.0, "s").or_else(2.0))
def detecting(object: Designator, timeout: float, desig: Designator) -> Command:  # noqa: A002  the key's name
    looked = {"camera": desig.get("camera", "")}
    if "name" in object:
        looked["name"] = object["name"]
    # A detector wants one length, as NaoVision has it; of what is known of a thing, `size` is the box around it.
    if isinstance(object.get("size"), Real):
        looked["size"] = float(object["size"])
    return command(VISION, "detect", type=object["type"], timeout=timeout, search=bool(desig.get("search")), **looked)


@rule(action, name=one_of("to say", "text to speech"), text=text(), wait=WAIT)
def to_say(desig: Designator, wait: bool) -> Command:
    return _saying(desig["text"], wait)


@rule(action, name=one_of("to say", "text to speech"), sentence=text(), wait=WAIT)
def to_say_a_sentence(sentence: str, wait: bool) -> Command:
    return _saying(sentence, wait)


def _saying(sentence: str, wait: bool) -> Command:
    return command(SPEECH, "say" if wait else "text_to_speech", text=sentence)

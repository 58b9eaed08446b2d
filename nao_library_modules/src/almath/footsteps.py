"""Footsteps that are within reach and keep the feet apart, and paths of two arcs and a straight piece (Dubins curves).

A foot is the list of the corners of a convex shape, in order, either way round, in m in the frame of the foot.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import List, NamedTuple, Union

from almath._components import AlmathError, as_number, require
from almath.positions import Pose2D, Position2D, vectorPose2D

Box = List[Union[Position2D, Pose2D]]

# Only steps this much outside the ellipse are clipped, so that a clipped step is not clipped again.
_ELLIPSE_TOLERANCE = 0.00001

# Cross product of two directions, in m^2, below which segments count as parallel.
_PARALLEL = 0.00001

# Halvings of the heading in the search for a step without collision: to 1/32 of the step's heading.
_HALVINGS = 5


def _corners(box: Box, where: str) -> list[Position2D]:
    """Corners as points; poses, which older scripts give, count by their point."""
    if not isinstance(box, Iterable):
        raise AlmathError(f"{where} takes a list of Position2D, got {box!r}")
    corners = list(box)
    for corner in corners:
        if not isinstance(corner, (Position2D, Pose2D)):
            raise AlmathError(f"{where} takes a list of Position2D, got {corner!r} in it")
    return [Position2D(corner.x, corner.y) for corner in corners]


def clipFootWithEllipse(max_x: float, max_y: float, step: Pose2D) -> bool:
    """Shorten a step that leaves an ellipse around the origin; direction and heading stay.

    Returns True if it had to be shortened.

    Args:
        max_x: Half axis of the ellipse along X, in m; its sign does not count.
        max_y: Half axis of the ellipse along Y, in m; its sign does not count.
        step: The step, changed in place.
    """
    require(step, Pose2D, "clipFootWithEllipse")
    max_x = as_number(max_x, "clipFootWithEllipse max_x")
    max_y = as_number(max_y, "clipFootWithEllipse max_y")
    if max_x == 0.0 or max_y == 0.0:
        raise AlmathError(f"clipFootWithEllipse takes half axes other than zero, got {max_x} and {max_y}")
    excess = (step.x / max_x) ** 2 + (step.y / max_y) ** 2
    if excess < 1.0 + _ELLIPSE_TOLERANCE:
        return False
    step.x /= math.sqrt(excess)
    step.y /= math.sqrt(excess)
    return True


def avoidFootCollision(left_box: Box, right_box: Box, is_left_support: bool, step: Pose2D) -> bool:
    """Turn a step less, until the two feet do not overlap.

    Args:
        left_box: Corners of the left foot.
        right_box: Corners of the right foot.
        is_left_support: True if the left foot stands and the right one makes the step.
        step: Where the moving foot goes, in the frame of the standing one; its heading is changed in place.

    Returns:
        True if the feet would have overlapped. If they do so with a heading of zero too, that is what is
        left.
    """
    require(step, Pose2D, "avoidFootCollision")
    boxes = [_corners(box, "avoidFootCollision") for box in (left_box, right_box)]
    standing, moving = boxes if is_left_support else reversed(boxes)
    if not areTwoBoxesInCollision(standing, _moved(moving, step)):
        return False
    dichotomie(standing, moving, step)
    return True


def dichotomie(fixed_box: Box, moving_box: Box, step: Pose2D) -> None:
    """Reduce the heading of a step to the largest one found by bisection that keeps two boxes apart.

    Args:
        fixed_box: Corners of the standing foot.
        moving_box: Corners of the moving foot, in its own frame.
        step: Where the moving foot goes, in the frame of the standing one; its heading is changed in place.
    """
    require(step, Pose2D, "dichotomie")
    fixed, moving = _corners(fixed_box, "dichotomie"), _corners(moving_box, "dichotomie")
    free, taken = 0.0, step.theta
    for _ in range(_HALVINGS):
        middle = (free + taken) / 2.0
        if areTwoBoxesInCollision(fixed, _moved(moving, Pose2D(step.x, step.y, middle))):
            taken = middle
        else:
            free = middle
    step.theta = free


def areTwoBoxesInCollision(box_a: Box, box_b: Box) -> bool:
    """Tell whether two convex shapes share a point; touching counts."""
    a, b = _corners(box_a, "areTwoBoxesInCollision"), _corners(box_b, "areTwoBoxesInCollision")
    if not a or not b:
        return False
    # Two convex shapes are apart exactly if the normal of one of their sides separates them.
    return not any(_separates(side, a, b) for box in (a, b) for side in _sides(box))


def _sides(box: list[Position2D]) -> list[Position2D]:
    return [end - start for start, end in zip(box, box[1:] + box[:1])]


def _separates(side: Position2D, a: list[Position2D], b: list[Position2D]) -> bool:
    shadow_a = [side.crossProduct(corner) for corner in a]
    shadow_b = [side.crossProduct(corner) for corner in b]
    return max(shadow_a) < min(shadow_b) or max(shadow_b) < min(shadow_a)


def _moved(box: list[Position2D], step: Pose2D) -> list[Position2D]:
    return [step * corner for corner in box]


def computeBox(box: Box, step: Pose2D, out: Box) -> None:
    """Write the corners of a foot, moved by a step, to the list `out`."""
    require(step, Pose2D, "computeBox")
    out[:] = _moved(_corners(box, "computeBox"), step)


def intersectionSegment2D(
    a_start: Position2D, a_end: Position2D, b_start: Position2D, b_end: Position2D, out: Position2D
) -> bool:
    """Find the point that two segments share.

    Returns True if there is exactly one; parallel segments share none or many.

    Args:
        a_start: Start of the first segment.
        a_end: End of the first segment.
        b_start: Start of the second segment.
        b_end: End of the second segment.
        out: Overwritten with the shared point, if there is one.
    """
    for point in (a_start, a_end, b_start, b_end, out):
        require(point, Position2D, "intersectionSegment2D")
    a, b, gap = a_end - a_start, b_end - b_start, b_start - a_start
    crossing = a.crossProduct(b)
    if abs(crossing) < _PARALLEL:
        return False
    share_a, share_b = gap.crossProduct(b) / crossing, gap.crossProduct(a) / crossing
    if not (0.0 <= share_a <= 1.0 and 0.0 <= share_b <= 1.0):
        return False
    shared = a_start + a * share_a
    out.x, out.y = shared.x, shared.y
    return True


_LEFT, _RIGHT = 1.0, -1.0
_TURNS = ((_LEFT, _LEFT), (_LEFT, _RIGHT), (_RIGHT, _LEFT), (_RIGHT, _RIGHT))


class _Path(NamedTuple):
    """An arc, a straight piece and an arc; the turns are 1 to the left and -1 to the right."""

    length: float
    start: Position2D
    end: Position2D
    heading: float
    first_turn: float
    second_turn: float


def getDubinsSolutions(target: Pose2D, radius: float) -> vectorPose2D:
    """Path from the origin, heading along X, to a pose, in arcs of one radius.

    Of the paths that turn left or right at either end, the one with the shortest straight piece is taken. Raises
    AlmathError if the radius is not above zero or the target is too near.

    Args:
        target: Where to arrive, at least four radii away.
        radius: Of the arcs, in m.

    Returns:
        The pose at the start and at the end of the straight piece, and the target. The headings are not
        wrapped: the first has the sign of the first turn, and the last minus the second has the sign of the
        second turn.
    """
    require(target, Pose2D, "getDubinsSolutions")
    if not as_number(radius, "getDubinsSolutions radius") > 0.0:
        raise AlmathError(f"getDubinsSolutions takes a radius above zero, got {radius}")
    if not target.norm() >= 4.0 * radius:
        raise AlmathError(
            f"getDubinsSolutions takes a target four radii ({4.0 * radius} m) away or more, got {target!r}"
        )
    path = min((_path(target, radius, *turns) for turns in _TURNS), key=lambda candidate: candidate.length)
    start_heading = path.first_turn * (path.first_turn * path.heading % (2.0 * math.pi))
    last_turn = path.second_turn * (target.theta - path.heading) % (2.0 * math.pi)
    return vectorPose2D(
        [
            Pose2D(path.start.x, path.start.y, start_heading),
            Pose2D(path.end.x, path.end.y, target.theta - path.second_turn * last_turn),
            target,
        ]
    )


def _path(target: Pose2D, radius: float, first_turn: float, second_turn: float) -> _Path:
    first_centre = Position2D(0.0, first_turn * radius)
    second_centre = target * Position2D(0.0, second_turn * radius)
    between = second_centre - first_centre
    # Both ends of the straight piece lie beside their centre; seen from it, the second centre is this far to
    # the left of the first.
    offset = (second_turn - first_turn) * radius
    distance = between.norm()
    heading = between.getAngle() - math.asin(max(-1.0, min(1.0, offset / distance)))
    left = Position2D(-math.sin(heading), math.cos(heading)) * radius
    return _Path(
        length=math.sqrt(max(0.0, distance**2 - offset**2)),
        start=first_centre - left * first_turn,
        end=second_centre - left * second_turn,
        heading=heading,
        first_turn=first_turn,
        second_turn=second_turn,
    )

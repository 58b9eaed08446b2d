"""The way from where the robot is to a posture: the shortest chain of moves. Pure."""

from __future__ import annotations

import heapq
from typing import Iterator, NamedTuple, Sequence

from nao_sim_bridge.control.balance.posture_recognition import LEFT, ON_CHAIR, RIGHT, UNKNOWN, Recognition
from nao_sim_bridge.core.posture_moves import GROUNDS, ON_THE_BACK, ON_THE_FEET, Move, direct
from nao_sim_bridge.model.postures import load_postures, posture
from nao_sim_bridge.model.robot_model import RobotModel

ON_FEET = ON_THE_FEET.families
# Neither on its feet, nor on its seat, nor lying: on its knees, say, or on a chair. Whatever it is, standing is near.
NEARLY_STANDING = (UNKNOWN, ON_CHAIR)
# Nobody stays on a side who stretches: he tips over, most often on his back.
ON_A_SIDE = (LEFT, RIGHT)
STRETCHED = "LyingBack"


class _Place(NamedTuple):
    """Where a move begins: what the robot's pose is taken for, and its (26,) command angles in rad."""

    seen: Recognition
    angles: Sequence[float]


def path_to(
    goal: str,
    seen: Recognition,
    angles: Sequence[float],
    fraction: float,
    model: RobotModel,
    moves: Sequence[Move],
) -> list[Move] | None:
    """The moves that most likely lead to a posture in the shortest time, None when none do.

    A robot that is in its goal already is still moved to it exactly.

    Args:
        angles: (26,) command angles, rad.
        fraction: Share of the joints' top speeds for direct moves, above 0 to 1.
    """
    best: dict[str, float] = {}
    # The counter keeps equal times apart: moves have no order.
    queue: list[tuple[float, int, _Place, list[Move]]] = [(0.0, 0, _Place(seen, angles), [])]
    count = 0
    while queue:
        time, _, place, path = heapq.heappop(queue)
        if path and path[-1].goal == goal:
            return path
        for move in _moves_from(place, fraction, model, moves):
            arrival = time + move.expected_duration
            if arrival < best.get(move.goal, float("inf")):
                best[move.goal] = arrival
                count += 1
                there = _Place(Recognition(move.goal, move.goal_family), posture(model, move.goal))
                heapq.heappush(queue, (arrival, count, there, [*path, move]))
    return None


def leaves_feet(seen: Recognition, move: Move) -> bool:
    """Whether a move begins or ends anywhere but on the feet, so that a leaning torso is no fall."""
    return seen.family not in ON_FEET or move.goal_family not in ON_FEET


def _moves_from(place: _Place, fraction: float, model: RobotModel, moves: Sequence[Move]) -> Iterator[Move]:
    seen, angles = place
    yield from (move for move in moves if move.start in (seen.posture, seen.family))
    postures = load_postures().by_name.values()
    if seen.family in NEARLY_STANDING:
        on_feet = [entry.name for entry in postures if entry.family in ON_FEET]
        nearest = min(on_feet, key=lambda name: max(abs(a - b) for a, b in zip(posture(model, name), angles)))
        yield direct(model, seen.family, nearest, angles, fraction, ON_THE_FEET)
        return
    if seen.family in ON_A_SIDE:
        yield direct(model, seen.family, STRETCHED, angles, fraction, ON_THE_BACK)
    begin = seen.family if seen.posture == UNKNOWN else seen.posture
    for ground in GROUNDS:
        if seen.family in ground.families:
            for entry in postures:
                if entry.family in ground.families:
                    yield direct(model, begin, entry.name, angles, fraction, ground)

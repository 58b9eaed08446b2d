"""What our action server costs on top of actionlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import Sample, interleave

if TYPE_CHECKING:
    from ..goals import GoalClient

ROUNDS, RARE_ROUNDS, WARM_UP = 400, 200, 40
GROUP = "ChestLeds"
# s. The bare server waits in slices of 100 ms and misses goals that come while it ends the one before.
STALL = 0.05


def run_in_turns(clients: tuple[GoalClient, GoalClient], goal: Any, rounds: int) -> list[Sample]:
    """Round trips of ours and of the bare server; the warm-up makes ours read the names of the lights."""
    ours, bare = clients
    return interleave([lambda: ours.run(goal), lambda: bare.run(goal)], rounds, WARM_UP)


class GoalRoundTrip(Row):
    """From sending a goal to its result, without the robot's part.

    The function is listGroup: the server checks and runs it like any other, with feedback and result, but the
    answer comes from what it knows of the robot. So there is no time of the robot to be subtracted. Nor is the moment
    that goals which would be over at once last: `soonest_end` is 0 here.
    """

    name = "goal_round_trip"
    subject = "goal of one function (listGroup: asks no robot)"
    against = "bare SimpleActionServer, same goal"
    unit = "ms"
    bound = at_most(1.15)

    def measure(self, stack: Stack) -> Figures:
        """Measure the two servers in turns; for the note also as if goals were rare."""
        clients = stack.goal_clients
        goal = clients[0].goal("listGroup", {"str_param": GROUP})
        ours, bare = run_in_turns(clients, goal, ROUNDS)
        rare_ours, rare_bare = run_in_turns(stack.rare_goal_clients, goal, RARE_ROUNDS)
        note = (
            f"if goals are rare {1e3 * rare_ours.median:.2f} ms : {1e3 * rare_bare.median:.2f} ms"
            f" = {rare_ours.median / rare_bare.median:.2f}; over {1e3 * STALL:g} ms:"
            f" {ours.share_above(STALL):.1%} : {bare.share_above(STALL):.1%} of the goals"
        )
        return Figures.compared(ours, bare, scale=1e3, note=note)

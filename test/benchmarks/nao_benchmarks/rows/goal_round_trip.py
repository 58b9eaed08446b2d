"""What our action server costs on top of actionlib."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import interleave

ROUNDS = 400
GROUP = "ChestLeds"


class GoalRoundTrip(Row):
    """From sending a goal to its result, without the robot's part.

    The function is listGroup: the server checks and runs it like any other, feedback and result included, but the
    answer comes from what it knows of the robot. So there is no time of the robot to be subtracted.
    """

    name = "goal_round_trip"
    subject = "goal of one function (listGroup: asks no robot)"
    against = "bare SimpleActionServer, same goal"
    unit = "ms"
    bound = at_most(1.15)

    def measure(self, stack: Stack) -> Figures:
        """Measure the two servers in turns; the warm-up makes ours read the names of the lights."""
        ours, bare = stack.goal_clients
        from ..goals import list_group  # not above: it needs the messages of the built workspace

        goal = list_group(GROUP)
        samples = interleave([lambda: ours.run(goal), lambda: bare.run(goal)], ROUNDS, warm_up=40)
        return Figures.compared(*samples, scale=1e3)

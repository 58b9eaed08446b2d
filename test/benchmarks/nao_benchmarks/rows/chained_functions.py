"""What a chain saves: many functions in one goal, against a goal for each."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import interleave

FUNCTIONS = 100
ROUNDS = 5
LIGHT = "Brain0"


class ChainedFunctions(Row):
    """The same functions, each with its call to the robot, sent together and one by one."""

    name = "chained_functions"
    subject = f"{FUNCTIONS} functions (setIntensity) in one goal"
    against = f"{FUNCTIONS} goals one after the other"
    unit = "ms"
    bound = at_most(0.2)

    def measure(self, stack: Stack) -> Figures:
        """Measure both ways with our server in turns."""
        client, _ = stack.goal_clients
        from ..goals import set_intensity  # not above: it needs the messages of the built workspace

        together, alone = set_intensity(LIGHT, FUNCTIONS), set_intensity(LIGHT, 1)

        def one_by_one() -> None:
            for _ in range(FUNCTIONS):
                client.run(alone)

        samples = interleave([lambda: client.run(together), one_by_one], ROUNDS, warm_up=1)
        return Figures.compared(*samples, scale=1e3)

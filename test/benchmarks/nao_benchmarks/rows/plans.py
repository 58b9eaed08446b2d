"""What plans cost: a designator that is performed beside the goal that it comes down to, and many branches at once."""

from __future__ import annotations

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import interleave

ROUNDS, WARM_UP = 300, 30
PAR_ROUNDS = 40
BRANCHES = 100
GROUP = "ChestLeds"


class PerformOverhead(Row):
    """How much longer a designator takes that is resolved by a rule and performed by a process module than its goal.

    Both go to the same bare server, from the same process.
    """

    name = "perform_overhead"
    subject = "perform of a designator, less the same goal of a bare client"
    unit = "ms"
    bound = at_most(5.0)

    def measure(self, stack: Stack) -> Figures:
        """Measure the two in turns."""
        bare = stack.goal_clients[1]
        # Not above: they need the messages of the built workspace.
        from nao_library_actions.msg import NaoLedAction
        from nao_library_modules.process_modules.control import top_level
        from nao_library_modules.process_modules.designators.designator import action, an
        from nao_library_modules.process_modules.designators.rules import RULES, command, rule
        from nao_library_modules.process_modules.plan_action_client import PlanActionClient
        from nao_library_modules.process_modules.process_module import (
            ProcessModule,
            perform,
            with_process_modules_running,
        )

        client, goal = PlanActionClient(bare.server, NaoLedAction), bare.goal("listGroup", {"str_param": GROUP})

        class Bare(ProcessModule):
            name = "bare"

            def execute(self, _command: object) -> object:
                return client.call(goal)

        @rule(action, type="listing")
        def listing() -> object:
            return command("bare", "list")

        with with_process_modules_running(Bare()):
            runs = [lambda: top_level(lambda: perform(an(action, type="listing"))), lambda: bare.run(goal)]
            ours, reference = interleave(runs, ROUNDS, WARM_UP)
        RULES.remove(next(each for each in RULES.of(action) if each.solve is listing))
        note = f"{1e3 * ours.median:.2f} ms : {1e3 * reference.median:.2f} ms"
        return Figures(1e3 * (ours.median - reference.median), note=note)


class ParOfHundred(Row):
    """A plan with a hundred branches beside each other that do nothing, from its begin to its end."""

    name = "par_of_hundred"
    subject = f"par of {BRANCHES} branches"
    unit = "ms"
    bound = at_most(50.0)

    def measure(self, _stack: Stack) -> Figures:
        """Measure alone: there is nothing to compare it with."""
        from nao_library_modules.process_modules.control import par, top_level

        branches = [lambda: None] * BRANCHES
        (sample,) = interleave([lambda: top_level(lambda: par(*branches))], PAR_ROUNDS, warm_up=5)
        return Figures(1e3 * sample.median, note=f"longest {1e3 * max(sample.seconds):.1f} ms")

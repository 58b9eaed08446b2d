"""What a behaviour costs: one step of a stored behaviour beside the goal that it comes down to."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from ..row import Figures, Row, at_most
from ..stack import Stack
from ..stats import interleave

ROUNDS, WARM_UP = 100, 10
GROUP = "ChestLeds"
NAME = "benchmark"
TEXT = f"help: Asks for the lights of a group.\ndo: [{{NaoLights.listGroup: {{str_param: {GROUP}}}}}]\n"


class BehaviorOverhead(Row):
    """How much longer a goal of NaoBehavior takes, with a behaviour of one step, than the goal of that step."""

    name = "behavior_overhead"
    subject = "behaviour of one step, less the goal of the step"
    unit = "ms"
    bound = at_most(15.0)

    def measure(self, stack: Stack) -> Figures:
        """Measure the two in turns; both go to servers of ours."""
        with TemporaryDirectory() as folder:
            (Path(folder) / f"{NAME}.yaml").write_text(TEXT, encoding="utf-8")
            behaviors, lights = stack.start_behaviors(folder)
            behavior = behaviors.goal("runBehavior", {"str_param": NAME})
            step = lights.goal("listGroup", {"str_param": GROUP})
            runs = [lambda: behaviors.run(behavior), lambda: lights.run(step)]
            ours, reference = interleave(runs, ROUNDS, WARM_UP)
        note = f"{1e3 * ours.median:.1f} ms : {1e3 * reference.median:.1f} ms"
        return Figures(1e3 * (ours.median - reference.median), note=note)

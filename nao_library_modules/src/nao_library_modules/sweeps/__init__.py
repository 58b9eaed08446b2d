"""How often does my behaviour fall? Many runs of a behaviour or a plan, each worker on a simulated robot of its own.

    from nao_library_modules.sweeps import BehaviorGoal, sweep_stack

    print(sweep_stack(BehaviorGoal("dance"), seeds=50, noise=[1.0], push=[0.0, 1.0, 2.0]).text("fell"))

In docs/scale.md: what a row has, what it costs, and which of it is equal in equal runs.
"""

from __future__ import annotations

from .subjects import BehaviorGoal, Outcome, PlanProgram
from .sweep_stack import sweep_stack

__all__ = ["BehaviorGoal", "Outcome", "PlanProgram", "sweep_stack"]

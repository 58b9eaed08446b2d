"""A thousand random plans with random failures and ends: nothing hangs, nothing is left."""

from __future__ import annotations

import random
import threading

from nao_library_modules.process_modules.control import do, par, pursue, seq, top_level, try_all, try_in_order
from nao_library_modules.process_modules.failures import PlanFailure, fail
from nao_library_modules.process_modules.flow import checkpoint, sleep, wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import give, with_failure_handling
from nao_library_modules.process_modules.policies import timeout_policy, with_policy
from nao_library_modules.process_modules.tasks import TaskState

PLANS = 1000
CONSTRUCTS = (seq, par, pursue, try_all, try_in_order)
MOMENT = 0.004


class RandomPlan:
    """A plan made with a seed; counts the goals that its leaves have sent and ended."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.running = Fluent("goals that run", 0)
        self.body = self._branch(4)

    def _branch(self, depth):
        kind = self.random.choice(["leaf", "leaf", "handling", "policy", *CONSTRUCTS]) if depth else "leaf"
        if kind == "leaf":
            return self._leaf()
        branches = [self._branch(depth - 1) for _ in range(self.random.randint(1, 4))]
        if kind == "handling":
            return do(with_failure_handling, branches[0], {PlanFailure: lambda failure: give()})
        if kind == "policy":
            return do(with_policy, timeout_policy(self.random.random() * 2 * MOMENT + 1e-4), branches[0])
        return do(kind, *branches)

    def _leaf(self):
        what, moment = self.random.choice(["quick", "fail", "sleep", "wait", "compute"]), self.random.random() * MOMENT
        arrived = Fluent("arrived", False)

        def leaf():
            self.running.update(lambda count: count + 1)
            try:
                if what == "fail":
                    fail("by chance")
                if what == "sleep":
                    sleep(moment)
                if what == "wait":
                    threading.Timer(moment, lambda: setattr(arrived, "value", True)).start()
                    wait_until(lambda: arrived.value, [arrived])
                if what == "compute":
                    for _ in range(20):
                        checkpoint()
            finally:
                self.running.update(lambda count: count - 1)

        return do(leaf)


def test_nothing_hangs_and_nothing_is_left():
    ends = set()
    for seed in range(PLANS):
        plan = RandomPlan(seed)
        roots = []

        def strike(roots=roots, plan=plan):
            if roots:
                target = plan.random.choice(list(roots[0]))
                plan.random.choice([target.evaporate, lambda: (target.suspend(), target.wake_up())])()

        strikes = [
            threading.Timer(plan.random.random() * 2 * MOMENT, strike) for _ in range(plan.random.choice([0, 0, 1, 3]))
        ]
        for timer in strikes:
            timer.start()
        try:
            top_level(plan.body, observers=[lambda task, roots=roots: roots or roots.append(task)])
            ends.add("answer")
        except PlanFailure as failure:
            ends.add(type(failure).__name__)
        for timer in strikes:
            timer.join()
        assert plan.running.value == 0, f"seed {seed}: goals run on"
        unfinished = [task for task in roots[0] if not task.state.over and task.state is not TaskState.CREATED]
        assert not unfinished, f"seed {seed}: {unfinished}"
    assert ends >= {"answer", "SimplePlanFailure", "CompositeFailure", "PlanTimedOut", "TaskEvaporatedFailure"}

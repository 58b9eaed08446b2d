"""A thousand random plans that use process modules, which fail, are cancelled and suspended at random."""

from __future__ import annotations

import random
import threading

from cram_modules import Many, One

from nao_library_modules.process_modules.control import (
    do,
    par,
    partial_order,
    pursue,
    seq,
    top_level,
    try_all,
    try_in_order,
)
from nao_library_modules.process_modules.designators.designator import Designator, action
from nao_library_modules.process_modules.designators.rules import Command
from nao_library_modules.process_modules.failures import NavigationGoalNotReached, PlanFailure, fail
from nao_library_modules.process_modules.flow import checkpoint, sleep, uninterrupted
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.handling import do_retry, give, with_failure_handling, with_retry_counters
from nao_library_modules.process_modules.policies import timeout_policy, with_policy
from nao_library_modules.process_modules.process_module import ModuleState, pm_cancel
from nao_library_modules.process_modules.registry import perform, with_process_modules_running
from nao_library_modules.process_modules.tasks import TaskState

PLANS = 1000
CONSTRUCTS = (seq, par, pursue, try_all, try_in_order)
MOMENT = 0.003
LIMBS = ("left", "right", "head")
PATIENCE = 60.0


class Work:
    """What modules do here: counts what runs, and what runs on a limb at the same time."""

    def __init__(self):
        self.running = Fluent("requests that run", 0)
        self.on_limb = {(module, limb): Fluent(limb, 0) for module in ("one", "many") for limb in LIMBS}
        self.clashes = 0

    def carry_out(self, command):
        limb, how, moment = (command.arguments[key] for key in ("limb", "how", "moment"))
        self.running.update(lambda count: count + 1)
        busy = self.on_limb[command.module, limb]
        if busy.update(lambda count: count + 1) > 1:
            self.clashes += 1
        try:
            if how == "fail":
                fail(NavigationGoalNotReached, "by chance")
            if how == "compute":
                for _ in range(10):
                    checkpoint()
            if how == "sleep":
                sleep(moment)
            if how == "stay":
                sleep(20.0 * MOMENT)
        finally:
            if how == "sleep":
                with uninterrupted():
                    sleep(moment / 4.0)
            busy.update(lambda count: count - 1)
            self.running.update(lambda count: count - 1)
        return how


class RandomPlan:
    """A plan made with a seed."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.body = self._branch(3)

    def _branch(self, depth):
        kinds = ["leaf", "leaf", "retry", "policy", "order", *CONSTRUCTS] if depth else ["leaf"]
        kind = self.random.choice(kinds)
        if kind == "leaf":
            return self._leaf()
        branches = [self._branch(depth - 1) for _ in range(self.random.randint(1, 3))]
        if kind == "retry":
            return do(self._retried, branches[0])
        if kind == "policy":
            return do(with_policy, timeout_policy(self.random.random() * 2 * MOMENT + 1e-4), branches[0])
        if kind == "order":
            named = {str(number): branch for number, branch in enumerate(branches)}
            return do(partial_order, named, [tuple(named)])
        return do(kind, *branches)

    @staticmethod
    def _retried(branch):
        with with_retry_counters(tries=1):
            handlers = {PlanFailure: lambda failure: (do_retry("tries", before=lambda: sleep(1e-4)), give())}
            return with_failure_handling(branch, handlers)

    def _leaf(self):
        limb = self.random.choice(LIMBS)
        arguments = {
            "limb": limb,
            "needs": [limb],
            "how": self.random.choice(["quick", "fail", "compute", "sleep", "sleep", "stay"]),
            "moment": self.random.random() * MOMENT,
        }
        made = Command(self.random.choice(["one", "many"]), "act", arguments)
        return do(perform, Designator(action, {"type": "acting"}, resolve=lambda _: [made]))

    def strike(self, roots, modules):
        """Something from outside: a task is ended, or suspended and woken, or a module is cancelled."""
        if not roots:
            return
        target = self.random.choice(list(roots[0]))
        what = self.random.choice(["end", "suspend", "cancel"])
        if what == "end":
            target.evaporate("struck")
        elif what == "suspend":
            target.suspend("struck")
            threading.Timer(MOMENT / 2.0, target.wake_up).start()
        else:
            pm_cancel(self.random.choice(modules))


def run(seed, modules, ends):
    """Run a plan; what went wrong with the tree."""
    plan, roots = RandomPlan(seed), []
    strikes = [
        threading.Timer(plan.random.random() * 3 * MOMENT, plan.strike, (roots, modules))
        for _ in range(plan.random.choice([0, 1, 1, 3]))
    ]
    for timer in strikes:
        timer.start()
    try:
        top_level(plan.body, observers=[lambda task: roots or roots.append(task)])
        ends.add("answer")
    except PlanFailure as failure:
        ends.add(type(failure).__name__)
    for timer in strikes:
        timer.join()
    return [task for task in roots[0] if not task.state.over and task.state is not TaskState.CREATED]


def test_no_request_runs_on_and_nothing_hangs():
    work, ends, problems = Work(), set(), []
    modules = (One(work), Many(work))
    with with_process_modules_running(*modules):

        def runs():
            for seed in range(PLANS):
                left = run(seed, modules, ends)
                if left or work.running.value:
                    problems.append(f"seed {seed}: {left}, {work.running.value} requests run on")

        thread = threading.Thread(target=runs, daemon=True)
        thread.start()
        thread.join(PATIENCE * 4.0)
        assert not thread.is_alive(), "a plan hangs"
        assert problems == []
        assert work.clashes == 0
        for module in modules:
            assert module.state in (ModuleState.WAITING, ModuleState.FAILED)
            assert not module._running and not module._waiting and not module.watchers
    assert {module.state for module in modules} == {ModuleState.OFFLINE}
    assert ends >= {"answer", "NavigationGoalNotReached", "CompositeFailure", "PlanTimedOut", "TaskEvaporatedFailure"}


def test_plans_beside_each_other_share_modules():
    work, ends, problems = Work(), set(), []
    modules = (One(work), Many(work))
    with with_process_modules_running(*modules):

        def runs(begin):
            for seed in range(begin, begin + 40):
                problems.extend(run(seed, modules, ends))

        threads = [threading.Thread(target=runs, args=(5000 + 100 * number,), daemon=True) for number in range(5)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join(PATIENCE)
            assert not thread.is_alive(), "a plan hangs"
    assert problems == [] and work.running.value == 0 and work.clashes == 0

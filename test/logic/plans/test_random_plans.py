"""Random plans against a model of what may come of them, left alone and struck: nothing hangs, nothing is left."""

from __future__ import annotations

import threading
from itertools import product

from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from plan_tools import LIMIT, Beside, forever

import nao_library_modules.process_modules as p
from nao_library_modules.process_modules.failures import NavigationGoalNotReached
from nao_library_modules.process_modules.process_module import ModuleState

MOMENT = 0.002
OK, NEVER = "ok", "never"
GONE, OVER, TIME, ALL = "NavigationGoalNotReached", "TaskEvaporatedFailure", "PlanTimedOut", "CompositeFailure"

leaves = st.one_of(
    st.tuples(st.sampled_from(["quick", "fail", "compute", "sleep", "never"])),
    st.tuples(st.just("perform"), st.sampled_from(["one", "many"]), st.sampled_from(["quick", "fail", "sleep"]),
              st.sampled_from(["left", "right"])),
)  # fmt: skip
KINDS = st.sampled_from(["seq", "par", "pursue", "try_all", "try_in_order", "order", "handled", "retried", "policy"])
trees = st.recursive(leaves, lambda inner: st.tuples(KINDS, st.lists(inner, min_size=1, max_size=3)), max_leaves=10)
strikes = st.lists(
    st.tuples(st.sampled_from(["end", "end a part", "suspend", "cancel"]), st.integers(0, 99), st.integers(0, 3)),
    max_size=3,
)


def in_order(outcomes):
    return {next((each for each in outcomes if each != OK), OK)}


def at_once(outcomes):
    failures = {each for each in outcomes if each not in (OK, NEVER)}
    return failures or ({NEVER} if NEVER in outcomes else {OK})


def race(outcomes):
    return {each for each in outcomes if each != NEVER} or {NEVER}


def first_good(outcomes):
    return {OK} if OK in outcomes else {NEVER} if NEVER in outcomes else {ALL}


def first_good_in_order(outcomes):
    return {next((each for each in outcomes if each in (OK, NEVER)), ALL)}


MODEL = {"seq": in_order, "order": in_order, "par": at_once, "pursue": race, "try_all": first_good,
         "try_in_order": first_good_in_order}  # fmt: skip


def possible(tree):
    """What may come of a plan: ok, never, or the names of failures."""
    kind, *rest = tree
    if kind in ("fail", "never"):
        return {GONE} if kind == "fail" else {NEVER}
    if kind == "perform":
        return {GONE} if rest[1] == "fail" else {OK}
    if not rest:
        return {OK}
    branches = [possible(each) for each in rest[0]]
    if kind in ("handled", "retried"):
        return {each if each in (OK, NEVER) else OK for each in branches[0]}
    if kind == "policy":
        return branches[0] - {NEVER} | {TIME}
    return set().union(*(MODEL[kind](combination) for combination in product(*branches)))


class Work:
    """What leaves do; counts what runs, and what runs on a limb of a module at the same time."""

    def __init__(self):
        self.running = p.Fluent("runs", 0)
        self.limbs = {key: p.Fluent("limb", 0) for key in product(("one", "many"), ("left", "right"))}
        self.clashes = 0

    def act(self, how, limb=None):
        busy = self.limbs.get(limb, self.running)
        self.running.update(lambda count: count + 1)
        self.clashes += limb is not None and busy.update(lambda count: count + 1) > 1
        try:
            if how == "fail":
                p.fail(NavigationGoalNotReached, "by chance")
            if how == "compute":
                for _ in range(10):
                    p.checkpoint()
            if how == "sleep":
                p.sleep(MOMENT)
            if how == "never":
                forever()
        finally:
            with p.uninterrupted():
                p.sleep(MOMENT / 4.0 if how == "sleep" else 0.0)
            if limb is not None:
                busy.update(lambda count: count - 1)
            self.running.update(lambda count: count - 1)

    def body(self, tree):
        kind, *rest = tree
        if kind == "perform":
            command = p.Command(rest[0], "act", {"how": rest[1], "limb": rest[2]})
            return p.do(p.perform, p.Designator(p.action, {"type": "acting"}, resolve=lambda _: [command]))
        if not rest:
            return p.do(self.act, kind)
        branches = [self.body(each) for each in rest[0]]
        if kind == "handled":
            return p.do(p.with_failure_handling, branches[0], {p.PlanFailure: lambda failure: p.give()})
        if kind == "retried":
            return p.do(self._retried, branches[0])
        if kind == "policy":
            return p.do(p.with_policy, p.timeout_policy(MOMENT), branches[0])
        if kind == "order":
            named = {str(number): branch for number, branch in enumerate(branches)}
            return p.do(p.partial_order, named, [tuple(named)])
        return p.do(getattr(p, kind), *branches)

    @staticmethod
    def _retried(branch):
        with p.with_retry_counters(tries=1):
            handlers = {p.PlanFailure: lambda failure: (p.do_retry("tries", before=lambda: p.sleep(1e-4)), p.give())}
            p.with_failure_handling(branch, handlers)


def modules_of(work):
    act = lambda self, command: work.act(command.arguments["how"], (self.name, command.arguments["limb"]))  # noqa: E731
    limbs = lambda self, command: frozenset({command.arguments["limb"]})  # noqa: E731
    return tuple(
        type(name, (base,), {"name": name, "execute": act, "resources": limbs})()
        for name, base in (("one", p.ProcessModule), ("many", p.AsynchronousProcessModule))
    )


def strike(root, what, which, modules):
    tasks = list(root)
    task = root if what == "end" else tasks[which % len(tasks)]
    if what == "suspend":
        task.suspend("struck")
        threading.Timer(MOMENT, task.wake_up).start()
    elif what == "cancel":
        modules[which % 2].cancel()
    else:
        task.evaporate("struck")


@settings(max_examples=120, phases=[Phase.generate])
@given(trees, strikes)
def test_random_plans_end_as_the_model_says_and_leave_nothing(tree, struck):
    work = Work()
    modules, told = modules_of(work), possible(tree)
    with p.with_process_modules_running(*modules):
        plan = Beside(work.body(tree))
        timers = [
            threading.Timer(after * MOMENT, strike, (plan.root, what, which, modules)) for what, which, after in struck
        ]
        for timer in timers:
            timer.start()
        for timer in timers:
            timer.join()
        if NEVER in told and not plan.root.join(2 * MOMENT):
            plan.root.evaporate("for ever")
        assert plan.root.join(LIMIT), "the plan hangs"
        try:
            plan.ended()
            outcome = OK
        except p.PlanFailure as failure:
            outcome = type(failure).__name__
        if not any(what in ("end a part", "cancel") for what, _, _ in struck):
            assert outcome in told | ({OVER} if struck or NEVER in told else set())
        assert (work.running.value, work.clashes) == (0, 0)
        assert all(task.state.over or task.state is p.TaskState.CREATED for task in plan.root)
    assert {module.state for module in modules} == {ModuleState.OFFLINE}


def test_plans_beside_each_other_share_modules():
    work = Work()
    branches = [("perform", *each) for each in product(("one", "many"), ("quick", "sleep", "fail"), ("left", "right"))]
    with p.with_process_modules_running(*modules_of(work)):
        plans = [Beside(work.body(("par", [("handled", [each]) for each in branches]))) for _ in range(6)]
        assert [len(plan.ended()) for plan in plans] == [len(branches)] * 6
    assert (work.running.value, work.clashes) == (0, 0)

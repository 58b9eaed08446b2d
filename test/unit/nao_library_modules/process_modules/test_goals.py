"""Goals: nothing to do when they hold, the most specific plan, and traces."""

from __future__ import annotations

import pytest

from nao_library_modules.process_modules.control import do, par, top_level
from nao_library_modules.process_modules.failures import GoalNotAchieved, PlanError, PlanFailure, fail
from nao_library_modules.process_modules.goals import ANY, achieve, declare_goal, def_goal, holds
from nao_library_modules.process_modules.plans import def_plan, def_top_level_plan
from nao_library_modules.process_modules.trace import Trace, trace_of


@pytest.fixture
def grippers():
    return {"left": 0.0, "right": 1.0}


@pytest.fixture
def gripper_open(grippers):
    @declare_goal
    def gripper_open(side, share=1.0):
        return grippers[side] >= share

    return gripper_open


def test_only_what_does_not_hold_is_done(gripper_open, grippers):
    opened = []

    @def_goal(gripper_open)
    def open_it(side, share):
        opened.append((side, share))
        grippers[side] = share
        return "opened"

    answers = top_level(lambda: par(do(achieve, gripper_open("left")), do(achieve, gripper_open, "right")))
    assert answers == ["opened", None]
    assert opened == [("left", 1.0)]
    assert holds(gripper_open("left")) and holds(gripper_open, "left", 0.5)


def test_the_most_specific_pattern_is_tried_first(gripper_open, grippers):
    chosen = []

    def plan(name):
        def act(*given):
            chosen.append((name, given))
            grippers.update(left=1.0, right=1.0)

        return act

    def_goal(gripper_open)(plan("any"))
    def_goal(gripper_open, ANY, lambda share: share < 0.5)(plan("a little"))
    def_goal(gripper_open, "left", 0.9)(plan("left, nearly"))
    for arguments in (("left", 0.9), ("left", 0.3), ("left", 0.8)):
        grippers["left"] = 0.0
        top_level(do(achieve, gripper_open, *arguments))
    assert chosen == [("left, nearly", ()), ("a little", ("left", 0.3)), ("any", ("left", 0.8))]


def test_a_plan_that_does_not_reach_its_goal_fails(gripper_open):
    def_goal(gripper_open)(lambda side, share: None)
    with pytest.raises(GoalNotAchieved, match=r"gripper_open\('left', 1.0\) does not hold, although"):
        top_level(do(achieve, gripper_open, "left"))


def test_a_goal_that_nobody_can_check_is_always_done():
    @declare_goal
    def greeted(name):
        """Somebody was greeted."""

    said = []
    def_goal(greeted)(said.append)
    top_level(do(achieve, greeted, "Anna"))
    top_level(do(achieve, greeted("Anna")))
    assert said == ["Anna", "Anna"] and not holds(greeted("Anna"))


def test_mistakes_are_told(gripper_open):
    with pytest.raises(PlanError, match=r"gripper_open takes \(side, share\)"):
        gripper_open("left", 1.0, 2.0)
    with pytest.raises(PlanError, match=r"gripper_open takes \(side, share\)"):
        gripper_open(sid="left")
    with pytest.raises(PlanError, match=r"no plan achieves gripper_open\('left', 1.0\): there are plans for nothing"):
        top_level(do(achieve, gripper_open("left")))
    with pytest.raises(PlanError, match="the pattern 3"):
        def_goal(gripper_open, ANY, ANY, ANY)
    with pytest.raises(PlanError, match="'open' is no occasion"):
        top_level(do(achieve, "open"))
    with pytest.raises(PlanError, match="sides: arguments of goals have names and no stars"):
        declare_goal(lambda *sides: True)


def test_plans_are_tasks_wherever_they_are_called(run_plan):
    @def_plan
    def nod(times):
        return times

    @def_plan
    def greet(name):
        return nod(2)

    _, root = run_plan(lambda: par(do(greet, "Anna"), lambda: greet("Bert")), name="plan")
    assert [task.path for task in root] == [
        "plan",
        "plan/par",
        "plan/par/greet",
        "plan/par/step",
        "plan/par/greet/nod",
        "plan/par/step/greet",
        "plan/par/step/greet/nod",
    ] or len(list(root)) == 7
    with pytest.raises(PlanError, match="outside of a plan"):
        nod(1)


def test_a_top_level_plan_begins_a_tree_or_joins_one():
    @def_top_level_plan
    def count(to):
        return to

    assert count(3) == 3
    assert top_level(lambda: count(4)) == 4


def test_the_trace_tells_the_whole_story_and_survives_json(run_plan):
    roots = []

    def plan():
        par(do(int, "1", name="one"), do(fail, "no ball", name="two"))

    with pytest.raises(PlanFailure):
        top_level(plan, name="plan", observers=[roots.append])
    trace = trace_of(roots[0])
    assert [(record.name, record.state) for record in trace.records] == [
        ("plan", "failed"),
        ("par", "failed"),
        ("one", "succeeded"),
        ("two", "failed"),
    ]
    assert trace.named("one")[0].result == "1"
    assert trace.named("two")[0].failure == "SimplePlanFailure: no ball"
    lines = str(trace).split("\n")
    assert lines[0].startswith("! plan") and lines[3].startswith("    ! two  ('no ball')")
    assert Trace.from_json(trace.to_json()) == trace

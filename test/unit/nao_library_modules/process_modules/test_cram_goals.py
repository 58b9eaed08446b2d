"""Goals that are aimed at together."""

from __future__ import annotations

import pytest

from nao_library_modules.process_modules import action_rules, perception  # noqa: F401
from nao_library_modules.process_modules.control import do, par, top_level
from nao_library_modules.process_modules.failures import GoalNotAchieved, NavigationGoalNotReached, fail
from nao_library_modules.process_modules.flow import sleep
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.goals import achieve, declare_goal, def_goal, holds
from nao_library_modules.process_modules.handling import with_failure_handling
from nao_library_modules.process_modules.waiting import wait_for

pytestmark = pytest.mark.usefixtures("nothing_is_known")


def test_goals_beside_each_other_each_keep_their_own():
    state = Fluent("state", frozenset())
    done = []

    @declare_goal
    def there(name):
        return name in state.value

    @def_goal(there)
    def bring(name):
        sleep(0.001)
        done.append(name)
        state.update(lambda names: names | {name})

    top_level(lambda: par(*(do(achieve, there(str(number))) for number in range(10))))
    top_level(lambda: par(*(do(achieve, there(str(number))) for number in range(10))))
    assert sorted(done) == [str(number) for number in range(10)] and holds(there("3"))


def test_a_goal_of_goals_fails_with_what_failed():
    @declare_goal
    def everything():
        return False

    @declare_goal
    def one_thing():
        return False

    @def_goal(one_thing)
    def try_it():
        fail(NavigationGoalNotReached, "stuck")

    @def_goal(everything)
    def all_of_it():
        par(do(achieve, one_thing()), do(sleep, 1000.0))

    with pytest.raises(NavigationGoalNotReached, match="stuck"):
        top_level(do(achieve, everything()))


def test_a_goal_that_somebody_else_reaches_meanwhile_is_reached():
    state = Fluent("state", False)

    @declare_goal
    def reached():
        return state.value

    @def_goal(reached)
    def nothing():
        wait_for(state)

    top_level(lambda: par(do(achieve, reached()), lambda: setattr(state, "value", True)))


def test_a_goal_that_does_not_hold_afterwards_can_be_tried_again():
    tries = []

    @declare_goal
    def lucky():
        return len(tries) >= 3

    @def_goal(lucky)
    def throw():
        tries.append(True)

    from nao_library_modules.process_modules.handling import retry

    top_level(
        lambda: with_failure_handling(do(achieve, lucky()), {GoalNotAchieved: lambda failure: retry()}),
    )
    assert len(tries) == 3

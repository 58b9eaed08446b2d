"""What docs/compatibility.md says is refused is refused with these words."""

import ast
import re

import pytest
from compatibility_tables import known

CALLS = [(module, call, why) for module, calls in known()["refused"].items() for call, why in calls.items()]


@pytest.mark.parametrize("module, call, why", CALLS, ids=[f"{module}.{call}" for module, call, _ in CALLS])
def test_a_method_that_always_refuses_says_why(robot, module, call, why):
    method, arguments = re.fullmatch(r"(\w+)\((.*)\)", call).groups()
    with pytest.raises(RuntimeError, match=re.escape(why)):
        getattr(robot, module).call(method, *ast.literal_eval(f"[{arguments}]"))


def test_no_module_that_the_page_misses_is_there(robot):
    assert known()["modules"].keys() & robot.server.modules().keys() == set()

"""The running stack of the level ros: every case finds it as if it had just started."""

from __future__ import annotations

import pytest
from ros_stack import RosStack


@pytest.fixture(scope="session")
def stack(tmp_path_factory):
    """Simulator, driver and servers; this process is a node beside them."""
    stack = RosStack(tmp_path_factory.mktemp("ros"))
    yield stack
    stack.close()


@pytest.fixture(autouse=True)
def intact(request, stack):
    """Names the case that kills a node, and starts the stack again for the next."""
    if stack.robot is None:
        stack.restart()
    yield
    dead = stack.deaths()
    if dead:
        stack.robot = None
        pytest.fail(f"this case ended {', '.join(dead)}; the stack is started again", pytrace=False)

"""What takes long on the running stack, the console among it."""

import pytest
from stack_fixtures import intact, running

__all__ = ["browser", "intact", "program", "running"]


@pytest.fixture(scope="module")
def program(stack, tmp_path_factory):
    """A console. Its end reports what its event loops should not have done."""
    from console_browser import ConsoleProgram

    stack.ensure()
    made = ConsoleProgram(tmp_path_factory.mktemp("console"))
    yield made
    made.close()


@pytest.fixture(scope="module")
def browser(program):
    """One that has entered the console."""
    from console_browser import ConsoleBrowser

    made = ConsoleBrowser(program).enter()
    yield made
    made.close()

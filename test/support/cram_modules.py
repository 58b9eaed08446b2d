"""Process modules for tests of plans: they do what their commands say, and keep a log of it."""

from __future__ import annotations

from nao_library_modules.process_modules.control import top_level
from nao_library_modules.process_modules.designators.designator import Designator, action
from nao_library_modules.process_modules.designators.rules import Command
from nao_library_modules.process_modules.failures import GripperGoalNotReached, NavigationGoalNotReached, fail
from nao_library_modules.process_modules.flow import sleep, uninterrupted, wait_until
from nao_library_modules.process_modules.fluents import Fluent
from nao_library_modules.process_modules.process_module import AsynchronousProcessModule, ProcessModule
from nao_library_modules.process_modules.waiting import wait_for

LIMIT = 10.0


class Log:
    """What a module has done: (what, word) pairs; commands wait for `go` of their word."""

    def __init__(self):
        self.events = Fluent("events", ())
        self.open = Fluent("open", frozenset())

    def tell(self, *event):
        self.events.update(lambda events: (*events, event))

    def let(self, *words):
        self.open.update(lambda there: there | set(words))

    def count(self, what):
        return sum(event[0] == what for event in self.events.value)

    def wait(self, *event):
        """From a test: until this has happened."""
        there = lambda: event in self.events.value  # noqa: E731
        assert top_level(lambda: wait_until(there, [self.events], LIMIT)), f"{event} did not happen"

    def carry_out(self, command):
        word, how = command.arguments.get("word", ""), command.name
        self.tell("begun", word)
        try:
            if how == "wait":
                wait_until(lambda: word in self.open.value, [self.open])
            elif how == "stumble":
                wait_until(lambda: word in self.open.value, [self.open])
                fail(NavigationGoalNotReached, f"{word} is far", word=word)
            elif how == "protected":
                with uninterrupted():
                    wait_until(lambda: word in self.open.value, [self.open])
            elif how == "stumble at the end":
                wait_until(lambda: False)
            return word
        except NavigationGoalNotReached:
            self.tell("failed", word)
            raise
        finally:
            self.tell("over", word)
            if how == "stumble at the end":
                fail(GripperGoalNotReached, "while it was ended")


class One(ProcessModule):
    name = "one"

    def __init__(self, log, name=""):
        super().__init__(name)
        self.log = log

    def execute(self, command):
        return self.log.carry_out(command)


class Many(AsynchronousProcessModule):
    name = "many"

    def __init__(self, log, name=""):
        super().__init__(name)
        self.log = log

    def execute(self, command):
        return self.log.carry_out(command)

    def resources(self, command):
        return frozenset(command.arguments.get("needs", ()))


def to(how, word="", module="one", **arguments):
    arguments = {"word": word, **arguments}
    return Designator(action, {"type": how}, resolve=lambda desig: [Command(module, how, arguments)])


def state_of(module, state):
    assert top_level(lambda: wait_for(module.status.eq(state), timeout=LIMIT)), module.state


def wait_here(module, count):
    """Wait until so many commands wait for their turn."""

    def plan():
        while len(module._waiting) < count:
            sleep(0.001)

    top_level(plan)
    return True

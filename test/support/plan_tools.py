"""What tests of plans are made of: branches that stay, plans beside the test, process modules that keep a log."""

from __future__ import annotations

import threading

import pytest

from nao_library_modules.process_modules import (
    AsynchronousProcessModule,
    Command,
    Designator,
    Fluent,
    ProcessModule,
    action,
    do,
    fail,
    top_level,
    wait_for,
    wait_until,
)
from nao_library_modules.process_modules.failures import GripperGoalNotReached, NavigationGoalNotReached

LIMIT = 60.0
SHORT = 0.02
"""s in which something would happen that must not."""


def fails(failure, match, body, **options):
    """The failure that a plan ends with."""
    with pytest.raises(failure, match=match) as caught:
        top_level(body, **options)
    return caught.value


def forever():
    wait_until(lambda: False)


def seen(fluent):
    """From a test: the value of a fluent once it is something."""
    answer = top_level(lambda: wait_for(fluent, timeout=LIMIT))
    assert answer, f"{fluent} did not come"
    return answer


def stays_false(fluent):
    """From a test: whether a fluent is nothing for a moment in which it would change."""
    return top_level(lambda: wait_for(fluent, timeout=SHORT)) is False


def at_once(*bodies):
    """Run functions in threads that begin at the same moment; what they answer or raise."""
    barrier, answers = threading.Barrier(len(bodies)), [None] * len(bodies)

    def run(number, body):
        barrier.wait(LIMIT)
        try:
            answers[number] = body()
        except Exception as error:
            answers[number] = error

    threads = [threading.Thread(target=run, args=each, daemon=True) for each in enumerate(bodies)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(3 * LIMIT)
        assert not thread.is_alive(), "a thread hangs"
    return answers


class Stays:
    """Branches that stay until they are ended; `there` counts them, `ended` has their names."""

    def __init__(self):
        self.there = Fluent("there", 0)
        self.ended = []

    def __call__(self, name="stays", then=lambda: None):
        def body():
            try:
                self.there.update(lambda count: count + 1)
                forever()
            finally:
                self.ended.append(name)
                then()

        return do(body, name=name)

    def once(self, count, then):
        """A branch that acts when so many are there."""
        return do(lambda: (wait_for(self.there >= count), then())[1], name="actor")


class Beside:
    """A plan that runs in a thread of its own; the test looks at its tree and waits for its end."""

    def __init__(self, body, limit=LIMIT, **options):
        self._limit = limit
        self.root = self.answer = self.error = None
        self._there = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(body, options), daemon=True)
        self._thread.start()
        assert self._there.wait(LIMIT)

    def ended(self):
        """Wait for the end; the answer."""
        self._thread.join(self._limit)
        assert not self._thread.is_alive(), "the plan does not end"
        if self.error is not None:
            raise self.error
        return self.answer

    def fails(self, failure, match=""):
        with pytest.raises(failure, match=match):
            self.ended()

    def _run(self, body, options):
        try:
            self.answer = top_level(body, observers=[self._see], **options)
        except BaseException as error:
            self.error = error

    def _see(self, task):
        if self.root is None:
            self.root = task
            self._there.set()


class Log:
    """What modules have done: (what, word) pairs; commands wait for `let` of their word."""

    def __init__(self):
        self.events = Fluent("events", ())
        self.open = Fluent("open", frozenset())

    def let(self, *words):
        self.open.update(lambda there: there | set(words))

    def words(self, what):
        return [word for each, word in self.events.value if each == what]

    def happened(self, *event):
        """In a plan: wait until this has happened."""
        wait_until(lambda: event in self.events.value, [self.events])

    def wait(self, *event):
        """From a test: the same."""
        there = lambda: event in self.events.value  # noqa: E731
        assert top_level(lambda: wait_until(there, [self.events], LIMIT)), f"{event} did not happen"

    def carry_out(self, command):
        word, how = command.arguments.get("word", ""), command.name
        tell = lambda what: self.events.update(lambda events: (*events, (what, word)))  # noqa: E731
        until_let = lambda: wait_until(lambda: word in self.open.value, [self.open])  # noqa: E731
        tell("begun")
        try:
            if how in ("wait", "stumble"):
                until_let()
            if how == "stumble":
                fail(NavigationGoalNotReached, f"{word} is far", word=word)
            if how == "bug":
                raise KeyError(word)
            if how == "stumble at the end":
                forever()
            return word
        finally:
            tell("over")
            if how == "stumble at the end":
                fail(GripperGoalNotReached, "while it was ended")


class _Logs:
    """A process module that does what its commands say.

    Attributes:
        asked: How many commands it was given.
    """

    def __init__(self, log, name=""):
        super().__init__(name)
        self.log = log
        self.asked = Fluent("asked", 0)

    def execute(self, command):
        return self.log.carry_out(command)

    def submit(self, request):
        super().submit(request)
        self.asked.update(lambda count: count + 1)


class One(_Logs, ProcessModule):
    name = "one"


class Many(_Logs, AsynchronousProcessModule):
    name = "many"

    def resources(self, command):
        return frozenset(command.arguments.get("needs", ()))


def to(how, word="", module="one", **arguments):
    """A designator of an action with one solution."""
    command = Command(module, how, {"word": word, **arguments})
    return Designator(action, {"type": how}, resolve=lambda desig: [command])


def state_of(module, state):
    """From a test: wait until a module is in a state."""
    assert top_level(lambda: wait_for(module.status.eq(state), timeout=LIMIT)), module.state

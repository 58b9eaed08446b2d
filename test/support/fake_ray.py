"""Ray without processes, as far as sweeps use it: computers with places, which a test takes away and adds."""

from __future__ import annotations

import itertools
from types import SimpleNamespace


class RayError(Exception):
    """A lost worker."""


class Future:
    def __init__(self, actor, method, arguments):
        self.actor, self.method, self.arguments = actor, method, arguments


class Actor:
    def __init__(self, work):
        self.work, self.computer, self.lost = work, None, False

    def __getattr__(self, method):
        return SimpleNamespace(remote=lambda *arguments: Future(self, method, arguments))


class FakeRay:
    """One call ends at each `wait`, the oldest first; `events`: what happens before the wait of this number.

    Attributes:
        places: How many workers fit on a computer, by name.
    """

    exceptions = SimpleNamespace(RayError=RayError)

    def __init__(self, **places):
        self.places, self.events, self.broken = places, {}, set()
        self.initialized, self.starting = True, lambda: None
        self.actors, self.calls = [], []
        self._waits = itertools.count()

    def is_initialized(self):
        return self.initialized

    def init(self, **options):
        """Start, by what `starting` does."""
        self.starting()
        self.initialized = True

    def shutdown(self):
        self.initialized = False

    def nodes(self):
        return [{"Alive": True, "Resources": {"CPU": float(count)}} for count in self.places.values()]

    def remote(self, **options):
        def make():
            self.actors.append(Actor(self._work()))
            return self.actors[-1]

        def decorate(kind):
            self._work = kind
            return SimpleNamespace(remote=make)

        return decorate

    def lose(self, computer):
        """The computer is gone, with its workers."""
        self.places[computer] = 0
        for actor in self.actors:
            actor.lost |= actor.computer == computer

    def kill(self, actor):
        actor.lost = True

    def wait(self, futures, num_returns, timeout):
        self.events.get(next(self._waits), lambda: None)()
        for actor in self.actors:
            self._place(actor)
        ended = [future for future in futures if future.actor.lost or future.actor.computer is not None]
        return ended[:num_returns], []

    def _place(self, actor):
        if actor.computer is None and not actor.lost:
            for computer, count in self.places.items():
                if sum(other.computer == computer and not other.lost for other in self.actors) < count:
                    actor.computer, actor.lost = computer, computer in self.broken
                    return

    def get(self, future):
        if future.actor.lost:
            raise RayError(f"the worker is gone\nwith {future.actor.computer}")
        self.calls.append((future.actor.computer, future.method))
        if future.method == "host":
            return future.actor.computer
        try:
            return getattr(future.actor.work, future.method)(*future.arguments)
        except SystemExit as error:  # takes its process along
            future.actor.lost = True
            raise RayError("the worker has died") from error

"""What NAOqi's extractors have in common: they work for their subscribers."""

from __future__ import annotations

from naoqi.errors import RobotError


class FakeSubscriptions:
    """Knows its subscribers.

    Attributes:
        name: Of the module.
        subscribers: Their names.
    """

    name = "ALExtractor"

    def __init__(self):
        self.subscribers = []

    def subscribe(self, name):
        self.subscribers.append(name)

    def unsubscribe(self, name):
        if name not in self.subscribers:
            raise RobotError(self.name, "unsubscribe", f"{name} is not subscribed")
        self.subscribers.remove(name)

    def getSubscribersInfo(self):
        return [[name, 30, 0.0] for name in self.subscribers]

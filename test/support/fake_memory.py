"""ALMemory with data and events, and a topic that keeps what it is given."""

from __future__ import annotations

from types import SimpleNamespace

from fake_robot import FakeSignal


class Memory:
    """ALMemory. A key is told when it is new, as on a robot.

    Attributes:
        values: Key -> value.
        events: Names of the events among them, with or without a value.
        asked: How many keys each question was for.
    """

    def __init__(self, values=(), events=()):
        self.values = dict(values)
        self.events = set(events)
        self.signals = {}
        self.asked = []

    def subscriber(self, name):
        return SimpleNamespace(signal=self.signals.setdefault(name, FakeSignal()))

    def listeners(self, name):
        return len(self.signals.get(name, ()))

    def getListData(self, keys):
        self.asked.append(len(keys))
        return [self.values.get(key) for key in keys]

    def getDataListName(self):
        return sorted({*self.values, *self.events})

    def getEventList(self):
        return sorted(self.events)

    def getMicroEventList(self):
        return []

    def insertData(self, key, value):
        new = key not in self.values
        self.values[key] = value
        if new:
            self._tell("ALMemory/KeyAdded", key)

    def insertListData(self, pairs):
        for key, value in pairs:
            self.insertData(key, value)

    def raiseEvent(self, key, value):
        new = key not in self.values
        self.values[key] = value
        self.events.add(key)
        self._tell(key, value)
        if new:
            self._tell("ALMemory/KeyAdded", key)

    def _tell(self, name, value):
        if name in self.signals:
            self.signals[name](value)


class FakeTopic:
    """A topic of one kind; the test says who listens, and takes what comes."""

    def __init__(self, name, kind, tell):
        self.name, self.kind, self.tell = name, kind, tell
        self.messages = []
        self.open = True

    def publish(self, value):
        self.messages.append(value)

    def close(self):
        self.open = False


class Topics:
    """Opens topics and keeps the newest of each name."""

    def __init__(self):
        self.by_name = {}
        self.opened = []

    def make(self, name, kind, tell):
        topic = self.by_name[name] = FakeTopic(name, kind, tell)
        self.opened.append((name, kind))
        return topic

    def __getitem__(self, name):
        return self.by_name[name]

    def __contains__(self, name):
        return name in self.by_name and self.by_name[name].open

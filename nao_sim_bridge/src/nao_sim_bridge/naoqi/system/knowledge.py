"""ALKnowledge of the simulated robot. Only NAOqi methods live here; what it knows is in `knowledge_store`."""

from __future__ import annotations

from contextlib import contextmanager
from datetime import datetime, timezone
from typing import Iterator, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.naoqi.system.knowledge_store import ANY, ASKED, EXPIRATION, HAPPENING, LEARNING, TripleStore
from nao_sim_bridge.naoqi.system.robot_file import RobotFile

FILE = ".local/share/ALKnowledge/knowledge.json"


class ALKnowledge:
    """ALKnowledge as the simulated robot offers it, kept in a file of the robot.

    Triples come and go at their dates, of the clock of the computer: whoever asks finds them in time. Questions
    write no file: what has come or gone is saved with the next change.
    """

    def __init__(self, files: ClientFiles) -> None:
        self._file = RobotFile(files, FILE)
        self._store = self._read()

    def add(self, domain: str, subject: str, predicate: str, object_: str) -> None:
        with self._change() as store:
            store.add(domain, (subject, predicate, object_))

    def update(self, domain: str, subject: str, predicate: str, object_: str) -> None:
        with self._change() as store:
            store.replace(domain, (subject, predicate, object_))

    def remove(self, domain: str, subject: str, predicate: str, object_: str) -> None:
        with self._change() as store:
            store.remove(domain, (subject, predicate, object_))

    def resetKnowledge(self, domain: str) -> None:
        with self._change() as store:
            store.clear(domain)

    def contains(self, domain: str, subject: str, predicate: str, object_: str) -> bool:
        return bool(self._settled().find(domain, (subject, predicate, object_)))

    def getSubject(self, domain: str, predicate: str, object_: str) -> list[str]:
        return self.query(domain, ASKED, predicate, object_)

    def getPredicate(self, domain: str, subject: str, object_: str) -> list[str]:
        return self.query(domain, subject, ASKED, object_)

    def getObject(self, domain: str, subject: str, predicate: str) -> list[str]:
        return self.query(domain, subject, predicate, ASKED)

    def query(self, domain: str, *words: str) -> list[str]:
        """What may stand for the "?" among subject, predicate, object, and name and value of metadata if given."""
        if words.count(ASKED) != 1:
            raise BadValue("query", list(words), f"one {ASKED} for what is asked for")
        pattern = [ANY if word == ASKED else word for word in words]
        rows = self._rows(domain, pattern) if len(words) == 3 else self._rows_with_data(domain, pattern, True)
        return list(dict.fromkeys(row[words.index(ASKED)] for row in rows))

    def queryTriplet(self, domain: str, *words: str) -> list[list[str]]:
        """[[domain, subject, predicate, object], ...]."""
        pattern = [ANY if word == ASKED else word for word in words]
        if len(words) == 3:
            return [[domain, *row] for row in self._rows(domain, pattern)]
        rows = self._rows_with_data(domain, pattern, True)
        return [[domain, *triple] for triple in dict.fromkeys(tuple(row[:3]) for row in rows)]

    # --- metadata -----------------------------------------------------------------------------------------------------

    def addMetadata(self, domain: str, subject: str, predicate: str, object_: str, name: str, value: str) -> bool:
        return self._add_data(domain, (subject, predicate, object_), name, value, keep=True)

    def updateMetadata(self, domain: str, subject: str, predicate: str, object_: str, name: str, value: str) -> bool:
        return self._add_data(domain, (subject, predicate, object_), name, value, keep=False)

    def containsMetadata(self, domain: str, subject: str, predicate: str, object_: str, name: str, value: str) -> bool:
        return bool(self._settled().find_data(domain, (subject, predicate, object_), name, value))

    def removeMetadata(self, domain: str, subject: str, predicate: str, object_: str, name: str, value: str) -> bool:
        if domain != LEARNING:
            return False
        with self._change() as store:
            store.remove_data(domain, (subject, predicate, object_), name, value)
        return True

    def queryMetadata(self, domain: str, subject: str, predicate: str, object_: str, name: str, *_asked: str) -> list:
        found = self._settled().find_data(domain, (subject, predicate, object_), name, ANY)
        return list(dict.fromkeys(value for _, _, value in found))

    def queryTripletWithMetadata(
        self, domain: str, subject: str, predicate: str, object_: str, name: str, value: str, exists: bool
    ) -> list[list[str]]:
        """[[domain, subject, predicate, object, name, value], ...]; also of triples that are gone unless `exists`."""
        return [
            [domain, *row] for row in self._rows_with_data(domain, [subject, predicate, object_, name, value], exists)
        ]

    def getId(self, domain: str, subject: str, predicate: str, object_: str, *_metadata: str) -> str:
        return self._store.id_of(domain, (subject, predicate, object_))

    def getTripletFromId(self, domain: str, triple_id: str) -> list[str]:
        return list(self._settled().of_id(domain, triple_id) or ())

    def addExpirationDate(self, domain: str, subject: str, predicate: str, object_: str, date: str) -> None:
        """The triple is added, too."""
        self._date(domain, (subject, predicate, object_), EXPIRATION, date, keep=True)

    def updateExpirationDate(self, domain: str, subject: str, predicate: str, object_: str, date: str) -> None:
        self._date(domain, (subject, predicate, object_), EXPIRATION, date, keep=False)

    def addHappeningDate(self, domain: str, subject: str, predicate: str, object_: str, date: str) -> None:
        """The triple is added when its time has come."""
        self._date(domain, (subject, predicate, object_), HAPPENING, date, keep=True)

    def updateHappeningDate(self, domain: str, subject: str, predicate: str, object_: str, date: str) -> None:
        self._date(domain, (subject, predicate, object_), HAPPENING, date, keep=False)

    def _add_data(self, domain: str, triple: tuple[str, str, str], name: str, value: str, keep: bool) -> bool:
        if domain != LEARNING:
            return False
        with self._change() as store:
            if not keep:
                store.remove_data(domain, triple, name, ANY)
            store.add_data(domain, triple, name, value)
        return True

    def _date(self, domain: str, triple: tuple[str, str, str], name: str, date: str, keep: bool) -> None:
        with self._change() as store:
            kept = store.date(name, date, durations=name == HAPPENING)
            if not keep:
                store.remove_data(domain, triple, name, ANY)
            store.add_data(domain, triple, name, kept)
            if name == EXPIRATION and keep:
                store.add(domain, triple)

    def _rows(self, domain: str, pattern: Sequence[str]) -> list[tuple[str, ...]]:
        subject, predicate, object_ = pattern
        return list(self._settled().find(domain, (subject, predicate, object_)))

    def _rows_with_data(self, domain: str, pattern: Sequence[str], exists: bool) -> list[tuple[str, ...]]:
        """Subject, predicate, object, name and value of what fits."""
        subject, predicate, object_, name, value = (ANY if word == ASKED else word for word in pattern)
        store = self._settled()
        found = store.find_data(domain, (subject, predicate, object_), name, value)
        return [(*triple, key, word) for triple, key, word in found if not exists or store.find(domain, triple)]

    def _settled(self) -> TripleStore:
        self._store.settle()
        return self._store

    @contextmanager
    def _change(self) -> Iterator[TripleStore]:
        """Something changes: it is in the file before it counts, and nothing has changed when it is refused."""
        store = self._settled()
        try:
            yield store
            self._file.save(store.content())
        except Exception:
            self._store = self._read()
            raise

    def _read(self) -> TripleStore:
        store = TripleStore(lambda: datetime.now(timezone.utc))
        self._file.load(store.restore)
        return store

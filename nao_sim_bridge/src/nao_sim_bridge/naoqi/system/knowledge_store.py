"""What ALKnowledge knows: triples by domain, data about triples, and dates at which triples come and go. No libqi here.

Data about a triple are triples themselves, whose subject is the id of it: they are added, asked for and removed like
others by who has the id. Patterns with a wildcard for the subject do not find them.
"""

from __future__ import annotations

import json
import math
import re
import uuid
from dataclasses import dataclass, field
from datetime import datetime, timedelta, timezone
from typing import Any, Callable, Iterable, Mapping, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.written_numbers import written_number
from nao_sim_bridge.naoqi.binding.errors import NaoqiError

ANY, ASKED = "*", "?"
"""What stands for everything, and for what is asked for."""
LEARNING = "com.aldebaran.learning"
"""The one domain that has data about triples, as NAOqi has it."""
ADDED_DATE, ADDING_COUNT = "addedDate", "addingCount"
EXPIRATION, HAPPENING = DATES = ("expirationDate", "happeningDate")
DATE_FORMAT = "%Y-%m-%dT%H:%M:%SZ"
DATE_WORDS = "a date such as 2030-12-31T23:59:59Z"
LONGEST_PART = 100_000
"""Days, hours, minutes or seconds of a duration."""
_DURATION = re.compile(r"P(?=.)(?:(\d{1,9})D)?(?:T(?=.)(?:(\d{1,9})H)?(?:(\d{1,9})M)?(?:(\d{1,9})S)?)?")
_NAMES = uuid.UUID("1f7a3d0e-5c0b-4b0a-9a53-6d1f7be0a6c2")

Triple = Tuple[str, str, str]


@dataclass
class _Node:
    """A triple that has data, which outlast it: names and values, in the order in which they were added."""

    triple: Triple
    data: dict[tuple[str, str], None] = field(default_factory=dict)

    def values(self, name: str) -> list[str]:
        return [value for key, value in self.data if key == name]

    def drop(self, name: str, value: str) -> None:
        self.data = {pair: None for pair in self.data if not _fits(pair, (name, value))}


@dataclass
class _Domain:
    """Triples in the order in which they were added, and by its id each that has data."""

    triples: dict[Triple, None] = field(default_factory=dict)
    nodes: dict[str, _Node] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.triples) + sum(len(node.data) for node in self.nodes.values())

    def fitting(self, pattern: Triple) -> list[_Node]:
        return [node for node in self.nodes.values() if _fits(node.triple, pattern)]


class TripleStore:
    """Triples by domain; the `clock` says what time it is, with its zone. Not thread-safe."""

    def __init__(self, clock: Callable[[], datetime]) -> None:
        self._clock = clock
        self._domains: dict[str, _Domain] = {}
        self._count = 0  # of triples and data, with those removed since it was counted
        self._due: datetime | None = None  # the first date at which a triple comes or goes

    # --- to and from a file ------------------------------------------------------------------------------------------

    def content(self) -> dict[str, Any]:
        """All of it as JSON has it."""
        return {
            name: {
                "triples": [list(triple) for triple in place.triples],
                "data": [[*node.triple, *pair] for node in place.nodes.values() for pair in node.data],
            }
            for name, place in self._domains.items()
        }

    def restore(self, content: Mapping[str, Any]) -> None:
        """Know what `content` has said, and nothing else.

        Raises:
            ValueError: It is not what `content` says. So do TypeError and LookupError.
        """
        self._domains = {}
        for name, entry in content.items():
            place = self._domains[name] = _Domain()
            place.triples = {(s, p, o): None for s, p, o in _rows(entry["triples"])}
            for s, p, o, key, value in _rows(entry["data"]):
                self._node(name, (s, p, o)).data[key, value] = None
        self._count = sum(map(len, self._domains.values()))
        self._look_for_dates()

    # --- triples -----------------------------------------------------------------------------------------------------

    def add(self, domain: str, triple: Triple, promised: bool = False) -> None:
        """Add a triple, which may be there; in the domain `LEARNING`, when and how often is kept as its data.

        Args:
            promised: Whether it comes also where there are too many: it was taken on before.

        Raises:
            BadValue: It has a wildcard.
            NaoqiError: There would be too many.
        """
        _check(triple)
        place = self._domains.setdefault(domain, _Domain())
        subject, name, value = triple
        if subject in place.nodes:
            self._put(place.nodes[subject].data, (name, value), promised)
            return
        self._put(place.triples, triple, promised)
        if domain == LEARNING:
            node = self._node(domain, triple)
            count = next((written_number(text, math.inf) or 0 for text in node.values(ADDING_COUNT)), 0)
            node.drop(ADDING_COUNT, ANY)
            self._put(node.data, (ADDING_COUNT, str(count + 1)), promised)
            self._put(node.data, (ADDED_DATE, self._clock().astimezone(timezone.utc).strftime(DATE_FORMAT)), promised)

    def replace(self, domain: str, triple: Triple) -> None:
        """Add a triple instead of all of the same subject and predicate."""
        _check(triple)
        self.remove(domain, (triple[0], triple[1], ANY))
        self.add(domain, triple)

    def remove(self, domain: str, pattern: Triple) -> None:
        """Remove what fits; data about it stay, as they tell what was."""
        place = self._place(domain)
        if pattern[0] in place.nodes:
            place.nodes[pattern[0]].drop(pattern[1], pattern[2])
        for triple in self.find(domain, pattern):
            place.triples.pop(triple, None)
        self._look_for_dates()

    def clear(self, domain: str) -> None:
        """Remove a domain with all data."""
        self._domains.pop(domain, None)
        self._look_for_dates()

    def find(self, domain: str, pattern: Triple) -> list[Triple]:
        """All triples that fit, the oldest first."""
        place, key = self._place(domain), pattern[0]
        if key in place.nodes:
            return [(key, *pair) for pair in place.nodes[key].data if _fits(pair, pattern[1:])]
        if ANY not in pattern:
            return [pattern] if pattern in place.triples else []
        return [triple for triple in place.triples if _fits(triple, pattern)]

    # --- data about triples ------------------------------------------------------------------------------------------

    def add_data(self, domain: str, triple: Triple, name: str, value: str) -> None:
        """Add something about a triple, which need not be there.

        Raises:
            NaoqiError: The domain has no data about triples, or there would be too many.
            BadValue: A word is a wildcard.
        """
        if domain != LEARNING:
            raise NaoqiError(f"domain is {domain!r}: only {LEARNING} has metadata")
        _check((*triple, name, value))
        self._domains.setdefault(domain, _Domain())
        self._put(self._node(domain, triple).data, (name, value))
        self._look_for_dates()

    def remove_data(self, domain: str, pattern: Triple, name: str, value: str) -> None:
        """Remove something about all triples that fit, also about those that are gone."""
        for node in self._place(domain).fitting(pattern):
            node.drop(name, value)
        self._look_for_dates()

    def find_data(self, domain: str, pattern: Triple, name: str, value: str) -> list[tuple[Triple, str, str]]:
        """What fits about triples that fit, also about those that are gone: triple, name, value."""
        nodes = self._place(domain).fitting(pattern)
        return [(node.triple, *pair) for node in nodes for pair in node.data if _fits(pair, (name, value))]

    def id_of(self, domain: str, triple: Triple) -> str:
        """The id of a triple, the same in every run."""
        return str(uuid.uuid5(_NAMES, json.dumps([domain, *triple])))

    def of_id(self, domain: str, key: str) -> Triple | None:
        """The triple of an id; None when nothing is known of it."""
        place = self._place(domain)
        if key in place.nodes:
            return place.nodes[key].triple
        return next((triple for triple in place.triples if self.id_of(domain, triple) == key), None)

    # --- dates --------------------------------------------------------------------------------------------------------

    def settle(self) -> bool:
        """Have triples come and go whose date is over; whether one has."""
        now = self._clock()
        if self._due is None or now < self._due:
            return False
        place = self._place(LEARNING)
        for node in list(place.nodes.values()):
            over = {name: [text for text in node.values(name) if _is_over(text, now)] for name in DATES}
            for name, text in ((name, text) for name, texts in over.items() for text in texts):
                node.drop(name, text)
            if over[HAPPENING]:
                self.add(LEARNING, node.triple, promised=True)
            if over[EXPIRATION]:
                place.triples.pop(node.triple, None)
        self._look_for_dates()
        return True

    def date(self, field_name: str, text: str, durations: bool = False) -> str:
        """A date as it is kept; a duration such as PT30M counts from now. A BadValue for another text."""
        if _date(text) is not None:
            return text
        parts = _DURATION.fullmatch(text) if durations else None
        if parts is None:
            words = f"{DATE_WORDS}, or a duration such as P1DT2H30M15S" if durations else DATE_WORDS
            raise BadValue(field_name, text, words)
        days, hours, minutes, seconds = (min(int(part or 0), LONGEST_PART) for part in parts.groups())
        then = self._clock() + timedelta(days=days, hours=hours, minutes=minutes, seconds=seconds)
        return then.astimezone(timezone.utc).strftime(DATE_FORMAT)

    def _look_for_dates(self) -> None:
        nodes = self._place(LEARNING).nodes.values()
        dates = [_date(text) for node in nodes for name in DATES for text in node.values(name)]
        self._due = min((date for date in dates if date is not None), default=None)

    def _place(self, domain: str) -> _Domain:
        return self._domains.get(domain) or _Domain()

    def _node(self, domain: str, triple: Triple) -> _Node:
        return self._domains[domain].nodes.setdefault(self.id_of(domain, triple), _Node(triple))

    def _put(self, where: dict[Any, None], entry: Any, promised: bool = False) -> None:
        most = load_sizes().kept.triples
        if entry in where:
            return
        if not promised and self._count >= most:
            self._count = sum(map(len, self._domains.values()))  # what was removed counts no more
            if self._count >= most:
                raise NaoqiError(f"{most} triples with metadata are known at most: remove, or resetKnowledge, first")
        self._count += 1
        where[entry] = None


def _check(words: Iterable[str]) -> None:
    for field_name, word in zip(("subject", "predicate", "object", "metadataName", "metadataValue"), words):
        if word in (ANY, ASKED):
            raise BadValue(field_name, word, f"something else than {ANY} and {ASKED}, which are for questions")


def _fits(triple: Sequence[str], pattern: Sequence[str]) -> bool:
    return all(wanted in (ANY, word) for word, wanted in zip(triple, pattern))


def _date(text: str) -> datetime | None:
    try:
        return datetime.strptime(text, DATE_FORMAT).replace(tzinfo=timezone.utc)
    except ValueError:
        return None


def _is_over(text: str, now: datetime) -> bool:
    date = _date(text)
    return date is not None and date <= now


def _rows(rows: Any) -> list[list[str]]:
    """Lists of texts as a file has them."""
    if not isinstance(rows, list):
        raise TypeError(f"{type(rows).__name__} instead of a list of triples")
    for row in rows:
        if not isinstance(row, list) or not all(isinstance(word, str) for word in row):
            raise ValueError(f"{row!r} is no list of texts")
    return rows

"""The trace of a plan's run: the tree of its tasks, their times and outcomes; as text and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass

from .short_text import cut, short_numbers, short_repr
from .tasks import Task

MARKS = {
    "created": ".",
    "running": ">",
    "suspended": "=",
    "succeeded": "+",
    "failed": "!",
    "evaporated": "-",
}
LONGEST = 160


@dataclass(frozen=True)
class Record:
    """One task, as it was when the record was taken."""

    number: int  # in the order of creation, from 0
    parent: int | None  # number of the parent task; None at the root
    name: str
    state: str
    created: float  # s since the creation of the root, as `began` and `ended`, which are None until then
    began: float | None
    ended: float | None
    result: str  # as text; empty for none
    failure: str  # class and text of the failure; or why it was evaporated or suspended
    facts: dict[str, str]


@dataclass(frozen=True)
class Trace:
    """All tasks of a tree, parents before their children."""

    records: tuple[Record, ...]

    def children(self, number: int | None) -> list[Record]:
        return [record for record in self.records if record.parent == number]

    def named(self, name: str) -> list[Record]:
        return [record for record in self.records if record.name == name]

    def __str__(self) -> str:
        """The tree as text, one line per task."""
        return "\n".join(
            f"{'  ' * depth}{MARKS[record.state]} {record.name}{_details(record)}" for record, depth in self.walk()
        )

    def walk(self, parent: int | None = None, depth: int = 0) -> Iterator[tuple[Record, int]]:
        """The tasks in the order of the tree, each with its depth."""
        for record in self.children(parent):
            yield record, depth
            yield from self.walk(record.number, depth + 1)

    def to_json(self) -> str:
        """The tree as JSON: {"tasks": [...]}, with a `Record` each."""
        return json.dumps({"tasks": [asdict(record) for record in self.records]}, indent=1)

    @staticmethod
    def from_json(text: str) -> Trace:
        return Trace(tuple(Record(**entry) for entry in json.loads(text)["tasks"]))


def trace_of(root: Task) -> Trace:
    """The trace of a tree, from any thread, during the run or afterwards."""
    with root.tree.lock:
        tasks = list(root)
        return Trace(tuple(_record(task, root.created) for task in tasks))


def _record(task: Task, start: float) -> Record:
    """The record of one task; times count from `start`, s."""
    failure = ""
    if task.failure is not None:
        failure = f"{type(task.failure).__name__}: {task.failure}"
    elif task.state.value in ("evaporated", "suspended"):
        failure = task.reason
    return Record(
        number=task.number,
        parent=task.parent.number if task.parent is not None else None,
        name=task.name,
        state=task.state.value,
        created=round(task.created - start, 6),
        began=_since(task.began, start),
        ended=_since(task.ended, start),
        result=short_repr(task.result, LONGEST) if task.result is not None else "",
        failure=cut(short_numbers(failure), LONGEST),
        facts={name: cut(fact if isinstance(fact, str) else repr(fact), LONGEST) for name, fact in task.facts.items()},
    )


def _details(record: Record) -> str:
    parts = []
    if "arguments" in record.facts:
        parts.append(f"({record.facts['arguments']})")
    if record.began is not None and record.ended is not None:
        parts.append(f"{record.began:.3f} s + {record.ended - record.began:.3f} s")
    if record.result:
        parts.append(f"-> {record.result}")
    if record.failure:
        parts.append(record.failure)
    return "".join(f"  {part}" for part in parts)


def _since(time: float | None, start: float) -> float | None:
    return None if time is None else round(time - start, 6)

"""What steps have to do with each other within a file: labels, times, barriers. No ROS."""

from __future__ import annotations

from collections.abc import Iterator

from ...base.suggestion import did_you_mean
from .errors import Problem
from .model import Barrier, Behavior, Parallel, PathParts, Repeat, Step, Timeline, path_text


def structure_problems(behavior: Behavior) -> list[Problem]:
    """What is wrong with labels, times and barriers of a behaviour; nothing that a step not read whole may cause."""
    return [*_labels(behavior), *_times(behavior.body), *_barriers(behavior.body, None)]


def walk(step: Step) -> Iterator[Step]:
    """A step and all inside of it, in the order of the file."""
    yield step
    for part in step.parts:
        yield from walk(part)


def name_on_timeline(step: Step) -> str:
    """What times may refer to: the label of an entry, the name of a barrier."""
    return step.name if isinstance(step, Barrier) else step.label


def barriers_in(step: Step) -> tuple[str, ...]:
    """Names of the barriers at which a branch of a parallel waits for other branches, in order."""
    if isinstance(step, Barrier):
        return (step.name,)
    if isinstance(step, (Parallel, Timeline)):
        return ()  # those inside are its own
    return tuple(name for part in step.parts for name in barriers_in(part))


def _labels(behavior: Behavior) -> Iterator[Problem]:
    seen: dict[str, Step] = {}
    for step in walk(behavior.body):
        if step.label in seen and step.label:
            first = path_text(seen[step.label].path)
            yield _problem(step, f"the label {step.label!r} is taken by step {first}")
        seen.setdefault(step.label, step)


def _times(step: Step) -> Iterator[Problem]:
    if isinstance(step, Timeline):
        yield from _times_of(step)
    for part in step.parts:
        yield from _times(part)


def _times_of(timeline: Timeline) -> Iterator[Problem]:
    entries: dict[str, Step] = {}
    for entry in timeline.steps:
        name = name_on_timeline(entry)
        if name and name in entries:
            yield _problem(entry, f"{name!r} is there already on this timeline")
        elif name:
            entries[name] = entry
    after: dict[PathParts, list[PathParts]] = {}
    for i, entry in enumerate(timeline.steps):
        after[entry.path] = [each.path for each in timeline.steps[:i]] if isinstance(entry, Barrier) else []
        if isinstance(entry, Barrier) and not i:
            yield _problem(entry, "nothing is above the barrier, and it would wait for nothing")
        name = entry.at.label if entry.at is not None else ""
        if not name:
            continue
        if name in entries:
            after[entry.path].append(entries[name].path)
        elif all(each.whole for each in timeline.steps):
            known = f"there are {', '.join(entries)}" if entries else "none of its entries has a label"
            hint = did_you_mean(name, entries)
            yield _problem(entry, f"at: there is no label {name!r} on this timeline{hint}; {known}")
    ready: set[PathParts] = set()
    while len(ready) < len(after):
        newly = {path for path in after if path not in ready and ready.issuperset(after[path])}
        if not newly:
            circle = [entry for entry in timeline.steps if entry.path not in ready]
            names = ", ".join(path_text(entry.path) for entry in circle)
            yield _problem(circle[0], f"steps {names} wait for each other")
            return
        ready |= newly


def _barriers(step: Step, home: Step | None) -> Iterator[Problem]:
    """Barriers have a meaning on timelines and in branches of a parallel, and there every branch meets them once.

    `step`: where to look. `home`: the parallel that barriers inside belong to.
    """
    if isinstance(step, Parallel):
        if all(each.whole for branch in step.steps for each in walk(branch)):
            yield from _orders(step, [barriers_in(branch) for branch in step.steps])
        home = step
    elif isinstance(step, Repeat):
        home = None
    for part in step.parts:
        if isinstance(part, Barrier):
            if home is None and not isinstance(step, Timeline):
                yield _problem(
                    part, "a barrier stands on a timeline, or in branches of a parallel and in no repetition"
                )
        elif isinstance(step, Timeline):
            yield from _barriers(part, None)
        else:
            yield from _barriers(part, home)


def _orders(parallel: Parallel, orders: list[tuple[str, ...]]) -> Iterator[Problem]:
    branches_of: dict[str, int] = {}
    for names in orders:
        for name in names:
            if names.count(name) > 1:
                yield _problem(parallel, f"a branch comes to the barrier {name!r} twice")
                return
            branches_of[name] = branches_of.get(name, 0) + 1
    for name, count in branches_of.items():
        if count == 1:
            yield _problem(parallel, f"only one branch comes to the barrier {name!r}: it would wait for nobody")
    # Two branches that come to the same barriers in another order wait for each other for ever; so do longer circles.
    open_orders = [list(names) for names in orders]
    while any(open_orders):
        heads = [names[0] for names in open_orders if names]
        met = next((name for name in heads if heads.count(name) == sum(name in names for names in open_orders)), None)
        if met is None:
            yield _problem(parallel, f"its branches come to the barriers {', '.join(dict.fromkeys(heads))} in circles")
            return
        open_orders = [names[1:] if names[:1] == [met] else names for names in open_orders]


def _problem(step: Step, text: str) -> Problem:
    return Problem(f"step {path_text(step.path)}" if step.path else "do", text, step.line)

"""Check a protocol: conditions that are always true or never, and commands that the robot would refuse."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..behaviors.behavior_errors import Problem
from ..behaviors.parameters import text_of
from ..core.errors import of_those
from .command_check import SERVICE, CommandCheck
from .protocol import (
    COUNTED,
    DONE,
    NOTHING,
    ORDERED,
    BranchStep,
    ChoiceStep,
    CommandStep,
    ProtocolStep,
    RoundsStep,
    SenseStep,
    StudyCondition,
    StudyProtocol,
    UntilStep,
    WhileStep,
    number_of,
)
from .schedule import all_steps, conditions_of, order_of, steps_in

MOST_COMBINED = 4096
"""Combinations of values that are looked at of a condition on several names."""


@dataclass(frozen=True)
class Domain:
    """What a value can be.

    Attributes:
        words: All that it can be, or what it can be beside a number.
        low, high: Of the number that it can be; None: it is none.
        whole: Whether that is a whole number.
        joined: Whether several words at once are an answer, too, as "front head, rear head".
        known: Whether anything is known of it.
        source: What it is, for people.
    """

    words: tuple[str, ...] = ()
    low: float | None = None
    high: float = math.inf
    whole: bool = False
    joined: bool = False
    known: bool = True
    source: str = ""

    def samples(self, compared: str) -> list[Any]:
        """Values that stand for all in a comparison with a word or a number."""
        found: list[Any] = list(self.words)
        parts = compared.split(", ")
        if self.joined and len(parts) > 1 and all(part in self.words for part in parts):
            found.append(compared)
        if self.low is not None:
            step = 1.0 if self.whole else 1e-6
            middle = number_of(compared)
            near = [] if middle is None else [middle - step, middle, middle + step]
            ends = [each for each in (self.low, self.high) if math.isfinite(each)]
            numbers = [*ends, *near, *([] if ends or near else [0.0])]
            found += [
                each
                for each in numbers
                if self.low <= each <= self.high and (not self.whole or float(each).is_integer())
            ]
            found += [each for each in (self.low, self.high) if math.isinf(each)]
        return found

    def __str__(self) -> str:
        parts = list(self.words)
        if self.low is not None:
            number = "a whole number" if self.whole else "a number"
            span = "" if math.isinf(self.low) else f" from {self.low:g}"
            span += "" if math.isinf(self.high) else f" to {self.high:g}"
            parts = [number + span, *parts]
        return " or ".join(filter(None, (", ".join(parts[:-1]), parts[-1] if parts else NOTHING)))


ANYTHING = Domain(known=False)


def impossible_conditions(protocol: StudyProtocol) -> list[Problem]:
    """What is wrong with the conditions of a protocol, in the order of the file."""
    return list(dict.fromkeys(_Look(protocol).problems()))


class _Look:
    """Walks through the steps, and knows of each which answers there can be before it."""

    def __init__(self, protocol: StudyProtocol) -> None:
        self._protocol = protocol
        count = len(order_of(protocol, 1))
        self._always: dict[str, Domain] = {
            "participant": ANYTHING,
            "number": Domain(low=1, whole=True, source="the participant's number"),
            "trial": Domain(low=1, high=count, whole=True, source="which of the participant's trials it is"),
            "trials": Domain((str(count),), source="how many trials a participant has"),
            **{name: ANYTHING for name in protocol.values},
        }
        for factor in protocol.factors:
            self._always[factor.name] = Domain(tuple(factor.levels), source=f"the level of {factor.name}")
            for name in next(iter(factor.levels.values())):
                values = tuple(dict.fromkeys(text_of(level.get(name, "")) for level in factor.levels.values()))
                given = any("{" in value for value in values)
                self._always[name] = (
                    ANYTHING if given else Domain(values, source=f"a value of the levels of {factor.name}")
                )
        self._labelled: dict[str, list[ProtocolStep]] = {}
        for phase in protocol.phases:
            for step in steps_in(phase.steps):
                if step.label:
                    self._labelled.setdefault(step.label, []).append(step)

    def problems(self) -> Iterator[Problem]:
        known: frozenset[str] = frozenset()
        for i, phase in enumerate(self._protocol.phases, 1):
            known = yield from self._steps(phase.steps, str(i), known, {})

    def _steps(
        self, steps: Sequence[ProtocolStep], prefix: str, known: frozenset[str], rounds: Mapping[str, int]
    ) -> Iterator[Any]:
        """Problems in steps; returns labels that may have an answer behind them, `known` those before."""
        for i, step in enumerate(steps, 1):
            path = f"{prefix}.{i}"
            if isinstance(step, BranchStep):
                after = known
                for number, (conditions, inner) in enumerate(step.branches, 1):
                    yield from self._conditions(conditions, path, known, rounds)
                    after |= yield from self._steps(inner, f"{path}.b{number}", known, rounds)
                known = after
            elif isinstance(step, RoundsStep):
                before = known | _labels(step.steps) if step.count > 1 else known
                more = {**rounds, **({step.name: step.count} if step.name else {})}
                known = yield from self._steps(step.steps, f"{path}.r1", before, more)
            elif isinstance(step, WhileStep):
                for each in step.waits:
                    yield from self._wait(each, path, known, rounds)
                before = known | _labels(step.steps) if step.rounds != 1 else known
                known = yield from self._steps(step.steps, f"{path}.w1", before, rounds)
            else:
                yield from self._wait(step, path, known, rounds)
            if step.label:
                known |= {step.label}
        return known

    def _wait(
        self, step: ProtocolStep, path: str, known: frozenset[str], rounds: Mapping[str, int]
    ) -> Iterator[Problem]:
        since = getattr(step, "since", "")
        if since in self._labelled and since not in known:
            line = self._labelled[since][0].line
            yield Problem(
                f"step {path}", f"since: {since} has not been done here: it is the step in line {line}", step.line
            )
        if not isinstance(step, UntilStep):
            return
        live = {name: Domain(low=0, whole=True, source=f"how many {name} there were") for name in COUNTED.values()}
        live["seconds"] = Domain(low=0, source="the time since the step began, s")
        problems = list(self._conditions(step.conditions, path, known, rounds, live))
        yield from problems
        counted = [each for each in step.conditions if set(each.names()) & {*live}]
        if (
            not problems
            and counted == [*step.conditions]
            and all(each.holds(dict.fromkeys(live, 0)) for each in counted)
        ):
            text = f"{' and '.join(map(str, counted))} is true as soon as the step begins, where all counts are 0"
            yield Problem(f"step {path}", f"{text}: it would not wait", counted[0].line or step.line)

    def _conditions(
        self,
        conditions: Sequence[StudyCondition],
        path: str,
        known: frozenset[str],
        rounds: Mapping[str, int],
        live: Mapping[str, Domain] | None = None,
    ) -> Iterator[Problem]:
        found = []
        for condition in conditions:
            domains = {name: (live or {}).get(name) or self._domain(name, known, rounds) for name in condition.names()}
            found.append(domains)
            text = self._impossible(condition, domains, known)
            if text:
                yield Problem(f"step {path}", text, condition.line)
                return
        for left in {condition.left: None for condition in conditions}:
            same = [condition for condition in conditions if condition.left == left and not _compared_names(condition)]
            if len(same) > 1 and same[0].names() == [left]:
                domain = found[conditions.index(same[0])][left]
                samples = [each for condition in same for each in domain.samples(condition.right)]
                if domain.known and not any(all(each.holds({left: value}) for each in same) for value in samples):
                    text = (
                        f"{' and '.join(map(str, same))} are never true together: all conditions of a list have to hold"
                    )
                    yield Problem(f"step {path}", text, same[-1].line)

    def _impossible(self, condition: StudyCondition, domains: Mapping[str, Domain], known: frozenset[str]) -> str:
        """What is to be told of a condition that is always true, or never; empty if it is neither."""
        if not domains or not all(domain.known for domain in domains.values()):
            return self._wrong_done(condition, domains)
        samples = [domain.samples(condition.right) for domain in domains.values()]
        simple = list(domains) == [condition.left]
        finite = all(domain.low is None for domain in domains.values())
        if not (simple or finite) or math.prod(map(len, samples)) > MOST_COMBINED:
            return ""
        results = {condition.holds(dict(zip(domains, values))) for values in itertools.product(*samples)}
        if len(results) != 1:
            return ""
        return self._told(condition, domains, results == {True}, known)

    def _told(
        self, condition: StudyCondition, domains: Mapping[str, Domain], always: bool, known: frozenset[str]
    ) -> str:
        name = next(iter(domains))
        steps = self._labelled.get(name) or self._labelled.get(name[: -len("_seconds")], [])
        label = steps[0].label if steps else ""
        verdict = "always" if always else "never"
        if label and label not in known:
            where = f"step in line {steps[0].line}"
            text = f"{condition} is {verdict} true: {name} has no answer here, as it is given by the {where}"
            return f"{text}; an answer that was not given is {NOTHING}"
        domain = domains[name]
        if (
            list(domains) == [condition.left]
            and condition.operation in ("==", "!=")
            and domain.words != (NOTHING,)
            and domain.low is None
        ):
            wrong = [word for word in condition.right.split(", ") if word not in domain.words] or [condition.right]
            if wrong[0] not in domain.words:
                return f"{name} is never {wrong[0]!r}{of_those(wrong[0], domain.words)}"
        text = f"{condition} is {verdict} true: {name}, {domain.source}, is {domain}"
        if condition.operation in ORDERED and domain.low is None and not any(map(_is_number, domain.words)):
            text += f"; {condition.operation} compares numbers"
            if any(isinstance(step, (SenseStep, WhileStep)) for step in steps):
                text += (
                    f". {name} != {NOTHING} is true where there was one; {{wait: until, until: touches >= 1}} counts"
                )
        return text

    def _wrong_done(self, condition: StudyCondition, domains: Mapping[str, Domain]) -> str:
        """Of an answer of a function of which nothing else is known."""
        steps = self._labelled.get(condition.left, [])
        asks = steps and all(isinstance(step, CommandStep) and step.asks for step in steps)
        if asks and condition.right == DONE and len(domains) == 1:
            return f"{condition.left} is never {DONE!r}: it is what the function answers, or {NOTHING}"
        return ""

    def _domain(self, name: str, known: frozenset[str], rounds: Mapping[str, int]) -> Domain:
        if name in rounds:
            return Domain(low=1, high=rounds[name], whole=True, source="the number of the round")
        if name in self._always:
            return self._always[name]
        timed = name not in self._labelled and name.endswith("_seconds")
        label = name[: -len("_seconds")] if timed else name
        steps = self._labelled.get(label, [])
        if not steps:
            return Domain((NOTHING,), source="the number of a round, outside of its repeat")
        if label not in known:
            return Domain((NOTHING,), source="an answer that was not given")
        if timed:
            measured = [step for step in steps if not isinstance(step, CommandStep)]
            early = [step for step in measured if not isinstance(step, (ChoiceStep, UntilStep))]
            low = None if not measured else -math.inf if early else 0.0
            return Domain((NOTHING,), low=low, source=f"the reaction time of {label}, s")
        if not all(step.answers for step in steps):
            return ANYTHING
        words = tuple(dict.fromkeys(answer for step in steps for answer in step.answers))
        joined = any(_is_touch(each) for step in steps for each in getattr(step, "waits", (step,)))
        return Domain(words, joined=joined, source=f"the answer of {steps[0].text!r}")


def _is_number(word: str) -> bool:
    return number_of(word) is not None


def _is_touch(step: ProtocolStep) -> bool:
    return isinstance(step, SenseStep) and step.sense == "touch"


def _compared_names(condition: StudyCondition) -> bool:
    return "{" in condition.right


def _labels(steps: Iterable[ProtocolStep]) -> frozenset[str]:
    return frozenset(step.label for step in steps_in(steps) if step.label)


class ProtocolCheck:
    """Checks protocols. `check`: of their commands."""

    def __init__(self, check: CommandCheck) -> None:
        self._check = check

    def problems(self, protocol: StudyProtocol) -> list[Problem]:
        """What the robot would refuse, in the order of the file; each step in all conditions."""
        found: dict[Problem, None] = {}
        for path, step in all_steps(protocol):
            if isinstance(step, CommandStep):
                for values in _all_values(protocol):
                    for text in self._check.problems(step.command.filled(values)):
                        found[Problem(f"step {path}", text, step.line)] = None
        return list(found)


def checked_for(robot: Any, protocol: StudyProtocol) -> list[Problem]:
    """What a robot would refuse; calls services, so not for the event loop. `robot`: a `RobotClient`."""
    from nao_library_msgs.srv import ListBehaviors

    ask = partial(robot.call, SERVICE, ListBehaviors)
    return ProtocolCheck(CommandCheck(robot.describe, robot.servers, ask)).problems(protocol)


def _all_values(protocol: StudyProtocol) -> Iterator[Mapping[str, str]]:
    """Values of texts in each condition that there is."""
    for between in conditions_of(protocol, within=False):
        for within in conditions_of(protocol, within=True):
            values = protocol.values_in({**between, **within})
            yield {name: text_of(value) for name, value in values.items()}

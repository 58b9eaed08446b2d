"""From the text of a file to a behaviour: its keys, parameters and steps, and how steps fit together. No ROS."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, Callable

from ..core.errors import BadGoal, did_you_mean
from ..core.fields import UNUSUAL, FailurePolicy
from .behavior_errors import BehaviorError, Problem
from .model import (
    LABEL,
    Barrier,
    Behavior,
    Box,
    Functions,
    Parallel,
    PathParts,
    Race,
    Repeat,
    Sequence,
    Step,
    Timeline,
    Unreadable,
    Wait,
    at_of,
    child,
    path_text,
)
from .parameters import IDENTIFIER, LIST, NUMBER, UNKNOWN, Parameter, kind_of, names_in, text_of
from .strict_yaml import line_in, line_of, load

# --- labels, times, barriers ------------------------------------------------------------------------------------------


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


# --- steps ------------------------------------------------------------------------------------------------------------

COMMON = ("label", "on_error", "for", UNUSUAL)
KINDS = ("SERVER.FUNCTION", "parallel", "race", "timeline", "behavior", "chain", "wait", "repeat", "do", "barrier")
FURTHER = {"behavior": ("parameters",), "repeat": ("do", "as")}
"""Keys that a kind has beside its own."""
_GROUPS = {"parallel": Parallel, "race": Race, "timeline": Timeline, "do": Sequence}
"""Kinds that hold nothing but a list of steps."""
_LABEL = re.compile(LABEL)
_FUNCTION = re.compile(rf"({IDENTIFIER.pattern})\.({IDENTIFIER.pattern})")


class StepReader:
    """Reads steps, and notes what is wrong with them. `parameters`: names that `${}` may use."""

    def __init__(self, parameters: Mapping[str, Any], problems: list[Problem]) -> None:
        self._names = dict.fromkeys(parameters)
        self._problems = problems
        self._here = ("", 0)
        self._kinds: dict[str, Callable[[Any, dict[Any, Any], dict[str, Any]], Step]] = {
            "wait": self._wait,
            "behavior": self._box,
            "chain": self._chain,
            "repeat": self._repeat,
            "barrier": self._barrier,
        }

    def steps(self, content: list[Any], path: PathParts, separator: str = ".", timed: bool = False) -> tuple[Step, ...]:
        """The steps of a list. What cannot be read is noted, and nothing is known of it.

        `separator`: between that path and their numbers. `timed`: whether they are entries of a timeline.
        """
        steps = []
        for number, each in enumerate(content, start=1):
            where = child(path, number, separator)
            try:
                steps.append(self._step(each, where, timed))
            except BadGoal as error:
                line = line_of(each) or line_in(content, number - 1)
                self._problems.append(Problem(f"step {path_text(where)}", str(error), line))
                steps.append(Unreadable(where, line))
        return tuple(steps)

    def _step(self, content: Any, path: PathParts, timed: bool) -> Step:
        if isinstance(content, list):
            if not content:
                raise BadGoal("step", content, "at least one step", "the sequence is empty")
            return Sequence(path, steps=self.steps(content, path))
        if not isinstance(content, dict):
            raise BadGoal("step", content, f"a mapping with one of {', '.join(KINDS)}, or a list of steps")
        self._here = (path_text(path), line_of(content))
        kind = self._kind(content)
        allowed = (*COMMON, *FURTHER.get(kind, ()), *(("at",) if timed else ()))
        for key in content:
            if key != kind and key not in allowed:
                problem = f"unknown key {key!r}{did_you_mean(str(key), allowed)}"
                if key == "at":
                    problem = "'at' is for entries of a timeline"
                raise BadGoal(str(key), content[key], f"beside {kind} there may be {', '.join(allowed)}", problem)
        common: dict[str, Any] = {"path": path, "line": line_of(content), "label": self._label(content)}
        common["policy"] = self._policy(content)
        if "for" in content:
            common["limit"] = self._number("for", content["for"], "s")
        common["unusual"] = content.get(UNUSUAL, False)
        if not isinstance(common["unusual"], bool):
            raise BadGoal(UNUSUAL, common["unusual"], "true or false")
        if timed:
            common["at"] = at_of(content.get("at", 0.0))
            if not self._known_names("at", common["at"].offset):
                common["at"] = replace(common["at"], offset=UNKNOWN)
        if kind in _GROUPS:
            return _GROUPS[kind](**common, steps=self._list(kind, content[kind], path, timed=kind == "timeline"))
        if kind in self._kinds:
            return self._kinds[kind](content[kind], content, common)
        return self._function(kind, content[kind], common)

    def _kind(self, content: dict[Any, Any]) -> str:
        kinds = [key for key in content if key in KINDS or (isinstance(key, str) and "." in key)]
        if "repeat" in kinds and "do" in kinds:
            kinds.remove("do")
        if len(kinds) == 1:
            return kinds[0]
        if kinds:
            raise BadGoal("step", kinds, "one a step", f"it is several things at once: {', '.join(kinds)}")
        unknown = [str(key) for key in content if key not in COMMON]
        hint = did_you_mean(unknown[0], KINDS) if unknown else ""
        problem = f"it does not say what to do: {', '.join(unknown) or 'nothing'}{hint}"
        raise BadGoal("step", unknown, f"one of {', '.join(KINDS)}", problem)

    # --- kinds --------------------------------------------------------------------------------------------------------

    def _function(self, kind: str, fields: Any, common: dict[str, Any]) -> Step:
        match = _FUNCTION.fullmatch(kind)
        if match is None:
            raise BadGoal("step", kind, "SERVER.FUNCTION, as NaoMotion.goToPosture")
        return Functions(**common, server=match[1], functions=(self._fields(kind, fields, match[2]),))

    def _chain(self, value: Any, _content: dict[Any, Any], common: dict[str, Any]) -> Step:
        allowed = "{SERVER: [{function: NAME, ...}, ...]}"
        if not isinstance(value, dict) or len(value) != 1:
            raise BadGoal("chain", value, allowed)
        ((server, functions),) = value.items()
        if not isinstance(server, str) or not isinstance(functions, list) or not functions:
            raise BadGoal("chain", value, allowed)
        read = []
        for i, fields in enumerate(functions, start=1):
            if not isinstance(fields, dict) or not isinstance(fields.get("function"), str):
                raise BadGoal("chain", fields, "{function: NAME, ...}", f"function {i} has no name")
            others = {key: each for key, each in fields.items() if key != "function"}
            read.append(self._fields(f"chain: function {i}", others, fields["function"]))
        return Functions(**common, server=server, functions=tuple(read), chained=True)

    def _fields(self, where: str, fields: Any, function: str) -> dict[str, Any]:
        if fields is None:
            fields = {}
        if not isinstance(fields, dict):
            raise BadGoal(where, fields, "{FIELD: VALUE, ...} with fields of its function message")
        if "function" in fields:
            raise BadGoal(f"{where}: function", fields["function"], "no field 'function'", "the key names it already")
        read = {name: value if self._known_names(name, value) else UNKNOWN for name, value in fields.items()}
        return {"function": function, **read}

    def _wait(self, value: Any, _content: dict[Any, Any], common: dict[str, Any]) -> Step:
        return Wait(**common, duration=self._number("wait", value, "s"))

    def _barrier(self, value: Any, content: dict[Any, Any], common: dict[str, Any]) -> Step:
        if not isinstance(value, str) or not _LABEL.fullmatch(value):
            raise BadGoal("barrier", value, "a name: letters, digits, '_' and '-', the first a letter or '_'")
        for key in ("label", "at", "on_error"):
            if key in content:
                raise BadGoal(key, content[key], "nothing", f"a barrier has no {key!r}")
        return Barrier(**common, name=value)

    def _repeat(self, value: Any, content: dict[Any, Any], common: dict[str, Any]) -> Step:
        count = self._number("repeat", value, "rounds")
        variable = content.get("as", "")
        if "as" in content and not (isinstance(variable, str) and IDENTIFIER.fullmatch(variable)):
            raise BadGoal("as", variable, "a name: letters, digits and '_', the first no digit")
        if variable in self._names:
            raise BadGoal("as", variable, "a name that nothing else has", f"there is a {variable!r} already")
        if variable:
            self._names[variable] = None
        try:
            steps = self._list("do", content.get("do"), common["path"])
        finally:
            self._names.pop(variable, None)
        return Repeat(**common, count=count, variable=variable, steps=steps)

    def _box(self, value: Any, content: dict[Any, Any], common: dict[str, Any]) -> Step:
        if not isinstance(value, str):
            raise BadGoal("behavior", value, "the name of a behavior")
        given = content.get("parameters") or {}
        if not isinstance(given, dict) or not all(isinstance(name, str) for name in given):
            raise BadGoal("parameters", given, "{NAME: VALUE, ...}")
        read = {name: each if self._known_names(name, each) else UNKNOWN for name, each in given.items()}
        return Box(**common, name=value, arguments=read)

    # --- values -------------------------------------------------------------------------------------------------------

    def _list(self, key: str, value: Any, path: PathParts, timed: bool = False) -> tuple[Step, ...]:
        if not isinstance(value, list) or not value:
            raise BadGoal(key, value, "a list of steps, with at least one")
        return self.steps(value, path, timed=timed)

    def _label(self, content: dict[Any, Any]) -> str:
        label = content.get("label", "")
        if label != "" and (not isinstance(label, str) or not _LABEL.fullmatch(label)):
            raise BadGoal("label", label, "letters, digits, '_' and '-', the first a letter or '_'")
        return label

    @staticmethod
    def _policy(content: dict[Any, Any]) -> FailurePolicy:
        value = content.get("on_error", "")
        if not isinstance(value, str):
            raise BadGoal("on_error", value, "stop, skip, retry N or retry N skip")
        return FailurePolicy.of(value)

    def _number(self, key: str, value: Any, unit: str) -> Any:
        """A number of 0 or more, or an expression that will be one."""
        if isinstance(value, str) and value.strip().startswith("${"):
            return value.strip() if self._known_names(key, value) else UNKNOWN
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0.0 <= value < 1e9:
            raise BadGoal(key, value, f"{unit}, a number of 0 or more")
        return value

    def _known_names(self, where: str, value: Any) -> bool:
        """Whether all names in a value are known; those that are not are noted, and so is what cannot be read."""
        wrong: list[BadGoal] = []
        try:
            for name in names_in(value):
                if name not in self._names:
                    known = f"there are {', '.join(self._names)}" if self._names else "the behavior has none"
                    problem = f"there is no parameter {name!r}{did_you_mean(name, self._names)}"
                    wrong.append(BadGoal(where, "${" + name + "}", known, problem))
        except BadGoal as error:
            wrong.append(error)
        path, line = self._here
        self._problems.extend(Problem(f"step {path}", str(error), line) for error in wrong)
        return not wrong


# --- files ------------------------------------------------------------------------------------------------------------

NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,99}")
NAME_ALLOWED = "letters, digits, '_' and '-', at most 100, no '-' in front"
KEYS = ("help", "tags", "parameters", "do")
PARAMETER_KEYS = ("default", "help", "choices", "min", "max", "unit")


def read(text: str, name: str, file: str = "") -> Behavior:
    """Read a behaviour. Nothing is known here of servers, functions, fields and other behaviours: see `check`.

    `text`: YAML, see docs/behaviors.md. `file`: path of the file that the text is from, for errors. Raises
    BehaviorError with everything that is wrong, and the behaviour as far as it could be read.
    """
    problems: list[Problem] = []
    behavior = None
    try:
        behavior = _behavior(load(text, name), name, problems)
    except BehaviorError as error:
        problems += error.problems
    if behavior is not None:
        behavior = replace(behavior, file=file)
        problems += structure_problems(behavior)
    if problems or behavior is None:
        raise BehaviorError(name, [replace(problem, file=file) for problem in problems], behavior)
    return behavior


def require_name(name: str, field: str = "str_param") -> str:
    """A name that a behaviour may have: it stays inside its folder. Raises BadGoal if it will not do."""
    if not NAME.fullmatch(name):
        raise BadGoal(field, name, NAME_ALLOWED, problem=f"{name[:120]!r} is no name for a behavior")
    return name


def _behavior(content: Any, name: str, problems: list[Problem]) -> Behavior | None:
    if not isinstance(content, dict):
        problems.append(Problem("", f"it is no mapping: the keys are {', '.join(KEYS)}", 1))
        return None
    for key in content:
        if key not in KEYS:
            hint = did_you_mean(str(key), KEYS)
            told = f"unknown key {key!r}{hint}; known are {', '.join(KEYS)}"
            problems.append(Problem("", told, line_in(content, key)))
    text = content.get("help")
    if not isinstance(text, str) or not text.strip():
        line = line_in(content, "help") or 1
        problems.append(Problem("help", "a line is needed that tells what it does", line))
    tags = content.get("tags", [])
    if not isinstance(tags, list) or not all(isinstance(tag, str) for tag in tags):
        problems.append(Problem("tags", f"{tags!r} is no list of texts", line_in(content, "tags")))
        tags = []
    parameters = _parameters(content.get("parameters"), line_in(content, "parameters"), problems)
    if not isinstance(content.get("do"), list) or not content["do"]:
        line = line_in(content, "do") or 1
        problems.append(Problem("do", "a list of steps is needed, with at least one", line))
        return None
    steps = StepReader(parameters, problems).steps(content["do"], ())
    one_line = " ".join(text.split()) if isinstance(text, str) else ""
    return Behavior(name, one_line, parameters, Sequence((), steps=steps), tuple(tags))


def _parameters(content: Any, line: int, problems: list[Problem]) -> dict[str, Parameter]:
    if content is None:
        return {}
    if not isinstance(content, dict):
        problems.append(Problem("parameters", "no mapping: name: {default: ..., help: ...}", line))
        return {}
    parameters = {}
    for name, facts in content.items():
        try:
            wrong = list(_wrong_keys(facts))
            parameters[name] = _parameter(name, facts)
        except BadGoal as error:
            wrong.append(error)
        if wrong:
            there = line_in(content, name)
            problems.extend(Problem(f"parameter {name}", str(error), there) for error in wrong)
            # The steps are read as if it were there: that they use it is no further mistake.
            parameters[name] = Parameter(str(name), UNKNOWN, "", line=there)
    return parameters


def _wrong_keys(facts: Any) -> Iterator[BadGoal]:
    for key in facts if isinstance(facts, dict) else ():
        if key not in PARAMETER_KEYS:
            problem = f"unknown key{did_you_mean(str(key), PARAMETER_KEYS)}"
            yield BadGoal(str(key), facts[key], f"known are {', '.join(PARAMETER_KEYS)}", problem)


def _parameter(name: Any, facts: Any) -> Parameter:
    if not isinstance(name, str) or not IDENTIFIER.fullmatch(name):
        raise BadGoal("parameters", name, "letters, digits and '_', no digit in front", "it is no name")
    if not isinstance(facts, dict):
        raise BadGoal(name, facts, "{default: ..., help: ...}")
    default, help_ = facts.get("default"), facts.get("help")
    kind = kind_of(default)
    if kind is None:
        raise BadGoal("default", default, "a text, a number, a truth value, or a list of these")
    if not isinstance(help_, str) or not help_.strip():
        raise BadGoal("help", help_, "a line that tells what it is for")
    choices = facts.get("choices", [])
    if not isinstance(choices, list) or any(kind_of(choice) != kind for choice in choices):
        raise BadGoal("choices", choices, f"a list; each a {kind}, as the default")
    lowest, highest, unit = facts.get("min", -math.inf), facts.get("max", math.inf), facts.get("unit", "")
    for key in ("min", "max", "unit"):
        if key in facts and kind not in ((NUMBER, LIST) if key == "unit" else (NUMBER,)):
            problem = f"it is for numbers, and the default {text_of(default)[:40]!r} makes this parameter a {kind}"
            also = "" if key != "unit" else ", or a list"
            raise BadGoal(
                key, facts[key], f"a {kind} may have choices; for {key}, let the default be a number{also}", problem
            )
    for key, value in (("min", lowest), ("max", highest)):
        if key in facts and kind_of(value) != NUMBER:
            raise BadGoal(key, value, "a number")
    if not isinstance(unit, str):
        raise BadGoal("unit", unit, "a text, as m, rad or s")
    parameter = Parameter(name, default, " ".join(help_.split()), tuple(choices), lowest, highest, unit, line_of(facts))
    parameter.check(default)
    return parameter

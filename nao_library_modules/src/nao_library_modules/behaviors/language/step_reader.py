"""Reads the steps of a behaviour: which kind each is, and its keys. No ROS."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Callable

from ...base.errors import BadGoal
from ...base.failure_policy import FailurePolicy
from ...base.field_checks import UNUSUAL
from ...base.suggestion import did_you_mean
from .errors import Problem
from .expressions import IDENTIFIER, UNKNOWN, names_in
from .model import (
    Barrier,
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
    child,
    path_text,
)
from .times import LABEL, at_of
from .yaml_text import line_in, line_of

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

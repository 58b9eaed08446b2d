"""From the text of a file to a behaviour: its keys and parameters; `step_reader` reads the steps. No ROS."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from .errors import BehaviorError, Problem
from .expressions import IDENTIFIER, UNKNOWN, text_of
from .model import Behavior, Sequence
from .parameters import LIST, NUMBER, Parameter, kind_of
from .step_reader import StepReader
from .structure import structure_problems
from .yaml_text import line_in, line_of, load

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

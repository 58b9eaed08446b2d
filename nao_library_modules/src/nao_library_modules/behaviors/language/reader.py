"""From the text of a file to a behaviour: its keys and parameters; `step_reader` reads the steps. No ROS."""

from __future__ import annotations

import math
import re
from typing import Any

from ..errors import BadGoal
from ..suggestion import did_you_mean
from .errors import BehaviorError, Problem
from .expressions import text_of
from .model import Behavior, Sequence
from .parameters import LIST, NUMBER, Parameter, kind_of
from .step_reader import StepReader
from .structure import check_structure
from .yaml_text import line_of, load

NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,99}")
NAME_ALLOWED = "letters, digits, '_' and '-', at most 100, no '-' in front"
PARAMETER_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
KEYS = ("help", "tags", "parameters", "do")
PARAMETER_KEYS = ("default", "help", "choices", "min", "max", "unit")


def read(text: str, name: str) -> Behavior:
    """Read a behaviour. Nothing is known here of servers, functions, fields and other behaviours: see `check`.

    Args:
        text: YAML, see docs/behaviors.md.
        name: Of the behaviour.

    Raises:
        BehaviorError: With everything that is wrong.
    """
    content = load(text, name)
    problems: list[Problem] = []
    behavior = _behavior(content, name, problems)
    if problems or behavior is None:
        raise BehaviorError(name, problems)
    check_structure(behavior)
    return behavior


def require_name(name: str, field: str = "str_param") -> str:
    """A name that a behaviour may have: it stays inside its folder.

    Raises:
        BadGoal: If it will not do.
    """
    if not NAME.fullmatch(name):
        raise BadGoal(field, name, NAME_ALLOWED, problem=f"{name[:120]!r} is no name for a behavior")
    return name


def _behavior(content: Any, name: str, problems: list[Problem]) -> Behavior | None:
    if not isinstance(content, dict):
        problems.append(Problem("", f"it is no mapping: the keys are {', '.join(KEYS)}"))
        return None
    for key in content:
        if key not in KEYS:
            hint = did_you_mean(str(key), KEYS)
            problems.append(Problem("", f"unknown key {key!r}{hint}; known are {', '.join(KEYS)}"))
    text = content.get("help")
    if not isinstance(text, str) or not text.strip():
        problems.append(Problem("help", "a line is needed that tells what it does"))
    tags = content.get("tags", [])
    if not isinstance(tags, list) or not all(isinstance(tag, str) for tag in tags):
        problems.append(Problem("tags", f"{tags!r} is no list of texts"))
        tags = []
    parameters = _parameters(content.get("parameters"), problems)
    if not isinstance(content.get("do"), list) or not content["do"]:
        problems.append(Problem("do", "a list of steps is needed, with at least one"))
        return None
    steps = StepReader(parameters, problems).steps(content["do"], ())
    one_line = " ".join(text.split()) if isinstance(text, str) else ""
    return Behavior(name, one_line, parameters, Sequence((), steps=steps), tuple(tags))


def _parameters(content: Any, problems: list[Problem]) -> dict[str, Parameter]:
    if content is None:
        return {}
    if not isinstance(content, dict):
        problems.append(Problem("parameters", "no mapping: name: {default: ..., help: ...}"))
        return {}
    parameters = {}
    for name, facts in content.items():
        try:
            parameters[name] = _parameter(name, facts)
        except BadGoal as error:
            problems.append(Problem(f"parameter {name}", str(error), line_of(facts) or line_of(content)))
            # The steps are read as if it were there: that they use it is no further mistake.
            parameters[name] = Parameter(str(name), "", "")
    return parameters


def _parameter(name: Any, facts: Any) -> Parameter:
    if not isinstance(name, str) or not PARAMETER_NAME.fullmatch(name):
        raise BadGoal("parameters", name, "letters, digits and '_', no digit in front", "it is no name")
    if not isinstance(facts, dict):
        raise BadGoal(name, facts, "{default: ..., help: ...}")
    for key in facts:
        if key not in PARAMETER_KEYS:
            problem = f"unknown key{did_you_mean(str(key), PARAMETER_KEYS)}"
            raise BadGoal(str(key), facts[key], f"known are {', '.join(PARAMETER_KEYS)}", problem)
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
    parameter = Parameter(name, default, " ".join(help_.split()), tuple(choices), lowest, highest, unit)
    parameter.check(default)
    return parameter

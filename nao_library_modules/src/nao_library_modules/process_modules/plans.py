"""Plans as functions: what `def_plan` decorates is a task of its own wherever it is called."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from .control import do, name_of, subtask, top_level
from .flow import here


def def_plan(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function whose calls are tasks in the tree, with their arguments. To be called in plans only."""

    @functools.wraps(function)
    def plan(*arguments: Any, **keywords: Any) -> Any:
        return subtask(do(plan, *arguments, **keywords))

    plan.plan_body = function  # type: ignore[attr-defined]
    return plan


def def_top_level_plan(function: Callable[..., Any]) -> Callable[..., Any]:
    """A plan that may be called anywhere: outside of plans it begins a tree of its own."""
    plan = def_plan(function)

    @functools.wraps(function)
    def begun(*arguments: Any, **keywords: Any) -> Any:
        if here() is not None:
            return plan(*arguments, **keywords)
        return top_level(do(plan, *arguments, **keywords), name=name_of(function))

    begun.plan_body = function  # type: ignore[attr-defined]
    return begun

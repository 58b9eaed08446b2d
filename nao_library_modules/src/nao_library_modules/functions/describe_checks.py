"""What functions take, read from the source of their checks: what a refusal would say is allowed. Nothing runs.

A check says it with `BadGoal(field, value, allowed)`, or calls what does. This walk follows the calls with what is
known without a message and without a robot: constants, tables, names of fields. What depends on either stays untold.
"""

from __future__ import annotations

import ast
import builtins
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ..base.errors import BadGoal
from .describe_limits import Allowed, told_by

DEEPEST = 8
"""Calls inside of calls that are followed."""
HARMLESS = frozenset(
    {"len", "str", "sorted", "tuple", "list", "dict", "map", "set", "max", "min", "range", "zip", "repr"}
)
TEXT_METHODS = frozenset({"join", "lower", "upper", "strip", "items", "keys", "values", "format", "replace"})
_REMEDY = re.compile(r".* first|another .*|none any more")
"""A refusal that tells what to do, not what the field may hold."""


def allowed_in(check: Callable[..., None] | None, owner: object, fields: Iterable[str]) -> dict[str, Allowed]:
    """What a check lets pass, by field.

    Args:
        check: The check of a function; None if it has none.
        owner: What it gets as its first argument: the module.
        fields: Fields of the message.
    """
    if check is None:
        return {}
    walk = _Walk(check, frozenset(fields))
    parameters = list(inspect.signature(check).parameters)
    walk.into(check, {parameters[0]: owner} if parameters else {}, 0)
    return {field: told_by(list(texts)) for field, texts in walk.found.items()}


class _Unknown(Exception):
    """What an expression is, is not known without a message or a robot."""


class _Walk:
    """Follows one check; `found` has field -> what is allowed, each text once."""

    def __init__(self, check: Callable[..., None], fields: frozenset[str]) -> None:
        self.found: dict[str, dict[str, None]] = {}
        self._fields = fields
        self._packages = {module.partition(".")[0] for module in (check.__module__, __name__)}
        self._seen: set[tuple[Any, ...]] = set()

    def into(self, function: Callable[..., Any], known: dict[str, Any], depth: int) -> None:
        """Walk through a function.

        Args:
            function: The function; its arguments are those of a plain function, `self` among them.
            known: The arguments whose values are known.
            depth: How many calls led here.
        """
        key = (function, tuple(sorted((name, repr(value)) for name, value in known.items() if name != "self")))
        if depth > DEEPEST or key in self._seen:
            return
        self._seen.add(key)
        try:
            tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
        except (OSError, TypeError, SyntaxError):
            return
        if isinstance(tree, ast.FunctionDef):
            _Body(self, function, known, depth).run(tree.body)

    def refusal(self, field: object, allowed: object) -> None:
        """Note what a refusal says."""
        if not isinstance(field, str) or not isinstance(allowed, str) or _REMEDY.fullmatch(allowed):
            return
        name = re.split(r"[.\[]", field)[0]
        if name in self._fields:
            self.found.setdefault(name, {}).setdefault(allowed)

    def follows(self, function: object) -> bool:
        """Whether a function is of the check's package, or of this one."""
        return inspect.isfunction(function) and function.__module__.partition(".")[0] in self._packages


class _Body:
    """The statements of one function, in order, with what is known at each."""

    def __init__(self, walk: _Walk, function: Callable[..., Any], known: dict[str, Any], depth: int) -> None:
        self._walk = walk
        self._globals: Mapping[str, Any] = getattr(function, "__globals__", {})
        self._known = dict(known)
        self._local = set(function.__code__.co_varnames)
        self._depth = depth

    def run(self, statements: Iterable[ast.stmt]) -> None:
        for statement in statements:
            self._statement(statement)

    def _statement(self, statement: ast.stmt) -> None:
        if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
            return
        if isinstance(statement, ast.For):
            self._expressions(statement.iter)
            self._loop(statement)
            return
        for part in ast.iter_child_nodes(statement):
            if isinstance(part, ast.stmt):
                self._statement(part)
            elif isinstance(part, ast.ExceptHandler):
                self.run(part.body)
            else:
                self._expressions(part)
        if isinstance(statement, (ast.Assign, ast.AnnAssign)) and statement.value is not None:
            targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
            for target in targets:
                self._bind(target, statement.value)

    def _loop(self, loop: ast.For) -> None:
        """A loop over what is written down runs once for each; another one once, with an unknown element."""
        if isinstance(loop.iter, (ast.Tuple, ast.List)):
            for element in loop.iter.elts:
                self._bind(loop.target, element)
                self.run(loop.body)
            return
        self._forget(loop.target)
        self.run(loop.body)

    def _bind(self, target: ast.expr, value: ast.expr) -> None:
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
            for part, element in zip(target.elts, value.elts):
                self._bind(part, element)
            return
        self._forget(target)
        try:
            known = self._value(value)
        except _Unknown:
            return
        if isinstance(target, ast.Name):
            self._known[target.id] = known
        elif isinstance(target, ast.Tuple) and isinstance(known, tuple) and len(known) == len(target.elts):
            names = [part.id for part in target.elts if isinstance(part, ast.Name)]
            if len(names) == len(known):
                self._known.update(zip(names, known))

    def _forget(self, target: ast.expr) -> None:
        for node in ast.walk(target):
            if isinstance(node, ast.Name):
                self._known.pop(node.id, None)

    def _expressions(self, expression: ast.AST) -> None:
        for node in ast.walk(expression):
            if isinstance(node, ast.Call):
                self._call(node)

    def _call(self, call: ast.Call) -> None:
        try:
            function, bound = self._callee(call.func)
        except _Unknown:
            return
        if function is BadGoal:
            keywords = {keyword.arg: keyword.value for keyword in call.keywords}
            field = call.args[0] if call.args else keywords.get("field")
            allowed = call.args[2] if len(call.args) > 2 else keywords.get("allowed")
            self._walk.refusal(self._or_none(field), self._or_none(allowed))
        elif self._walk.follows(function):
            self._walk.into(function, self._arguments(function, bound, call), self._depth + 1)

    def _or_none(self, expression: ast.expr | None) -> Any:
        try:
            return None if expression is None else self._value(expression)
        except _Unknown:
            return None

    def _callee(self, expression: ast.expr) -> tuple[Any, tuple[object, ...]]:
        """A function, and the object that it is bound to, if any. Looks, but runs no property."""
        if isinstance(expression, ast.Name):
            if expression.id in self._known:
                return self._known[expression.id], ()
            if expression.id in self._local:
                raise _Unknown
            return self._globals.get(expression.id), ()
        if isinstance(expression, ast.Attribute):
            holder = self._holder(expression.value)
            found = inspect.getattr_static(holder, expression.attr, None)
            if isinstance(found, staticmethod):
                return found.__func__, ()
            if inspect.isfunction(found) and not inspect.ismodule(holder) and not inspect.isclass(holder):
                return found, (holder,)
            return found, ()
        raise _Unknown

    def _holder(self, expression: ast.expr) -> Any:
        if isinstance(expression, ast.Name) and expression.id in self._known:
            return self._known[expression.id]
        if isinstance(expression, ast.Name) and expression.id not in self._local and expression.id in self._globals:
            return self._globals[expression.id]
        if isinstance(expression, ast.Attribute):
            holder = self._holder(expression.value)
            attributes = getattr(holder, "__dict__", {})
            if expression.attr in attributes:
                return attributes[expression.attr]
        raise _Unknown

    def _arguments(self, function: Callable[..., Any], bound: tuple[object, ...], call: ast.Call) -> dict[str, Any]:
        """The arguments of a call that are known, by the names of the function's parameters."""
        known: dict[str, Any] = {}
        parameters = list(inspect.signature(function).parameters.values())
        names = [p.name for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
        known.update(zip(names, bound))
        given = set(names[: len(bound)])
        position = len(bound)
        for argument in call.args:
            if isinstance(argument, ast.Starred):
                values = self._or_none(argument.value)
                if not isinstance(values, (tuple, list)):
                    return known
                known.update(zip(names[position:], values))
                given.update(names[position : position + len(values)])
                position += len(values)
                continue
            if position < len(names):
                self._keep(known, names[position], argument)
                given.add(names[position])
            position += 1
        for keyword in call.keywords:
            if keyword.arg is not None:
                self._keep(known, keyword.arg, keyword.value)
                given.add(keyword.arg)
        for parameter in parameters:
            if parameter.name not in given and parameter.default is not parameter.empty:
                known[parameter.name] = parameter.default
        return known

    def _keep(self, known: dict[str, Any], name: str, argument: ast.expr) -> None:
        try:
            known[name] = self._value(argument)
        except _Unknown:
            known.pop(name, None)

    def _value(self, expression: ast.expr) -> Any:
        """What an expression is, if that is written down."""
        if not self._harmless(expression):
            raise _Unknown
        scope = {**self._globals, "__builtins__": vars(builtins)}
        try:
            # Only what `_harmless` let pass: constants, names that are known, and pure functions of texts and lists.
            return eval(compile(ast.Expression(expression), "<check>", "eval"), scope, dict(self._known))
        except Exception:
            raise _Unknown from None

    def _table(self, call: ast.Call) -> bool:
        """Whether a call reads one of our tables: a function of ours without arguments, kept by a cache."""
        function = self._globals.get(getattr(call.func, "id", ""))
        return hasattr(function, "cache_info") and not (call.args or call.keywords)

    def _harmless(self, expression: ast.expr) -> bool:
        bound = {
            name.id
            for node in ast.walk(expression)
            if isinstance(node, ast.comprehension)
            for name in ast.walk(node.target)
            if isinstance(name, ast.Name)
        }
        if bound:
            return False  # a comprehension does not see the names that are known here
        for node in ast.walk(expression):
            if isinstance(node, ast.Name):
                known = node.id in self._known or (
                    node.id not in self._local and (node.id in self._globals or node.id in HARMLESS)
                )
                if not known:
                    return False
            elif isinstance(node, ast.Call):
                plain = isinstance(node.func, ast.Name) and (node.func.id in HARMLESS or self._table(node))
                method = isinstance(node.func, ast.Attribute) and node.func.attr in TEXT_METHODS
                if not (plain or method):
                    return False
            elif isinstance(node, (ast.Lambda, ast.Await, ast.Yield, ast.YieldFrom, ast.NamedExpr)):
                return False
        # An attribute of what is known may be a property that asks the robot.
        attributes = [node for node in ast.walk(expression) if isinstance(node, ast.Attribute)]
        return all(node.attr in TEXT_METHODS or not self._of_known(node) for node in attributes)

    def _of_known(self, attribute: ast.Attribute) -> bool:
        return isinstance(attribute.value, ast.Name) and attribute.value.id in self._known

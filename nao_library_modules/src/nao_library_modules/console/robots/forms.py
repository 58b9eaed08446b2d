"""Forms of functions: fields as the server declares them, values from what is typed, and what can be copied from them.

What is filled in becomes a line of a shell, a Python program, or a step of a behaviour.
"""

from __future__ import annotations

import json
import math
import re
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Tuple

from ...behaviors.behavior_errors import BehaviorError
from ...behaviors.model import Behavior
from ...behaviors.parameters import UNKNOWN, escaped, text_of
from ...behaviors.strict_yaml import dump, dump_line, load
from ...core.errors import did_you_mean
from ...core.geometry import ANGLES, in_rad, is_in_degrees
from ...core.server_types import ServerType, described_type, server_type

if TYPE_CHECKING:
    from ...studies.commands import RobotCommand


_WHOLE = re.compile(r"u?int\d+|byte|char")
_FLOAT = re.compile(r"float\d+|duration|time")
_TRUTH = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}
_KINDS = {"text": "string", "number": "number", "truth value": "bool", "list": "any"}
"""Kind of a behaviour's parameter -> type of a field."""
EXPRESSION = "${"
"""In a text: its value is calculated when a behaviour runs."""
_MARKS = "[]{},\"'#"
"""Characters that have a meaning in lists of YAML."""


@dataclass(frozen=True)
class FormField:
    """A field of a form."""

    name: str
    type: str  # of one value, as messages write it: string, float64, bool, duration, package/Message; "number", "any"
    help: str = ""
    unit: str = ""  # empty: none
    choices: Tuple[str, ...] = ()  # words that may be meant; others may do as well
    low: float = -math.inf  # the least number
    high: float = math.inf  # the greatest one
    default: Any = None  # plain value; None: there is none to show
    repeated: bool = False  # whether it holds a list
    allowed: str = ""  # what it may hold, in words

    @property
    def numeric(self) -> bool:
        return self.type == "number" or bool(_WHOLE.fullmatch(self.type) or _FLOAT.fullmatch(self.type))

    @property
    def hint(self) -> str:
        """What there is to say beside its name: its meaning, unit and range."""
        limits = self.allowed or self._range()
        if self.help.endswith(limits) or limits.endswith(self.help):  # "text to say", and "the text to say"
            limits = ""
        unit = f"in {self.unit}" if self.unit and self.unit not in limits.split() else ""
        return "; ".join(filter(None, (self.help, limits if not self.choices else "", unit)))

    def _range(self) -> str:
        low, high = math.isfinite(self.low), math.isfinite(self.high)
        if low and high:
            return f"{self.low:g}..{self.high:g}"
        return f"{self.low:g} or more" if low else f"{self.high:g} or less" if high else ""


def form_of(described_function: Any) -> list[FormField]:
    """The fields of a function. `described_function`: FunctionDescription, or whatever has its `arguments`."""
    return [_field(argument) for argument in described_function.arguments]


def form_of_parameters(parameters: Sequence[Any]) -> list[FormField]:
    """The fields for the parameters of a stored behaviour; `parameters`: BehaviorParameter of each."""
    return [
        _of_parameter(
            each.name,
            each.type,
            each.help,
            each.unit,
            [load(choice, each.name) for choice in each.choices],
            (each.min, each.max),
            load(each.default, each.name),
        )
        for each in parameters
    ]


def form_of_behavior(behavior: Behavior) -> list[FormField]:
    """The fields for the parameters of a behaviour that was read; without those that the file is wrong about."""
    return [
        _of_parameter(
            each.name, each.kind, each.help, each.unit, each.choices, (each.lowest, each.highest), each.default
        )
        for each in behavior.parameters.values()
        if each.default is not UNKNOWN
    ]


def _of_parameter(
    name: str, kind: str, help_: str, unit: str, choices: Sequence[Any], bounds: tuple[float, float], default: Any
) -> FormField:
    texts = tuple(map(text_of, choices))
    return FormField(name, _KINDS.get(kind, "any"), help_, unit, texts, *bounds, default, kind == "list")


def _field(argument: Any) -> FormField:
    kind, bracket, _ = argument.type.partition("[")
    low = -math.inf if math.isnan(argument.minimum) else argument.minimum
    high = math.inf if math.isnan(argument.maximum) else argument.maximum
    return FormField(
        argument.name,
        kind,
        argument.help,
        "" if argument.unit == "no unit" else argument.unit,
        tuple(argument.choices),
        low,
        high,
        json.loads(argument.default) if argument.default else None,
        bool(bracket),
        argument.allowed,
    )


def value_of(field: FormField, text: str) -> Any:
    """The plain value that a text stands for in a field; times in s.

    Lists are values with commas between them, or YAML in brackets; messages are YAML in braces. Raises ValueError with
    what is wrong and what would be right.
    """
    if not field.repeated:
        return _single(field, text)
    bare = text.strip()
    if not bare.startswith("["):
        return [_single(field, entry.strip()) for entry in bare.split(",")] if bare else []
    entries = _yaml(field, bare)
    if not isinstance(entries, list):
        raise ValueError(f"{field.name}: {text!r} is no list: values with commas between them, or [...]")
    return [_single(field, each) for each in entries]


def typed_value(field: FormField, text: str) -> Any:
    """As `value_of`, for steps of behaviours: a text with an expression in it is left as it is. Raises ValueError."""
    if EXPRESSION not in text:
        return value_of(field, text)
    bare = text.strip()
    if bare.startswith("["):
        return value_of(FormField(field.name, "any", repeated=True), bare)
    alone = bare.startswith(EXPRESSION) and bare.endswith("}") and bare.count(EXPRESSION) == 1
    return value_of(FormField(field.name, "string", repeated=field.repeated and not alone), text)


def text_of_value(field: FormField, value: Any) -> str:
    """A plain value as a person would type it: `value_of` reads it as the same."""
    if not field.repeated:
        return _typed(value)
    if not isinstance(value, list):
        return _typed(value)
    plain = all(not isinstance(each, (dict, list)) for each in value)
    texts = [_typed(each) for each in value]
    if plain and all(text and text == text.strip() and not any(mark in text for mark in _MARKS) for text in texts):
        return ", ".join(texts)
    return dump_line(value) if value else ""


def _typed(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, (dict, list)):
        return dump_line(value)
    return repr(value) if isinstance(value, float) and not value.is_integer() else text_of(value)


def _single(field: FormField, value: Any) -> Any:
    kind = field.type
    if kind == "string":
        return value if isinstance(value, str) else text_of(value)
    if kind == "bool":
        return _truth(field, value)
    if kind == "any":
        return _yaml(field, value) if isinstance(value, str) else value
    if field.numeric:
        return _number(field, value)
    content = _yaml(field, value) if isinstance(value, str) else value
    if not isinstance(content, dict):
        raise ValueError(f"{field.name}: {value!r} is no {kind}: its fields in braces are wanted, as {{name: value}}")
    return content


def _truth(field: FormField, value: Any) -> bool:
    if isinstance(value, bool):
        return value
    word = str(value).strip().lower()
    if word not in _TRUTH:
        hint = did_you_mean(word, ("true", "false"))
        raise ValueError(f"{field.name}: {value!r} is neither true nor false{hint}")
    return _TRUTH[word]


def _number(field: FormField, value: Any) -> float | int:
    unit = f" {field.unit}" if field.unit else ""
    try:
        number = _angle(field, value)
    except ValueError:
        wanted = "a whole number" if _WHOLE.fullmatch(field.type) else "a number"
        raise ValueError(f"{field.name}: {value!r} is no number: {wanted}{f' in{unit}' if unit else ''}") from None
    if not math.isfinite(number):
        raise ValueError(f"{field.name}: {value!r} is no finite number")
    if not field.low <= number <= field.high:
        allowed = field.allowed or f"{field._range()}{unit}"
        raise ValueError(f"{field.name}: {number:g} is not allowed: {allowed}")
    if _WHOLE.fullmatch(field.type):
        if number != int(number):
            raise ValueError(f"{field.name}: {value!r} is no whole number")
        return int(number)
    if field.type == "number" and number == int(number) and not (isinstance(value, str) and "." in value):
        return int(number)
    return number


def _angle(field: FormField, value: Any) -> float:
    """A number; in a field for angles also one in degrees, as rad."""
    return in_rad(value) if field.name in ANGLES else float(value)


def _yaml(field: FormField, text: str) -> Any:
    try:
        return load(text, field.name)
    except BehaviorError as error:
        raise ValueError(f"{field.name}: {error.problems[0].text}") from None


_PROGRAM = """\
import actionlib
import rospy

{imports}

rospy.init_node("console_copy", anonymous=True)
rospy.sleep(0.0)  # simulated time begins at zero and jumps with the first message of /clock
client = actionlib.SimpleActionClient({server!r}, {action})
client.wait_for_server()
functions = [
{functions}
]
client.send_goal({goal}(functions))
client.wait_for_result()
print(client.get_goal_status_text())
print(client.get_result())
"""


def as_python(command: RobotCommand, namespace: str, described: Any = None) -> str:
    """A program that sends a command and prints what the server answers.

    Raises NaoError if the types of the server are not known here.

    Args:
        command: What to send.
        namespace: Of the robot, "/" or "/nao1/".
        described: DescribeFunctionsResponse of the server, where it is none of this package's.
    """
    server = _types(command.server, described)
    literals = _Literals()
    lines = [f"    {literals.call(server.function, {'function': name, **fields})}," for name, fields in command.chain]
    literals.use(server.action)
    literals.use(server.goal)
    name = f"{namespace}{command.server}" if namespace.strip("/") else command.server
    return _PROGRAM.format(
        imports=literals.imports(),
        server=name,
        action=server.action.__name__,
        functions="\n".join(lines),
        goal=server.goal.__name__,
    )


def as_command(command: RobotCommand, namespace: str) -> str:
    """A line of a shell that sends a command. `namespace`: of the robot, "/" or "/nao1/"."""
    words = ["nao", "call", command.server]
    for number, (name, fields) in enumerate(command.chain):
        words += [*([","] if number else []), name]
        words += [f"{field}:={_argument(value)}" for field, value in fields.items()]
    if namespace.strip("/"):
        words += ["--robot", namespace.strip("/")]
    return " ".join(map(shlex.quote, words))


def as_yaml(command: RobotCommand) -> str:
    """A command as a step of a behaviour's file."""
    functions = [(name, escaped(dict(fields))) for name, fields in command.chain]
    if len(functions) == 1:
        ((name, fields),) = functions
        return dump([{f"{command.server}.{name}": fields}])
    return dump([{"chain": {command.server: [{"function": name, **fields} for name, fields in functions]}}])


def _types(server: str, described: Any) -> ServerType:
    try:
        return server_type(server)
    except KeyError:
        if described is None:
            raise
        return described_type(server, described)


def _argument(value: Any) -> str:
    """A value as `nao call` reads it."""
    if isinstance(value, list):
        texts = [_argument(each) for each in value]
        nested = any(isinstance(each, (list, dict)) for each in value)
        if nested or any("," in text or text != text.strip() or not text for text in texts) or _is_bracketed(texts):
            return dump_line(value)
        return ",".join(texts)
    if isinstance(value, dict):
        return dump_line(value)
    return repr(value) if isinstance(value, float) else text_of(value)


def _is_bracketed(texts: list[str]) -> bool:
    return bool(texts) and texts[0].startswith("[")


class _Literals:
    """Values as Python writes them, and the names that these need."""

    def __init__(self) -> None:
        self._used: dict[str, set[str]] = {}

    def use(self, kind: type) -> str:
        """The name of a type of messages, which is to be imported."""
        package = kind.__module__.partition(".")[0]
        self._used.setdefault(package, set()).add(kind.__name__)
        return kind.__name__

    def imports(self) -> str:
        return "\n".join(
            f"from {package}.msg import {', '.join(sorted(names))}" for package, names in sorted(self._used.items())
        )

    def call(self, kind: Any, fields: Mapping[str, Any]) -> str:
        """A message with fields."""
        types = dict(zip(kind.__slots__, kind._slot_types))
        given = []
        for name, value in fields.items():
            written = self._value(types.get(name, ""), _in_rad(value) if name in ANGLES else value)
            given.append(f"{name}={written}")
        return f"{self.use(kind)}({', '.join(given)})"

    def _value(self, kind: str, value: Any) -> str:
        base, bracket, _ = kind.partition("[")
        if bracket and isinstance(value, list):
            return f"[{', '.join(self._value(base, each) for each in value)}]"
        if base in ("duration", "time"):
            return f"rospy.{base.capitalize()}({value!r})"
        if isinstance(value, Mapping):
            from roslib.message import get_message_class

            message = get_message_class(base)
            return repr(dict(value)) if message is None else self.call(message, value)
        return repr(value)


def _in_rad(value: Any) -> Any:
    if isinstance(value, list):
        return [_in_rad(each) for each in value]
    return round(in_rad(value), 6) if is_in_degrees(value) else value

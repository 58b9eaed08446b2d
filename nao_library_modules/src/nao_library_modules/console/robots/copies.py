"""A command as a program, as a line of a shell, and as a step of a behaviour: to be copied by a person."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ...base.degrees import ANGLES, in_rad, is_in_degrees
from ...behaviors.language.expressions import escaped, text_of
from ...behaviors.language.yaml_text import dump, dump_line
from ...functions.server_types import ServerType, described_type, server_type

if TYPE_CHECKING:
    from .commands import RobotCommand

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

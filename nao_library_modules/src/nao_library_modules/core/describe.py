"""Descriptions of the functions of a server, and its services NAME/describe and NAME/check."""

from __future__ import annotations

import inspect
import json
import logging
import re
import struct
import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from io import BytesIO
from typing import Any

import genpy

from nao_library_msgs import msg
from nao_library_msgs.msg import ArgumentDescription, FunctionDescription
from nao_library_msgs.srv import CheckGoalsRequest, CheckGoalsResponse, DescribeFunctionsResponse
from naoqi.errors import NaoError
from naoqi.limits import ANSWER_LIMIT

from .chain import COMMON, FunctionTable, declared_fields, fields_read
from .fields import Field, Question
from .goal_checks import GoalCheck, GoalProblem, check_goals, offline_module
from .lights_and_colours import plain_words
from .memory_functions import MemoryFunctions
from .server_types import ACTIONS, server_type
from .waiting import OncePerConnection

log = logging.getLogger(__name__)

_NUMBER = re.compile(r"u?int\d+|float\d+")
_TIMES = ("duration", "time")
_FIELD = re.compile(r"(?P<type>[\w/]+(?:\[\d*\])?)\s+(?P<name>\w+)\s*(?:#\s*(?P<comment>.*))?")
_MORE = re.compile(r"\s+#\s*(?P<comment>.*)")


@dataclass(frozen=True)
class MessageField:
    """A field of a message."""

    name: str  # its name
    type: str  # its type as messages write it
    comment: str  # what the definition says about it, in one line

    @property
    def is_time(self) -> bool:
        return self.type.partition("[")[0] in _TIMES

    @property
    def numeric(self) -> bool:
        """Whether it holds numbers or times."""
        return self.is_time or _NUMBER.fullmatch(self.type.partition("[")[0]) is not None


def read_fields(definition: str) -> dict[str, MessageField]:
    """The fields of a message by name, in their order.

    `definition`: text of the .msg file; what genpy keeps of the messages inside may follow it.
    """
    fields: dict[str, MessageField] = {}
    last = ""
    for line in definition.split("=" * 80)[0].splitlines():
        more = _MORE.fullmatch(line)
        field = _FIELD.fullmatch(line.rstrip())
        if more and last:
            before = fields[last]
            fields[last] = MessageField(last, before.type, f"{before.comment} {more['comment'].strip()}".strip())
        elif field:
            last = field["name"]
            fields[last] = MessageField(last, field["type"], (field["comment"] or "").strip())
        else:
            last = ""
    return fields


LIGHTS: Sequence[Question] = (("ALLeds", "listGroups"), ("ALLeds", "listLEDs"))
JOINTS: Sequence[Question] = (("ALMotion", "getBodyNames", "Chains"), ("ALMotion", "getBodyNames", "Body"))
POSTURES: Sequence[Question] = (("ALRobotPosture", "getPostureList"),)
VOICES: Sequence[Question] = (("ALTextToSpeech", "getAvailableVoices"),)
LANGUAGES: Sequence[Question] = (("ALTextToSpeech", "getAvailableLanguages"),)
HEARD_LANGUAGES: Sequence[Question] = (("ALSpeechRecognition", "getAvailableLanguages"),)


class Choices:
    """What one robot answers. Any thread may ask."""

    def __init__(self, robot: Any, own: Callable[[str, str], Sequence[str]]) -> None:
        """Ask nothing yet.

        `robot`: proxies and connection. `own`: function, field -> words that the module itself knows.
        """
        self._own = own
        self._robot = robot
        self._lock = threading.Lock()
        # Answers by the question's text: arguments may be lists.
        self._known: OncePerConnection[dict[str, tuple[str, ...]]] = OncePerConnection(robot, dict)

    def of(self, function: str, field: str, asked: Sequence[Question]) -> tuple[str, ...]:
        """Words that a field of a function may hold; none where nobody has a say or the robot cannot be asked.

        `field`: the name of the field. `asked`: what the field declares to ask the robot.
        """
        own = self._own(function, field)
        if own:
            return tuple(own)
        if not asked or self._robot.connection.state != "connected" or self._robot.connection.silent:
            return ()
        told = [word for question in asked for word in self._answer(question)]
        words = plain_words(told) if asked is LIGHTS else []
        return tuple(dict.fromkeys([*told, *words]))

    def _answer(self, question: Question) -> tuple[str, ...]:
        with self._lock:
            known, key = self._known(), repr(question)
            if key not in known:
                module, method, *arguments = question
                try:
                    answer = self._robot.proxy(module).call_async(method, *arguments).result(timeout=ANSWER_LIMIT)
                except NaoError as error:
                    log.debug("%s.%s cannot be asked: %s", module, method, error)
                    return ()
                known[key] = tuple(map(str, answer))
            return known[key]


NO_UNIT = "no unit"
"""Unit of numbers that have none."""
NOTHING = "nothing"
_ANSWERS = {"str": "text", "float": "number", "int": "whole number", "bool": "truth value", "Any": "value"}
_MANY = re.compile(r"(?:list|List|Sequence|tuple)\[(.*)\]")


@dataclass(frozen=True)
class Argument:
    """A field as one function reads it; see ArgumentDescription.msg."""

    name: str
    type: str
    unit: str
    default: str
    help: str
    allowed: str
    choices: tuple[str, ...]
    minimum: float
    maximum: float


@dataclass(frozen=True)
class Described:
    """One function; see FunctionDescription.msg."""

    name: str
    help: str
    answers: str
    shared: bool
    arguments: tuple[Argument, ...]


class Description:
    """The functions of one server. Each is worked out when it is asked for, and kept.

    Attributes:
        action: Type of the action, with its package.
        message: Type of the function messages, with its package.
        table: NAOqi function name -> callable; it may change.
        help: First line of the docstring of the module's class.
        choices: Function, field, what to ask the robot -> words that it may hold, where they are not declared.
    """

    def __init__(
        self,
        table: Mapping[str, Callable[..., Any]],
        kind: type,
        action: type,
        choices: Callable[[str, str, Sequence[Question]], Sequence[str]] = lambda function, field, asked: (),
    ) -> None:
        """Look at what the server takes.

        Args:
            table: Its functions, those of the robot's memory among them.
            kind: Class of the module behind it.
            action: Type of its action; the first field of the goal is the array of function messages.
            choices: As the attribute.
        """
        import roslib.message  # not needed by who only looks at texts

        self.choices = choices
        goal = action().action_goal.goal
        self.action = f"{goal._type.rpartition('/')[0]}/{action.__name__[: -len('Action')]}"
        self.message = goal._slot_types[0].partition("[")[0]
        self.table = table
        self.help = first_line(kind)
        self._message_type = roslib.message.get_message_class(self.message)
        self._fields = read_fields(self._message_type._full_text)
        self._defaults = self._message_type()
        self._shared = frozenset(MemoryFunctions.functions)

    def functions(self, names: Sequence[str] = (), arguments: bool = True) -> list[Described]:
        """Descriptions of functions; of all without names. Unknown names are left out.

        `names`: names of functions. `arguments`: False: without what they take.
        """
        table = dict(self.table)
        return [self._described(name, table[name], arguments) for name in names or table if name in table]

    def common(self) -> list[Argument]:
        """The fields that every function has."""
        return [self._argument("", name, field) for name, field in COMMON.items() if name in self._fields]

    def _described(self, name: str, function: Callable[..., Any], arguments: bool) -> Described:
        taken = self._arguments(name, function) if arguments else ()
        return Described(name, first_line(function), answers(function), name in self._shared, tuple(taken))

    def _arguments(self, name: str, function: Callable[..., Any]) -> list[Argument]:
        names = self._message_type.__slots__
        declared = declared_fields(function, names)
        return [self._argument(name, each, declared.get(each)) for each in fields_read(function, names)]

    def _argument(self, function: str, name: str, declared: Field | None) -> Argument:
        known = self._fields[name]
        field = declared or Field(known.comment)
        unit = "s" if known.is_time else field.unit
        return Argument(
            name,
            known.type,
            unit or (NO_UNIT if known.numeric and declared else ""),
            default_text(getattr(self._defaults, name)),
            field.help,
            field.allowed,
            tuple(field.choices) or tuple(self.choices(function, name, field.asked if declared else self._asked(name))),
            field.minimum,
            field.maximum,
        )

    def _asked(self, name: str) -> Sequence[Question]:
        """What a field of this name asks the robot in the first function that declares it so."""
        functions = (each for each in self.table.values() if callable(each))
        fields = (declared_fields(each, (name,)).get(name) for each in functions)
        return next((field.asked for field in fields if field and field.asked), ())


def default_text(value: Any) -> str:
    """A field's default as JSON; empty for a message inside."""
    to_sec = getattr(value, "to_sec", None)
    if to_sec is not None:
        value = to_sec()
    try:
        return json.dumps(value)
    except TypeError:
        return ""


def first_line(thing: Any) -> str:
    """First line of a docstring; empty if there is none."""
    return (inspect.getdoc(thing) or "").partition("\n")[0]


def answers(function: Callable[..., Any]) -> str:
    """What a function answers, in words, told from its annotation."""
    annotation = inspect.signature(function).return_annotation
    if annotation is inspect.Signature.empty or annotation in (None, "None"):
        return NOTHING
    return _in_words(annotation if isinstance(annotation, str) else getattr(annotation, "__name__", str(annotation)))


def _in_words(annotation: str) -> str:
    name = annotation.strip()
    many = _MANY.fullmatch(name)
    if many:
        return f"list of {_in_words(many[1].partition(', ...')[0])}"
    if name.endswith("| None"):
        return f"{_in_words(name[: -len('| None')])} or nothing"
    return _ANSWERS.get(name, re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower())


class DescribeService:
    """Answers for one server. Clients come in threads of their own; the lock lets them in one after the other.

    ROS API:
        Service `NAME/describe` (nao_library_msgs/DescribeFunctions), NAME the name of the action.
    """

    def __init__(
        self, describe: Callable[[], Description], robot: Any, running: Callable[[], tuple[Sequence[str], int]]
    ) -> None:
        """Keep what it tells of; nothing is worked out before somebody asks.

        Args:
            describe: Makes the description; called once.
            robot: Proxies and connection; None: there is none.
            running: The functions of the goal that runs, and the index of the one that does.
        """
        self._description = lru_cache(maxsize=None)(describe)
        self._robot = robot
        self._running = running
        self._lock = threading.Lock()

    def answer(self, request: Any) -> Any:
        running, index = self._running()
        robot = self._robot
        with self._lock:
            description = self._description()
            response = DescribeFunctionsResponse(
                action=description.action,
                message=description.message,
                help=description.help,
                robot="" if robot is None else str(robot.address),
                connected=robot is not None and robot.connection.state == "connected",
                running=list(running),
                index=index,
            )
            if not request.without_functions:
                described = description.functions(request.functions, not request.without_arguments)
                response.functions = [function_message(function) for function in described]
                response.common = [argument_message(argument) for argument in description.common()]
                response.unknown = [name for name in request.functions if name not in description.table]
        return response


def function_message(described: Described) -> FunctionDescription:
    arguments = [argument_message(argument) for argument in described.arguments]
    return FunctionDescription(**{**vars(described), "arguments": arguments})


def argument_message(argument: Argument) -> ArgumentDescription:
    return ArgumentDescription(**{**vars(argument), "choices": list(argument.choices)})


CHECK = "/check"
"""What the service is called behind the name of the action."""


class NotValidated(NaoError):
    """A server did not say whether it could carry out goals."""


class CheckService:
    """Answers for one server. Clients come in threads of their own, and each has a check of its own.

    ROS API:
        Service `NAME/check` (nao_library_msgs/CheckGoals), NAME the name of the action.
    """

    def __init__(self, module: Any, action: type) -> None:
        self._module = module
        self._goal = type(action().action_goal.goal)

    def answer(self, request: Any) -> Any:
        kind = self._goal
        if (request.type, request.md5sum) != (kind._type, kind._md5sum):
            asked = f"{request.type} ({request.md5sum})"
            return CheckGoalsResponse(refused=f"its goals are {kind._type} ({kind._md5sum}), and not {asked}")
        try:
            goals = [kind().deserialize(goal.data) for goal in request.goals]
        except (genpy.DeserializationError, struct.error) as error:
            return CheckGoalsResponse(refused=f"what was sent is no {kind._type}: {error}")
        check = check_goals(self._module, goals)
        return CheckGoalsResponse("", list(map(_message, check.problems)), list(map(_message, check.unchecked)))


def check_request(goals: Sequence[Any]) -> Any:
    """What to ask a server. `goals`: of one type, at least one."""
    serialized = []
    for goal in goals:
        buffer = BytesIO()
        goal.serialize(buffer)
        serialized.append(msg.SerializedGoal(buffer.getvalue()))
    return CheckGoalsRequest(goals[0]._type, goals[0]._md5sum, serialized)


def read_response(response: Any) -> GoalCheck:
    """What a server answered. Raises NotValidated if it did not look at the goals."""
    if response.refused:
        raise NotValidated(response.refused)
    return GoalCheck(tuple(map(_problem, response.problems)), tuple(map(_problem, response.unchecked)))


def _message(problem: GoalProblem) -> msg.GoalProblem:
    return msg.GoalProblem(problem.goal, problem.index, problem.function, problem.field, problem.text)


def _problem(message: msg.GoalProblem) -> GoalProblem:
    return GoalProblem(message.goal, message.index, message.function, message.field, message.text)


@dataclass(frozen=True)
class OfflineServer:
    """An action server as it would present itself."""

    name: str  # relative name of the action
    action: type  # its type
    kind: type  # class of the module behind it
    table: Mapping[str, Callable[..., Any]]  # NAOqi function name -> plain function of the class
    service: DescribeService  # what would answer NAME/describe


def offline_servers() -> list[OfflineServer]:
    """The servers of all modules in this package, by name."""
    return [_declared(name) for name in sorted(ACTIONS, key=str.lower)]


def _declared(name: str) -> OfflineServer:
    server = server_type(name)
    kind, action = server.module, server.action
    table = FunctionTable(kind.declared_functions(), MemoryFunctions.functions)
    module = lru_cache(maxsize=None)(lambda: offline_module(kind))
    choices = lambda function, field, _: module().argument_choices(function, field)  # noqa: E731
    service = DescribeService(lambda: Description(table, kind, action, choices), None, lambda: ((), 0))
    return OfflineServer(name, action, kind, table, service)

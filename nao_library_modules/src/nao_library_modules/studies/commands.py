"""Commands for a robot in YAML files: of a wizard's button, of a protocol's step, of a form.

{say: "Hello {name}", animated: true}
{run: hello, with: {color: green}}
{call: NaoLights.setColor, with: {lights: [FaceLeds], str_param: red}}
{chain: NaoMotion, steps: [{wakeUp: {}}, {goToPosture: {str_param: Stand}}]}
{posture: Stand}
{walk_to: [0.5, 0.0, 0.0]}          # m ahead, m to the left, rad or deg to the left
{stop: true}

`FileReader` reads any YAML file strictly, and notes each problem with its line. `goal_of` makes a command a goal.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Callable

from naoqi.errors import NaoError

from ..behaviors.behavior_errors import BehaviorError, Problem
from ..behaviors.parameters import text_of
from ..behaviors.server_functions import message_of
from ..behaviors.strict_yaml import Mapping as FileMapping
from ..behaviors.strict_yaml import line_in, line_of, load
from ..core.errors import BadGoal, cut, did_you_mean, of_those
from ..core.fields import UNUSUAL
from ..core.server_types import ACTIONS, ServerType, described_type, server_type

LONGEST = 400_000
"""Characters of a text that pages and files of the console take: some 8 s of reading."""


class ConsoleFileError(NaoError):
    """A file of the console will not do. `problems`: what is wrong, in the order of the file."""

    def __init__(self, name: str, problems: Sequence[Problem]) -> None:
        super().__init__(cut(f"{name}: " + "; ".join(map(str, problems))))
        self.name = name
        self.problems = tuple(problems)


class FileReader:
    """Reads one file, and collects what is wrong with it.

    `name`: of the file, for errors.
    """

    def __init__(self, text: str, name: str) -> None:
        self.name = name
        self.problems: list[Problem] = []
        if len(text) > LONGEST:
            raise ConsoleFileError(name, [Problem("", f"the text has {len(text)} characters: at most {LONGEST}", 1)])
        try:
            self.content = load(text, name)
        except BehaviorError as error:
            raise ConsoleFileError(name, error.problems) from None

    def note(self, where: str, text: str, line: int = 0) -> None:
        self.problems.append(Problem(where, text, line))

    def finish(self) -> None:
        """Raise ConsoleFileError if anything was noted."""
        if self.problems:
            raise ConsoleFileError(self.name, sorted(self.problems, key=lambda each: each.line))

    def mapping(
        self,
        value: Any,
        where: str,
        allowed: Iterable[str],
        needed: Sequence[str] = (),
        place_of: Callable[[str], str] = lambda key: "",
    ) -> FileMapping:
        """A mapping with the keys `allowed`; what it is not is noted, and unknown keys are left out.

        `place_of`: text to append to an unknown key that belongs elsewhere, else empty.
        """
        known = list(allowed)
        if not isinstance(value, dict):
            self.note(where, f"a mapping with {', '.join(known)} is wanted, not {value!r}"[:300], line_of(value))
            return FileMapping()
        for key in value:
            if key not in known:
                hint = place_of(str(key)) or did_you_mean(str(key), known)
                self.note(
                    where, f"there is no key {key!r}{hint or ': there are ' + ', '.join(known)}", line_in(value, key)
                )
        for key in needed:
            if value.get(key) is None:
                self.note(where, f"{key} is missing", line_of(value))
        kept = FileMapping((key, entry) for key, entry in value.items() if key in known)
        kept.line, kept.lines = line_of(value), getattr(value, "lines", {})
        return kept

    def items(self, value: Any, where: str) -> list[Any]:
        """A list; None is an empty one."""
        if value is None:
            return []
        if not isinstance(value, list):
            self.note(where, f"a list is wanted, not {value!r}"[:300], line_of(value))
            return []
        return value

    def text(self, holder: Any, key: str, where: str, default: str = "") -> str:
        """A text under a key of a mapping; numbers are taken as they are written."""
        value = holder.get(key, default)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, (str, int, float)):
            self.note(
                f"{where}.{key}" if where else key, f"a text is wanted, not {value!r}"[:300], line_in(holder, key)
            )
            return default
        return text_of(value)

    def number(self, holder: Any, key: str, where: str, default: float, low: float = 0.0, high: float = 1e9) -> float:
        """A number `low`..`high` under a key of a mapping."""
        value = holder.get(key, default)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not low <= value <= high:
            problem = f"{value!r} is not allowed: a number {low:g}..{high:g}"[:300]
            self.note(f"{where}.{key}" if where else key, problem, line_in(holder, key))
            return default
        return float(value)

    def choice(self, holder: Any, key: str, where: str, allowed: Sequence[str], default: str) -> str:
        """One of some words under a key of a mapping."""
        value = self.text(holder, key, where, default)
        if value not in allowed:
            hint = did_you_mean(value, allowed) or f": there are {', '.join(allowed)}"
            self.note(f"{where}.{key}" if where else key, f"{value!r} is not allowed{hint}", line_in(holder, key))
            return default
        return value

    def flag(self, holder: Any, key: str, where: str, default: bool = False) -> bool:
        """True or false under a key of a mapping."""
        value = holder.get(key, default)
        if not isinstance(value, bool):
            self.note(
                f"{where}.{key}" if where else key, f"{value!r} is neither true nor false"[:300], line_in(holder, key)
            )
            return default
        return value


def revision_of(text: str) -> str:
    """What tells one text of a file from another."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]


class NotThere(NaoError):
    """A server, service or topic does not run."""


class Stopped(NaoError):
    """The robot was stopped since something was asked of it."""


class ServiceRefused(NaoError):
    """A service answers that it cannot."""


SPEECH, MOTION, BEHAVIORS = "nao_audio_out", "NaoMotion", "NaoBehavior"
RUN = "runBehavior"
FORMS: Mapping[str, tuple[str, ...]] = {
    "say": ("animated",),
    "run": ("with",),
    "call": ("with",),
    "chain": ("steps",),
    "posture": (),
    "walk_to": (),
    "stop": (),
}
"""First key of each form -> the keys that may stand beside it."""
KEYS = (*FORMS, "animated", "with", "steps", UNUSUAL)
"""All keys of commands: a file may have others beside them."""
_PLACES = {
    "call": "fields of the function stand in with: {{{}: ...}}",
    "run": "parameters of the behaviour stand in with: {{{}: ...}}",
    "chain": "fields stand behind their function: steps: [{{FUNCTION: {{{}: ...}}}}]",
    "say": "call: nao_audio_out.say takes further fields, in with: {{str_param: TEXT, {}: ...}}",
}
"""Where the fields belong that do not stand beside the first key of a form."""
POSTURE_SPEED = 0.8
_NAME = re.compile(r"\{(\w+)\}")

Describe = Callable[[str], Any]
"""Gives the DescribeFunctionsResponse of a server by its relative name."""


@dataclass(frozen=True)
class RobotCommand:
    """Functions of one server, in their order.

    `chain`: of each function its name -> its fields; empty together with an empty `server`: everything stops.
    """

    server: str = ""
    chain: tuple[tuple[str, Mapping[str, Any]], ...] = ()
    source: Mapping[str, Any] | None = None  # as the file has it
    unusual: bool = False  # whether its numbers are meant though they are not usual

    @property
    def stops(self) -> bool:
        """Whether it ends everything that the robot does."""
        return not self.server

    @property
    def label(self) -> str:
        """For people: what is said, or what runs."""
        if self.stops:
            return "stop"
        name, fields = self.chain[0]
        told = fields.get("str_param") or fields.get("values") or ""
        more = f" and {len(self.chain) - 1} more" if len(self.chain) > 1 else ""
        return f"{name} {text_of(told) if not isinstance(told, list) else ', '.join(map(text_of, told))}".strip() + more

    def filled(self, values: Mapping[str, str]) -> RobotCommand:
        """With `{name}` in its texts replaced; names that `values` lacks stay as they are."""
        return replace(self, chain=tuple((name, _filled(fields, values)) for name, fields in self.chain))

    def to_yaml(self) -> Mapping[str, Any]:
        """As a file would have it."""
        if self.source is not None:
            return self.source
        if self.stops:
            return {"stop": True}
        if len(self.chain) > 1:
            return {"chain": self.server, "steps": [{name: dict(fields)} for name, fields in self.chain]}
        ((name, fields),) = self.chain
        return {"call": f"{self.server}.{name}", **({"with": dict(fields)} if fields else {})}


def call(server: str, function: str, **fields: Any) -> RobotCommand:
    return RobotCommand(server, ((function, fields),))


def say(text: str, animated: bool = False) -> RobotCommand:
    return call(SPEECH, "animatedSay" if animated else "say", str_param=text)


def run_behavior(name: str, parameters: Mapping[str, Any]) -> RobotCommand:
    given = [f"{key}={text_of(value)}" for key, value in parameters.items()]
    return call(BEHAVIORS, RUN, str_param=name, **({"parameters": given} if given else {}))


def posture(name: str) -> RobotCommand:
    return call(MOTION, "goToPosture", str_param=name, speed=POSTURE_SPEED)


def walk_to(x: float, y: float, theta: float) -> RobotCommand:
    """Walk x m ahead, y m to the left, and turn by theta rad; a robot that does not stand stands up before."""
    steps = (("goToPosture", {"str_param": "StandInit"}), ("moveTo", {"values": [x, y, theta]}))
    return RobotCommand(MOTION, steps)


def place_of_field(holder: Mapping[str, Any], key: str, known: Iterable[str]) -> str:
    """Text to append to "there is no key ..." of a command: where a field of this name belongs; empty if nowhere.

    `known`: keys that may stand there, one of which may have been meant.
    """
    places = [text.format(key) for kind, text in _PLACES.items() if kind in holder]
    if not places:
        return ""
    hint = did_you_mean(key, known)
    return f"{hint}{';' if hint else ':'} {places[0]}"


def read_command(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    """The command among the keys of a mapping; None if there is none that can be read, which is noted.

    `holder`: a mapping of a file; it may have other keys, which the caller looks at.
    """
    kinds = [key for key in FORMS if key in holder]
    if len(kinds) != 1:
        told = f"{' and '.join(kinds)} exclude each other" if kinds else f"one of {', '.join(FORMS)} is wanted"
        reader.note(where, told, line_of(holder))
        return None
    (kind,) = kinds
    for key in ("animated", "with", "steps"):
        if key in holder and key not in FORMS[kind]:
            reader.note(where, f"{key} is not for {kind}", line_in(holder, key))
    source = {key: holder[key] for key in (kind, *FORMS[kind], UNUSUAL) if key in holder}
    made = _READERS[kind](reader, holder, where)
    return None if made is None else replace(made, source=source, unusual=reader.flag(holder, UNUSUAL, where))


def _read_say(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    return say(reader.text(holder, "say", where), reader.flag(holder, "animated", where))


def _read_run(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    given = holder.get("with") or {}
    if not isinstance(given, dict):
        reader.note(f"{where}.with", "a mapping of parameters is wanted", line_in(holder, "with"))
        given = {}
    return run_behavior(reader.text(holder, "run", where), given)


def _read_call(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    server, dot, function = reader.text(holder, "call", where).partition(".")
    if not dot or not server or not function:
        reader.note(f"{where}.call", "SERVER.FUNCTION is wanted: NaoLights.setColor", line_in(holder, "call"))
        return None
    return _chain(reader, server, [(function, holder.get("with") or {}, line_in(holder, "call"))], where)


def _read_chain(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    steps = []
    for number, step in enumerate(reader.items(holder.get("steps"), f"{where}.steps"), start=1):
        if not isinstance(step, dict) or len(step) != 1:
            reader.note(
                f"{where}.steps {number}", "FUNCTION: {FIELD: VALUE} is wanted", line_in(holder["steps"], number - 1)
            )
            continue
        ((function, fields),) = step.items()
        steps.append((function, fields or {}, line_of(step)))
    if not holder.get("steps"):
        reader.note(where, "steps is missing: functions of the chain, in their order", line_of(holder))
    return _chain(reader, reader.text(holder, "chain", where), steps, where)


def _read_posture(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    return posture(reader.text(holder, "posture", where))


def _read_walk(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    from ..core.geometry import in_rad, is_in_degrees

    way = holder["walk_to"]
    try:
        x, y, theta = way
        return walk_to(float(x), float(y), in_rad(theta) if is_in_degrees(theta) else float(theta))
    except (TypeError, ValueError):
        reader.note(
            f"{where}.walk_to",
            "m ahead, m to the left and rad (or 90deg) to the left are wanted: [0.5, 0, 0]",
            line_in(holder, "walk_to"),
        )
        return None


def _read_stop(reader: FileReader, holder: Any, where: str) -> RobotCommand | None:
    return RobotCommand() if reader.flag(holder, "stop", where) else None


_READERS = {
    "say": _read_say,
    "run": _read_run,
    "call": _read_call,
    "chain": _read_chain,
    "posture": _read_posture,
    "walk_to": _read_walk,
    "stop": _read_stop,
}


def _chain(reader: FileReader, server: str, steps: Any, where: str) -> RobotCommand | None:
    """A chain whose names and fields are looked at as far as this package's servers go."""
    made = []
    for function, fields, line in steps:
        if not isinstance(fields, dict):
            reader.note(where, f"{function}: a mapping of fields is wanted", line)
            continue
        made.append((str(function), dict(fields)))
        if server in ACTIONS:
            try:
                message_of(server_type(server).function, dict(fields))
            except BadGoal as error:
                reader.note(where, f"{function}: {error}", line)
    return RobotCommand(server, tuple(made)) if made else None


def _filled(value: Any, values: Mapping[str, str]) -> Any:
    if isinstance(value, str):
        return _NAME.sub(lambda found: values.get(found[1], found[0]), value)
    if isinstance(value, Mapping):
        return {key: _filled(entry, values) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_filled(entry, values) for entry in value]
    return value


@dataclass(frozen=True)
class CommandGoal:
    """A goal, ready to be sent. `action`: type of the action. `goal`: of its goal type."""

    server: str
    action: type
    goal: Any


def type_of(server: str, describe: Describe) -> ServerType:
    """The types of a server: one of this package's, or another one as it describes itself.

    Raises BadGoal if its messages are not known here, and what `describe` raises if there is no such server.
    """
    return server_type(server) if server in ACTIONS else described_type(server, describe(server))


def goal_of(command: RobotCommand, types: ServerType) -> CommandGoal:
    """The goal of a command. Raises BadGoal if a field will not do."""
    functions = []
    for position, (name, fields) in enumerate(command.chain, start=1):
        where = f"function {position} ({name})" if len(command.chain) > 1 else name
        message = message_of(types.function, dict(fields), where)
        message.function = name
        functions.append(message)
    return CommandGoal(command.server, types.action, types.goal(functions))


def command_problems(command: RobotCommand, describe: Describe) -> list[str]:
    """What is wrong with a command as far as descriptions of its server tell: names of functions and fields, kinds.

    `describe`: raises NaoError if there is no such server.
    """
    from naoqi.errors import NaoError

    if command.stops:
        return []
    try:
        described = describe(command.server)
        types = type_of(command.server, describe)
    except (NaoError, KeyError) as error:
        return [str(error)]
    functions = {each.name: each for each in described.functions}
    told = []
    for name, fields in command.chain:
        if name not in functions:
            told.append(f"{command.server} has no function {name!r}{did_you_mean(name, functions)}")
            continue
        takes = [each.name for each in (*functions[name].arguments, *described.common)]
        told += [f"{name} takes no field {field!r}{of_those(field, takes)}" for field in fields if field not in takes]
    if not told:
        try:
            goal_of(command, types)
        except BadGoal as error:
            told.append(str(error))
    return told

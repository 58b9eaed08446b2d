"""Read a protocol from YAML. Each mistake is reported with its line and with what would be right. Pure."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from ..behaviors.behavior_errors import Problem
from ..behaviors.parameters import IDENTIFIER
from ..behaviors.strict_yaml import line_in
from ..core.errors import BadGoal, of_those
from ..core.fields import limit
from ..core.nao_facts import sensors_of
from .commands import FORMS, ConsoleFileError, FileReader, place_of_field, read_command
from .commands import KEYS as COMMAND_KEYS
from .protocol import (
    FIRST,
    FORM,
    GIVEN,
    HOLD,
    LAST,
    LIVE,
    NOTHING,
    NOW,
    ON_ERROR,
    OTHER_NAMES,
    SENSES,
    BranchStep,
    ChoiceStep,
    CommandStep,
    PauseStep,
    ProtocolStep,
    RoundsStep,
    SenseStep,
    StudyCondition,
    StudyFactor,
    StudyPhase,
    StudyProtocol,
    UntilStep,
    WantedRecordings,
    WhileStep,
    unknown_names,
)
from .protocol_check import impossible_conditions
from .schedule import FIXED, LATIN_SQUARE, ORDERS, RANDOM, all_steps, steps_in
from .step_waits import server_of

NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}")
"""What studies and participants may be called: it is the name of a folder, too."""
NAME_FORM = "letters, digits, _ and -, a letter or digit first, 64 at most"
TOPIC = re.compile(r"/?[A-Za-z]\w*(/[A-Za-z]\w*)*")
LONGEST = DEFAULT_WAIT = limit("timeout").highest
"""s: the longest wait of the servers, and that of a step that names none."""
MOST_ROUNDS, MOST_CONDITIONS = 1000, 64
_TOP = ("name", "help", "factors", "order", "seed", "blind", "values", "record", "phases")
_COMMON = ("label", "timeout", "on_error")
_KEYS = {
    "wizard": ("choices", "label", "timeout"),
    "wait": (),
    "when": ("then", "else"),
    "choose": ("cases", "else"),
    "repeat": ("as", "order", "steps"),
    "while": (),
}
_SENSE_KEYS = {"touch": ("sensors",), "word": ("words",), "sound": (), "face": ("names",)}
_WAITS = (*SENSES, *OTHER_NAMES)
_WHILE_KEYS = ("do", "until", "times", "timeout", "label")
KINDS = (*FORMS, *_KEYS)


def read_protocol(text: str, name: str) -> StudyProtocol:
    """A protocol of its YAML. `name`: of the file. Raises ConsoleFileError with all that is wrong."""
    return _Reader(text, name).protocol(text)


def read_protocol_file(path: Path) -> StudyProtocol:
    """A protocol of its file. Raises ConsoleFileError with all that is wrong, or if it cannot be read."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConsoleFileError(path.name, [Problem("", f"cannot be read: {error}", file=str(path))]) from error
    return read_protocol(text, path.name)


def hash_of(text: str) -> str:
    """SHA-256 of a protocol's text, in hexadecimal digits."""
    return hashlib.sha256(text.encode()).hexdigest()


class _Wrong(Exception):  # a signal: the problem is noted, the part is left out
    pass


class _Reader(FileReader):
    def __init__(self, text: str, name: str) -> None:
        super().__init__(text, name)
        self._names: set[str] = set()
        self._labels: dict[str, int] = {}
        self._seed = 0

    def protocol(self, text: str) -> StudyProtocol:
        top = self.content
        if not isinstance(top, dict):
            self.note("", f"a protocol is a mapping with {', '.join(_TOP)}", 1)
            self.finish()
        self._keys(top, _TOP, "the protocol")
        factors = tuple(self._factors(top))
        values = self._values(top, "values")
        self._names = {*GIVEN, *values, *(factor.name for factor in factors)}
        for factor in factors:
            for level in factor.levels.values():
                self._names.update(level)
        self._find_labels(top.get("phases"), {})
        seed = top.get("seed", 0)
        if not _whole(seed):
            self.note("seed", f"{seed!r} is no whole number", line_in(top, "seed"))
            seed = 0
        self._seed = seed
        order = top.get("order", LATIN_SQUARE)
        if order not in ORDERS:
            self.note("order", f"there is no order {order!r}{of_those(str(order), ORDERS)}", line_in(top, "order"))
        title = top.get("name", Path(self.name).stem)
        if not isinstance(title, str) or not NAME.fullmatch(title) or title == "protocols":
            self.note("name", f"{title!r} is no name of a study: {NAME_FORM}; not protocols", line_in(top, "name"))
        protocol = StudyProtocol(
            str(title),
            self._plain_text(top, "help", ""),
            factors,
            str(order),
            seed,
            values,
            self._recordings(top),
            tuple(self._phases(top)),
            text,
            self.flag(top, "blind", ""),
        )
        self._check_texts(protocol)
        if not self.problems:  # what is wrong otherwise may be what a condition lacks
            self.problems += impossible_conditions(protocol)
        self.finish()
        return protocol

    def _factors(self, top: dict[str, Any]) -> Iterable[StudyFactor]:
        factors = self._mapping(top, "factors")
        conditions = 1
        for name, value in factors.items():
            line = line_in(factors, name)
            where = f"factor {name}"
            if not _identifier(name) or name in (*GIVEN, *LIVE):
                self.note(where, f"{name!r} is no name: letters, digits and _, and none of {', '.join(GIVEN)}", line)
                continue
            if not isinstance(value, dict):
                value = {"levels": value}
            self._keys(value, ("levels", "assigned"), where, line)
            levels, assigned = value.get("levels"), value.get("assigned", "within")
            if assigned not in ("within", "between"):
                text = f"assigned is {assigned!r}; right are within (each participant meets all levels), between (one)"
                self.note(where, text, line_in(value, "assigned") or line)
            if isinstance(levels, list):
                levels = {_word(level): {} for level in levels}
            if not isinstance(levels, dict) or len(levels) < 2:
                self.note(where, "levels are two or more, as [one, two] or {one: {NAME: VALUE}, two: ...}", line)
                continue
            read = {}
            for level, content in levels.items():
                if content is not None and not isinstance(content, dict):
                    self.note(
                        where, f"level {level} is a mapping of values, or nothing", line_in(levels, level) or line
                    )
                    content = None
                read[_word(level)] = dict(content or {})
            if len({frozenset(values) for values in read.values()}) > 1:
                self.note(where, "all levels have values of the same names", line)
            conditions *= len(read)
            yield StudyFactor(name, read, assigned != "between")
        if conditions > MOST_CONDITIONS:
            self.note("factors", f"{conditions} conditions: at most {MOST_CONDITIONS}", line_in(top, "factors"))

    def _recordings(self, top: dict[str, Any]) -> WantedRecordings:
        record = self._mapping(top, "record")
        self._keys(record, ("bag", "video", "sound"), "record")
        bag, video, sound = record.get("bag", []), record.get("video", ""), record.get("sound", False)
        if not isinstance(bag, list) or not all(isinstance(each, str) and TOPIC.fullmatch(each) for each in bag):
            self.note("record", f"bag is a list of topics, not {bag!r}", line_in(record, "bag"))
            bag = []
        if video not in ("", "top", "bottom"):
            self.note("record", f"video is of a camera, top or bottom, not {video!r}", line_in(record, "video"))
        if not isinstance(sound, bool):
            self.note("record", f"sound is true or false, not {sound!r}", line_in(record, "sound"))
        return WantedRecordings(tuple(bag), str(video), sound is True)

    def _phases(self, top: dict[str, Any]) -> Iterable[StudyPhase]:
        phases = top.get("phases")
        if not isinstance(phases, list) or not phases:
            self.note("phases", "there is no list of phases, each with a name and steps", line_in(top, "phases") or 1)
            return
        for i, phase in enumerate(phases):
            line = line_in(phases, i)
            where = f"phase {i + 1}"
            if not isinstance(phase, dict):
                self.note(where, "a phase is a mapping with phase (its name), steps and only", line)
                continue
            self._keys(phase, ("phase", "only", "steps"), where, line)
            only = phase.get("only", "")
            if only not in ("", FIRST, LAST):
                text = f"only is {only!r}; right are first, last: in that trial of a participant alone"
                self.note(where, text, line_in(phase, "only"))
            name = self._plain_text(phase, "phase", f"Phase {i + 1}")
            yield StudyPhase(name, str(only), self._steps(phase.get("steps"), str(i + 1), line))

    def _steps(self, value: Any, prefix: str, line: int) -> tuple[ProtocolStep, ...]:
        if not isinstance(value, list) or not value:
            self.note(f"step {prefix}", "steps are a list with at least one step", line)
            return ()
        steps = []
        for i, each in enumerate(value):
            try:
                steps.append(self._step(each, f"{prefix}.{i + 1}", line_in(value, i) or line))
            except _Wrong:
                continue
        return tuple(steps)

    def _step(self, value: Any, path: str, line: int) -> ProtocolStep:
        where = f"step {path}"
        if not isinstance(value, dict):
            self._fail(where, f"a step is a mapping with one of {', '.join(KINDS)}", line)
        kinds = [kind for kind in KINDS if kind in value]
        # A chain has steps of its own, and a call may be one that stops.
        kind = kinds[0] if kinds else ""
        if not kind:
            key = next(iter(value), "")
            self._fail(where, f"there is no step {key!r}{of_those(str(key), KINDS)}", line)
        label = value.get("label", "")
        if label and not (isinstance(label, str) and label in self._labels):
            label = ""
        if kind in FORMS:
            return self._command(value, where, line, label)
        if kind != "wait":  # whose keys depend on what it waits for
            self._keys(value, (kind, *_KEYS[kind]), where, line)
        read: Callable[[dict[str, Any], str, int, str], ProtocolStep] = getattr(self, f"_{kind}")
        return read(value, path, line, label)

    def _command(self, value: dict[str, Any], where: str, line: int, label: str) -> ProtocolStep:
        on_error = value.get("on_error", HOLD)
        if on_error not in ON_ERROR:
            self.note(where, f"on_error is {on_error!r}; right are {', '.join(ON_ERROR)}", line)
        self._keys(value, (*COMMAND_KEYS, *_COMMON), where, line)
        command = read_command(self, value, where)
        if command is None:
            raise _Wrong
        return CommandStep(line, label, command, self._seconds(value, "timeout", where, line, 0.0), str(on_error))

    def _wizard(self, value: dict[str, Any], path: str, line: int, label: str) -> ProtocolStep:
        where = f"step {path}"
        choices = value.get("choices", ["continue"])
        if not isinstance(choices, list) or not choices or any(isinstance(each, (dict, list)) for each in choices):
            self._fail(where, "choices are a list of words: [yes, no]", line_in(value, "choices") or line)
        words = tuple(map(_word, choices))
        if len({*words}) < len(words):
            self.note(where, "a choice comes twice", line_in(value, "choices") or line)
        timeout = self._seconds(value, "timeout", where, line, 0.0)
        return ChoiceStep(line, label, self._plain_text(value, "wizard", ""), words, timeout)

    def _wait(self, value: dict[str, Any], path: str, line: int, label: str) -> ProtocolStep:
        where, what = f"step {path}", value["wait"]
        if isinstance(what, (int, float)) and not isinstance(what, bool):
            self._keys(value, ("wait",), where, line)
            return PauseStep(line, "", self._seconds(value, "wait", where, line, 0.0))
        if isinstance(what, list):
            self._keys(value, ("wait",), where, line)
            return self._drawn_pause(what, where, line_in(value, "wait") or line)
        if what == "until":
            self._keys(value, ("wait", "until", "label", "timeout", "since"), where, line)
            known = {*self._names, *LIVE}
            conditions = self._conditions(value.get("until"), where, line_in(value, "until") or line, known)
            timeout, since = self._seconds(value, "timeout", where, line, 0.0), self._since(value, where, line)
            return UntilStep(line, label, conditions, timeout, since)
        if what not in _WAITS:
            text = f"there is no wait for {what!r}{of_those(str(what), (*_WAITS, 'until'))}, or a number of seconds"
            self._fail(where, text, line)
        return self._sense(value, str(what), where, line, label, ("wait", "label", "timeout"))

    def _drawn_pause(self, bounds: list[Any], where: str, line: int) -> PauseStep:
        if len(bounds) != 2 or not all(map(_number, bounds)) or not 0 <= bounds[0] <= bounds[1] <= LONGEST:
            told = f"the least and the most seconds of a wait that is drawn are two numbers 0..{LONGEST:g}"
            self._fail(where, f"{told}, as wait: [2, 5], not {bounds!r}", line)
        return PauseStep(line, "", float(bounds[0]), float(bounds[1]), self._seed)

    def _sense(
        self, value: dict[str, Any], what: str, where: str, line: int, label: str, known: Sequence[str]
    ) -> SenseStep:
        """A wait for a touch, a word, a sound or a face. `known`: further keys that may stand there."""
        what = OTHER_NAMES.get(what, what)
        keys = _SENSE_KEYS[what]
        self._keys(value, (*known, *keys, "confidence", "since"), where, line)
        key = keys[0] if keys else ""
        names = value.get(key, [])
        names = [names] if isinstance(names, str) else names
        at = line_in(value, key) or line
        if not isinstance(names, list) or any(isinstance(each, (dict, list)) for each in names):
            self._fail(where, f"{key} are a list of words", at)
        words = tuple(map(_word, names))
        if what == "touch":
            try:
                sensors_of(words)
            except BadGoal as error:
                self.note(where, str(error), at)
                words = ()
        elif what == "word" and not words:
            self.note(where, "wait: word needs words, those that the robot is to listen for: [yes, no]", at)
        elif what == "word" and any("," in word for word in words):
            self.note(where, f"words are a list: [{', '.join(words)}]", at)
        elif what == "face" and len(words) > 1:
            self.note(where, f"names are {len(words)} names: the robot looks for one of them, or for anybody", at)
        confidence = value.get("confidence", 0.0)
        if not _number(confidence) or not 0 <= confidence <= 1:
            self._fail(where, f"confidence is a number 0..1, not {confidence!r}", line_in(value, "confidence"))
        timeout = self._seconds(value, "timeout", where, line, DEFAULT_WAIT) or DEFAULT_WAIT
        return SenseStep(line, label, what, words, timeout, float(confidence), self._since(value, where, line))

    def _since(self, value: dict[str, Any], where: str, line: int) -> str:
        since = value.get("since", "")
        if since and since != NOW and since not in self._labels:
            text = f"since is {since!r}; right are {NOW} or the label of an earlier step"
            self.note(where, f"{text}{of_those(str(since), (NOW, *self._labels))}", line_in(value, "since") or line)
            return ""
        return str(since)

    def _while(self, value: dict[str, Any], path: str, line: int, _label: str) -> ProtocolStep:
        where, content = f"step {path}", value["while"]
        if not isinstance(content, dict) or not {"do", "until"} <= {*content}:
            form = "{do: [STEP, ...], until: touch, timeout: 20, label: NAME}"
            self._fail(where, f"while is a mapping with do and until: {form}", line)
        label = content.get("label", "")
        label = label if isinstance(label, str) and label in self._labels else ""
        waits = self._ends(content, where, line_in(content, "until") or line)
        times = content.get("times", 0)
        if not _whole(times) or not 0 <= times <= MOST_ROUNDS:
            self.note(where, f"times is a whole number 0..{MOST_ROUNDS}, not {times!r}", line_in(content, "times"))
            times = 0
        steps = self._steps(content.get("do"), f"{path}.w1", line_in(content, "do") or line)
        for each in steps:
            self._only_acts(each, where)
        self._share_no_server(waits, steps, where, line)
        timeout = self._seconds(content, "timeout", where, line, 0.0)
        return WhileStep(line, label, waits, steps, times, timeout)

    def _ends(self, content: dict[str, Any], where: str, line: int) -> tuple[ProtocolStep, ...]:
        """What a `while` waits for: `until` takes what `wait` takes, a condition, or a list of waits."""
        until = content["until"]
        if until in _WAITS:
            return (self._sense(content, str(until), where, line, "", _WHILE_KEYS),)
        if isinstance(until, list) and any(isinstance(each, dict) or each in _WAITS for each in until):
            self._keys(content, _WHILE_KEYS, where, line)
            return tuple(self._end(each, where, line_in(until, i) or line) for i, each in enumerate(until))
        seconds = until == "time"
        self._keys(content, (*_WHILE_KEYS, "seconds" if seconds else "since"), where, line)
        if seconds and "seconds" not in content:
            self.note(where, "until: time needs seconds: {do: [...], until: time, seconds: 20}", line)
        if seconds or _number(until):
            key = "seconds" if seconds else "until"
            return (PauseStep(line, "", self._seconds(content, key, where, line, 0.0)),)
        if isinstance(until, str) and not set(until) & set("=<>"):
            text = f"there is no until: {until!r}{of_those(until, (*_WAITS, 'time'))}, a number of seconds, a condition"
            self._fail(where, f"{text} as touches >= 3, or a list of waits", line)
        conditions = self._conditions(until, where, line, {*self._names, *LIVE})
        return (UntilStep(line, "", conditions, 0.0, self._since(content, where, line)),)

    def _end(self, value: Any, where: str, line: int) -> ProtocolStep:
        if not isinstance(value, dict) or "wait" not in value:
            self._fail(where, "a list of until has waits: [{wait: touch}, {wait: word, words: [yes]}]", line)
        for key in ("label", "timeout"):
            if key in value:
                self.note(where, f"{key} is one of the while, not of a wait in its until", line_in(value, key) or line)
        return self._wait(value, where[len("step ") :], line, "")

    def _share_no_server(
        self, waits: Sequence[ProtocolStep], steps: Iterable[ProtocolStep], where: str, line: int
    ) -> None:
        """Note what would end a wait of a `while`: a server does one thing at a time."""
        used: dict[str, ProtocolStep] = {}
        for wait in waits:
            server = server_of(wait)
            if server and server in used:
                text = f"{used[server].text!r} and {wait.text!r} both need {server}, which does one thing at a time"
                self.note(where, f"{text}: one wait may name several sensors or words", line)
            used.setdefault(server, wait)
        for step in steps_in(steps):
            if isinstance(step, CommandStep) and used and step.command.stops:
                self.note(where, "stop would end the wait of the while as well", step.line)
            elif isinstance(step, CommandStep) and server_of(step) in used:
                text = f"{step.text!r} needs {server_of(step)}, which waits in until and does one thing at a time"
                self.note(where, text, step.line)

    def _only_acts(self, step: ProtocolStep, where: str) -> None:
        """Note steps in a `while` that wait for somebody: it waits itself."""
        if not isinstance(step, (CommandStep, PauseStep, BranchStep, RoundsStep, WhileStep)):
            text = f"{step.text!r} waits for somebody, as the while does: its do has steps of the robot, wait: SECONDS"
            self.note(where, f"{text}, when, choose and repeat; until takes a list of waits", step.line)
        if isinstance(step, WhileStep):
            self.note(where, "a while stands in no while: until takes a list of waits", step.line)
        elif isinstance(step, (BranchStep, RoundsStep)):
            for _, inner in [*step.inner()][: 1 if isinstance(step, RoundsStep) else None]:
                for each in inner:
                    self._only_acts(each, where)

    def _when(self, value: dict[str, Any], path: str, line: int, _label: str) -> ProtocolStep:
        conditions = self._conditions(value["when"], f"step {path}", line, self._names)
        branches = [(conditions, self._steps(value.get("then"), f"{path}.b1", line))]
        if "else" in value:
            branches.append(((), self._steps(value["else"], f"{path}.b2", line_in(value, "else"))))
        return BranchStep(line, "", tuple(branches))

    def _choose(self, value: dict[str, Any], path: str, line: int, _label: str) -> ProtocolStep:
        where, name, cases = f"step {path}", value["choose"], value.get("cases")
        if name not in self._names:
            self.note(where, f"there is no value {name!r}{of_those(str(name), sorted(self._names))}", line)
        if not isinstance(cases, dict) or not cases:
            self._fail(where, "cases are a mapping: {ANSWER: [STEP, ...], ...}", line_in(value, "cases") or line)
        branches = []
        for i, (answer, steps) in enumerate(cases.items(), 1):
            at = line_in(cases, answer)
            read = self._steps(steps, f"{path}.b{i}", at)
            condition = StudyCondition(str(name), "==", _word(answer), at)
            branches.append(((condition,), read))
        if "else" in value:
            read = self._steps(value["else"], f"{path}.b{len(cases) + 1}", line_in(value, "else"))
            branches.append(((), read))
        return BranchStep(line, "", tuple(branches))

    def _repeat(self, value: dict[str, Any], path: str, line: int, _label: str) -> ProtocolStep:
        where, count, name = f"step {path}", value["repeat"], value.get("as", "")
        if not _whole(count) or not 1 <= count <= MOST_ROUNDS:
            self._fail(where, f"repeat is a whole number 1..{MOST_ROUNDS}, not {count!r}", line)
        if name and not _identifier(name):
            self.note(where, f"{name!r} is no name: letters, digits and _", line_in(value, "as"))
        order = value.get("order", FIXED)
        if order not in (FIXED, RANDOM):
            text = f"order of rounds is {FIXED} (1, 2, 3) or {RANDOM}, not {order!r}"
            self.note(where, text, line_in(value, "order") or line)
        elif order == RANDOM and not name:
            text = f"order: {RANDOM} needs as: NAME, the value that is drawn for each round"
            self.note(where, text, line_in(value, "order") or line)
        seed = self._seed if order == RANDOM else None
        return RoundsStep(line, "", count, str(name), self._steps(value.get("steps"), f"{path}.r1", line), seed)

    def _conditions(self, value: Any, where: str, line: int, known: Iterable[str]) -> tuple[StudyCondition, ...]:
        texts = value if isinstance(value, list) else [value]
        if value is None or not texts:
            self.note(where, f"a condition is missing, as answer == yes: {FORM}", line)
            return ()
        read = []
        for i, text in enumerate(texts):
            at = (line_in(value, i) if isinstance(value, list) else line) or line
            try:
                condition = StudyCondition.read(_word(text), at)
            except ValueError as error:
                self.note(where, str(error), at)
                continue
            for name in condition.names():
                if name not in known:
                    self.note(where, f"there is no value {name!r}{self._hint(name, condition, known)}", at)
            read.append(condition)
        return tuple(read)

    @staticmethod
    def _hint(name: str, condition: StudyCondition, known: Iterable[str]) -> str:
        if name in LIVE:
            return f": {name} is counted while something is waited for: {{wait: until, until: {condition}}}"
        if condition.right in known:
            return f": a value stands on the left: {condition.right} {condition.operation} {condition.left}"
        return of_those(name, sorted(known))

    def _find_labels(self, value: Any, taken: dict[str, int]) -> None:
        """Note labels and names of rounds, which conditions may name.

        Branches of which one is taken may have steps of the same label. `taken`: lines of the labels before, to which
        those of the value are added.
        """
        if isinstance(value, list):
            for each in value:
                self._find_labels(each, taken)
            return
        if not isinstance(value, dict):
            return
        label, name = value.get("label"), value.get("as")
        if label is not None and (any(kind in value for kind in KINDS) or "until" in value):
            line = line_in(value, "label")
            if not _identifier(label) or label in (*GIVEN, *LIVE, NOW, NOTHING):
                reserved = ", ".join((*GIVEN, *LIVE, NOW, NOTHING))
                self.note("label", f"{label!r} is no label: letters, digits and _, and none of {reserved}", line)
            elif label in taken:
                text = f"{label!r} is the label of the step in line {taken[label]}, too"
                self.note("label", f"{text}: only branches of which one is taken share a label", line)
            elif label in self._names and label not in self._labels:
                self.note("label", f"{label!r} is the name of something else, too", line)
            else:
                self._labels.setdefault(label, line)
                self._names.update((label, f"{label}_seconds"))
                taken[label] = line
        if "repeat" in value and _identifier(name):
            self._names.add(name)
        cases = value.get("cases")
        of_branches: dict[str, int] = {}
        for each in (value.get("then"), *(cases.values() if isinstance(cases, dict) else ()), value.get("else")):
            if each is not None:
                of_branch = dict(taken)
                self._find_labels(each, of_branch)
                of_branches.update(of_branch)
        taken.update(of_branches)
        for key, each in value.items():
            if key not in ("then", "cases", "else"):
                self._find_labels(each, taken)

    def _check_texts(self, protocol: StudyProtocol) -> None:
        known = sorted(self._names)
        levels = {f"factor {factor.name}": list(factor.levels.values()) for factor in protocol.factors}
        for where, value in {"values": [protocol.values], **levels}.items():
            for text in _texts_in(value):
                for problem in unknown_names(text, known):
                    self.note(where, problem, 0)
        for path, step in all_steps(protocol):
            texts = [step.question] if isinstance(step, ChoiceStep) else []
            if isinstance(step, CommandStep):
                texts = list(_texts_in([fields for _, fields in step.command.chain]))
            for text in texts:
                for problem in unknown_names(text, known):
                    self.note(f"step {path}", problem, step.line)

    def _values(self, top: dict[str, Any], key: str) -> dict[str, Any]:
        values = self._mapping(top, key)
        for name in values:
            if not _identifier(name) or name in GIVEN:
                self.note(key, f"{name!r} is no name: letters, digits and _", line_in(values, name))
        return dict(values)

    def _mapping(self, value: dict[str, Any], key: str) -> dict[str, Any]:
        inner = value.get(key)
        if inner is None:
            return {}
        if not isinstance(inner, dict):
            self.note(key, f"{key} is a mapping, not {inner!r}", line_in(value, key))
            return {}
        return inner

    def _plain_text(self, value: dict[str, Any], key: str, default: str) -> str:
        text = value.get(key, default)
        if isinstance(text, (dict, list)) or text is None:
            self.note(key, f"{key} is a text, not {text!r}", line_in(value, key))
            return default
        return _word(text)

    def _seconds(self, value: dict[str, Any], key: str, where: str, line: int, default: float) -> float:
        seconds = value.get(key, default)
        if not _number(seconds) or not 0 <= seconds <= LONGEST:
            self.note(
                where, f"{key} is a number of seconds 0..{LONGEST:g}, not {seconds!r}", line_in(value, key) or line
            )
            return default
        return float(seconds)

    def _keys(self, value: dict[str, Any], known: Sequence[str], where: str, line: int = 0) -> None:
        for key in value:
            if key not in known:
                hint = place_of_field(value, str(key), known) or of_those(str(key), known)
                self.note(where, f"there is no {key!r}{hint}", line_in(value, key) or line)

    def _fail(self, where: str, text: str, line: int) -> Any:
        self.note(where, text, line)
        raise _Wrong


def _texts_in(value: Any) -> Iterable[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for each in value.values():
            yield from _texts_in(each)
    elif isinstance(value, (list, tuple)):
        for each in value:
            yield from _texts_in(each)


def _identifier(value: Any) -> bool:
    return isinstance(value, str) and IDENTIFIER.fullmatch(value) is not None


def _whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)


def _number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _word(value: Any) -> str:
    """A plain value of the file as a word: true is what it stands for in the file, not True."""
    return str(value).lower() if isinstance(value, bool) else str(value)

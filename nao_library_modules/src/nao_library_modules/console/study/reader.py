"""YAML -> protocol. Every mistake is told with its line and with what would be right. Pure."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from ...base.errors import BadGoal
from ...base.suggestion import of_those
from ...behaviors.language.errors import Problem
from ...behaviors.language.expressions import IDENTIFIER
from ...behaviors.language.yaml_text import line_in
from ...nao.touch_names import sensors_of
from ..files.yaml_file import ConsoleFileError, FileReader
from ..robots.commands import FORMS, read_command
from ..robots.commands import KEYS as COMMAND_KEYS
from .conditions import StudyCondition, unknown_names
from .course import all_steps
from .order import LATIN_SQUARE, ORDERS
from .protocol import (
    FIRST,
    GIVEN,
    HOLD,
    LAST,
    LIVE,
    ON_ERROR,
    SENSES,
    BranchStep,
    ChoiceStep,
    CommandStep,
    PauseStep,
    ProtocolStep,
    RoundsStep,
    SenseStep,
    StudyFactor,
    StudyPhase,
    StudyProtocol,
    UntilStep,
    WantedRecordings,
)

NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}")
"""What studies and participants may be called: it is the name of a folder, too."""
NAME_FORM = "letters, digits, _ and -, a letter or digit first, 64 at most"
TOPIC = re.compile(r"/?[A-Za-z]\w*(/[A-Za-z]\w*)*")
LONGEST, DEFAULT_WAIT = 3600.0, 3600.0
"""s: the longest wait of the servers, and that of a step that names none."""
MOST_ROUNDS, MOST_CONDITIONS = 1000, 64
_TOP = ("name", "help", "factors", "order", "seed", "values", "record", "phases")
_COMMON = ("label", "timeout", "on_error")
_KEYS = {
    "wizard": ("choices", "label", "timeout"),
    "wait": (),
    "when": ("then", "else"),
    "choose": ("cases", "else"),
    "repeat": ("as", "steps"),
}
_SENSE_KEYS = {"touch": "sensors", "word": "words", "face": "names"}
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
        self._compared: list[tuple[StudyCondition, str, int]] = []  # with where they stand, and their line

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
        self._find_labels(top.get("phases"))
        seed = top.get("seed", 0)
        if not _whole(seed):
            self.note("seed", f"{seed!r} is no whole number", line_in(top, "seed"))
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
            seed if _whole(seed) else 0,
            values,
            self._recordings(top),
            tuple(self._phases(top)),
            text,
        )
        self._check_texts(protocol)
        self._check_answers(protocol)
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
        if what == "until":
            self._keys(value, ("wait", "until", "label", "timeout"), where, line)
            known = {*self._names, *LIVE}
            conditions = self._conditions(value.get("until"), where, line_in(value, "until") or line, known)
            return UntilStep(line, label, conditions, self._seconds(value, "timeout", where, line, 0.0))
        if what not in SENSES:
            text = f"there is no wait for {what!r}{of_those(str(what), (*SENSES, 'until'))}, or a number of seconds"
            self._fail(where, text, line)
        key = _SENSE_KEYS[what]
        self._keys(value, ("wait", key, "label", "timeout", "confidence"), where, line)
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
        confidence = value.get("confidence", 0.0)
        if not _number(confidence) or not 0 <= confidence <= 1:
            self._fail(where, f"confidence is a number 0..1, not {confidence!r}", line_in(value, "confidence"))
        timeout = self._seconds(value, "timeout", where, line, DEFAULT_WAIT)
        return SenseStep(line, label, str(what), words, timeout or DEFAULT_WAIT, float(confidence))

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
            condition = StudyCondition(str(name), "==", _word(answer))
            self._compared.append((condition, where, at))
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
        return RoundsStep(line, "", count, str(name), self._steps(value.get("steps"), f"{path}.r1", line))

    def _conditions(self, value: Any, where: str, line: int, known: Iterable[str]) -> tuple[StudyCondition, ...]:
        texts = value if isinstance(value, list) else [value]
        read = []
        for text in texts:
            try:
                condition = StudyCondition.read(str(text))
            except ValueError as error:
                self.note(where, str(error), line)
                continue
            for name in condition.names():
                if name not in known:
                    self.note(where, f"there is no value {name!r}{of_those(name, sorted(known))}", line)
            self._compared.append((condition, where, line))
            read.append(condition)
        return tuple(read)

    def _find_labels(self, value: Any) -> None:
        """Labels and names of rounds, which conditions before or behind them may name."""
        if isinstance(value, list):
            for each in value:
                self._find_labels(each)
        if not isinstance(value, dict):
            return
        label, name = value.get("label"), value.get("as")
        if label is not None and any(kind in value for kind in KINDS):
            line = line_in(value, "label")
            if not _identifier(label) or label in (*GIVEN, *LIVE):
                self.note(
                    "label", f"{label!r} is no label: letters, digits and _, and none of {', '.join(GIVEN)}", line
                )
            elif label in self._labels or label in self._names:
                self.note("label", f"{label!r} is the name of something else, too", line)
            else:
                self._labels[label] = line
                self._names.update((label, f"{label}_seconds"))
        if "repeat" in value and _identifier(name):
            self._names.add(name)
        for each in value.values():
            self._find_labels(each)

    def _check_texts(self, protocol: StudyProtocol) -> None:
        levels = {f"factor {factor.name}": list(factor.levels.values()) for factor in protocol.factors}
        for where, value in {"values": [protocol.values], **levels}.items():
            for text in _texts_in(value):
                for problem in unknown_names(text, sorted(self._names)):
                    self.note(where, problem, 0)
        for path, step in all_steps(protocol):
            texts = [step.question] if isinstance(step, ChoiceStep) else []
            if isinstance(step, CommandStep):
                texts = list(_texts_in([fields for _, fields in step.command.chain]))
            for text in texts:
                for problem in unknown_names(text, sorted(self._names)):
                    self.note(f"step {path}", problem, step.line)

    def _check_answers(self, protocol: StudyProtocol) -> None:
        """Note conditions that wait for an answer that a step cannot have, or a level that a factor does not have."""
        words: dict[str, tuple[str, ...]] = {factor.name: tuple(factor.levels) for factor in protocol.factors}
        words.update((step.label, step.answers) for _, step in all_steps(protocol) if step.label)
        for condition, where, line in self._compared:
            known = words.get(condition.left, ())
            # Several sensors that are touched at once are one answer.
            for word in condition.right.split(", ") if known and condition.operation in ("==", "!=") else ():
                if word not in known:
                    self.note(where, f"{condition.left} is never {word!r}{of_those(word, known)}", line)

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
                self.note(where, f"there is no {key!r}{of_those(str(key), known)}", line_in(value, key) or line)

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

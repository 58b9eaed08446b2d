"""From the text of the wizard's file to what the page is made of. Every mistake is told with its line. Pure.

The file is a mapping::

    title: Greeting study              # all keys may be left out
    speed: 0.5                         # share of the full speed that walking begins with
    names: {participant: ""}           # for {participant} in texts; what they begin with
    templates: ["Hello {participant}!"]
    groups:
      - group: Words
        color: blue
        buttons:
          - {label: Hello, key: "1", say: "Hello {participant}!", animated: true}
          - {label: Wave, key: H, color: green, tooltip: With the right hand, run: hello, with: {text: Hi}}
          - {label: Nod now and then, repeat: 8, run: nod}
          - {label: Consent, once: true, say: "Shall we begin?"}
          - {label: The other looks, robot: nao2, perform: {type: looking, direction: left}}

What a button does is one of the forms of `robots.commands`, or `perform`: a designator for the node
`process_modules`, as a text or a mapping.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...base.colours import is_colour
from ...base.errors import BadGoal
from ...base.suggestion import did_you_mean
from ...behaviors.language.yaml_text import dump_line, line_in, line_of
from ..files.yaml_file import FileReader, revision_of
from ..robots.commands import FORMS, KEYS, place_of_field, read_command
from .key_names import BadKey, key_of
from .model import ButtonAction, ButtonGroup, PlanDesignator, WizardButton, WizardLayout, hex_colour
from .texts import NAME, names_in

TOP_KEYS = ("title", "speed", "names", "templates", "groups")
GROUP_KEYS = ("group", "color", "robot", "buttons")
PERFORM = "perform"
BUTTON_KEYS = ("label", "key", "color", "tooltip", "once", "repeat", "robot", *KEYS, PERFORM)
SLOWEST, SPEED = 0.1, 0.5
"""Shares of the full speed: the least one to choose, and the usual one."""
LONGEST_REPEAT = 3600.0
LONGEST_LABEL = 60
LONGEST_TEXT = 2000
MOST_BUTTONS = 400


def read_layout(text: str, name: str = "console.yaml") -> WizardLayout:
    """Read a wizard's file.

    Functions and behaviours are not looked up here: `check.doubts` does that.

    Args:
        text: YAML, as the top of this module shows.
        name: Of the file, for errors.

    Raises:
        ConsoleFileError: With all that is wrong, in the order of the file.
    """
    reader = FileReader(text, name)
    layout = _LayoutReader(reader, revision_of(text)).layout()
    reader.finish()
    return layout


class _LayoutReader:
    """Makes the layout of a file, and notes what is wrong with it."""

    def __init__(self, file: FileReader, revision: str) -> None:
        self._file = file
        self._revision = revision
        self._names: Mapping[str, str] = {}
        self._keys: dict[str, tuple[str, int]] = {}
        self._labels: dict[tuple[str, str], int] = {}
        self._count = 0

    def layout(self) -> WizardLayout:
        content = {} if self._file.content is None else self._file.content
        top = self._file.mapping(content, "", TOP_KEYS)
        if not isinstance(content, dict):
            return WizardLayout()
        speed = self._file.number(content, "speed", "", SPEED, SLOWEST, 1.0)
        self._names = self._read_names(content)
        templates = self._templates(content)
        groups = [
            self._group(each, f"group {number}", line_in(top["groups"], number - 1))
            for number, each in enumerate(self._file.items(top.get("groups"), "groups"), start=1)
        ]
        if self._count > MOST_BUTTONS:
            self._file.note("groups", f"{self._count} buttons: at most {MOST_BUTTONS}", line_in(content, "groups"))
        title = self._short(content, "title", "") or WizardLayout.title
        return WizardLayout(title, tuple(groups), self._names, templates, speed, self._revision)

    def _group(self, value: Any, where: str, line: int) -> ButtonGroup:
        if not isinstance(value, dict):
            self._file.note(where, f"a mapping with {', '.join(GROUP_KEYS)} is wanted", line)
            return ButtonGroup("", ())
        content = self._file.mapping(value, where, GROUP_KEYS)
        title = self._short(value, "group", where)
        if not title:
            self._file.note(where, "it has no title: `group: TITLE`", line_of(value) or line)
        given = (title, self._colour(value, where), self._short(value, "robot", where))
        items = self._file.items(content.get("buttons"), f"{where}.buttons")
        buttons = [
            self._button(each, f"{where}, button {place}", line_in(items, place - 1), given)
            for place, each in enumerate(items, start=1)
        ]
        return ButtonGroup(title, tuple(button for button in buttons if button is not None))

    def _button(self, value: Any, where: str, line: int, group: tuple[str, str, str]) -> WizardButton | None:
        self._count += 1
        if not isinstance(value, dict):
            self._file.note(where, f"a mapping with {', '.join(BUTTON_KEYS)} is wanted", line)
            return None
        self._file.mapping(value, where, BUTTON_KEYS, place_of=lambda key: place_of_field(value, key, BUTTON_KEYS))
        line = line_of(value) or line
        action = self._action(value, where, line)
        label = self._label(value, where, line, group[0], action)
        once = self._file.flag(value, "once", where)
        repeat = self._file.number(value, "repeat", where, 0.0, 0.0, LONGEST_REPEAT)
        if once and repeat:
            self._file.note(where, "once and repeat exclude each other: one of them", line_in(value, "repeat"))
        names = () if action is None else names_in(action.to_yaml())
        self._declared(names, where, line)
        key = self._key(value, where, label)
        color = self._colour(value, where) or group[1]
        robot = self._short(value, "robot", where) or group[2]
        tooltip = self._file.text(value, "tooltip", where)[:LONGEST_TEXT]
        if action is None:
            return None
        return WizardButton(
            str(self._count), label, action, key, color, tooltip, once, repeat, robot, names=names, line=line
        )

    def _label(self, value: Any, where: str, line: int, group: str, action: ButtonAction | None) -> str:
        label = self._short(value, "label", where) or getattr(action, "label", "")[:LONGEST_LABEL]
        if not label and action is not None:
            self._file.note(where, "it has no label: `label: TEXT`", line)
        if (group, label) in self._labels and action is not None:
            first = self._labels[group, label]
            problem = f"{label!r} is there already, in line {first}: each label once in a group, for logs tell them so"
            self._file.note(where, problem, line_in(value, "label") or line)
        self._labels.setdefault((group, label), line)
        return label

    def _action(self, value: Any, where: str, line: int) -> ButtonAction | None:
        if PERFORM not in value:
            unknown = [key for key in value if key not in BUTTON_KEYS]
            if unknown and not any(key in FORMS for key in value):
                return None  # the unknown key was noted, and is most likely what it should do
            return read_command(self._file, value, where)
        others = [key for key in value if key in KEYS]
        if others:
            self._file.note(where, f"{PERFORM} and {others[0]} exclude each other", line_in(value, others[0]))
        designator = value[PERFORM]
        if isinstance(designator, str) and designator.strip():
            return PlanDesignator(designator.strip(), designator.strip())
        if isinstance(designator, dict) and designator:
            text = dump_line(designator)
            return PlanDesignator(text, str(designator.get("type", text)))
        problem = "a designator is wanted: {type: looking, direction: left}, or the same as a text"
        self._file.note(f"{where}.{PERFORM}", problem, line_in(value, PERFORM) or line)
        return None

    # --- values -------------------------------------------------------------------------------------------------------

    def _read_names(self, content: Any) -> Mapping[str, str]:
        names = content.get("names") or {}
        if not isinstance(names, dict):
            self._file.note("names", 'a mapping is wanted: `names: {participant: ""}`', line_in(content, "names"))
            return {}
        read = {}
        for name in names:
            if isinstance(name, str) and NAME.fullmatch(name):
                read[name] = self._file.text(names, name, "names")
            else:
                problem = f"{name!r} is no name: letters, digits and '_', no digit in front"
                self._file.note("names", problem, line_in(names, name))
        return read

    def _templates(self, content: Any) -> tuple[str, ...]:
        items = self._file.items(content.get("templates"), "templates")
        read = []
        for place, each in enumerate(items):
            where, line = f"template {place + 1}", line_in(items, place)
            if isinstance(each, str) and 0 < len(each.strip()) <= LONGEST_TEXT:
                self._declared(names_in(each), where, line)
                read.append(each.strip())
            else:
                told = f"a text of 1 to {LONGEST_TEXT} characters is wanted; one that begins with {{ needs quotes"
                self._file.note(where, told, line)
        return tuple(read)

    def _declared(self, names: tuple[str, ...], where: str, line: int) -> None:
        for name in names:
            if name not in self._names:
                hint = did_you_mean(name, self._names) or f': add it, `names: {{{name}: ""}}`'
                self._file.note(where, f"{{{name}}} is not among the names of the file{hint}", line)

    def _key(self, value: Any, where: str, label: str) -> str:
        written = self._file.text(value, "key", where)
        if not written:
            return ""
        line = line_in(value, "key")
        try:
            key = key_of(written)
        except BadKey as error:
            self._file.note(f"{where}.key", str(error), line)
            return ""
        if key in self._keys:
            other, at = self._keys[key]
            self._file.note(f"{where}.key", f"{key} is that of {other!r} already, in line {at}: each key once", line)
            return ""
        self._keys[key] = (label, line)
        return key

    def _colour(self, value: Any, where: str) -> str:
        written = self._file.text(value, "color", where)
        if not written or is_colour(written):
            return hex_colour(written) if written else ""
        try:
            hex_colour(written)
        except BadGoal as error:
            self._file.note(where, f"{error}; one with # needs quotes", line_in(value, "color"))
        return ""

    def _short(self, value: Any, key: str, where: str) -> str:
        text = self._file.text(value, key, where).strip()
        if len(text) > LONGEST_LABEL:
            self._file.note(where, f"{key} has {len(text)} characters: at most {LONGEST_LABEL}", line_in(value, key))
        return text[:LONGEST_LABEL]

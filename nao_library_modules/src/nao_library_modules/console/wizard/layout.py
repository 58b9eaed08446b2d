"""What the wizard's page consists of: buttons, groups, names in texts, keys; read from its YAML file. Pure.

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

What a button does is one of the forms of `studies.commands`, or `perform`: a designator for the node
`process_modules`, as a text or a mapping.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Union

from naoqi.errors import NaoError

from ...behaviors.strict_yaml import dump_line, line_in, line_of
from ...core.errors import BadGoal, did_you_mean
from ...core.lights_and_colours import is_colour, parse_colour, to_integer
from ...driver.teleop.teleop_nao_keyboard import ARROWS, DIRECTIONS
from ...studies.commands import FORMS, KEYS, FileReader, RobotCommand, place_of_field, read_command, revision_of
from ..robots.robot_goals import GOAL_ENDS, NOT_SENT


class EditConflict(NaoError):
    """The file has changed on the disk since its text was read."""

    def __init__(self, path: Path) -> None:
        super().__init__(f"{path} has changed on the disk since you opened it: load it again, or save over it")
        self.path = path


class PressRefused(NaoError):
    """A button or a text is not sent to the robot."""


SHIFT = "Shift+"
FUNCTION_KEYS = ("F2", "F4", "F8", "F9")
"""Those that no usual browser takes for itself."""
ALLOWED = f"a letter, a digit, one of , . - + # or {', '.join(FUNCTION_KEYS)}; letters and digits also with {SHIFT}"
_SIGNS = ",.-+#"
_SHIFTED = re.compile(r"[A-Z0-9]")
WALKING = {
    **{f"Arrow{name.capitalize()}": DIRECTIONS[key] for name, key in ARROWS.items()},
    **{key.upper(): velocity for key, velocity in DIRECTIONS.items()},
}
"""Keys that walk while they are held, in the form of `key_of` -> the velocity."""
_BROWSER = {"TAB": "moves the focus", "ENTER": "presses what has the focus", "SPACE": "presses what has the focus"}


class BadKey(NaoError):
    """A text names no key that a button may have."""


def key_of(text: str) -> str:
    """A shortcut in its one form: "h" and "H" are "H", "shift + h" is "Shift+H", "f2" is "F2".

    Raises BadKey if a button cannot have it.
    """
    word = "".join(text.split()) if len(text) > 1 else text
    shifted = word.lower().startswith(SHIFT.lower()) and len(word) > len(SHIFT)
    key = word[len(SHIFT) :] if shifted else word
    key = key.upper()
    if key in ("ESC", "ESCAPE"):
        raise BadKey(f"{text!r} always stops the robot: {ALLOWED}")
    if key in WALKING or key.startswith("ARROW"):
        raise BadKey(f"{text!r} walks (W A S D Q E and the arrows): {ALLOWED}")
    if key in _BROWSER or key == " ":
        raise BadKey(f"{text!r} {_BROWSER.get(key, _BROWSER['SPACE'])}: {ALLOWED}")
    if key in FUNCTION_KEYS and not shifted:
        return key
    if _SHIFTED.fullmatch(key):
        return f"{SHIFT}{key}" if shifted else key
    if len(key) == 1 and key in _SIGNS and not shifted:
        return key
    raise BadKey(f"{text!r} is no key for a button: {ALLOWED}")


NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_BRACES = re.compile(r"(?<![${])\{([A-Za-z_][A-Za-z0-9_]*)\}")


def names_in(value: Any) -> tuple[str, ...]:
    """Names in braces in all texts of a value, each once, in their order. `value`: of JSON's kinds."""
    found: dict[str, None] = {}
    _collect(value, found)
    return tuple(found)


def filled_text(text: str, values: Mapping[str, str]) -> str:
    """A text with names replaced by their values; a name without a value stays."""
    return _BRACES.sub(lambda match: values.get(match[1], match[0]), text)


def _collect(value: Any, found: dict[str, None]) -> None:
    if isinstance(value, str):
        found.update(dict.fromkeys(match[1] for match in _BRACES.finditer(value)))
    elif isinstance(value, Mapping):
        for each in value.values():
            _collect(each, found)
    elif isinstance(value, (list, tuple)):
        for each in value:
            _collect(each, found)


RUNS, REPEATS, USED = "runs", "repeats", "used"
BUTTON_WORDS = {
    RUNS: "runs",
    REPEATS: "repeats",
    USED: "done",
    **{end.state: end.word for end in GOAL_ENDS if end.failed},
}
"""State of a button -> what stands on it."""
FAILED_STATES = tuple(end.state for end in GOAL_ENDS if end.failed)
DARK, LIGHT = "#000000", "#ffffff"


@dataclass(frozen=True)
class PlanDesignator:
    """What the plans' node `process_modules` performs. `text`: YAML or Lisp, as docs/plans.md has it."""

    text: str
    label: str = ""

    def to_yaml(self) -> Mapping[str, Any]:
        """As `RobotCommand.to_yaml`."""
        return {"perform": self.text}


ButtonAction = Union[RobotCommand, PlanDesignator]


@dataclass(frozen=True)
class WizardButton:
    """A button.

    Attributes:
        id: Of this button among those of the file.
        label: What stands on it; with the title of its group it is the button's name in logs.
        action: What it has the robot do.
        key: Its shortcut in the form of `key_of`, as "Shift+H"; empty: none.
        color: Background as #RRGGBB; empty: that of its group or of the theme.
        tooltip: Empty: what it does, in the words of its action.
        once: Whether it can be pressed a single time, until it is armed again.
        repeat: s from the end of one run to the beginning of the next, until it is pressed again; 0: it runs once.
        robot: Name or namespace of the robot that it is for; empty: the one of the page.
        names: Names in braces in its texts.
        line: In the file, counted from 1.
    """

    id: str
    label: str
    action: ButtonAction
    key: str = ""
    color: str = ""
    tooltip: str = ""
    once: bool = False
    repeat: float = 0.0
    robot: str = ""
    names: tuple[str, ...] = ()
    line: int = 0


@dataclass(frozen=True)
class ButtonGroup:
    """Buttons that stand together under a title."""

    title: str
    buttons: tuple[WizardButton, ...]


@dataclass(frozen=True)
class WizardLayout:
    """The wizard's file.

    Attributes:
        title: Of the page.
        groups: In the order of the file.
        names: Names that texts may use in braces, with the values they begin with.
        templates: Free texts to choose from.
        speed: Share of the full speed that walking begins with, 0.1..1.
        revision: Of the text that it was read from; another text has another one.
    """

    title: str = "Wizard"
    groups: tuple[ButtonGroup, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    templates: tuple[str, ...] = ()
    speed: float = 0.5
    revision: str = ""

    def buttons(self) -> Iterator[tuple[ButtonGroup, WizardButton]]:
        """All buttons with their groups, in the order of the file."""
        for group in self.groups:
            for button in group.buttons:
                yield group, button


def hex_colour(text: str) -> str:
    """A colour as #RRGGBB. `text`: as `lights_and_colours.parse_colour` takes it, which raises BadGoal."""
    return f"#{to_integer(parse_colour(text, 'color')):06x}"


def text_colour(background: str) -> str:
    """Black or white, whichever has the higher contrast on a colour: 4.58 to 1 at least.

    `background`: #RRGGBB. Source: relative luminance of WCAG 2.1.
    """
    parts = [int(background[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    return DARK if (luminance + 0.05) / 0.05 >= 1.05 / (luminance + 0.05) else LIGHT


def action_text(action: ButtonAction) -> str:
    """What an action does, for a tooltip: its form in the file."""
    return "; ".join(f"{key}: {_shown(value)}" for key, value in action.to_yaml().items())


def _shown(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=str)


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

    Functions and behaviours are not looked up here: `layout_file.doubts` does that.

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


def layout_message(layout: WizardLayout) -> dict[str, Any]:
    """A layout for static/wizard.js, with what stands on buttons in their states, and the keys that walk.

    `failed`: the states of presses that have failed. `walking`: keys with their velocities, [ahead, left, turn left].
    """
    groups = [
        {"title": group.title, "buttons": [_button(button) for button in group.buttons]} for group in layout.groups
    ]
    keys = {button.key: button.id for _, button in layout.buttons() if button.key}
    return {
        "layout": {"revision": layout.revision, "speed": layout.speed, "groups": groups, "keys": keys},
        "words": BUTTON_WORDS,
        "failed": FAILED_STATES,
        "not_sent": NOT_SENT.state,
        "walking": {key: [way.x, way.y, way.theta] for key, way in WALKING.items()},
    }


def _button(button: WizardButton) -> dict[str, Any]:
    notes = [button.tooltip or action_text(button.action)]
    if button.robot:
        notes.append(f"robot {button.robot}")
    if button.once:
        notes.append("once")
    if button.repeat:
        notes.append(f"again {button.repeat:g} s after its end, until it is pressed again")
    return {
        "id": button.id,
        "label": button.label,
        "key": button.key,
        "color": button.color,
        "text_color": text_colour(button.color) if button.color else "",
        "robot": button.robot,
        "stops": getattr(button.action, "stops", False),
        "tooltip": "; ".join(notes),
    }

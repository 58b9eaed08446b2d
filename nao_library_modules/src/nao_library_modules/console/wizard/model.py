"""What the wizard's page is made of. Pure."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Union

from ...base.colours import parse_colour, to_integer
from ..robots.commands import RobotCommand
from ..robots.runs import GOAL_ENDS

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
        key: Its shortcut in the form of `key_names`, as "Shift+H"; empty: none.
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
    """A colour as #RRGGBB. `text`: as `base.colours.parse_colour` takes it, which raises BadGoal."""
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

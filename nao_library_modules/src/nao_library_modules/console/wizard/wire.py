"""What the wizard's page is told of its layout, as values that JSON has. Pure."""

from __future__ import annotations

from typing import Any

from ..robots.runs import NOT_SENT
from .key_names import WALKING
from .model import BUTTON_WORDS, FAILED_STATES, WizardButton, WizardLayout, action_text, text_colour


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

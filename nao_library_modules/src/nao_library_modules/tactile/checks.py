"""What depends on several fields of a TactileFunction, or on the links that there are. Every check raises BadGoal."""

from __future__ import annotations

from typing import Any

from ..base.field_checks import require_known
from .fields import PRESSES, TOUCH_TIME
from .touch import COUNT, HOLD, PRESS


def check_touch(_self: Any, touch: str, count: int, duration: float) -> None:
    """The numbers that a kind of touch has."""
    kind = touch.strip() or PRESS
    if kind == COUNT:
        PRESSES.require("count", count)
    if kind in (COUNT, HOLD):
        TOUCH_TIME.require("duration", duration)


def check_binding(
    self: Any, str_param: str, touch: str, count: int, duration: float, behavior: str, context: dict[str, Any]
) -> None:
    """As waitForTouch; later functions of the chain may remove the link."""
    check_touch(self, touch, count, duration)
    context.setdefault("bindings", set(self.bindings.names)).add(str_param.strip() or behavior.strip())


def check_removal(self: Any, str_param: str, context: dict[str, Any]) -> None:
    """A link that is there when it is to be removed."""
    names = context.setdefault("bindings", set(self.bindings.names))
    if not str_param.strip():
        names.clear()
        return
    names.remove(require_known("str_param", str_param, sorted(names), "link between a touch and a behaviour"))

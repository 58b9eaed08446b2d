"""Bounds of numbers and texts in requests of the simulator's ROS services: those of calls over libqi."""

from __future__ import annotations

from typing import Any

from nao_sim_bridge.base.limits import check, field_kind
from nao_sim_bridge.naoqi.binding.limits import check_sizes


def checked(request: Any) -> Any:
    """A request whose numbers are within the bounds of the fields that they are in, and whose texts are not too long.

    Raises:
        BadValue: One of them is not.
    """
    check_sizes(_plain(request))
    for field in request.__slots__:
        check(_plain(getattr(request, field)), field, field_kind(field))
    return request


def _plain(value: Any) -> Any:
    """A message as a list, a duration as seconds; anything else as it is."""
    if hasattr(value, "to_sec"):
        return value.to_sec()
    slots = getattr(value, "__slots__", None)
    return value if slots is None else [_plain(getattr(value, slot)) for slot in slots]

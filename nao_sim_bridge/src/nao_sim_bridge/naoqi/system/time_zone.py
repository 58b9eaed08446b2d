"""The time zone that the robot's clock shows."""

from __future__ import annotations

import logging
import os
from datetime import datetime, tzinfo
from pathlib import Path

from dateutil import tz

log = logging.getLogger("nao_sim.time_zone")

ZONES = Path("/usr/share/zoneinfo")
LOCAL = Path("/etc/localtime")
"""The computer's own zone; mostly a link to one of `ZONES`."""
UTC = "UTC"


class TimeZone:
    """A time zone that can be changed; at first that of this process: what TZ says, else the computer's own."""

    def __init__(self) -> None:
        self.name, self._zone = _own()

    def change(self, name: str) -> bool:
        """Change it to one that this machine knows; False when it knows none of this name."""
        parts = Path(name).parts
        file = ZONES.joinpath(*parts)
        if not parts or ".." in parts or Path(name).is_absolute():
            return False
        try:
            if not file.is_file():
                return False
            self._zone = tz.tzfile(str(file))
        except (OSError, ValueError):  # no name that a file can have; a table of the zones, or something else
            return False
        self.name = name
        return True

    def now(self) -> datetime:
        """What the clock shows."""
        return datetime.now(self._zone)


def _own() -> tuple[str, tzinfo]:
    if "TZ" not in os.environ:
        return _computers_name(), tz.tzlocal()
    name = os.environ["TZ"].lstrip(":") or UTC
    try:
        zone = tz.gettz(name)
    except (OSError, ValueError):  # a file that is no zone
        zone = None
    if zone is None:
        log.warning("TZ is %r, which this machine does not know as a time zone: the robot's clock shows UTC", name)
        return UTC, tz.UTC
    return name, zone


def _computers_name() -> str:
    """Name of the computer's own zone, as far as a link tells it."""
    try:
        target = os.readlink(LOCAL)
    except OSError:
        return UTC
    return target.rpartition(f"/{ZONES.name}/")[2] if f"/{ZONES.name}/" in target else UTC

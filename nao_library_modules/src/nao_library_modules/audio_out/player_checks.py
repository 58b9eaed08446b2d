"""Checks of the functions that play sounds, made before a chain begins. Parameters are fields of AudioOutFunction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from ..base.errors import BadGoal
from ..base.suggestion import did_you_mean
from .files import LoadedSounds


class Plays(Protocol):
    """The module, as far as the checks need it."""

    loaded: LoadedSounds
    player: Callable[..., Any]


def check_background(_self: object, duration: float, background: bool) -> None:
    """No time to end a sound in the background."""
    if background and duration > 0.0:
        # Somebody has to wait for its end, to end it.
        raise BadGoal("duration", duration, "0 for a sound in the background; stopAll ends it")


def check_load(self: Plays, str_param: str, context: dict[str, Any]) -> None:
    """Later functions of the chain may use the file by its name."""
    _loaded(self, context).append(str_param.strip())


def check_loaded(self: Plays, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
    """A sound that is loaded, or that the chain has loaded by then."""
    if sound_id > 0:
        return  # others may have loaded it: the robot knows
    name, known = str_param.strip(), _loaded(self, context)
    if name and name not in known:
        allowed = f"one of {', '.join(dict.fromkeys(known))}" if known else "loadFile comes first"
        raise BadGoal("str_param", str_param, allowed, problem=f"{name!r} is not loaded{did_you_mean(name, known)}")
    if not known:
        raise BadGoal("sound_id", sound_id, "loadFile comes first", problem="no sound is loaded")


def check_unload(self: Plays, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
    """A sound that is loaded."""
    check_loaded(self, sound_id, str_param, context)
    known, name = _loaded(self, context), str_param.strip()
    if sound_id == 0:
        known.remove(name or known[-1])


def check_unload_all(self: Plays, context: dict[str, Any]) -> None:
    """Later functions of the chain have no sound any more."""
    _loaded(self, context).clear()


def check_play(
    self: Plays, sound_id: int, str_param: str, duration: float, background: bool, context: dict[str, Any]
) -> None:
    """A sound that is loaded, and no time to end it in the background."""
    check_loaded(self, sound_id, str_param, context)
    check_background(self, duration, background)


def check_volume_of(self: Plays, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
    """Nothing, or a sound that is loaded."""
    if sound_id or str_param.strip():
        check_loaded(self, sound_id, str_param, context)


def check_set(self: Plays, str_param: str) -> None:
    """A sound set that is installed."""
    name, known = str_param.strip(), list(self.player("getInstalledSoundSetsList"))
    if name not in known:
        allowed = f"one of {', '.join(known)}" if known else "none is installed"
        problem = f"{name!r} is no sound set of the robot{did_you_mean(name, known)}"
        raise BadGoal("str_param", str_param, allowed, problem=problem)


def check_set_file(self: Plays, str_param: str, duration: float, background: bool) -> None:
    """A sound set that is installed, or none; and no time to end the sound in the background."""
    if str_param.strip():
        check_set(self, str_param)
    check_background(self, duration, background)


def _loaded(self: Plays, context: dict[str, Any]) -> list[str]:
    """Names of the sounds that are loaded by then, the last one last."""
    return context.setdefault("loaded", self.loaded.names)

"""Checks of the functions that play sounds, made before a chain begins. Parameters are fields of AudioOutFunction."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol
from urllib.parse import urlsplit

from ..audio.checks import require_file
from ..base.errors import BadGoal
from ..base.field_checks import CONTROL, require_number, require_text, require_whole, require_within, require_zero_or
from ..base.limits import limit
from ..base.suggestion import did_you_mean
from .files import LoadedSounds

SOUND_FILES = (".wav", ".ogg", ".flac", ".mp3")
STREAMS = ("http", "https")
LENGTH, SHARE, SETTING, TONE = limit("recording"), limit("share"), limit("setting"), limit("tone")


class Plays(Protocol):
    """The module, as far as the checks need it."""

    loaded: LoadedSounds
    player: Callable[..., Any]


def require_seconds(field: str, value: float) -> float:
    """A time that is not absurd, s."""
    return require_zero_or(field, value, LENGTH)


def _check_sound(volume: float, pan: float, duration: float, background: bool) -> None:
    """How loud a sound is, and how long."""
    require_within("volume", volume, SHARE)
    require_number("pan", pan, -1.0, 1.0, "-1 (left) .. 1 (right)")
    require_seconds("duration", duration)
    if background and duration > 0.0:
        # Somebody has to wait for its end, to end it.
        raise BadGoal("duration", duration, "0 for a sound in the background; stopAll ends it")


def check_play_file(
    _self: object, str_param: str, volume: float, pan: float, duration: float, background: bool
) -> None:
    """A file, how loud it is, and how long."""
    require_file("str_param", str_param, SOUND_FILES)
    _check_sound(volume, pan, duration, background)


def check_play_from(
    _self: object, str_param: str, position: float, volume: float, pan: float, duration: float, background: bool
) -> None:
    """A file, from where on, how loud it is, and how long."""
    check_play_file(_self, str_param, volume, pan, duration, background)
    require_seconds("position", position)


def check_sine(_self: object, frequency: float, volume: float, pan: float, duration: float) -> None:
    """A tone that can be heard."""
    require_whole("frequency", frequency, TONE.lowest, TONE.highest, " (Hz)")
    require_within("volume", volume, SHARE)
    if pan not in (-1.0, 0.0, 1.0):
        raise BadGoal("pan", pan, "-1 (left), 0 or 1 (right)")
    require_within("duration", duration, LENGTH)


def check_stream(_self: object, str_param: str, volume: float, pan: float, duration: float, background: bool) -> None:
    """An address, how loud it is, and how long."""
    address = require_text("str_param", str_param, "the address of a stream")
    allowed = "an address that begins with http:// or https://"
    try:
        parts = urlsplit(address)
        good = parts.scheme in STREAMS and bool(parts.hostname) and not CONTROL.search(address)
    except ValueError:
        good = False
    if not good:
        raise BadGoal("str_param", str_param, allowed)
    _check_sound(volume, pan, duration, background)


def check_load(self: Plays, str_param: str, context: dict[str, Any]) -> None:
    """A file; later functions of the chain may use it by its name."""
    _loaded(self, context).append(require_file("str_param", str_param, SOUND_FILES))


def check_loaded(self: Plays, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
    """A sound that is loaded, or that the chain has loaded by then."""
    if sound_id < 0:
        raise BadGoal("sound_id", sound_id, "as loadFile answers it, or 0 for the one in str_param")
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
    self: Plays,
    sound_id: int,
    str_param: str,
    volume: float,
    pan: float,
    duration: float,
    background: bool,
    context: dict[str, Any],
) -> None:
    """A sound that is loaded, how loud it is, and how long."""
    check_loaded(self, sound_id, str_param, context)
    _check_sound(volume, pan, duration, background)


def check_go_to(self: Plays, sound_id: int, str_param: str, position: float, context: dict[str, Any]) -> None:
    """A sound that is loaded, and a place in it."""
    check_loaded(self, sound_id, str_param, context)
    require_seconds("position", position)


def check_pitch(self: Plays, sound_id: int, str_param: str, pitch: float, context: dict[str, Any]) -> None:
    """A sound that is loaded, and its level of pitch."""
    check_loaded(self, sound_id, str_param, context)
    require_within("pitch", pitch, SETTING)


def check_volume(self: Plays, sound_id: int, str_param: str, volume: float, context: dict[str, Any]) -> None:
    """A volume; of a sound that is loaded, if one is named."""
    if sound_id or str_param.strip():
        check_loaded(self, sound_id, str_param, context)
    require_within("volume", volume, SHARE)


def check_volume_of(self: Plays, sound_id: int, str_param: str, context: dict[str, Any]) -> None:
    """Nothing, or a sound that is loaded."""
    if sound_id or str_param.strip():
        check_loaded(self, sound_id, str_param, context)


def check_share(_self: object, volume: float) -> None:
    """A volume 0..1."""
    require_within("volume", volume, SHARE)


def check_panorama(_self: object, pan: float) -> None:
    """A direction."""
    require_number("pan", pan, -1.0, 1.0, "-1 (left) .. 1 (right)")


def check_set_name(_self: object, str_param: str) -> None:
    """Name of a sound set."""
    require_text("str_param", str_param, "the name of a sound set")


def check_set(self: Plays, str_param: str) -> None:
    """A sound set that is installed."""
    name = require_text("str_param", str_param, "the name of a sound set")
    known = list(self.player("getInstalledSoundSetsList"))
    if name not in known:
        allowed = f"one of {', '.join(known)}" if known else "none is installed"
        problem = f"{name!r} is no sound set of the robot{did_you_mean(name, known)}"
        raise BadGoal("str_param", str_param, allowed, problem=problem)


def check_set_file_name(_self: object, str_param: str, file_name: str) -> None:
    """Names of a sound set and of a file in it."""
    check_set_name(_self, str_param)
    require_text("file_name", file_name, "the name of a file of the sound set")


def check_set_file(
    self: Plays,
    str_param: str,
    file_name: str,
    position: float,
    volume: float,
    pan: float,
    duration: float,
    background: bool,
) -> None:
    """A file of a sound set, or of any that is loaded; from where on, how loud it is, and how long."""
    require_text("file_name", file_name, "the name of a file of the sound set")
    if str_param.strip():
        check_set(self, str_param)
    require_seconds("position", position)
    _check_sound(volume, pan, duration, background)


def _loaded(self: Plays, context: dict[str, Any]) -> list[str]:
    """Names of the sounds that are loaded by then, the last one last."""
    return context.setdefault("loaded", self.loaded.names)

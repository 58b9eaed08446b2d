"""Sounds that a world file places in the world: what may stand in its section `sounds`.

An entry has `name`, a place, and what sounds. The place is `position` ([x, y, z], counted from the floor as all places
are), or `on`, the name of an object of the world that it rides on; `position` is then in the frame of that object.
What sounds is one of `file` (beside the world file), `tone` (Hz, or a list of them), `noise` (`white` or `pink`), `say`
(a text; `voice` is who says it). It may have `level_db` (dB SPL at 1 m), `start` (s after the start or a reset),
`loop`, `pause` (s of silence between repetitions) and, for tones and noises, `duration` (s; without it they do not
end).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Sequence

from nao_sim_bridge.base.config import check_keys, vector
from nao_sim_bridge.base.errors import did_you_mean
from nao_sim_bridge.world.entries import name_of, number, truth
from nao_sim_bridge.world.world import Content, WorldError, WorldSound

KINDS = ("file", "tone", "noise", "say")
NOISES = ("white", "pink")
OPTIONS = ("position", "on", *KINDS, "voice", "level_db", "start", "loop", "pause", "duration")
TALK_DB = 65.0
LOUDEST = 140.0
HIGHEST_TONE = 20000.0
LONGEST = 3600.0


def read_sounds(
    entries: Sequence[tuple[str, Any]], objects: Sequence[str], folder: Path | None
) -> tuple[WorldSound, ...]:
    """The sounds of a world with these objects, whose file is in `folder`, from the entries of its file."""
    sounds: list[WorldSound] = []
    for where, entry in entries:
        sound = _read_sound(entry, where, objects, folder)
        if sound.name in [other.name for other in sounds]:
            raise WorldError(f"{where}.name", f"{sound.name!r} is taken")
        sounds.append(sound)
    return tuple(sounds)


def _read_sound(entry: Any, where: str, objects: Sequence[str], folder: Path | None) -> WorldSound:
    if isinstance(entry, Mapping):
        # YAML reads the bare word "on" as true.
        entry = {"on" if key is True else key: value for key, value in entry.items()}
    check_keys(entry, where, ("name",), OPTIONS, WorldError)
    name = name_of(entry, where)
    kind, content = _read_content(entry, where, folder)
    on = entry.get("on")
    if on is None and "position" not in entry:
        raise WorldError(where, "missing 'position', or 'on' with the name of an object")
    if on is not None and on not in objects:
        there = ", ".join(objects) or "none"
        hint = did_you_mean(on, objects)
        raise WorldError(
            f"{where}.on", f"is {on!r}{hint}{'' if hint else ','} allowed is an object of this world ({there})"
        )
    if "voice" in entry and (kind != "say" or not isinstance(entry["voice"], str)):
        raise WorldError(f"{where}.voice", "is for a text to say, and the name of a voice")
    lasting = kind in ("tone", "noise")
    if "duration" in entry and not lasting:
        raise WorldError(f"{where}.duration", f"is for tones and noises; a {kind} is as long as it is")
    loop = truth(entry, "loop", where)
    if "pause" in entry and not loop:
        raise WorldError(f"{where}.pause", "is for what is repeated: it needs 'loop: true'")
    return WorldSound(
        name=name,
        kind=kind,
        content=content,
        position=tuple(vector(entry.get("position", (0.0, 0.0, 0.0)), f"{where}.position", 3, WorldError).tolist()),
        on=on,
        voice=entry.get("voice", ""),
        level_db=number(entry, "level_db", where, TALK_DB, -20.0, LOUDEST),
        start=number(entry, "start", where, 0.0),
        loop=loop,
        pause=number(entry, "pause", where, 0.0, 0.0, LONGEST),
        duration=number(entry, "duration", where, 1.0, 0.01, LONGEST) if "duration" in entry else None,
    )


def _read_content(entry: Mapping, where: str, folder: Path | None) -> tuple[str, Content]:
    kinds = [kind for kind in KINDS if kind in entry]
    if len(kinds) != 1:
        raise WorldError(
            where, f"has {' and '.join(kinds) or 'nothing'} to sound, needs exactly one of {', '.join(KINDS)}"
        )
    kind = kinds[0]
    value, place = entry[kind], f"{where}.{kind}"
    if kind == "file":
        return kind, _file(value, place, folder)
    if kind == "tone":
        return kind, _tone(value, place)
    if kind == "noise":
        if value not in NOISES:
            raise WorldError(place, f"is {value!r}, allowed is {' or '.join(NOISES)}")
        return kind, value
    if not isinstance(value, str) or not value.strip():
        raise WorldError(place, f"is {value!r}, not a text")
    return kind, value


def _file(value: Any, place: str, folder: Path | None) -> Path:
    if not isinstance(value, str) or not value:
        raise WorldError(place, f"is {value!r}, not the name of a file")
    if folder is None:
        raise WorldError(place, "a world without a file has no files beside it")
    root = folder.resolve()
    path = (root / value).resolve()
    if Path(value).is_absolute() or root not in path.parents:
        raise WorldError(place, f"is {value!r}, allowed is a name inside {root}, where the world file is")
    if not path.is_file():
        raise WorldError(place, f"there is no file {value!r} in {root}")
    return path


def _tone(value: Any, place: str) -> tuple[float, ...]:
    listed = value if isinstance(value, list) else [value]
    frequencies = vector(listed, place, len(listed), WorldError)
    if not listed or frequencies.min() <= 0.0 or frequencies.max() > HIGHEST_TONE:
        raise WorldError(place, f"is {value!r}, allowed is above 0 to {HIGHEST_TONE:g} Hz")
    return tuple(frequencies.tolist())

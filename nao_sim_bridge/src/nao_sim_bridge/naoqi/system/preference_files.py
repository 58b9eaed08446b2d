"""The XML files of ALPreferences, which NAOqi 1.20 replaced by ALPreferenceManager; programs still read them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Callable, Mapping
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.errors import BadValue, ConfigError
from nao_sim_bridge.base.record_dir import ClientFiles
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.whole_file import write_whole
from nao_sim_bridge.base.xml_values import parse_xml
from nao_sim_bridge.naoqi.memory.store import MemoryStore

NAME = "ALPreferences"
FOLDER = ".config/{application}/{file}"
"""Where programs of the robot have their configuration, below its home."""
APPLICATION = "naoqi"
ROOT, ENTRY, ARRAY = "ModulePreference", "Preference", "array"
DEEPEST = 20
"""Preferences in preferences."""
_TYPES: Mapping[str, Callable[[str], Any]] = {
    "bool": lambda text: text.strip().lower() in ("1", "true", "yes"),
    "int": int,
    "float": float,
    "string": str,
}


@dataclass(frozen=True)
class Preference:
    """One preference, or a group of them; `memory_name` is the key of ALMemory that it is written to, if any."""

    name: str
    description: str
    value: Any  # a list of preferences for a group
    memory_name: str = ""

    def as_value(self) -> list[Any]:
        """[name, description, value], and the name of the key in ALMemory where there is one."""
        value = [one.as_value() for one in self.value] if isinstance(self.value, list) else self.value
        return [self.name, self.description, value, *([self.memory_name] if self.memory_name else [])]


class PreferenceFiles:
    """Reads, writes and removes the files, `.config/APPLICATION/NAME.xml` in the home of the robot."""

    def __init__(self, files: ClientFiles) -> None:
        self._files = files

    def read(self, application: str, name: str) -> Preference:
        """All of a file: its name, and a list of preferences.

        Raises:
            NoSuchFile: There is none.
            ConfigError: It is none of these files.
        """
        path = self._files.to_read(_path(application, name))
        try:
            content = read_bounded(path, load_sizes().xml.file_bytes)
        except (TooLarge, OSError) as error:
            raise ConfigError(path.name, str(error)) from error
        return _read(content, path)

    def write(self, name: str, content: Preference) -> None:
        """Write a file that `read` gives back as it is; a BadValue when no file can hold the content."""
        root = ElementTree.Element(ROOT, name=content.name, description=content.description, version="1.0")
        _add(root, content.value)
        path, most = self._files.to_change(_path(APPLICATION, name)), load_sizes().xml.file_bytes
        try:
            text = ElementTree.tostring(root)
            held = len(text) <= most and _read(text, path) == replace(content, name=content.name or path.stem)
        except (ConfigError, UnicodeEncodeError):  # it has characters that XML has not
            held = False
        if not held:
            raise BadValue("prefs", content.as_value(), f"what an XML file of {most} bytes can hold")
        write_whole(path, text)

    def remove(self, name: str) -> None:
        """Remove a file; a NoSuchFile when there is none."""
        path = _path(APPLICATION, name)
        self._files.to_read(path)
        self._files.to_change(path).unlink()


class ALPreferences:
    """ALPreferences as the simulated robot offers it."""

    def __init__(self, files: ClientFiles, memory: MemoryStore) -> None:
        self._files = PreferenceFiles(files)
        self._memory = memory

    def readPrefFile(self, name: str, memory_names: bool) -> list[Any]:
        """[name, description, [preference, ...]]; with keys of ALMemory for all, file/group/name, if asked for."""
        content = self._files.read(APPLICATION, name)
        return (_with_keys(content, "") if memory_names else content).as_value()

    def writePrefFile(self, name: str, preferences: Any, without_keys: bool) -> None:
        content = _preference(preferences, "prefs", 0)
        if not isinstance(content.value, list):
            raise BadValue("prefs", preferences, "[name, description, [preference, ...]]")
        self._files.write(name, _without_keys(content) if without_keys else content)

    def saveToMemory(self, preferences: Any) -> bool:
        for key, value in _keys(_preference(preferences, "prefs", 0)):
            self._memory.insert(key, value, by_client=True)
        return True

    def removePrefFile(self, name: str) -> None:
        self._files.remove(name)


def _path(application: str, name: str) -> str:
    file = name if Path(name).suffix == ".xml" else f"{name}.xml"
    for field, text in (("application", application), ("file", file)):
        if not text or "/" in text or text.startswith("."):
            raise BadValue(field, text, "a name without folders")
    return FOLDER.format(application=application, file=file)


def _read(content: bytes, path: Path) -> Preference:
    root = parse_xml(content, path.name)
    return Preference(root.get("name") or path.stem, root.get("description", ""), _children(root, path.name, 1))


def _children(parent: Element, where: str, depth: int) -> list[Preference]:
    if depth > DEEPEST:
        raise ConfigError(where, f"has preferences in preferences, more than {DEEPEST} levels")
    found = []
    for entry in parent.findall(ENTRY):
        name, kind = entry.get("name", ""), entry.get("type", "string")
        value: Any
        if kind == ARRAY:
            value = _children(entry, where, depth + 1)
        else:
            try:
                value = _TYPES.get(kind, str)(entry.get("value", ""))
            except ValueError:
                raise ConfigError(where, f"{name!r} is {entry.get('value')!r}, no {kind}") from None
        found.append(Preference(name, entry.get("description", ""), value, entry.get("memoryName", "")))
    return found


def _add(parent: Element, preferences: list[Preference]) -> None:
    for one in preferences:
        given = {"name": one.name, "description": one.description}
        if one.memory_name:
            given["memoryName"] = one.memory_name
        if isinstance(one.value, list):
            _add(ElementTree.SubElement(parent, ENTRY, type=ARRAY, **given), one.value)
        else:
            kind = next(word for word, made in (("bool", bool), ("int", int), ("float", float), ("string", str))
                        if isinstance(one.value, made))  # fmt: skip
            ElementTree.SubElement(parent, ENTRY, type=kind, value=str(one.value), **given)


def _preference(value: Any, field: str, depth: int) -> Preference:
    """A preference as a client gives it."""
    right = "[name, description, value] or [name, description, value, key in ALMemory]"
    if depth > DEEPEST or not isinstance(value, (list, tuple)) or len(value) not in (3, 4):
        raise BadValue(field, value, right)
    name, description, content, *key = value
    if not all(isinstance(text, str) for text in (name, description, *key)):
        raise BadValue(field, value, right)
    if isinstance(content, (list, tuple)):
        content = [_preference(one, f"{field}[2][{i}]", depth + 1) for i, one in enumerate(content)]
    elif not isinstance(content, (bool, int, float, str)):
        raise BadValue(f"{field}[2]", content, "a text, a number, true, false, or a list of preferences")
    return Preference(name, description, content, *key)


def _with_keys(one: Preference, before: str) -> Preference:
    path = before + one.name
    if isinstance(one.value, list):
        return Preference(one.name, one.description, [_with_keys(inner, f"{path}/") for inner in one.value])
    return Preference(one.name, one.description, one.value, one.memory_name or path)


def _without_keys(one: Preference) -> Preference:
    value = [_without_keys(inner) for inner in one.value] if isinstance(one.value, list) else one.value
    return Preference(one.name, one.description, value)


def _keys(one: Preference) -> list[tuple[str, Any]]:
    """Keys of ALMemory and what to write there."""
    if isinstance(one.value, list):
        return [pair for inner in one.value for pair in _keys(inner)]
    return [(one.memory_name, one.value)] if one.memory_name else []

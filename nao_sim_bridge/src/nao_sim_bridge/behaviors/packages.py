"""Reads what clients install: behaviours in YAML or JSON, a behavior.xar, or a package of Choregraphe (folder or .pkg).

A package has a manifest.xml with a `uuid` and a `behaviorContent` for each behaviour, which is in the folder of its
`path`, as behavior.xar. Its behaviours are called uuid/path.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Callable
from xml.etree.ElementTree import Element

from nao_sim_bridge.base.archives import Archive, BadArchive
from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.behaviors.reader import NATURES, checked_name, read_behaviors
from nao_sim_bridge.behaviors.steps import NO_NATURE, Behavior
from nao_sim_bridge.behaviors.xar import LARGEST_FILE, parse_xml, read_xar, xar_step

MANIFEST, BEHAVIOR_FILE = "manifest.xml", "behavior.xar"
TEXT_FILES, PACKAGES = (".yaml", ".yml", ".json"), (".pkg", ".zip")
# Reads a file of a package by its path in it.
Read = Callable[[str], bytes]


def read_package(path: Path) -> list[Behavior]:
    """The behaviours of a file, or of the package whose manifest.xml it is; a ConfigError for what cannot be played."""
    ending = path.suffix.lower()
    if ending in TEXT_FILES:
        return list(read_behaviors(path).values())
    if path.name == MANIFEST:
        return _package(lambda name: _inside(path.parent, name), path.parent.name)
    if ending == ".xar":
        folder = path.parent.name or "user"
        name = f"{folder}/{path.stem}" if path.name == BEHAVIOR_FILE else path.stem
        return [Behavior(checked_name(name, path.name), read_xar(path))]
    if ending in PACKAGES:
        return _zipped(path)
    raise ConfigError(path.name, f"is no package: known are {', '.join((*TEXT_FILES, '.xar', *PACKAGES, MANIFEST))}")


def renamed(behaviors: list[Behavior], name: str) -> list[Behavior]:
    """The same behaviours under another name, or below it when there are several; a ConfigError when it is no name."""
    name = checked_name(name.strip("/"), "localPath")
    if len(behaviors) == 1:
        return [replace(behaviors[0], name=name)]
    return [replace(behavior, name=f"{name}/{behavior.name.rsplit('/', 1)[-1]}") for behavior in behaviors]


def _zipped(path: Path) -> list[Behavior]:
    try:
        with Archive(path) as archive:
            manifest = next((n for n in archive.names if n.rsplit("/", 1)[-1] == MANIFEST), MANIFEST)
            folder = manifest[: -len(MANIFEST)]
            return _package(lambda name: archive.read(folder + name), path.name)
    except (OSError, BadArchive) as error:
        raise ConfigError(path.name, f"is no package: {error}") from error


def _inside(folder: Path, name: str) -> bytes:
    path = (folder / name).resolve()
    if folder.resolve() not in path.parents:
        raise ConfigError(folder.name, f"{name!r} is not in the package")
    try:
        return read_bounded(path, LARGEST_FILE)
    except TooLarge as error:
        raise ConfigError(folder.name, f"{name!r} {error}") from error
    except OSError as error:
        raise ConfigError(folder.name, f"{name} cannot be read: {error.strerror}") from error


def _package(read: Read, where: str) -> list[Behavior]:
    root = parse_xml(read(MANIFEST), f"{where}: {MANIFEST}")
    contents = root.findall("contents/behaviorContent")
    if not contents or not root.get("uuid"):
        raise ConfigError(where, "its manifest has no uuid, or no behaviorContent")
    return [_behavior(read, entry, root.get("uuid", ""), where) for entry in contents]


def _behavior(read: Read, entry: Element, package: str, where: str) -> Behavior:
    folder = entry.get("path", "").strip("/")
    step = xar_step(read(f"{folder}/{BEHAVIOR_FILE}" if folder not in ("", ".") else BEHAVIOR_FILE), where)
    nature = (entry.findtext("nature") or NO_NATURE).strip()
    tags = tuple(tag.text.strip() for tag in entry.iter("tag") if tag.text)
    name = checked_name(f"{package}/{folder}".rstrip("/."), where)
    about = (entry.findtext("descriptions/description") or "").strip()
    return Behavior(name, step, about, nature if nature in NATURES else NO_NATURE, tags)

"""Reads what clients install: behaviours in YAML or JSON, a behavior.xar, or a package of Choregraphe (folder or .pkg).

A package has a manifest.xml with a `uuid` and a `behaviorContent` for each behaviour, which is in the folder of its
`path`, as behavior.xar. Its behaviours are called uuid/path.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable, Mapping, Tuple
from xml.etree.ElementTree import Element

from nao_sim_bridge.base.archives import Archive, BadArchive
from nao_sim_bridge.base.config import TooLarge, read_bounded
from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.base.xml_values import parse_xml
from nao_sim_bridge.behaviors.reader import NATURES, checked_name, read_behaviors
from nao_sim_bridge.behaviors.steps import NO_NATURE, Behavior, Refused, Step
from nao_sim_bridge.behaviors.xar import read_xar, xar_step

MANIFEST, BEHAVIOR_FILE, ICON = "manifest.xml", "behavior.xar", "icon.png"
LARGEST_ICON = 1_000_000
"""Bytes of the icon of a package, which is kept in memory."""
TEXT_FILES, PACKAGES = (".yaml", ".yml", ".json"), (".pkg", ".zip")
# Reads a file of a package by its path in it.
Read = Callable[[str], bytes]


@dataclass(frozen=True)
class PackageInfo:
    """What a manifest says of its package, and its icon, a PNG picture; empty where it says nothing."""

    uuid: str
    version: str
    names: Mapping[str, str]  # by language, such as en_US
    descriptions: Mapping[str, str]
    languages: Tuple[str, ...]
    programs: Tuple[str, ...]  # services and other programs, which a robot would start
    icon: bytes


def package_info(path: Path) -> PackageInfo:
    """What a package (.pkg, .zip) says of itself; a ConfigError when it is none."""
    try:
        with Archive(path) as archive:
            manifest, folder = _manifest(archive)
            root = parse_xml(archive.read(manifest), f"{path.name}: {MANIFEST}")
            icon = archive.read(folder + ICON) if folder + ICON in archive.names else b""
            if len(icon) > LARGEST_ICON:
                raise BadArchive(f"its {ICON} has {len(icon)} bytes, at most {LARGEST_ICON} are allowed")
    except (OSError, BadArchive) as error:
        raise ConfigError(path.name, f"is no package: {error}") from error
    services = [entry.get("name", "") for entry in root.findall("services/service")]
    files = [entry.get("path", "") for entry in root.findall("executableFiles/file")]
    return PackageInfo(
        root.get("uuid", ""),
        root.get("version", ""),
        _by_language(root, "names/name"),
        _by_language(root, "descriptions/description"),
        tuple((entry.text or "").strip() for entry in root.findall("supportedLanguages/language")),
        tuple(filter(None, [*services, *files])),
        icon,
    )


def read_package(path: Path) -> list[Behavior]:
    """The behaviours of a file, or of the package whose manifest.xml it is.

    A behaviour of a package that cannot be played says why when it is begun.

    Raises:
        ConfigError: It cannot be read, or none of its behaviours can be played.
    """
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
            _, folder = _manifest(archive)
            return _package(lambda name: archive.read(folder + name), path.name)
    except (OSError, BadArchive) as error:
        raise ConfigError(path.name, f"is no package: {error}") from error


def _manifest(archive: Archive) -> tuple[str, str]:
    """The path of the manifest, and of the folder that it is in, which is empty or ends with a slash."""
    manifest = next((n for n in archive.names if n.rsplit("/", 1)[-1] == MANIFEST), MANIFEST)
    return manifest, manifest[: -len(MANIFEST)]


def _by_language(root: Element, path: str) -> dict[str, str]:
    return {entry.get("lang", ""): (entry.text or "").strip() for entry in root.findall(path)}


def _inside(folder: Path, name: str) -> bytes:
    path = (folder / name).resolve()
    if folder.resolve() not in path.parents:
        raise ConfigError(folder.name, f"{name!r} is not in the package")
    try:
        return read_bounded(path, load_sizes().xml.file_bytes)
    except TooLarge as error:
        raise ConfigError(folder.name, f"{name!r} {error}") from error
    except OSError as error:
        raise ConfigError(folder.name, f"{name!r} cannot be read: {error.strerror}") from error


def _package(read: Read, where: str) -> list[Behavior]:
    root = parse_xml(read(MANIFEST), f"{where}: {MANIFEST}")
    contents = root.findall("contents/behaviorContent")
    if not contents or not root.get("uuid"):
        raise ConfigError(where, "its manifest has no uuid, or no behaviorContent")
    behaviors = [_behavior(read, entry, root.get("uuid", ""), where) for entry in contents]
    refused = [behavior.step.reason for behavior in behaviors if isinstance(behavior.step, Refused)]
    if len(refused) == len(behaviors):
        raise ConfigError(where, "none of its behaviors can be played: " + "; ".join(refused))
    return behaviors


def _behavior(read: Read, entry: Element, package: str, where: str) -> Behavior:
    folder = entry.get("path", "").strip("/")
    file = f"{folder}/{BEHAVIOR_FILE}" if folder not in ("", ".") else BEHAVIOR_FILE
    step: Step
    try:
        step = xar_step(read(file), file)
    except (ConfigError, BadArchive) as error:
        step = Refused(str(error))
    nature = (entry.findtext("nature") or NO_NATURE).strip()
    tags = tuple(tag.text.strip() for tag in entry.iter("tag") if tag.text)
    name = checked_name(f"{package}/{folder}".rstrip("/."), where)
    about = (entry.findtext("descriptions/description") or "").strip()
    return Behavior(name, step, about, nature if nature in NATURES else NO_NATURE, tags)

"""Reads XML that others bring: elements and attributes are counted while it is read, whatever its size in bytes."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from nao_sim_bridge.base.errors import ConfigError
from nao_sim_bridge.base.sizes import load_sizes

DOCTYPE = b"<!DOCTYPE"
PIECE = 65536
"""Bytes that are read at a time: other threads have their turn between two pieces."""


class _TooMuch(Exception):
    """More elements, attributes or levels than are allowed."""


class _BoundedBuilder(ElementTree.TreeBuilder):
    """Makes the tree, and no more of it than is allowed."""

    def __init__(self) -> None:
        super().__init__()
        sizes = load_sizes().xml
        self._elements, self._attributes, self._levels = sizes.elements, sizes.attributes, sizes.levels  # left

    def start(self, tag: Any, attributes: Any) -> Any:
        self._elements -= 1
        self._attributes -= len(attributes)
        self._levels -= 1
        if self._elements < 0 or self._attributes < 0 or self._levels < 0:
            raise _TooMuch
        return super().start(tag, attributes)

    def end(self, tag: Any) -> Any:
        self._levels += 1
        return super().end(tag)


def parse_xml(content: bytes, where: str) -> Element:
    """The root of what is written in XML.

    Raises:
        ConfigError: It is no XML, has a document type, or is larger than `sizes.json` allows.
    """
    # Entities can make a short file one that fills the memory; Choregraphe writes none. UTF-16, of which every other
    # byte is 0, would hide them.
    most = load_sizes().xml.file_bytes
    if len(content) > most:
        raise ConfigError(where, f"has {len(content)} bytes, at most {most} are allowed")
    if b"\0" in content:
        raise ConfigError(where, "is not in UTF-8")
    if DOCTYPE in content:
        raise ConfigError(where, "declares a document type, which is not allowed")
    parser = ElementTree.XMLParser(target=_BoundedBuilder())
    try:
        for begin in range(0, len(content), PIECE):
            parser.feed(content[begin : begin + PIECE])
        return parser.close()
    except _TooMuch as error:
        sizes = load_sizes().xml
        allowed = f"{sizes.elements} elements, {sizes.attributes} attributes and {sizes.levels} levels"
        raise ConfigError(where, f"is more than the {allowed} that are allowed") from error
    except ElementTree.ParseError as error:
        raise ConfigError(where, f"is no XML: {error}") from error

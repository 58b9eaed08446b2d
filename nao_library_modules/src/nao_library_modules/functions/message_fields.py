"""The fields of a message as its definition has them: names, types, comments. Pure."""

from __future__ import annotations

import re
from dataclasses import dataclass

_NUMBER = re.compile(r"u?int\d+|float\d+")
_TIMES = ("duration", "time")
_FIELD = re.compile(r"(?P<type>[\w/]+(?:\[\d*\])?)\s+(?P<name>\w+)\s*(?:#\s*(?P<comment>.*))?")
_MORE = re.compile(r"\s+#\s*(?P<comment>.*)")


@dataclass(frozen=True)
class MessageField:
    """A field of a message."""

    name: str  # its name
    type: str  # its type as messages write it
    comment: str  # what the definition says about it, in one line

    @property
    def is_time(self) -> bool:
        return self.type.partition("[")[0] in _TIMES

    @property
    def numeric(self) -> bool:
        """Whether it holds numbers or times."""
        return self.is_time or _NUMBER.fullmatch(self.type.partition("[")[0]) is not None


def read_fields(definition: str) -> dict[str, MessageField]:
    """The fields of a message by name, in their order.

    `definition`: text of the .msg file; what genpy keeps of the messages inside may follow it.
    """
    fields: dict[str, MessageField] = {}
    last = ""
    for line in definition.split("=" * 80)[0].splitlines():
        more = _MORE.fullmatch(line)
        field = _FIELD.fullmatch(line.rstrip())
        if more and last:
            before = fields[last]
            fields[last] = MessageField(last, before.type, f"{before.comment} {more['comment'].strip()}".strip())
        elif field:
            last = field["name"]
            fields[last] = MessageField(last, field["type"], (field["comment"] or "").strip())
        else:
            last = ""
    return fields

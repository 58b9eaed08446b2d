"""What the comments in a message's definition say about its fields, and about each function that reads them. Pure.

A comment speaks of all functions until it names some: `rad. setAngles, changeAngles: one each` and `a posture
(goToPosture), a leg (wb...)` tell of the functions that they name, `wb...` of all that begin so.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass

NO_UNIT = "no unit"
"""Unit of numbers that have none."""
NUMBER = re.compile(r"u?int\d+|float\d+")
TIMES = ("duration", "time")
"""Types that hold s."""
OTHERS = "..."
EVERY = "all functions"
MEMORY = "memory function"
"""What a part of a comment says that is about those alone."""

_FIELD = re.compile(r"(?P<type>[\w/]+(?:\[\d*\])?)\s+(?P<name>\w+)\s*(?:#\s*(?P<comment>.*))?")
_MORE = re.compile(r"\s+#\s*(?P<comment>.*)")
_LIST = re.compile(r"\((?P<names>[^()]*)\)")
_UNIT = re.compile(
    r"(?<![\w'./])"
    r"(rad/s|m/s|rad|deg|mm|m|s|%|Hz|kg|N|pixels|frames a second|samples a second|degrees Celsius)"
    r"(?![\w'/])"
)
_KIND = re.compile(r"[A-Z][a-z]*(?:, [a-z]+| [a-z]+)?:")
_RANGE = re.compile(r"\d\.\.-?\d|\b(?:[Ff]raction|[Ff]actor|shares?|whole number|stiffnesses)\b|as the robot|how many")


@dataclass(frozen=True)
class FieldComment:
    """A field of a message as its definition tells of it.

    Attributes:
        name: Name of the field.
        type: Its type as messages write it.
        text: The comment, in one line.
    """

    name: str
    type: str
    text: str

    @property
    def numeric(self) -> bool:
        """Whether it holds numbers or times."""
        base = self.type.partition("[")[0]
        return base in TIMES or NUMBER.fullmatch(base) is not None


def read_fields(definition: str) -> dict[str, FieldComment]:
    """The fields of a message by name, in their order.

    Args:
        definition: Text of the .msg file; what genpy keeps of the messages inside may follow it.
    """
    fields: dict[str, FieldComment] = {}
    last = ""
    for line in definition.split("=" * 80)[0].splitlines():
        more = _MORE.fullmatch(line)
        field = _FIELD.fullmatch(line.rstrip())
        if more and last:
            before = fields[last]
            fields[last] = FieldComment(before.name, before.type, f"{before.text} {more['comment'].strip()}".strip())
        elif field:
            last = field["name"]
            fields[last] = FieldComment(last, field["type"], (field["comment"] or "").strip())
        else:
            last = ""
    return fields


@dataclass(frozen=True)
class _Part:
    """A piece of a comment and what it is about.

    Attributes:
        text: The piece.
        sentence: Which sentence of the comment it is from.
        names: The functions that it is about; none for all of them.
        kind: A kind of functions that it is about: Walks, Memory functions.
    """

    text: str
    sentence: int
    names: tuple[str, ...] = ()
    kind: str = ""

    @property
    def general(self) -> bool:
        """Whether it is about all functions."""
        return not self.names and not self.kind

    @property
    def of_memory(self) -> bool:
        """Whether it is about the functions of the robot's memory."""
        return MEMORY in self.text.lower() or MEMORY in self.kind.lower()

    def about(self, function: str) -> bool:
        """Whether it names a function."""
        return any(_fits(name, function) for name in self.names)


class FieldHelp:
    """Comments of one message type, read for the functions of one server."""

    def __init__(
        self, fields: Mapping[str, FieldComment], functions: Iterable[str], memory: Container[str] = ()
    ) -> None:
        """Take the comments apart.

        Args:
            fields: As `read_fields` gives them.
            functions: All functions of the server: what comments may name.
            memory: Those of them that comments call memory functions.
        """
        self.fields = fields
        self._memory = memory
        self._functions = tuple(functions)
        self._parts = {name: list(self._split(field.text)) for name, field in fields.items()}

    def help(self, field: str, function: str) -> str:
        """What a field means to a function; the whole comment where nothing is said about this function."""
        parts = self._relevant(field, function)
        return "; ".join(part.text for part in parts) or self.fields[field].text

    def unit(self, field: str, function: str, allowed: str = "") -> str:
        """Unit of a field's numbers; empty where it holds none.

        Args:
            field: Name of the field.
            function: The function that reads it.
            allowed: What the function takes, in words: it comes before the comment.
        """
        if not self.fields[field].numeric:
            return ""
        if self.fields[field].type.partition("[")[0] in TIMES:
            return "s"
        parts = self._relevant(field, function)
        own = " ".join(part.text for part in parts if not part.general)
        general = " ".join(part.text for part in parts if part.general)
        for text in (allowed, own, general):
            units = list(dict.fromkeys(_UNIT.findall(text)))
            if units:
                return ", ".join(units)
            if text is not general and _RANGE.search(text):
                break  # a range without a unit is a pure number's, whatever the field holds otherwise
        return NO_UNIT

    def _relevant(self, field: str, function: str) -> list[_Part]:
        of_memory = function in self._memory
        parts = [part for part in self._parts[field] if part.of_memory == of_memory] or self._parts[field]
        own = [part for part in parts if part.about(function)]
        kinds = {part.sentence for part in own}
        own += [part for part in parts if part.kind and not part.names and part.sentence in kinds]
        if not own:  # lists that end in "..." and kinds leave room for functions that are not named
            own = [part for part in parts if OTHERS in part.names or part.kind]
        return [part for part in parts if part.general or part in own]

    def _split(self, comment: str) -> Iterable[_Part]:
        names: tuple[str, ...] = ()
        kind = ""
        sentence = 0
        for text, ends in _sentences(comment, lambda rest: bool(self._led_by(rest))):
            if self._only_names(text):
                names, text = self._only_names(text), ""
            elif self._led_by(text):
                names, kind, text = self._led_by(text), "", text.partition(":")[2].strip()
            elif _KIND.match(text):
                names, kind, text = (), text.partition(":")[0], text.partition(":")[2].strip()
            if text and names:
                yield _Part(text, sentence, names)
            elif text:
                yield from self._listed(text, sentence, kind)
            if ends:
                names, kind, sentence = (), "", sentence + 1

    def _led_by(self, text: str) -> tuple[str, ...]:
        """Functions that a text opens with, before a colon."""
        opening, colon, _ = text.partition(":")
        return self._only_names(opening) if colon else ()

    def _listed(self, text: str, sentence: int, kind: str) -> Iterable[_Part]:
        """Pieces that end in a list of functions in brackets; what follows a colon is about all that were listed."""
        begin = 0
        so_far: tuple[str, ...] = ()
        for match in _LIST.finditer(text):
            listed, _, more = match["names"].partition(";")
            names = self._names(listed)
            if names or listed.startswith(EVERY):
                piece = _bare(text[begin : match.start()])
                begin = match.end()
                so_far += names
                if piece:
                    yield _Part(f"{piece} ({more.strip()})" if more else piece, sentence, names, "" if names else kind)
        rest = text[begin:].strip()
        about = so_far if rest.startswith(":") else ()
        if _bare(rest):
            yield _Part(_bare(rest), sentence, about, "" if about else kind)

    def _names(self, text: str) -> tuple[str, ...]:
        """Functions in a list of words, which may have more to say behind them."""
        words = [word.strip().partition(" ")[0] for word in text.partition(":")[0].split(",")]
        known = tuple(word for word in words if word == OTHERS or self._known(word))
        return known if any(word != OTHERS for word in known) else ()

    def _only_names(self, text: str) -> tuple[str, ...]:
        """Functions in a list of nothing else."""
        names = self._names(text)
        return names if len(names) == len(text.split(",")) == len(text.split()) else ()

    def _known(self, word: str) -> bool:
        return any(_fits(word, function) for function in self._functions)


def _bare(piece: str) -> str:
    """A piece of a sentence without what joined it to the others."""
    bare = piece.strip(" ,:")
    return bare[len("or ") :] if bare.startswith("or ") else bare


def _fits(name: str, function: str) -> bool:
    """Whether a name in a comment means a function: `wb...` means all that begin so."""
    if name.lower() == function.replace("_", "").lower():  # some functions have an old spelling as well
        return True
    pieces = name.split(OTHERS)
    return len(pieces) > 1 and any(pieces) and re.fullmatch(".+".join(map(re.escape, pieces)), function) is not None


def _sentences(comment: str, opens: Callable[[str], bool]) -> Iterable[tuple[str, bool]]:
    """Pieces of a comment, each with whether a full stop ends it. What stands in brackets is not taken apart.

    Args:
        comment: The comment.
        opens: Tells whether a text opens with functions: then a row of dots before it was the end of a sentence.
    """
    depth, begin = 0, 0
    for i, character in enumerate(comment):
        depth += {"(": 1, ")": -1}.get(character, 0)
        ends = comment[i + 1 : i + 2] in ("", " ")
        stop = character == "." and (comment[i - 1 : i] != "." or opens(comment[i + 1 :]))
        if depth == 0 and ends and (stop or character == ";"):
            end = i + 1 if comment[begin : i + 1].endswith(OTHERS) else i
            yield comment[begin:end].strip(), stop
            begin = i + 1
    rest = comment[begin:].strip()
    if rest:
        yield rest, True

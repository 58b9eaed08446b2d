"""A grammar as a network of states: what a decoder walks through. Arithmetic on tables, no decoder here."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Callable, Iterable, Sequence

from nao_sim_bridge.base.errors import BadValue
from nao_sim_bridge.hearing.grammars import grammar as g

# Larger ones would be slow, and come from a slip in a grammar rather than from what people say.
MOST_ARCS = 20000
OTHER = "OTHER-"


@dataclass(frozen=True)
class Arc:
    """A way from one state to another, on which a token of `Network.tokens` is said, or nothing (None)."""

    start: int
    end: int
    token: str | None = None


@dataclass(frozen=True)
class Token:
    """What is said on an arc, in its pronunciations, of the grammar of that name.

    `heard` is what it adds to the result, empty when another arc of the same words tells.
    """

    phones: Sequence[str]
    heard: str
    grammar: str


@dataclass
class Network:
    """States 0 (start) and 1 (end) and others, and arcs between them."""

    arcs: list[Arc] = field(default_factory=list)
    tokens: dict[str, Token] = field(default_factory=dict)
    states: int = 2
    start: int = 0
    end: int = 1


def build(
    grammars: Iterable[g.Grammar], pronounce: Callable[[str], Sequence[str]], other_phones: Sequence[str]
) -> Network:
    """The network of several grammars, any of which may be said; other speech is made of `other_phones`.

    Raises:
        BadValue: The grammars are too large.
    """
    builder = _Builder(pronounce, other_phones)
    for grammar in grammars:
        builder.grammar = grammar.name
        builder.add(grammar.root, builder.network.start, builder.network.end)
    return builder.network


def spoken_word(token: str) -> str:
    """The word that a token of phrases stands for."""
    return token.rpartition("-")[0]


class _Builder:
    def __init__(self, pronounce: Callable[[str], Sequence[str]], other_phones: Sequence[str]) -> None:
        self.network = Network()
        self.grammar = ""
        self._pronounce = pronounce
        self._other_phones = other_phones

    def add(self, node: g.Node, start: int, end: int) -> None:
        """Ways from `start` to `end` on which `node` is said."""
        if isinstance(node, g.Words):
            self._words(node, start, end)
        elif isinstance(node, g.Anything):
            self._anything(node.written, start, end)
        elif isinstance(node, g.Sequence):
            states = [start, *(self._state() for _ in node.parts[1:]), end]
            if not node.parts:
                self._arc(start, end)
            for part, here, there in zip(node.parts, states, states[1:]):
                self.add(part, here, there)
        elif isinstance(node, g.Choice):
            for part in node.parts:
                self.add(part, start, end)
        else:
            self._repeat(node, start, end)

    def _words(self, node: g.Words, start: int, end: int) -> None:
        states = [start, *(self._state() for _ in node.spoken[1:]), end]
        for position, (word, here, there) in enumerate(zip(node.spoken, states, states[1:])):
            name = f"{word}-{len(self.network.tokens)}"
            heard = node.heard if position == 0 else ""
            self.network.tokens[name] = Token(self._pronounce(word), heard, self.grammar)
            self._arc(here, there, name)

    def _anything(self, written: bool, start: int, end: int) -> None:
        """A loop of single sounds, which may be passed by."""
        loop = self._state()
        self._arc(start, loop)
        for phone in self._other_phones:
            name = f"{OTHER}{'written' if written else 'silent'}-{phone}"
            self.network.tokens.setdefault(name, Token([phone], g.OTHER_SPEECH if written else "", ""))
            self._arc(loop, loop, name)
        self._arc(loop, end)

    def _repeat(self, node: g.Repeat, start: int, end: int) -> None:
        here = start
        for _ in range(node.least):
            there = self._state()
            self.add(node.part, here, there)
            here = there
        if node.most is None:
            # A state of its own, or the loop would let what comes before be passed by.
            loop, back = self._state(), self._state()
            self._arc(here, loop)
            self.add(node.part, loop, back)
            self._arc(back, loop)
            self._arc(loop, end)
            return
        for _ in range(node.most - node.least):
            there = self._state()
            self.add(node.part, here, there)
            self._arc(here, end)
            here = there
        self._arc(here, end)

    def _state(self) -> int:
        self.network.states += 1
        return self.network.states - 1

    def _arc(self, start: int, end: int, token: str | None = None) -> None:
        if len(self.network.arcs) >= MOST_ARCS:
            raise BadValue("grammar", f"of more than {MOST_ARCS} words and turns", "something smaller")
        self.network.arcs.append(Arc(start, end, token))

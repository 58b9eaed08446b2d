"""Grammar files as NAOqi takes them (BNF+EM): directives and rules, read into a tree.

What is understood, each statement ending with a semicolon:

    #BNF+EM V2.1;                     the first statement
    !grammar NAME;                    the name; it may be in quotes
    !language "American English";     kept, not used
    !start <rule>, <rule>;            rules that may be said as a whole; at least one
    !activatable <rule>;              rules that may be switched off and on wherever they are used
    !slot <name>;                     rules that are filled with words later
    !pronounce ...;                   ignored: pronunciations come from the dictionary
    <rule>: alternatives;

Alternatives are separated by `|`; in each there are words, "words in quotes", <rules>, (groups), [optional parts],
!optional(part), !repeat(part, least, most) with `*` for any number, !tag(name, part) and !id(number), which stand for
the part and for nothing, and <...> for any other speech. Comments are // to the end of the line and /* */.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Dict, Iterator, List, Sequence, Tuple, Union

from nao_sim_bridge.base.errors import SimulationError
from nao_sim_bridge.base.written_numbers import written_number
from nao_sim_bridge.hearing.grammars import grammar as g

TOKEN = re.compile(
    r"""(?P<blank>\s+|//[^\n]*|/\*.*?\*/)
    |(?P<rule><[^<>\n]+>)
    |(?P<quoted>"[^"\n]*")
    |(?P<header>\#[^;\n]*)
    |(?P<directive>![A-Za-z_]+)
    |(?P<sign>[;:|()\[\],*])
    |(?P<word>[^\s<>";:|()\[\],*!#]+)""",
    re.VERBOSE | re.DOTALL,
)
HEADER = re.compile(r"#BNF\+EM\s*V?\s*\d", re.IGNORECASE)
MOST_REPEATS = 100
DEEPEST = 100


class GrammarError(SimulationError):
    """A grammar file that cannot be read; lines count from 1, 0 is the file as a whole."""

    def __init__(self, problem: str, line: int = 0) -> None:
        self.line = line
        super().__init__(f"line {line}: {problem}" if line else problem)


@dataclass(frozen=True)
class RuleUse:
    """A rule that is used inside of another one."""

    name: str
    line: int


Part = Union[g.Words, g.Anything, RuleUse, "Group"]


@dataclass(frozen=True)
class Group:
    """Alternatives, each a row of parts, said `least` to `most` times, None for any number."""

    alternatives: Tuple[Tuple[Part, ...], ...]
    least: int = 1
    most: int | None = 1


@dataclass
class BnfGrammar:
    """A grammar file: rules that may be said as a whole, that may be switched off, and that are filled later, slots."""

    name: str = ""
    start: List[str] = field(default_factory=list)
    activatable: List[str] = field(default_factory=list)
    slots: List[str] = field(default_factory=list)
    rules: Dict[str, Group] = field(default_factory=dict)


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    line: int


def parse_bnf(text: str) -> BnfGrammar:
    """Read a grammar.

    Raises:
        GrammarError: It is not well-formed, or uses a rule that it does not have.
    """
    return _Parser(_tokens(text)).parse()


def _tokens(text: str) -> list[_Token]:
    tokens, at, line = [], 0, 1
    while at < len(text):
        match = TOKEN.match(text, at)
        if match is None:
            raise GrammarError(f"unexpected {text[at]!r}", line)
        kind = match.lastgroup or ""
        if kind != "blank":
            tokens.append(_Token(kind, match.group(), line))
        line += match.group().count("\n")
        at = match.end()
    return tokens


class _Parser:
    def __init__(self, tokens: Sequence[_Token]) -> None:
        self._tokens = tokens
        self._at = 0
        self._grammar = BnfGrammar()
        self._depth = 0

    def parse(self) -> BnfGrammar:
        if not self._tokens or not HEADER.match(self._tokens[0].text):
            raise GrammarError("does not begin with #BNF+EM V2.1;", 1)
        self._next()
        self._expect(";")
        while self._at < len(self._tokens):
            self._statement()
        self._check()
        return self._grammar

    def _statement(self) -> None:
        token = self._next()
        if token.kind == "directive":
            self._directive(token)
        elif token.kind == "rule":
            name = _rule(token)
            if name in self._grammar.rules:
                raise GrammarError(f"rule <{name}> is there already", token.line)
            self._expect(":")
            self._grammar.rules[name] = self._group(";")
        else:
            raise GrammarError(f"expected a directive (!...) or a rule (<...>:), found {token.text!r}", token.line)

    def _directive(self, token: _Token) -> None:
        lists = {
            "!start": self._grammar.start,
            "!activatable": self._grammar.activatable,
            "!slot": self._grammar.slots,
        }
        if token.text == "!grammar":
            self._grammar.name = self._next("word", "quoted").text.strip('"')
            self._expect(";")
        elif token.text in lists:
            while True:
                lists[token.text].append(_rule(self._next("rule")))
                if self._next_sign(";", ",").text == ";":
                    break
        elif token.text in ("!language", "!pronounce"):
            while self._next().text != ";":
                pass
        else:
            known = ", ".join(["!grammar", *lists, "!language", "!pronounce"])
            raise GrammarError(f"unknown directive {token.text}; there are {known}", token.line)

    def _group(self, *ends: str) -> Group:
        """Alternatives up to one of the signs, which is taken as well."""
        self._depth += 1
        if self._depth > DEEPEST:
            raise GrammarError(f"more than {DEEPEST} groups inside each other", self._tokens[self._at - 1].line)
        alternatives: list[tuple[Part, ...]] = []
        parts: list[Part] = []
        while True:
            token = self._next()
            if token.text == "|" or token.text in ends and token.kind == "sign":
                if not parts:
                    raise GrammarError(f"nothing before {token.text!r}", token.line)
                alternatives.append(tuple(parts))
                parts = []
                if token.text != "|":
                    self._depth -= 1
                    self._end = token
                    return Group(tuple(alternatives))
                continue
            parts += self._part(token)

    def _part(self, token: _Token) -> list[Part]:
        if token.kind == "word":
            return [self._words(token, token.text)]
        if token.kind == "quoted":
            return [self._words(token, token.text.strip('"'))]
        if token.text == g.OTHER_SPEECH:
            return [g.Anything()]
        if token.kind == "rule":
            return [RuleUse(_rule(token), token.line)]
        if token.text == "(":
            return [self._group(")")]
        if token.text == "[":
            return [Group(self._group("]").alternatives, 0, 1)]
        if token.kind == "directive":
            return self._operator(token)
        raise GrammarError(f"unexpected {token.text!r}", token.line)

    def _operator(self, token: _Token) -> list[Part]:
        self._expect("(", token)
        if token.text == "!optional":
            return [Group(self._group(")").alternatives, 0, 1)]
        if token.text == "!repeat":
            return [self._repeat(token)]
        if token.text == "!tag":
            self._next("word", "quoted")
            self._expect(",")
            return [self._group(")")]
        if token.text == "!id":
            self._next("word")
            self._expect(")")
            return []
        raise GrammarError(f"unknown {token.text}(...); there are !optional, !repeat, !tag, !id", token.line)

    def _repeat(self, token: _Token) -> Group:
        group = self._group(",", ")")
        least, most = 1, None
        if self._end.text == ",":
            least = most = self._count()
            if self._next_sign(",", ")").text == ",":
                if self._tokens[self._at].text == "*":
                    self._next()
                    most = None
                else:
                    most = self._count()
                self._expect(")")
        if most is not None and most < least:
            raise GrammarError(f"!repeat from {least} to {most} times", token.line)
        return Group(group.alternatives, least, most)

    def _count(self) -> int:
        token = self._next("word")
        count = written_number(token.text, MOST_REPEATS)
        if count is None:
            raise GrammarError(f"expected a number up to {MOST_REPEATS}, found {token.text!r}", token.line)
        return count

    def _words(self, token: _Token, text: str) -> g.Words:
        try:
            return g.words(text)
        except SimulationError as error:
            raise GrammarError(str(error), token.line) from error

    def _next(self, *kinds: str) -> _Token:
        if self._at >= len(self._tokens):
            raise GrammarError("ends in the middle of a statement", self._tokens[-1].line)
        token = self._tokens[self._at]
        if kinds and token.kind not in kinds:
            raise GrammarError(f"expected a {' or a '.join(kinds)}, found {token.text!r}", token.line)
        self._at += 1
        return token

    def _next_sign(self, *signs: str) -> _Token:
        token = self._next()
        if token.text not in signs or token.kind != "sign":
            raise GrammarError(f"expected {' or '.join(map(repr, signs))}, found {token.text!r}", token.line)
        return token

    def _expect(self, sign: str, after: _Token | None = None) -> None:
        if after is not None and (self._at >= len(self._tokens) or self._tokens[self._at].text != sign):
            raise GrammarError(f"expected {sign!r} after {after.text}", after.line)
        self._next_sign(sign)

    def _check(self) -> None:
        grammar = self._grammar
        if not grammar.name:
            raise GrammarError("has no name: !grammar NAME; is missing")
        if not grammar.start:
            raise GrammarError("has no start rule: !start <rule>; is missing")
        known = {*grammar.rules, *grammar.slots}
        for directive, names in (("!start", grammar.start), ("!activatable", grammar.activatable)):
            for name in names:
                if name not in known:
                    raise GrammarError(f"{directive} <{name}>: there is no such rule")
        for slot in grammar.slots:
            if slot in grammar.rules:
                raise GrammarError(f"slot <{slot}> is a rule as well")
        checked: set[str] = set()
        for name in grammar.rules:
            _check_rule(name, known, grammar.rules, (), checked)


def _check_rule(name: str, known: set[str], rules: Dict[str, Group], path: Tuple[str, ...], checked: set[str]) -> None:
    """Refuse unknown rules inside of a rule, and rules that use themselves: there is no end to what they say."""
    if name in checked or name not in rules:
        return
    for use in _uses(rules[name]):
        if use.name not in known:
            raise GrammarError(f"unknown rule <{use.name}>", use.line)
        if use.name in (*path, name):
            raise GrammarError(f"rule <{use.name}> uses itself: {' > '.join((*path, name, use.name))}", use.line)
        if len(path) > DEEPEST:
            raise GrammarError(f"more than {DEEPEST} rules inside each other", use.line)
        _check_rule(use.name, known, rules, (*path, name), checked)
    checked.add(name)


def _uses(group: Group) -> Iterator[RuleUse]:
    for part in (part for row in group.alternatives for part in row):
        if isinstance(part, Group):
            yield from _uses(part)
        elif isinstance(part, RuleUse):
            yield part


def _rule(token: _Token) -> str:
    name = token.text[1:-1].strip()
    if name == "...":
        raise GrammarError("<...> is any other speech, not a rule", token.line)
    return name

"""Contexts of speech recognition: grammars under a name, with rules that are switched on and off, and slots."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Dict, FrozenSet, Iterable, List, Mapping, Sequence, Tuple

from nao_sim_bridge.base.errors import BadValue, SimulationError, UnknownName
from nao_sim_bridge.base.sizes import load_sizes
from nao_sim_bridge.hearing.grammars import grammar as g
from nao_sim_bridge.hearing.grammars.bnf import BnfGrammar, Group, Part, RuleUse

THRESHOLD = "ConfidenceThreshold"
"""Parameter of a context: hypotheses below this confidence are not told."""


class ContextError(SimulationError):
    """A context that is there already, or not there."""


@dataclass(frozen=True)
class Context:
    """A grammar in use, of so many characters. Never changed: every change makes another one."""

    bnf: BnfGrammar
    characters: int = 0
    inactive: FrozenSet[str] = frozenset()
    slots: Mapping[str, Tuple[str, ...]] = field(default_factory=dict)
    parameters: Mapping[str, float] = field(default_factory=lambda: {THRESHOLD: 0.0})

    def switchable(self) -> list[str]:
        """Rules that can be switched on and off: those that are so declared, and start rules."""
        return list(dict.fromkeys([*self.bnf.start, *self.bnf.activatable]))

    def rules(self, kind: str) -> list[str]:
        """Names of the rules of a kind: start, active, activatable or slot."""
        switchable = self.switchable()
        kinds = {
            "start": list(self.bnf.start),
            "active": [name for name in switchable if name not in self.inactive],
            "activatable": switchable,
            "slot": list(self.bnf.slots),
        }
        if kind not in kinds:
            raise BadValue("typeName", kind, ", ".join(kinds))
        return kinds[kind]

    def switched(self, rule: str, active: bool) -> Context:
        """With a rule switched on or off."""
        if rule not in self.switchable():
            raise UnknownName("rule that can be activated", rule, self.switchable())
        return replace(self, inactive=self.inactive - {rule} if active else self.inactive | {rule})

    def all_switched(self, active: bool) -> Context:
        return replace(self, inactive=frozenset() if active else frozenset(self.switchable()))

    def with_slot(self, slot: str, words: Sequence[str]) -> Context:
        """With a slot filled with words, beside those that it has; with none, it is empty."""
        if slot not in self.bnf.slots:
            raise UnknownName("slot", slot, self.bnf.slots)
        sizes = load_sizes().vocabulary
        for word in words:
            if len(word) > sizes.phrase_characters:
                raise BadValue("wordList", f"{word[:40]}...", f"{sizes.phrase_characters} characters at most of a word")
            g.words(word)  # refuses what has no word in it
        filled = tuple(dict.fromkeys([*self.slots.get(slot, ()), *words])) if words else ()
        count = len(filled) + sum(len(other) for name, other in self.slots.items() if name != slot)
        if count > sizes.phrases:
            raise BadValue("wordList", f"{count} words of a context", f"{sizes.phrases} at most")
        return replace(self, slots={**self.slots, slot: filled})

    def with_parameter(self, name: str, value: float) -> Context:
        self.parameter(name)
        if not 0.0 <= value <= 1.0:
            raise BadValue(name, value, "0 to 1")
        return replace(self, parameters={**self.parameters, name: value})

    def parameter(self, name: str) -> float:
        if name not in self.parameters:
            raise UnknownName("parameter of a context", name, self.parameters)
        return self.parameters[name]

    def root(self) -> g.Node:
        """What may be said now."""
        return _Expansion(self).root()


class _Expansion:
    """Turns the rules of a context into one tree; each rule once, however often it is used."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._done: Dict[str, g.Node] = {}

    def root(self) -> g.Node:
        return g.Choice(tuple(self._rule(name) for name in self._context.bnf.start))

    def _rule(self, name: str) -> g.Node:
        if name not in self._done:
            self._done[name] = self._made(name)
        return self._done[name]

    def _made(self, name: str) -> g.Node:
        context = self._context
        if name in context.inactive:
            return g.Choice(())
        if name in context.bnf.slots:
            return g.Choice(tuple(g.words(word) for word in context.slots.get(name, ())))
        return self._group(context.bnf.rules[name])

    def _group(self, group: Group) -> g.Node:
        node: g.Node = g.Choice(tuple(g.Sequence(tuple(map(self._part, row))) for row in group.alternatives))
        return node if (group.least, group.most) == (1, 1) else g.Repeat(node, group.least, group.most)

    def _part(self, part: Part) -> g.Node:
        if isinstance(part, Group):
            return self._group(part)
        return self._rule(part.name) if isinstance(part, RuleUse) else part


class Contexts:
    """All contexts, a stack of those put aside, and sets of them that were saved. For one thread at a time."""

    def __init__(self) -> None:
        self._contexts: Dict[str, Context] = {}
        self._stack: List[Dict[str, Context]] = []
        self._saved: Dict[str, Dict[str, Context]] = {}

    def names(self) -> list[str]:
        return list(self._contexts)

    def get(self, name: str) -> Context:
        """A context.

        Raises:
            UnknownName: There is none of this name.
        """
        if name not in self._contexts:
            raise UnknownName("context", name, self._contexts)
        return self._contexts[name]

    def threshold(self, name: str) -> float:
        """Least confidence for what a context recognises; 0 for what is no context."""
        context = self._contexts.get(name)
        return context.parameter(THRESHOLD) if context is not None else 0.0

    def add(self, name: str, bnf: BnfGrammar, characters: int = 0) -> None:
        """A new context with all rules active; its grammar has so many characters.

        Raises:
            ContextError: The name is taken, or there are too many contexts or characters of grammars.
        """
        if not name:
            raise BadValue("contextName", name, "a name, not empty")
        if name in self._contexts:
            raise ContextError(f"a context named {name!r} already exists; remove it first")
        sizes = load_sizes().vocabulary
        if len(self._contexts) >= sizes.contexts:
            raise ContextError(
                f"there are {len(self._contexts)} contexts, {sizes.contexts} at most: removeContext first"
            )
        kept = [self._contexts, *self._stack, *self._saved.values()]
        grammars = {id(context.bnf): context.characters for contexts in kept for context in contexts.values()}
        whole = sum(grammars.values()) + characters
        if whole > sizes.grammar_characters:
            raise ContextError(
                f"grammars in use, put aside, saved would have {whole} characters, {sizes.grammar_characters} at most"
            )
        self._contexts[name] = Context(bnf, characters)

    def put(self, name: str, context: Context) -> None:
        """Put a changed context in the place of the one of this name."""
        self.get(name)
        self._contexts[name] = context

    def remove(self, name: str) -> None:
        self.get(name)
        del self._contexts[name]

    def clear(self) -> None:
        """Forget all contexts; those put aside and those saved stay."""
        self._contexts = {}

    def push(self) -> None:
        """Put all contexts aside."""
        self._stack.append(self._contexts)
        self._contexts = {}

    def pop(self) -> None:
        """Take back what was put aside last, in the place of what is there now.

        Raises:
            ContextError: Nothing was put aside.
        """
        if not self._stack:
            raise ContextError("no contexts have been pushed")
        self._contexts = self._stack.pop()

    def save(self, name: str) -> None:
        """Keep the contexts as they are under a name; a ContextError when too many are kept."""
        if not name:
            raise BadValue("saveName", name, "a name, not empty")
        most = load_sizes().vocabulary.put_aside
        if len({*self._saved, name}) > most:
            raise ContextError(f"{most} sets of contexts are saved at most: eraseContextSet first")
        self._saved[name] = dict(self._contexts)

    def load(self, name: str) -> None:
        """Put saved contexts in the place of those there are."""
        self._contexts = dict(self._of_saved(name))

    def erase(self, name: str) -> None:
        """Forget saved contexts."""
        self._of_saved(name)
        del self._saved[name]

    def grammars(self) -> Iterable[g.Grammar]:
        """What may be said now, a grammar for each context."""
        return [g.Grammar(name, context.root()) for name, context in self._contexts.items()]

    def state(self) -> tuple:
        """What has to be kept to undo a change; see `restore`."""
        return dict(self._contexts), list(self._stack), dict(self._saved)

    def restore(self, state: tuple) -> None:
        """Undo what has changed since `state`."""
        contexts, stack, saved = state
        self._contexts, self._stack, self._saved = dict(contexts), list(stack), dict(saved)

    def _of_saved(self, name: str) -> Dict[str, Context]:
        if name not in self._saved:
            raise UnknownName("saved context set", name, self._saved)
        return self._saved[name]

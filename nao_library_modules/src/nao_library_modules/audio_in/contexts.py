"""Hearing functions for grammars: contexts of ALSpeechRecognition, their rules, slots and parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..base.errors import BadGoal
from ..functions.chain import checked_by
from ..functions.parts import Part
from .fields import (
    CompiledGrammar,
    Context,
    ContextParameter,
    ContextSet,
    ContextValue,
    GrammarFiles,
    GrammarLanguage,
    Overwrite,
    ReplacedSet,
    Rule,
    RuleType,
    Slot,
    SlotWords,
)
from .recogniser import Recogniser
from .recording import SoundRecordingFunctions


class ContextFunctions(Part):
    """Grammars. `str_param` names the context; further names are in `vocabulary`, in NAOqi's order.

    What a running recognition would refuse is done in a pause of it. Contexts stay until they are removed.
    `saved_sets`: names under which this server has saved contexts; NAOqi does not report which there are.
    """

    left_by_goals = frozenset({"saved_sets"})

    def __init__(self, recogniser: Recogniser, recordings: SoundRecordingFunctions) -> None:
        self._recogniser = recogniser
        self._recordings = recordings
        self.saved_sets: set[str] = set()

    def _check_compile(self, vocabulary: Sequence[str], overwrite: bool, context: dict[str, Any]) -> None:
        """A file to write that is new or may be replaced."""
        file, written = vocabulary[1], context.setdefault("grammars", set())
        self._recordings.require_new_file(file, overwrite, "vocabulary")
        if file in written and not overwrite:
            problem = f"an earlier function writes {file}"
            raise BadGoal("vocabulary", file, "another name, or overwrite", problem=problem)
        written.add(file)

    @checked_by(_check_compile)
    def compile(self, str_param: GrammarLanguage, vocabulary: GrammarFiles, overwrite: Overwrite) -> None:
        """Check a grammar file (BNF) of a language and write it in the form that `addContext` takes."""
        self._recordings.require_new_file(vocabulary[1], overwrite, "vocabulary")
        self._recogniser.call("compile", *vocabulary, str_param.strip())

    def add_context(self, str_param: Context, vocabulary: CompiledGrammar) -> None:
        """Listen for what a compiled grammar has, too."""
        self._recogniser.idly("addContext", vocabulary[0], str_param.strip())

    def remove_context(self, str_param: Context) -> None:
        """Forget a context."""
        self._recogniser.idly("removeContext", str_param.strip())

    def remove_all_context(self) -> None:
        """Forget all contexts."""
        self._recogniser.idly("removeAllContext")

    def _check_new_set(self, str_param: str, overwrite: bool, context: dict[str, Any]) -> None:
        """A name that this server has saved no contexts under, or that may be replaced."""
        name, sets = str_param.strip(), context.setdefault("sets", {})
        if not overwrite and (sets[name] if name in sets else name in self.saved_sets):
            problem = f"{name!r} is saved already"
            raise BadGoal("str_param", str_param, "another name, or overwrite", problem=problem)
        sets[name] = True

    @checked_by(_check_new_set)
    def save_context_set(self, str_param: ContextSet, overwrite: ReplacedSet) -> None:
        """Keep the contexts as they are under a name; `overwrite` replaces those that this server saved."""
        self._recogniser.call("saveContextSet", str_param.strip())
        self.saved_sets.add(str_param.strip())

    def load_context_set(self, str_param: ContextSet) -> None:
        """Put saved contexts in the place of those there are."""
        self._recogniser.idly("loadContextSet", str_param.strip())

    def _check_erased_set(self, str_param: str, context: dict[str, Any]) -> None:
        """Nothing can be wrong; the name is free then."""
        context.setdefault("sets", {})[str_param.strip()] = False

    @checked_by(_check_erased_set)
    def erase_context_set(self, str_param: ContextSet) -> None:
        """Forget saved contexts."""
        self._recogniser.call("eraseContextSet", str_param.strip())
        self.saved_sets.discard(str_param.strip())

    def get_rules(self, str_param: Context, vocabulary: RuleType) -> list[str]:
        """Names of the rules of a type."""
        return list(self._recogniser.call("getRules", str_param.strip(), vocabulary[0].strip()))

    def activate_rule(self, str_param: Context, vocabulary: Rule) -> None:
        """Switch a rule on."""
        self._recogniser.idly("activateRule", str_param.strip(), vocabulary[0])

    def deactivate_rule(self, str_param: Context, vocabulary: Rule) -> None:
        """Switch a rule off."""
        self._recogniser.idly("deactivateRule", str_param.strip(), vocabulary[0])

    def activate_all_rules(self, str_param: Context) -> None:
        """Switch all rules of a context on."""
        self._recogniser.idly("activateAllRules", str_param.strip())

    def deactivate_all_rules(self, str_param: Context) -> None:
        """Switch all rules of a context off."""
        self._recogniser.idly("deactivateAllRules", str_param.strip())

    def add_word_list_to_slot(self, str_param: Context, vocabulary: SlotWords) -> None:
        """Fill a slot with words, beside those that it has."""
        self._recogniser.idly("addWordListToSlot", str_param.strip(), vocabulary[0], list(vocabulary[1:]))

    def remove_word_list_from_slot(self, str_param: Context, vocabulary: Slot) -> None:
        """Empty a slot."""
        self._recogniser.idly("removeWordListFromSlot", str_param.strip(), vocabulary[0])

    def set_context_param(self, str_param: Context, vocabulary: ContextParameter, values: ContextValue) -> None:
        """Change a parameter of a context: ConfidenceThreshold, 0..1, below which it tells nothing."""
        self._recogniser.call("setContextParam", str_param.strip(), vocabulary[0], float(values[0]))

    def get_context_param(self, str_param: Context, vocabulary: ContextParameter) -> float:
        """A parameter of a context."""
        return float(self._recogniser.call("getContextParam", str_param.strip(), vocabulary[0]))

    functions = {
        "compile": compile,
        "addContext": add_context,
        "removeContext": remove_context,
        "removeAllContext": remove_all_context,
        "saveContextSet": save_context_set,
        "loadContextSet": load_context_set,
        "eraseContextSet": erase_context_set,
        "getRules": get_rules,
        "activateRule": activate_rule,
        "deactivateRule": deactivate_rule,
        "activateAllRules": activate_all_rules,
        "deactivateAllRules": deactivate_all_rules,
        "addWordListToSlot": add_word_list_to_slot,
        "removeWordListFromSlot": remove_word_list_from_slot,
        "setContextParam": set_context_param,
        "getContextParam": get_context_param,
    }

"""Hearing functions for grammars: contexts of ALSpeechRecognition, their rules, slots and parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..base.errors import BadGoal
from ..base.field_checks import require_within
from ..functions.chain import checked_by
from .checks import SETTING
from .recogniser import RecogniserAccess


def check_name(_self: object, str_param: str) -> None:
    """A name."""
    if not str_param.strip():
        raise BadGoal("str_param", str_param, "a name", problem="it is empty")


def _check(wanted: str, more: bool = False) -> Callable[..., None]:
    """A check for a name in `str_param` and further ones in `vocabulary`.

    Args:
        wanted: What they name, with commas between.
        more: Whether further ones may follow.
    """
    least = wanted.count(",") + 1

    def check(self: object, str_param: str, vocabulary: Sequence[str]) -> None:
        check_name(self, str_param)
        count = len(vocabulary)
        if count < least or (count > least and not more) or not all(vocabulary):
            raise BadGoal("vocabulary", list(vocabulary), wanted)

    return check


_check_parameter = _check("name of the parameter")


def check_parameter(self: object, str_param: str, vocabulary: Sequence[str], values: Sequence[float]) -> None:
    """A name, a parameter, and its value."""
    _check_parameter(self, str_param, vocabulary)
    if len(values) != 1:
        raise BadGoal("values", list(values), "the value of the parameter")
    require_within("values", values[0], SETTING)


_check_grammar = _check("file of the grammar, file to write")


def check_compile(
    self: ContextFunctions, str_param: str, vocabulary: Sequence[str], overwrite: bool, context: dict[str, Any]
) -> None:
    """A language, a grammar, and a file that is new or may be replaced."""
    _check_grammar(self, str_param, vocabulary)
    file, written = vocabulary[1], context.setdefault("grammars", set())
    self.require_new_file(file, overwrite, "vocabulary")
    if file in written and not overwrite:
        problem = f"an earlier function writes {file}"
        raise BadGoal("vocabulary", file, "another name, or overwrite", problem=problem)
    written.add(file)


def check_new_set(self: ContextFunctions, str_param: str, overwrite: bool, context: dict[str, Any]) -> None:
    """A name that this server has saved no contexts under, or that may be replaced."""
    check_name(self, str_param)
    name, sets = str_param.strip(), context.setdefault("sets", {})
    if not overwrite and (sets[name] if name in sets else name in self.saved_sets):
        problem = f"{name!r} is saved already"
        raise BadGoal("str_param", str_param, "another name, or overwrite", problem=problem)
    sets[name] = True


def check_erased_set(self: object, str_param: str, context: dict[str, Any]) -> None:
    """A name; it is free then."""
    check_name(self, str_param)
    context.setdefault("sets", {})[str_param.strip()] = False


class ContextFunctions(RecogniserAccess):
    """Grammars. `str_param` names the context; further names are in `vocabulary`, in NAOqi's order.

    What a running recognition would refuse is done in a pause of it. Contexts stay until they are removed.

    Attributes:
        saved_sets: Names under which this server has saved contexts; NAOqi does not tell which there are.
    """

    saved_sets: set[str]
    require_new_file: Callable[..., None]  # of RecordingFunctions

    def context_functions(self) -> dict[str, Callable[..., Any]]:
        """Name -> function, to be put into the function table of a module."""
        return {
            "compile": self.compile,
            "addContext": self.add_context,
            "removeContext": self.remove_context,
            "removeAllContext": self.remove_all_context,
            "saveContextSet": self.save_context_set,
            "loadContextSet": self.load_context_set,
            "eraseContextSet": self.erase_context_set,
            "getRules": self.get_rules,
            "activateRule": self.activate_rule,
            "deactivateRule": self.deactivate_rule,
            "activateAllRules": self.activate_all_rules,
            "deactivateAllRules": self.deactivate_all_rules,
            "addWordListToSlot": self.add_word_list_to_slot,
            "removeWordListFromSlot": self.remove_word_list_from_slot,
            "setContextParam": self.set_context_param,
            "getContextParam": self.get_context_param,
        }

    @checked_by(check_compile)
    def compile(self, str_param: str, vocabulary: Sequence[str], overwrite: bool) -> None:
        """Check a grammar file (BNF) of a language and write it in the form that `addContext` takes."""
        self.require_new_file(vocabulary[1], overwrite, "vocabulary")
        self.recogniser("compile", *vocabulary, str_param.strip())

    @checked_by(_check("file of the compiled grammar"))
    def add_context(self, str_param: str, vocabulary: Sequence[str]) -> None:
        """Listen for what a compiled grammar has, too."""
        self.idly("addContext", vocabulary[0], str_param.strip())

    @checked_by(check_name)
    def remove_context(self, str_param: str) -> None:
        """Forget a context."""
        self.idly("removeContext", str_param.strip())

    def remove_all_context(self) -> None:
        """Forget all contexts."""
        self.idly("removeAllContext")

    @checked_by(check_new_set)
    def save_context_set(self, str_param: str, overwrite: bool) -> None:
        """Keep the contexts as they are under a name; `overwrite` replaces those that this server saved."""
        self.recogniser("saveContextSet", str_param.strip())
        self.saved_sets.add(str_param.strip())

    @checked_by(check_name)
    def load_context_set(self, str_param: str) -> None:
        """Put saved contexts in the place of those there are."""
        self.idly("loadContextSet", str_param.strip())

    @checked_by(check_erased_set)
    def erase_context_set(self, str_param: str) -> None:
        """Forget saved contexts."""
        self.recogniser("eraseContextSet", str_param.strip())
        self.saved_sets.discard(str_param.strip())

    @checked_by(_check("start, active, activatable or slot"))
    def get_rules(self, str_param: str, vocabulary: Sequence[str]) -> list[str]:
        """Names of the rules of a type."""
        return list(self.recogniser("getRules", str_param.strip(), vocabulary[0]))

    @checked_by(_check("name of the rule"))
    def activate_rule(self, str_param: str, vocabulary: Sequence[str]) -> None:
        """Switch a rule on."""
        self.idly("activateRule", str_param.strip(), vocabulary[0])

    @checked_by(_check("name of the rule"))
    def deactivate_rule(self, str_param: str, vocabulary: Sequence[str]) -> None:
        """Switch a rule off."""
        self.idly("deactivateRule", str_param.strip(), vocabulary[0])

    @checked_by(check_name)
    def activate_all_rules(self, str_param: str) -> None:
        """Switch all rules of a context on."""
        self.idly("activateAllRules", str_param.strip())

    @checked_by(check_name)
    def deactivate_all_rules(self, str_param: str) -> None:
        """Switch all rules of a context off."""
        self.idly("deactivateAllRules", str_param.strip())

    @checked_by(_check("name of the slot, words", more=True))
    def add_word_list_to_slot(self, str_param: str, vocabulary: Sequence[str]) -> None:
        """Fill a slot with words, beside those that it has."""
        self.idly("addWordListToSlot", str_param.strip(), vocabulary[0], list(vocabulary[1:]))

    @checked_by(_check("name of the slot"))
    def remove_word_list_from_slot(self, str_param: str, vocabulary: Sequence[str]) -> None:
        """Empty a slot."""
        self.idly("removeWordListFromSlot", str_param.strip(), vocabulary[0])

    @checked_by(check_parameter)
    def set_context_param(self, str_param: str, vocabulary: Sequence[str], values: Sequence[float]) -> None:
        """Change a parameter of a context: ConfidenceThreshold, 0..1, below which it tells nothing."""
        self.recogniser("setContextParam", str_param.strip(), vocabulary[0], float(values[0]))

    @checked_by(_check_parameter)
    def get_context_param(self, str_param: str, vocabulary: Sequence[str]) -> float:
        """A parameter of a context."""
        return float(self.recogniser("getContextParam", str_param.strip(), vocabulary[0]))

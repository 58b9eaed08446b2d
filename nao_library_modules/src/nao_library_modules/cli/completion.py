"""How a word can go on, as the running robot knows it. Whatever goes wrong, there is just nothing to offer.

In bash also words with colons and equals signs: bash takes `lights:=Brain0` for three words.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Mapping
from typing import Any

from click.shell_completion import BashComplete, CompletionItem, add_completion_class

from .chain_text import ASSIGN, NEXT, ends_function
from .cli_settings import QUICK, CliSettings, quietly
from .direct_robot import DirectRobot


@quietly
def servers(settings: CliSettings, *_: Any) -> list[str]:
    return settings.stack.servers()


@quietly
def all_functions(settings: CliSettings, *_: Any) -> list[str]:
    """Names of all functions of all servers, and of the servers."""
    names = dict.fromkeys(settings.stack.servers())
    for _, told in settings.stack.described(names=True):
        names.update(dict.fromkeys(function.name for function in told.functions))
    return list(names)


@quietly
def chain(settings: CliSettings, start: str, typed: Mapping[str, Any]) -> list[str]:
    """Next word of a chain: a function, a field, a value."""
    server, before = typed.get("server") or "", typed.get("chain") or ()
    last = max((i for i, word in enumerate(before) if word in NEXT or ends_function(word)), default=-1)
    piece = [word for word in before[last + 1 :] if word]
    if not piece:
        return [function.name for function in settings.stack.describe(server, names=True).functions]
    described = settings.stack.describe(server, [piece[0]])
    arguments = [argument for function in described.functions for argument in function.arguments]
    arguments += described.common
    field, assigned, value = start.partition(ASSIGN)
    if not assigned:
        used = {word.partition(ASSIGN)[0] for word in piece[1:]}
        return [f"{argument.name}{ASSIGN}" for argument in arguments if argument.name not in used]
    for argument in arguments:
        if argument.name == field:
            return [f"{field}{ASSIGN}{word}" for word in _values(argument, value)]
    return []


def choices(server: str, function: str, field: str) -> Callable[..., list[str]]:
    """An offer of the words that a field of a function may hold."""

    @quietly
    def offer(settings: CliSettings, *_: Any) -> list[str]:
        for described in settings.stack.describe(server, [function]).functions:
            for argument in described.arguments:
                if argument.name == field:
                    return list(argument.choices)
        return []

    return offer


@quietly
def behaviors(settings: CliSettings, *_: Any) -> list[str]:
    return [behavior["name"] for behavior in settings.stack.behaviors()]


@quietly
def parameters(settings: CliSettings, _start: str, typed: Mapping[str, Any]) -> list[str]:
    found = settings.stack.behaviors(typed.get("name") or "")
    return [f"{parameter['name']}=" for behavior in found for parameter in behavior["parameters"]]


@quietly
def keys(settings: CliSettings, start: str, _typed: Mapping[str, Any]) -> list[str]:
    """Keys and events of the robot's memory; up to the next slash, for there are more than a thousand."""
    with DirectRobot(settings.stack.robot_address(), QUICK) as robot:
        names = [name for name in robot.memory_names() if name.startswith(start)]
    return sorted({start + _to_slash(name[len(start) :]) for name in names})


def _to_slash(rest: str) -> str:
    head, slash, _ = rest.partition("/")
    return head + slash


def _values(argument: Any, typed: str) -> list[str]:
    if argument.type == "bool":
        return ["true", "false"]
    if argument.type.endswith("[]"):
        begun = typed.rpartition(",")[0]
        return [f"{begun},{word}" if begun else word for word in argument.choices]
    return list(argument.choices)


# --- bash -------------------------------------------------------------------------------------------------------------

BREAKS = ":="
"""Characters that bash begins a new word at, among those that our words have."""

SOURCE = """\
%(complete_func)s() {
    local IFS=$'\\n' line
    COMPREPLY=()
    for line in $(NAO_LINE="${COMP_LINE:0:$COMP_POINT}" %(complete_var)s=bash_complete $1); do
        COMPREPLY+=("$line")
        case "$line" in *:=|*=|*/) compopt -o nospace ;; esac
    done
}
complete -o nosort -F %(complete_func)s %(prog_name)s
"""


class LineComplete(BashComplete):
    """Takes the whole line apart itself, and answers what bash has to put behind the last colon or equals sign."""

    name = "bash"
    source_template = SOURCE

    def get_completion_args(self) -> tuple[list[str], str]:
        """The words before the one that is being typed, and that one."""
        words, last = split_line(os.environ.get("NAO_LINE", ""))
        self._hidden = 1 + max(last.rfind(sign) for sign in BREAKS)
        return words[1:], last

    def format_completion(self, item: CompletionItem) -> str:
        """One word as bash wants it."""
        return item.value[self._hidden :]


def split_line(line: str) -> tuple[list[str], str]:
    """Words of a line as a shell splits them, and the last one, which is not complete; it may be empty."""
    lexer = shlex.shlex(line, posix=True, punctuation_chars=False)
    lexer.whitespace_split = True
    lexer.commenters = ""
    words = []
    try:
        for word in lexer:
            words.append(word)
    except ValueError:  # a quote that is still open
        words.append(lexer.token)
    if line and not line[-1].isspace() and words:
        return words[:-1], words[-1]
    return words, ""


def register() -> None:
    add_completion_class(LineComplete)

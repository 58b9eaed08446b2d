"""Completion in bash of words with colons and equals signs in them: bash takes `lights:=Brain0` for three words."""

from __future__ import annotations

import os
import shlex

from click.shell_completion import BashComplete, CompletionItem, add_completion_class

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

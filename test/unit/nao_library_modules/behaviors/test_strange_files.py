"""Files that are damaged at random: what is wrong is told, and nothing else happens."""

from __future__ import annotations

import random

import pytest
from behavior_texts import EVERYTHING

from nao_library_modules.behaviors import problems_of, read

STRANGE = [
    "null", "~", "-1", "1e999", ".inf", ".nan", "9" * 400, "[]", "{}", "[[[[]]]]", "'", '"', "&a", "*a", "on", "\t",
    "!!python/name:os", "!!binary aGk=", "2024-01-01", "${", "${}", "${count}", "${count / 0}", "? a", "<<: 3", "---",
    "${" + "(" * 150 + "1" + ")" * 150 + "}", "${9" + "9" * 150 + " * 9" + "9" * 30 + "}", "...", "\x00", "\u202e",
    "\ud800", "x" * 5000,
]  # fmt: skip


def damaged(text, chance):
    """A text with some of its parts cut out, doubled, moved or replaced."""
    for _ in range(chance.randrange(1, 4)):
        lines = text.splitlines()
        kind = chance.randrange(5)
        at = chance.randrange(len(lines) or 1)
        if kind == 0:
            lines[at : at + 1] = []
        elif kind == 1:
            lines.insert(chance.randrange(len(lines) + 1), lines[at] if lines else "")
        elif kind == 2 and lines:
            words = lines[at].split(" ")
            words[chance.randrange(len(words))] = chance.choice(STRANGE)
            lines[at] = " ".join(words)
        elif kind == 3 and lines:
            start = chance.randrange(len(lines[at]) + 1)
            lines[at] = lines[at][:start] + lines[at][start + chance.randrange(4) :]
        elif lines:
            key, colon, _ = lines[at].rpartition(": ")
            lines[at] = f"{key}{colon}{chance.choice(STRANGE)}"
        text = "\n".join(lines)
    return text


@pytest.mark.parametrize("seed", range(8))
def test_damaged_files_are_told_and_never_more(seed, library, texts, tables):
    texts["bow"] = "help: Bows.\nparameters: {depth: {default: 0.2, help: x}}\ndo: [{wait: '${depth}'}]"
    chance = random.Random(seed)
    wrong = 0
    for _ in range(40):
        text = damaged(EVERYTHING, chance)
        found = problems_of(lambda text=text: read(text, "test"), library, tables)
        assert all(isinstance(problem, str) and problem for problem in found)
        wrong += bool(found)
    assert wrong > 10

"""The fenced and indented blocks of README.md and docs/*.md: what each one is, and what its page says of it.

A block runs, and ends with status 0, unless a comment before it says otherwise: `<!-- sample: WORD: TEXT -->`, with a
WORD of `MARKS`. On GitHub the comments are not seen.
"""

from __future__ import annotations

import ast
import builtins
import re
import textwrap
from dataclasses import dataclass
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", *sorted(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md")))
MARKS = {
    "no": "nothing runs, for one of REASONS",
    "part of": "stands word for word in that file of this project, which the tests run",
    "run by": "stands in that test as it stands here: it needs a stack of its own",
    "until": "goes on: each line in a shell of its own, until their output has this (regular expression), then Ctrl-C",
    "fails": "ends with another status than 0, and its output has this",
    "file": "a file of the reader's, at that place for all blocks of the page",
}
REASONS = ("a drawing", "installs and builds", "a real robot", "a window", "several robots", "measures for minutes")
KINDS = {"python": "python", "yaml": "yaml", "json": "json", "xml": "xml"}
KINDS.update(dict.fromkeys(("bash", "sh", "console", ""), "shell"))
WHOLE = {"do", "groups", "phases"}
"""Keys of files that go on with none before them: behaviours, buttons of the console, protocols."""
COMMENT = r"<!--[^\n]*?-->"
TOKEN = re.compile(
    r"""^\ *<!--\ sample:\ (?P<mark>[^\n]+?)\ -->$
    |^\#+\ (?P<heading>[^\n]+)$
    |^\ *```(?P<language>\w*)\n(?P<fenced>.*?)^\ *```$
    |(?<=\n\n)(?P<indented>(?:\ {4,}[^\n]+\n)(?:\n?\ {4,}[^\n]+\n)*)""",
    re.MULTILINE | re.DOTALL | re.VERBOSE,
)


class SampleError(Exception):
    """A block or its mark cannot be read."""


@dataclass(frozen=True)
class Sample:
    """One block.

    Attributes:
        page: Path of its document from the root of this project.
        line: Of its first line, from 1.
        heading: What it stands under.
        kind: python, shell, yaml, json or xml.
        text: What is in it.
        marks: WORD of a mark -> its text.
        before: The blocks of the same kind that stand before it on the page.
    """

    page: str
    line: int
    heading: str
    kind: str
    text: str
    marks: dict[str, str]
    before: tuple[Sample, ...]

    @property
    def name(self) -> str:
        """What it is called in reports."""
        return f"{self.page}, line {self.line}, {self.kind} of {self.heading!r}"

    @property
    def files(self) -> list[str]:
        """Files of this project that its marks name."""
        return [self.marks[word] for word in ("part of", "run by") if word in self.marks]

    @property
    def program(self) -> str:
        """Python that runs by itself: a block that uses names which it does not give goes on with the one before."""
        earlier = [sample for sample in self.before if not {"no", "until"} & set(sample.marks)]
        if not earlier or not _unbound(self.text):
            return self.text
        return f"{earlier[-1].program}\n{self.text}"

    @property
    def document(self) -> object:
        """YAML that is whole: an entry or a list goes on with the file that stands before it on the page.

        A list is one of a behaviour's steps, or of a world's things.
        """
        content = yaml.safe_load(self.text)
        if not self.before:
            return content
        whole = dict(self.before[0].document)
        if isinstance(content, list):
            key = "do" if "do" in whole else "objects"
            return {**whole, key: content if key == "do" else whole[key] + content}
        return content if WHOLE & set(content) else {**whole, **content}

    @property
    def commands(self) -> list[tuple[str, list[str]]]:
        """Shell: what is typed behind `$ `, and the lines that it prints; all of a block without `$ ` is typed."""
        if not self.text.startswith("$ "):
            return [(self.text, [])]
        parts = re.split(r"^\$ ", self.text, flags=re.MULTILINE)[1:]
        return [(command, output) for command, *output in (part.rstrip("\n").split("\n") for part in parts)]


def samples(page: str) -> list[Sample]:
    """All blocks of a page, in their order.

    Raises:
        SampleError: A mark without a block or with an unknown word, a language that is not known.
    """
    text = (ROOT / page).read_text(encoding="utf-8")
    found: list[Sample] = []
    marks: dict[str, str] = {}
    heading, marked = "", 0
    for token in TOKEN.finditer(text):
        line = text.count("\n", 0, token.start()) + 1
        if marks and re.sub(COMMENT, "", text[marked : token.start()]).strip() or token["heading"] and marks:
            raise SampleError(f"{page}:{line}: a block has to follow its mark {list(marks)}")
        if token["heading"]:
            heading = token["heading"]
        elif token["mark"]:
            word, _, more = token["mark"].partition(": ")
            if word not in MARKS or not more or (word == "no" and more not in REASONS):
                raise SampleError(f"{page}:{line}: no mark {token['mark']!r}; WORD: TEXT with {list(MARKS)}, {REASONS}")
            marks[word] = more
            marked = token.end()
        else:
            kind = KINDS.get(token["language"] or "")
            if kind is None:
                raise SampleError(f"{page}:{line}: no language {token['language']!r}; there are {list(KINDS)}")
            block = textwrap.dedent(token["indented"] or token["fenced"])
            before = tuple(sample for sample in found if sample.kind == kind)
            found.append(Sample(page, line, heading, kind, block, marks, before))
            marks = {}
    if marks:
        raise SampleError(f"{page}: nothing follows the mark {list(marks)}")
    return found


def _unbound(text: str) -> set[str]:
    """Names that a program uses and gives nowhere."""
    used, bound = set(), set(dir(builtins))
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Name):
            (used if isinstance(node.ctx, ast.Load) else bound).add(node.id)
        elif isinstance(node, ast.arg):
            bound.add(node.arg)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            bound.update((alias.asname or alias.name).split(".")[0] for alias in node.names)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            bound.add(node.name)
        elif isinstance(node, ast.ExceptHandler) and node.name:
            bound.add(node.name)
    return used - bound

"""Draws mutants.jsonl: a seeded sample of small changes of the product, by the operators of cosmic-ray.

Needs the packages of setup/requirements-faults.txt; `run.py --sample N` installs them into a place of their own.
"""

from __future__ import annotations

import argparse
import ast
import json
import random
import re
import warnings
from collections import defaultdict
from pathlib import Path

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

ROOT = Path(__file__).resolve().parents[2]
SOURCES = ("nao_library_modules/src", "nao_sim_bridge/src")
LEFT_OUT = re.compile(r"NoOp|VariableReplacer|VariableInserter|ExceptionReplacer|RemoveDecorator")
# Lines that only say something, to people or to type checkers.
ONLY_WORDS = re.compile(
    r"^(@|import|from|class|def|log\b|logger\b|raise|[\"'f(])"
    r"|^\w+: .*=?\s*field\(|__all__|->|TYPE_CHECKING|log\.|help=|Union\[|Callable\["
)


def places(path: Path):
    """(operator, occurrence, line number) of everything that may be changed in a file."""
    source = path.read_text(encoding="utf-8")
    tree, lines = ast.parse(source), source.splitlines()
    words = set()
    for node in ast.walk(tree):
        notes = [getattr(node, "annotation", None), getattr(node, "returns", None)]
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            notes.append(node)
        if isinstance(node, (ast.Raise, ast.JoinedStr)):
            notes.append(node)
        words.update(n for note in notes if note for n in range(note.lineno, note.end_lineno + 1))
    nodes = list(ast_nodes(get_ast(source)))
    for name in operator_names():
        if LEFT_OUT.search(name):
            continue
        operator, count = get_operator(name)(), 0
        for node in nodes:
            for (line, _), _ in operator.mutation_positions(node):
                if line not in words and not ONLY_WORDS.search(lines[line - 1].strip()):
                    yield name, count, line
                count += 1


def changed(path: Path, operator: str, occurrence: int):
    """(line before, line after, which of equal lines it is), None if the change is no single line that compiles."""
    source = path.read_text(encoding="utf-8")
    after = mutate_code(source, get_operator(operator)(), occurrence)
    before_lines, after_lines = source.splitlines(), (after or "").splitlines()
    differing = [n for n, (a, b) in enumerate(zip(before_lines, after_lines)) if a != b]
    if len(before_lines) != len(after_lines) or len(differing) != 1:
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            compile(after, str(path), "exec")
        except SyntaxError:
            return None
    was, now = before_lines[differing[0]].strip(), after_lines[differing[0]].strip()
    return was, now, [line.strip() for line in before_lines[: differing[0]]].count(was)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=150)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    files = [p for s in SOURCES for p in sorted((ROOT / s).rglob("*.py")) if p.name != "__init__.py"]
    by_folder = defaultdict(list)
    for path in files:
        by_folder[path.parent].append(path)
    lengths = {folder: sum(len(p.read_text().splitlines()) for p in paths) for folder, paths in by_folder.items()}
    total, owed, sample = sum(lengths.values()), 0.0, []
    for folder, paths in sorted(by_folder.items()):
        owed += arguments.count * lengths[folder] / total
        tries = 0
        while owed >= 0.5 and tries < 50:
            tries += 1
            path = chance.choices(paths, [len(p.read_text().splitlines()) for p in paths])[0]
            kinds = defaultdict(list)  # a line counts once, and at it each kind of operator once
            for operator, occurrence, line in places(path):
                kinds[line, operator.split("_")[0]].append((operator, occurrence))
            if not kinds:
                continue
            operator, occurrence = chance.choice(kinds[chance.choice(sorted(kinds))])
            found = changed(path, operator, occurrence)
            if found is None or any(entry["was"] == found[0] for entry in sample):
                continue
            was, now, nth = found
            file = path.relative_to(ROOT).as_posix()
            name = f"m{len(sample) + 1:03d}"
            operator = operator.split("/")[1]
            sample.append({"name": name, "file": file, "operator": operator, "nth": nth, "was": was, "now": now})
            owed -= 1.0
    text = "".join(json.dumps(entry, ensure_ascii=False) + "\n" for entry in sample)
    Path(__file__).with_name("mutants.jsonl").write_text(text, encoding="utf-8")
    print(f"{len(sample)} mutants")


if __name__ == "__main__":
    main()

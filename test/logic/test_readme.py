"""README.md and docs/*.md: the tables that are made from the code are up to date, and the printed programs run."""

from __future__ import annotations

import ast
import re

import readme_tables


def test_the_documents_say_what_the_code_says():
    tables = readme_tables.all_tables()
    texts = {document.name: document.read_text(encoding="utf-8") for document in readme_tables.DOCUMENTS}
    stale = [name for name, text in texts.items() if readme_tables.fill(text, tables) != text]
    assert not stale, "run 'make docs'"
    assert readme_tables.untold(list(texts.values()), tables) == []


def test_every_promise_of_the_documents_has_a_place_and_a_test():
    text = (readme_tables.ROOT / "docs" / "documents.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| ([PT]\d+) \|.*?\| (`.*?) \| (`.*?) \|", text, re.MULTILINE)
    assert [number for number, _, _ in rows] == re.findall(r"^\| ([PT]\d+) \|", text, re.MULTILINE)
    for number, places, tests in rows:
        for file, name in re.findall(r"`(test/[^`]+)::(\w+)`", tests):
            assert f"def {name}(" in (readme_tables.ROOT / file).read_text(encoding="utf-8"), (number, name)
        for file, name in re.findall(r"`([^`]+/[^`]*)`(?: `([^`]+)`)?", places):
            place = readme_tables.ROOT / file
            assert place.exists(), (number, file)
            assert not name or name.rpartition(".")[2] in place.read_text(encoding="utf-8"), (number, name)


def test_the_printed_client_is_the_example_and_every_program_compiles():
    programs = re.findall(r"```python\n(.*?)```", readme_tables.DOCUMENTS[0].read_text(encoding="utf-8"), re.DOTALL)
    assert len(programs) >= 2
    for program in programs:
        compile(program, "README.md", "exec")
    example = ast.parse(readme_tables.CLIENT.read_text(encoding="utf-8"))
    assert ast.get_docstring(example)
    del example.body[0]
    assert ast.dump(ast.parse(programs[0])) == ast.dump(example)

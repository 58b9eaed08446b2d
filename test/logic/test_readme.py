"""README.md and docs/*.md: the tables that are made from the code are up to date, and their blocks can be read."""

from __future__ import annotations

import ast
import re

import pytest
import readme_tables
from samples import PAGES, samples


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


def test_the_printed_client_is_the_example():
    program = next(sample for sample in samples("README.md") if sample.kind == "python")
    example = ast.parse(readme_tables.CLIENT.read_text(encoding="utf-8"))
    assert ast.get_docstring(example)
    del example.body[0]
    assert ast.dump(ast.parse(program.text)) == ast.dump(example)


@pytest.mark.parametrize("page", PAGES)
def test_every_block_of_a_page_can_be_read_and_its_comment_as_well(page):
    for sample in samples(page):
        if sample.kind == "python":
            compile(sample.program, sample.name, "exec")
        assert all((readme_tables.ROOT / file).exists() for file in sample.files), sample.name

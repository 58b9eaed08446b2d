"""README.md and docs/*.md: tables from the code are up to date, blocks can be read, links lead somewhere."""

from __future__ import annotations

import ast
import re

import pytest
import readme_tables
from feature_table import PAGE, features
from samples import PAGES, samples

LINK = re.compile(r"\]\((?!https?:)(?P<file>[^)#\s]*)(?:#(?P<anchor>[^)\s]+))?\)")
FENCED = re.compile(r"^ *```.*?^ *```$", re.MULTILINE | re.DOTALL)
HEADING = re.compile(r"^#+ (.+)$", re.MULTILINE)
OTHERS = ("CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md", "test/faults/README.md")
MOST_DEPARTURES = 20
"""Of the code from what the two documents say."""
LONGEST = 250
"""Lines of README.md: what takes more has a page of its own."""


def test_the_documents_say_what_the_code_says():
    tables = readme_tables.all_tables()
    texts = {document: document.read_text(encoding="utf-8") for document in readme_tables.DOCUMENTS}
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
    departures = re.findall(r"^\| [PT]\d+ \|.*\*\*Departs:\*\*", text, re.MULTILINE)
    assert f"there are\n  {len(departures)} departures" in text and len(departures) <= MOST_DEPARTURES


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


def test_every_block_has_a_name_of_its_own():
    names = [sample.name for page in PAGES for sample in samples(page)]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("page", [*PAGES, *OTHERS])
def test_every_link_of_a_page_leads_to_a_file_and_to_a_heading_of_it(page):
    here = readme_tables.ROOT / page
    for link in LINK.finditer(FENCED.sub("", here.read_text(encoding="utf-8"))):
        there = (here.parent / link["file"]).resolve() if link["file"] else here
        assert there.exists(), link[0]
        assert not link["anchor"] or link["anchor"] in anchors(there.read_text(encoding="utf-8")), link[0]


def anchors(text):
    """What GitHub makes of the headings: lower case, blanks as hyphens, no other punctuation."""
    headings = HEADING.findall(FENCED.sub("", text))
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_the_index_has_every_page_and_the_readme_is_short():
    index = (readme_tables.ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    listed = {link["file"] for link in LINK.finditer(index)}
    assert {page.rpartition("/")[2] for page in PAGES if page.startswith("docs/")} - {"README.md"} <= listed
    assert (readme_tables.ROOT / "README.md").read_text(encoding="utf-8").count("\n") <= LONGEST


def test_the_page_of_features_can_be_read():
    assert len(features(PAGE.read_text(encoding="utf-8"))) > 100

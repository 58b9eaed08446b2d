"""What the documents at the root name is there: files, make targets, scripts, launch files."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
TARGETS = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
LARGEST_PICTURE = 150_000
"""Bytes; everyone who clones the repository carries the pictures."""


@pytest.fixture(params=DOCUMENTS, ids=lambda path: path.name)
def document(request):
    return request.param.read_text(encoding="utf-8"), request.param.parent


def test_the_documents_are_there():
    assert {"README.md", "CONTRIBUTING.md", "CHANGELOG.md"} <= {path.name for path in DOCUMENTS}


def test_links_inside_the_repository_lead_somewhere(document):
    text, folder = document
    links = [link for link in re.findall(r"\]\(([^)#\s]+)", text) if "://" not in link]
    assert [link for link in links if not (folder / link).exists()] == []


def test_paths_in_code_type_are_there(document):
    text, _ = document
    tops = "|".join(re.escape(path.name) for path in ROOT.iterdir() if path.is_dir() and path.name[0] != ".")
    paths = re.findall(rf"(?<![\w/.-])(?:{tops})/[\w./-]*\w", text)
    made = ("demo_output", "bench_output")
    files = [path for path in paths if not path.startswith(made) and not is_ros_type(path)]
    assert [path for path in files if not (ROOT / path).exists()] == []


def is_ros_type(name):
    """Whether it is a type as `rostopic` takes it: nao_library_msgs/FadeRGB, nao_library_actions/BlinkActionGoal."""
    package, _, kind = name.partition("/")
    action = kind.replace("ActionGoal", "")
    files = (f"msg/{kind}.msg", f"srv/{kind}.srv", f"action/{action}.action")
    return any((ROOT / package / file).is_file() for file in files)


def test_make_targets_exist(document):
    text, _ = document
    assert set(re.findall(r"(?:^ {4}|`)make ([a-z]+)", text, re.MULTILINE)) <= TARGETS


def test_launch_files_exist(document):
    text, _ = document
    for name in re.findall(r"[\w/]+\.launch\b", text):
        assert (ROOT / "launch" / "launch" / Path(name).name).is_file(), name


def test_pictures_are_small():
    pictures = list((ROOT / "docs" / "images").iterdir())
    assert pictures
    assert {path.name for path in pictures if path.stat().st_size > LARGEST_PICTURE} == set()


def test_the_changelog_begins_with_what_is_unreleased():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (.*)$", text, re.MULTILINE)[0] == "Unreleased"
    assert set(re.findall(r"^### (.*)$", text, re.MULTILINE)) <= {"Added", "Changed", "Fixed", "Removed"}

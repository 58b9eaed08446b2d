"""What editors of texts show beside lines, and which text of a behaviour needs no draft."""

from __future__ import annotations

from nao_library_modules.behaviors.behavior_errors import Problem
from nao_library_modules.console.pages.text_editor import marks_of, mistakes, problems_of
from nao_library_modules.console.timeline.document import BehaviorDocument
from nao_library_modules.studies.commands import ConsoleFileError
from naoqi.errors import NaoError

TEXT = "a: 1\n\U0001f916: 2\nc: 3"


def test_mistakes_stand_at_the_ends_of_their_lines_each_line_once():
    problems = [Problem("c", "no", 3), Problem("c", "nor this", 3), Problem("a", "wrong", 1), Problem("a", "wrong", 1)]
    marks = marks_of(TEXT, problems)
    lines = [mark["line"] for mark in marks if mark["kind"] == "line"]
    widgets = [(mark["position"], mark["text"].strip(" \u2190")) for mark in marks if mark["kind"] == "widget"]
    assert lines == [1, 3] and widgets == [(4, "wrong"), (len(TEXT), "no; nor this")]


def test_a_mistake_without_a_line_of_the_text_is_not_marked():
    assert marks_of(TEXT, [Problem("", "all of it"), Problem("", "behind it", 4), NaoError("no robot")]) == []


def test_what_is_wrong_is_counted_and_each_has_its_own_line():
    error = ConsoleFileError("a.yaml", [Problem("", "one", 1), Problem("", "two", 2)])
    assert [each.line for each in problems_of(error)] == [1, 2] and mistakes(len(problems_of(error))) == "2 mistakes"
    assert mistakes(len(problems_of(NaoError("no robot")))) == "1 mistake"


def test_a_behaviour_that_nobody_has_changed_needs_no_draft():
    new, opened = BehaviorDocument.new(), BehaviorDocument("nod", "do:\n  - wait: 1.0\n")
    assert new.text == new.stored_text and opened.text == opened.stored_text
    opened.set_text("do:\n  - wait: 2.0\n")
    assert opened.text != opened.stored_text
    opened.stored("nod")
    assert opened.text == opened.stored_text

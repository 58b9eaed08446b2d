"""Stored behaviours as a page asks for them, and what a projection answers."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from nao_library_modules.behaviors.behavior_errors import NoSuchBehavior
from nao_library_modules.console.timeline.projection import read_run
from nao_library_modules.studies.command_check import ALONE, StoredBehaviors, problems_in
from nao_library_modules.studies.commands import NotThere
from nao_library_msgs.msg import BehaviorInfo, BehaviorProblem

BOX = "help: A box.\ndo: [{wait: 1.0}]\n"


def nobody(*_, **__):
    raise NotThere("it does not run")


class Service:
    """The service of a server with one behaviour. `asked`: fields of the requests, in order."""

    def __init__(self):
        self.asked = []

    def __call__(self, **fields):
        self.asked.append(fields)
        there = not fields or fields.get("name") == "box" or "text" in fields
        return SimpleNamespace(behaviors=[BehaviorInfo(name="box", text=BOX, shipped=True)] if there else [])


def test_the_service_is_asked_and_no_goal_is_sent():
    service = Service()
    stored = StoredBehaviors(service, nobody)
    assert stored.text("box") == (BOX, True)
    assert stored.load("box").help == stored.load("box").help == "A box."
    assert len(service.asked) == 2


def test_a_check_has_the_servers_look_at_their_goals():
    service = Service()
    StoredBehaviors(service, nobody).check(BOX, "mine.yaml", ["a=1"])
    assert service.asked == [{"text": BOX, "file": "mine.yaml", "parameters": ["a=1"], "validate": True}]


def test_one_that_is_not_there_is_told_with_those_that_are():
    with pytest.raises(NoSuchBehavior, match="did you mean 'box'"):
        StoredBehaviors(Service(), nobody).text("bix")


def test_without_a_server_the_library_is_there_and_checks_say_so(tmp_path, monkeypatch):
    monkeypatch.setattr("nao_library_modules.studies.command_check.FOLDER", str(tmp_path))
    stored = StoredBehaviors(nobody, nobody)
    assert "hello" in [info.name for info in stored.infos()]
    assert stored.text("hello")[1]
    info = stored.check("help: h\ndo: [{NaoMotion.wakeUp: {}}]\n", "mine.yaml")
    assert not problems_in(info) and ALONE in info.unvalidated[0]
    (problem,) = problems_in(stored.check("help: h\ndo: [{NaoMotion.wakUp: {}}]\n", "mine.yaml"))
    assert (problem.file, problem.line, problem.where) == ("mine.yaml", 2, "step 1")


def test_problems_keep_line_and_place():
    info = BehaviorInfo(problems=[BehaviorProblem("a.yaml", 3, "step 1", "wrong")])
    assert list(map(str, problems_in(info))) == ["a.yaml:3: step 1: wrong"]


def test_a_projection_tells_lengths_of_what_ended_and_why_others_did_not():
    steps = [
        {"path": "1", "what": "wait", "state": "ended", "began": 1.0, "ended": 3.5, "error": ""},
        {"path": "2", "what": "wait", "state": "failed", "began": 3.5, "ended": 4.0, "error": "no luck"},
    ]
    run = read_run({"state": "aborted", "text": "t", "duration": 4.0, "steps": steps})
    assert (run.lengths, run.failures) == ({"1": 2.5}, ("2 wait failed: no luck",))

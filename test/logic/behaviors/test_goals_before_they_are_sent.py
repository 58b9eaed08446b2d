"""What is found of a behaviour's goals before anything moves, without any server."""

from __future__ import annotations

import pytest
from wrong_behaviors import GOOD, LINE, START, WRONG, wrong_text

from nao_library_modules.behaviors import BehaviorError, BehaviorStore, check, problems_of, read
from nao_library_modules.behaviors.checking import ask_nobody, preview_facts
from nao_library_modules.core.describe import CheckService, NotValidated, check_request, read_response
from nao_library_modules.core.files import config_file
from nao_library_modules.core.goal_checks import GoalCheck, GoalProblem, offline_module
from nao_library_modules.core.server_types import server_type


@pytest.fixture
def shipped(tmp_path):
    return BehaviorStore(tmp_path / "none", config_file("behaviors"))


def problems(text, store, tables, *given, **options):
    return problems_of(lambda: read(text, "mine", "mine.yaml"), store.load, tables, given, **options)


@pytest.mark.parametrize("name", WRONG)
def test_what_no_robot_could_do_is_found_without_one(name, shipped, tables):
    (problem,) = problems(wrong_text(name), shipped, tables)
    assert problem.startswith(f"mine.yaml:{LINE}: {WRONG[name][1]}")


def test_all_mistakes_are_told_at_once_and_values_of_parameters_too(shipped, tables):
    steps = "".join(f"  - {step}\n" for step, _ in WRONG.values())
    chain = "  - chain: {NaoLights: [{function: of}, {function: on, lights: [FaceLed], time: x}, {function: on}]}\n"
    found = problems("".join([wrong_text("colour"), steps, chain]), shipped, tables, "turn=2", "turn", "ligth=x")
    lines = [4, 4, *range(LINE, LINE + 6), 13, 13]
    assert [problem.partition(": ")[0] for problem in found] == ["mine.yaml", *(f"mine.yaml:{line}" for line in lines)]
    assert "did you mean 'light'" in found[0] and "-1 to 1 rad" in found[1] and "has no '='" in found[2]
    assert "function 2.time" in found[-2] and "function 1 (of)" in found[-1]
    chain = chain.replace("time: x", "time: 1")
    told = ("function 1 (of): unknown", "function 2 (on): field lights: unknown light", "function 3 (on): field lights")
    found = problems(START + chain, shipped, tables)
    assert len(found) == len(told)
    for problem, words in zip(found, told):
        assert problem.startswith(f"mine.yaml:{LINE}: step 2: {words}")
    with pytest.raises(BehaviorError, match="unknown light 'FaceLed'"):
        check(read(wrong_text("light"), "mine"), shipped.load, None, tables)
    text = "help: x\ndo:\n- {wait: 1}\n- {wait: 1\n"
    (broken,) = problems_of(lambda: read(text, "mine", "mine.yaml"), shipped.load, tables)
    assert broken.startswith("mine.yaml:") and "no YAML" in broken


def test_mistakes_of_reading_hide_no_others_and_what_depends_on_them_is_not_told(shipped, tables):
    text = """help: x
parameters:
  colour: {default: purple, help: of the eyes, choices: [red, green]}
  text: {default: Hi, help: what it says}
do:
  - NaoLights.setColor: {lights: [FaceLeds], str_param: "${colour}"}
  - nao_audio_out.say: {str_param: "${txt}", speeed: 1}
  - hello
  - NaoLights.on: {lights: [FaceLed]}
  - {wait: -1}
  - NaoLights.of: {}
"""
    found = problems(text, shipped, tables)
    assert [each.split(": ")[0].rpartition(":")[2] for each in found] == ["3", "7", "7", "8", "9", "10", "11"]


def test_an_unknown_field_is_told_with_those_that_its_function_takes(shipped, tables):
    (told,) = problems("help: x\ndo:\n- NaoMotion.playMotion: {spead: 2}", shipped, tables)
    assert "did you mean 'speed'?; there are str_param, speed, mirror, stiffness, time, on_error" in told


def test_what_earlier_steps_make_and_what_only_a_robot_knows_is_refused_by_nobody(shipped, tables):
    assert problems(GOOD, shipped, tables) == []
    later = """
help: x
do:
  - timeline:
      - {NaoLights.on: {lights: [Late]}, at: 2.0}
      - {NaoLights.createGroup: {str_param: Late, lights: [Brain0]}, at: 1.0}
  - nao_audio_in.listen: {}
  - nao_audio_out.say: {str_param: x, voice: somebody}
  - nao_audio_out.play: {str_param: loaded.wav}
  - NaoMotion.playMotion: {str_param: mine}
  - NaoMotion.setPose: {str_param: mine}
  - NaoMotion.setAngles: {names: [HeadYaw], angles: [0.1]}
  - NaoMotion.moveTo: {values: [0.1, 0, 0]}
  - NaoMotion.walkTo: {values: [0, 0, 0], str_param: some_frame}
  - NaoVision.unsubscribe: {id: mine}
"""
    assert problems(later, shipped, tables) == []


def test_a_step_that_may_fail_ends_nothing_and_is_told(shipped, tables):
    text = "help: x\ndo:\n- {do: [{NaoLights.on: {lights: [FaceLed]}}, {wait: 0}], on_error: retry 1 skip}"
    facts = preview_facts("mine", lambda: read(text, "mine"), shipped.load, tables, (), ask_nobody)
    (told,) = facts.preview.unchecked
    assert facts.problem == "" and told.startswith("1.1 NaoLights.on: it would be skipped: field lights: unknown light")


def test_the_behaviours_that_come_along_pass_without_servers(shipped, tables):
    for name in shipped.names():
        facts = preview_facts(name, lambda name=name: shipped.load(name), shipped.load, tables, (), ask_nobody)
        assert facts.behavior is not None and facts.problems == () and facts.unvalidated, name


def test_a_server_that_answers_counts_and_one_that_does_not_is_told(shipped, tables):
    asked = []

    def ask(server, goals):
        asked.append((server, [goal.functions[0].function for goal in goals]))
        if server == "NaoMotion":
            raise NotValidated("it sleeps")
        return GoalCheck([GoalProblem(0, 0, "on", "lights", "it is broken")])

    facts = preview_facts("mine", lambda: read(wrong_text("light"), "mine", "mine.yaml"), shipped.load, tables, (), ask)
    assert [str(problem) for problem in facts.problems] == [f"mine.yaml:{LINE}: step 2: it is broken"]
    assert asked == [("NaoMotion", ["goToPosture"]), ("NaoLights", ["on"])]
    other = "help: x\ndo:\n- repeat: 3\n  as: i\n  do: [{NaoLights.on: {lights: [FaceLeds], time: '${i}'}}]"
    asked.clear()
    problems_of(lambda: read(other, "mine"), shipped.load, tables, (), ask)
    assert asked == [("NaoLights", ["on", "on"])], "the first round and the last"
    good = "help: x\ndo: [{NaoMotion.goToPosture: {str_param: Stand}}]"
    facts = preview_facts("mine", lambda: read(good, "mine"), shipped.load, tables, (), ask)
    assert (facts.problem, facts.unvalidated) == ("", ("NaoMotion: it sleeps",))


def test_the_service_refuses_goals_of_another_type():
    kind = server_type("NaoLights")
    module = offline_module(kind.module)
    service = CheckService(module, kind.action)
    goal = kind.goal([kind.function(function="on", lights=["FaceLed"]), kind.function(function="of")])
    check = read_response(service.answer(check_request([goal, kind.goal()])))
    assert [(each.goal, each.index, each.function, each.field) for each in check.problems] == [
        (0, 0, "on", "lights"), (0, 1, "of", ""), (1, -1, "", "functions"),
    ]  # fmt: skip
    assert str(check.problems[1]).startswith("function 2 (of): unknown function 'of'")
    for field, value in (("type", "other/Goal"), ("md5sum", "0" * 32)):
        request = check_request([goal])
        setattr(request, field, value)
        with pytest.raises(NotValidated, match="its goals are nao_library_actions/NaoLedGoal"):
            read_response(service.answer(request))
    cut = check_request([goal])
    cut.goals[0].data = cut.goals[0].data[:20]
    with pytest.raises(NotValidated, match="what was sent is no"):
        read_response(service.answer(cut))

"""Goals of NaoBehavior."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
import rospy
import yaml
from actionlib_msgs.msg import GoalID, GoalStatus
from std_msgs.msg import Header

from nao_library_actions.msg import NaoBehaviorGoal, NaoLedActionGoal, NaoLedActionResult, NaoLedGoal
from nao_library_modules.behaviors.server import NaoBehavior
from nao_library_msgs.msg import BehaviorFunction, LedFunction

LIGHTS = """
help: Lights up.
tags: [light]
parameters: {light: {default: FaceLeds, help: which}, n: {default: 1, help: how often, min: 1, max: 3, unit: times}}
do: [{repeat: "${n}", do: [{NaoLights.on: {lights: ["${light}"]}}]}]
"""
HOLD = "help: Goes on.\ndo: [{nao_audio_out.say: {str_param: hold}}]"
FAIL = "help: Fails.\ndo: [{nao_audio_out.say: {str_param: fail}}, {wait: 1}]"
GREEN = NaoLedGoal([LedFunction(function="setColor", lights=["FaceLeds"], str_param="green")])


@pytest.fixture
def module(robot, edge, clients, tmp_path, tables):
    made = NaoBehavior("10.0.0.7", 9559, tmp_path, clients, robot=robot, edge=edge)
    made.tables = tables  # looking them up takes a while
    for name, text in (("lights", LIGHTS), ("goes_on", HOLD), ("fails", FAIL)):
        made.store.save(name, text)
    return made


@pytest.fixture
def send(edge):
    """Somebody sends a goal to the lights, so many s ago; it has ended already if there is a status."""

    def to_lights(goal, number, ago=0.0, status=None):
        id_ = GoalID(id=str(number))
        header = Header(stamp=rospy.Time.from_sec(edge.clock.now() - ago))
        edge.subscribers["NaoLights/goal"](NaoLedActionGoal(header=header, goal_id=id_, goal=goal))
        if status is not None:
            result = NaoLedActionResult(status=GoalStatus(goal_id=id_, status=status))
            edge.subscribers["NaoLights/result"](result)

    return to_lights


def f(function, name="", **fields):
    return BehaviorFunction(function=function, str_param=name, **fields)


@pytest.fixture
def play(module):
    return lambda *functions: module.server.play(NaoBehaviorGoal(list(functions)))


def test_a_behaviour_runs_with_its_parameters(play, clients):
    end = play(f("runBehavior", "lights", parameters=["n=2", "light=Brain0"]))
    assert (end.end, end.text) == ("succeeded", "")
    assert [goal.functions[0].lights for goal in clients.goals] == [["Brain0"]] * 2
    steps = end.result.steps
    assert [(step.path, step.what, step.state) for step in steps] == [
        ("1", "repeat", "ended"), ("1#1.1", "NaoLights.on", "ended"), ("1#2.1", "NaoLights.on", "ended"),
    ]  # fmt: skip
    assert steps[1].results[0].values == ["done"]
    assert float(end.result.memList[0]) >= steps[0].ended
    told = [(each.path, each.state) for each in end.feedback if each.behavior]
    assert told[0] == ("1", "began") and told[-1] == ("1", "ended")
    assert {each.function for each in end.feedback} == {"runBehavior"}


@pytest.mark.parametrize(
    ("functions", "told"),
    [
        ([f("runBehavior", "light")], "did you mean 'lights'"),
        ([f("runBehavior", "")], "no name for a behavior"),
        ([f("runBehavior", "lights", parameters=["n"])], "has no '='"),
        ([f("runBehavior", "lights", parameters=["n=4"])], "1 to 3 times"),
        ([f("runBehavior", "lights", parameters=["n=x"])], "is no number"),
        ([f("runBehavior", "lights", parameters=["n=1", "n=2"])], "comes twice"),
        ([f("runBehavior", "lights", parameters=["m=1"])], "there is no parameter 'm'"),
        ([f("storeBehavior", "x")], "either a behavior, or the server"),
        ([f("storeBehavior", "x", text="help: x")], "a list of steps"),
        ([f("storeBehavior", "x", text="help: x\ndo: [{behavior: x}]")], "x -> x"),
        ([f("storeBehavior", "lights", text=HOLD)], "already"),
        ([f("storeBehavior", "x", server="NaoLight")], "did you mean 'NaoLights'"),
        ([f("renameBehavior", "lights", new_name="fails")], "already"),
        ([f("renameBehavior", "lights", new_name="a/b")], "field new_name"),
        ([f("copyBehavior", "nothing", new_name="b")], "there is no behavior 'nothing'"),
        ([f("deleteBehavior", "lights"), f("runBehavior", "lights")], "function 3 (runBehavior): there is no"),
        ([f("deleteBehavior", "lights"), f("deleteBehavior", "lights")], "there is no behavior 'lights'; there are"),
        ([f("stopRecording")], "nothing is recorded"),
        ([f("recordBehavior", "x"), f("recordBehavior", "y")], "goes on"),
        ([f("recordBehavior", "x", servers=["NaoSmell"])], "NaoSmell"),
        ([f("recordBehavior", "x", duration=-1.0)], "field duration"),
        ([f("recordBehavior", "lights")], "already"),
        ([f("checkBehavior")], "either a name"),
        ([f("describeBehavior", "nothing")], "there is no behavior"),
    ],
)
def test_what_cannot_be_done_is_refused_before_anything_happens(play, module, clients, functions, told):
    before = {name: module.store.text(name) for name in module.store.names()}
    end = play(f("runBehavior", "lights"), *functions)
    assert end.end == "aborted"
    assert told in end.text
    assert clients.goals == [] and module.recording is None
    assert {name: module.store.text(name) for name in module.store.names()} == before


def test_a_chain_may_use_what_it_stores(play, module):
    end = play(
        f("storeBehavior", "inner", text=HOLD.replace("hold", "hello")),
        f("storeBehavior", "outer", text="help: x\ndo: [{behavior: inner}]"),
        f("runBehavior", "outer"),
        f("renameBehavior", "inner", new_name="moved"),
        f("copyBehavior", "moved", new_name="again"),
        f("runBehavior", "again"),
        f("deleteBehavior", "moved"),
    )
    assert end.end == "succeeded", end.text
    assert end.result.results[3].values == ["outer"]  # it still uses the old name
    assert {"again", "outer"} <= set(module.store.names()) and "moved" not in module.store.names()


def test_a_failure_is_told_with_its_step(play):
    end = play(f("runBehavior", "fails"))
    assert end.end == "aborted"
    assert end.text == "function 1 (runBehavior): step 1 (nao_audio_out.say): bad luck"
    assert [(step.path, step.state, step.error) for step in end.result.steps] == [
        ("1", "failed", "bad luck"), ("2", "not run", ""),
    ]  # fmt: skip


def test_preemption_ends_it_and_stop_tells_what_it_was(module, play, clients):
    thread = module.server.play_in_background(NaoBehaviorGoal([f("runBehavior", "goes_on")]))
    clients.next_goal()
    module.server.preempt()
    thread.join(10.0)
    assert module.server.end == "preempted"
    assert [step.state for step in module.server.result.steps] == ["preempted"]
    assert not clients.running()
    assert play(f("stopBehavior")).result.memList == ["goes_on"]
    assert play(f("stopBehavior")).result.memList == []


def test_behaviours_are_shown(play, edge, module):
    end = play(f("listBehaviors"))
    assert {"fails", "goes_on", "lights"} <= set(end.result.memList)
    shown = {info.name: info for info in end.result.behaviors}
    lights = shown["lights"]
    assert (lights.help, lights.tags, lights.servers, lights.shipped) == ("Lights up.", ["light"], ["NaoLights"], False)
    assert [(p.name, p.type, p.default, p.unit) for p in lights.parameters] == [
        ("light", "text", "FaceLeds", ""), ("n", "number", "1", "times"),
    ]  # fmt: skip
    assert play(f("describeBehavior", "lights")).result.memList == [LIGHTS]
    module.store.save("broken", "help: x\ndo: [{wat: 1}]")
    answer = edge.services["NaoBehavior/list"]
    listed = {info.name: info.problem for info in answer(SimpleNamespace(name="")).behaviors}
    assert "did you mean 'wait'" in listed["broken"] and listed["lights"] == ""
    assert [info.name for info in answer(SimpleNamespace(name="lights")).behaviors] == ["lights"]


def test_problems_are_told_without_an_error(play):
    end = play(
        f("checkBehavior", "lights"),
        f("checkBehavior", text="help: x\ndo: [{wat: 1}, {NaoLights.on: 3}]"),
        f("checkBehavior", "lights", parameters=["n=9"]),
    )
    assert end.end == "succeeded"
    assert [len(each.values) for each in end.result.results] == [0, 2, 1]


def test_a_check_looks_once_and_tells_all_problems(play, module, monkeypatch):
    from nao_library_modules.behaviors import binder, checking

    looks = []

    def bind(behavior, *others):
        looks.append(behavior.name)
        return binder.bind(behavior, *others)

    monkeypatch.setattr(checking, "bind", bind)
    load = module.store.load
    monkeypatch.setattr(module.store, "load", lambda name: looks.append(f"load {name}") or load(name))
    wrong = ", ".join(["{NaoLights.on: {lights: [FaceLeds], time: x}}"] * 15)
    end = play(f("checkBehavior", "lights", parameters=["n=2"]), f("checkBehavior", text=f"help: x\ndo: [{wrong}]"))
    assert looks == ["load lights", "lights", "text"]
    good, bad = end.result.results
    assert good.values == [] and len(bad.values) == 15
    assert "and 5 more" in end.result.behaviors[1].problem


def test_a_check_tells_what_would_be_done_and_what_only_the_robot_knows(play, edge):
    end = play(f("checkBehavior", "lights", parameters=["light=Brain0"]), f("checkBehavior", text="help: x\ndo: []"))
    lights, wrong = end.result.behaviors
    assert (lights.problem, lights.servers, lights.shipped) == ("", ["NaoLights"], False)
    assert list(lights.steps) == ["1 repeat 1 times", "1#1.1 NaoLights.on: lights [Brain0]"]
    assert list(lights.unchecked) == ["1#1.1 NaoLights.on: lights [Brain0]"]
    assert "a list of steps is needed" in wrong.problem and not (wrong.steps or wrong.shipped)
    listed = edge.services["NaoBehavior/list"]
    (asked,) = listed(SimpleNamespace(name="lights")).behaviors
    assert list(asked.steps) == ["1 repeat 1 times", "1#1.1 NaoLights.on: lights [FaceLeds]"]
    assert not any(info.steps for info in listed(SimpleNamespace(name="")).behaviors)


def test_the_last_goal_of_a_server_is_stored(play, clients, send):
    assert "got no goal so far" in play(f("storeBehavior", "green", server="NaoLights")).text
    send(GREEN, 1)
    assert play(f("storeBehavior", "green", server="NaoLights"), f("runBehavior", "green")).end == "succeeded"
    assert clients.goals[-1].functions == GREEN.functions


def test_a_recording_goes_on_until_it_is_stopped(play, send, module):
    assert play(f("recordBehavior", "taken")).end == "succeeded"
    send(GREEN, 1, 0.75, GoalStatus.SUCCEEDED)
    send(GREEN, 2, 0.25, GoalStatus.ABORTED)
    send(GREEN, 3, 100.0)  # by another clock: it counts as sent now
    send(NaoLedGoal([LedFunction(function="blink")]), 4)
    assert play(f("runBehavior", "lights")).end == "succeeded"
    name, count, left_out = play(f("stopRecording")).result.memList
    assert (name, count) == ("taken", "3") and "unknown function 'blink'" in left_out
    entries = yaml.safe_load(module.store.text("taken"))["do"][0]["timeline"]
    assert [entry["at"] for entry in entries] == pytest.approx([0.0, 0.5, 0.75], abs=0.2)
    assert [entry.get("on_error") for entry in entries] == [None, "skip", None]
    send(GREEN, 5)
    assert len(module.store.load("taken").body.steps[0].steps) == 3
    assert module.store.load("taken").tags == ("recorded",)
    assert play(f("runBehavior", "taken")).end == "succeeded"


def test_a_recording_that_is_preempted_keeps_what_came(module, edge, send):
    goal = NaoBehaviorGoal([f("recordBehavior", "taken", duration=100.0)])
    thread = module.server.play_in_background(goal)
    assert edge.clock.waiting.wait(10.0)
    send(GREEN, 1)
    module.server.preempt()
    thread.join(10.0)
    assert module.server.end == "preempted"
    assert "setColor" in module.store.text("taken") and module.recording is None
    assert [(each.what, each.state) for each in module.server.feedback if each.behavior] == [
        ("NaoLights.setColor", "recorded")
    ]


def test_the_end_of_the_node_keeps_a_recording(play, module, send):
    play(f("recordBehavior", "taken"))
    send(GREEN, 1)
    module.shut_down()
    assert "setColor" in module.store.text("taken")


def test_a_recording_without_goals_is_not_stored(play, module):
    end = play(f("recordBehavior", "nothing"), f("stopRecording"))
    assert end.end == "aborted" and "nothing was sent" in end.text
    assert "nothing" not in module.store.names()
    assert play(f("recordBehavior", "other")).end == "succeeded"  # the other one is over

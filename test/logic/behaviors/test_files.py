"""Files of behaviours: what they may hold, what is said about wrong ones, how they are kept and recorded."""

from __future__ import annotations

import math
import re
from pathlib import Path

import genpy
import pytest
from actionlib_msgs.msg import GoalStatus

from nao_library_actions.msg import NaoLedGoal, NaoMotionGoal
from nao_library_modules.behaviors import (
    BehaviorError,
    BehaviorStore,
    NoSuchBehavior,
    bind,
    from_goal,
    problems_of,
    read,
)
from nao_library_modules.behaviors.behavior_store import text_of
from nao_library_modules.behaviors.clients import BehaviorRecording
from nao_library_modules.behaviors.model import (
    At,
    Barrier,
    Box,
    Functions,
    GoalNode,
    Parallel,
    Repeat,
    Sequence,
    Timeline,
    Wait,
    walk,
)
from nao_library_modules.behaviors.parameters import BadExpression, escaped, names_in, substitute
from nao_library_modules.behaviors.server_functions import NAMES, FunctionTables, fields_of, message_of
from nao_library_modules.behaviors.strict_yaml import dump, load
from nao_library_modules.core.errors import BadGoal
from nao_library_modules.core.files import config_file
from nao_library_msgs.msg import LedFunction, MotionFunction

GUIDE = (Path(__file__).parents[3] / "docs" / "behaviors.md").read_text(encoding="utf-8")
SHOWN = re.findall(r"```yaml\n(.*?)```", GUIDE, re.DOTALL)[0]
EVERYTHING = """
help: Waves and
  says hello.
tags: [greeting]
parameters:
  text: {default: "Hello!", help: what it says}
  count: {default: 2, help: how often, min: 1, max: 5, unit: times}
  colour: {default: green, help: of the eyes, choices: [green, red]}
do:
  - NaoMotion.goToPosture: {str_param: Stand}
  - parallel:
      - nao_audio_out.say: {str_param: "${text}"}
      - [{NaoLights.setColor: {lights: [FaceLeds], str_param: "${colour}"}}, {wait: 0.5}]
  - timeline:
      - {NaoLights.on: {lights: [FaceLeds]}, at: 0.5, label: eyes}
      - {wait: 1, at: eyes.end + 0.5}
      - {wait: 1, at: "eyes + ${count / 2}"}
      - {barrier: all}
      - {wait: 0, at: all}
  - behavior: bow
    parameters: {depth: 0.3}
  - chain: {NaoLights: [{function: on, lights: [A]}, {function: off, lights: [A]}]}
  - {repeat: "${count}", as: round, do: [{wait: "${round}"}]}
  - {label: x, on_error: retry 2 skip, for: 3.0, NaoVision.lookFor: {str_param: ball}}
  - {do: [{wait: 1}], on_error: skip}
"""
WAITS, LONGER = "help: Waits.\ndo: [{wait: 1}]\n", "help: Waits longer.\ndo: [{wait: 2}]\n"


def told_of(text):
    with pytest.raises(BehaviorError) as caught:
        read(text, "test")
    return caught.value.problems


def test_everything_that_a_file_may_hold_is_read():
    behavior = read(EVERYTHING, "hello")
    assert (behavior.name, behavior.help, behavior.tags) == ("hello", "Waves and says hello.", ("greeting",))
    assert [each.kind for each in behavior.parameters.values()] == ["text", "number", "text"]
    steps = behavior.body.steps
    kinds = [Functions, Parallel, Timeline, Box, Functions, Repeat, Functions, Sequence]
    assert [type(step) for step in steps] == kinds
    assert steps[0].functions == ({"function": "goToPosture", "str_param": "Stand"},)
    assert isinstance(steps[1].steps[1], Sequence) and isinstance(steps[1].steps[1].steps[1], Wait)
    assert [each.at for each in steps[2].steps[:3]] == [At(0.5), At(0.5, "eyes", True), At("${count / 2}", "eyes")]
    assert isinstance(steps[2].steps[3], Barrier)
    assert (steps[3].name, steps[3].arguments) == ("bow", {"depth": 0.3})
    assert [each["function"] for each in steps[4].functions] == ["on", "off"]
    assert (steps[5].variable, steps[6].label, steps[6].limit) == ("round", "x", 3.0)
    assert (steps[6].policy.retries, steps[6].policy.skip) == (2, True)


HEADS = [
    ("", "line 1: it is no mapping"), ("- a", "no mapping"), ("help: a\nhelp: b", "'help' comes twice"),
    ("help: [a", "no YAML"),
    ("help: x\nsteps: []", "unknown key 'steps'"), ("do: [{wait: 1}]", "help (line 1): a line is needed"),
    ("help: x", "do (line 1): a list of steps"), ("help: x\ndo: []", "at least one"),
    ("help: x\ntags: a\ndo: [{wait: 1}]", "tags"),
]  # fmt: skip
PARAMETERS = [
    ("a: 1", "{default: ..., help: ...}"),
    ("a: {default: 1}", "field help"),
    ("a: {default: 1, help: x, minn: 1}", "did you mean 'min'"),
    ("a: {default: hi, help: x, min: 1}", "field min: it is for numbers, and the default 'hi' makes this parameter a "
     "text: a text may have choices; for min, let the default be a number"),
    ("a: {default: 9, help: x, max: 5}", "field a: 9 is not allowed"),
    ("a: {default: {}, help: x}", "a text, a number"),
    ("a: {default: b, help: x, choices: [c]}", "'b' is not allowed"),
]  # fmt: skip
STEPS = [
    ("{wait: -1}", "0 or more"), ("{wait: '${n}'}", "no parameter 'n'"), ("{wait: 1, at: 2}", "entries of a timeline"),
    ("{wait: 1, on_error: maybe}", "field on_error"), ("{wait: 1, NaoLights.on: {}}", "several things at once"),
    ("{label: x}", "does not say what to do"), ("{paralel: []}", "did you mean 'parallel'"),
    ("4", "a mapping with one of"), ("{parallel: []}", "at least one"), ("{A.b.c: {}}", "SERVER.FUNCTION"),
    ("{NaoLights.on: [1]}", "{FIELD: VALUE, ...}"), ("{NaoLights.on: {function: off}}", "the key names it already"),
    ("{chain: {A: [], B: []}}", "field chain"), ("{chain: {A: [{lights: []}]}}", "function 1 has no name"),
    ("{behavior: 3}", "name of a behavior"), ("{repeat: 3}", "field do"),
    ("{repeat: 2, as: i, do: [{repeat: 2, as: i, do: [{wait: 1}]}]}", "there is a 'i' already"),
    ("{repeat: 2, as: i, do: [{wait: 1}]}, {wait: '${i}'}", "no parameter 'i'"),
    ("{wait: 1, label: a}, {wait: 1, label: a}", "the label 'a' is taken by step 1"),
    ("{timeline: [{wait: 1, at: b}]}", "no label 'b'"), ("{timeline: [{wait: 1, at: a - 1, label: a}]}", "field at"),
    ("{timeline: [{wait: 1, at: a, label: a}]}", "wait for each other"),
    ("{timeline: [{barrier: a}, {wait: 1}]}", "nothing is above"),
    ("{timeline: [{wait: 1}, {barrier: b}, {barrier: b}]}", "is there already on this timeline"),
    ("{barrier: b}", "stands on a timeline"), ("{parallel: [[{barrier: b}], [{wait: 1}]]}", "only one branch"),
    ("{parallel: [[{barrier: a}, {barrier: b}], [{barrier: b}, {barrier: a}]]}", "in circles"),
]  # fmt: skip
WRONG = [
    *HEADS,
    *((f"help: x\nparameters: {{{each}}}\ndo: [{{wait: 1}}]", told) for each, told in PARAMETERS),
    *((f"help: x\ndo: [{each}]", told) for each, told in STEPS),
]


@pytest.mark.parametrize("text, told", WRONG)
def test_what_is_wrong_is_told(text, told):
    assert told in "; ".join(map(str, told_of(text)))


def test_all_that_is_wrong_is_told_with_path_and_line_and_a_few_lines_cannot_stand_for_endless_values():
    found = told_of("help: x\ndo:\n  - {wait: -1}\n  - parallel:\n      - {wait: 1}\n      - {waitt: 2}\n")
    assert [(each.where, each.line) for each in found] == [("step 1", 3), ("step 2.2", 6)]
    doubled = [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 9)]
    assert "values" in str(told_of("a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n" + "".join(doubled))[0])
    assert "levels" in str(told_of("[" * 60 + "]" * 60)[0])


VALUES = {"n": 3, "x": 0.5, "text": "hi", "flag": True, "names": ["a", "b"]}


@pytest.mark.parametrize(
    "value, expected",
    [
        ("${n}", 3), ("${flag}", True), ("${names}", ["a", "b"]), ("${n / 2}", 1.5), ("${-(n + 1) * x}", -2.0),
        ("say ${text}, ${n} times, ${x}", "say hi, 3 times, 0.5"), ("${n * 1.0}x", "3x"), ("${flag}!", "true!"),
        ("${names}!", "a, b!"), ("$${n} and ${n}", "${n} and 3"), ("$${n}", "${n}"), ("${n - 1}", 2), (4, 4),
        ({"a": ["${x}", {"b": "${n}"}]}, {"a": [0.5, {"b": 3}]}),
    ],
)  # fmt: skip
def test_values_take_the_place_of_expressions(value, expected):
    result = substitute(value, VALUES)
    assert result == expected and type(result) is type(expected)
    assert substitute(escaped([{"a": value}]), VALUES) == [{"a": value}]
    assert sorted(names_in({"a": ["${x + n}", "$${no}", 3], "b": "${text}"})) == ["n", "text", "x"]


@pytest.mark.parametrize(
    "text, told",
    [
        ("${m}", "there is no parameter 'm'"), ("${txt}", "did you mean 'text'"), ("${n", "its } is missing"),
        ("${n +}", "cannot be read"), ("${n ** 9999999}", "cannot be read"), ("${n(3)}", "cannot be read"),
        ("${n / 0}", "divides by zero"), ("${1e308 * 1e308}", "too large"), ("${text + 1}", "'hi' is no number"),
        ("${1e999}", "too large"), ("${-1e999}", "too large"),
        ("${flag + 1}", "no number"), ("${" + "1+" * 150 + "1}", "characters"),
    ],
)  # fmt: skip
def test_what_cannot_be_worked_out_is_told(text, told):
    with pytest.raises(BadExpression, match=re.escape(told)):
        substitute(text, VALUES)


@pytest.mark.parametrize(
    "fields, told",
    [
        ({"light": []}, "did you mean 'lights'"), ({"lights": "FaceLeds"}, "a list: [FaceLeds]"),
        ({"lights": [["a"]]}, "lights[0]"), ({"str_param": True}, "is no text"), ({"i_values": ["1"]}, "i_values[0]"),
        ({"i_values": [float("nan")]}, "finite"), ({"revert": 1}, "true or false"), ({"angle": 1.5}, "a whole number"),
        ({"angle": 2**31}, "-2147483648..2147483647"), ({"time": 1e12}, "2147483648"), ({"time": "1"}, "a number"),
    ],
)  # fmt: skip
def test_fields_of_the_wrong_kind_are_refused(fields, told):
    with pytest.raises(BadGoal, match=re.escape(told)):
        message_of(LedFunction, fields)


def test_fields_become_what_they_are_in_the_message():
    points = [{"positions": [1], "time_from_start": 0.7}]
    fields = {"angles": [1, 0.5], "time": 1.3, "str_param": 4, "limp": True, "trajectory": {"points": points}}
    message = message_of(MotionFunction, fields)
    assert (message.angles, message.str_param, message.limp) == ([1.0, 0.5], "4", True)
    assert message.time == genpy.Duration(1, 300000000)
    assert message.trajectory.points[0].time_from_start == genpy.Duration(0, 700000000)
    assert message_of(MotionFunction, load(dump(fields_of(message)), "test")) == message
    assert message_of(MotionFunction, {"angles": [0.5, "90deg"]}).angles == [0.5, pytest.approx(math.pi / 2)]
    with pytest.raises(BadGoal, match=r"angles\[0\]: '9deeg' is not allowed: a number"):
        message_of(MotionFunction, {"angles": ["9deeg"]})
    with pytest.raises(BadGoal, match=r"trajectory\.points\[0\]\.position"):
        message_of(MotionFunction, {"trajectory": {"points": [{"position": [1]}]}})


def test_what_comes_with_the_library_and_what_the_guide_shows_can_be_run(tmp_path, tables):
    store = BehaviorStore(tmp_path, config_file("behaviors"))
    store.save("shown", SHOWN)
    names = store.names()
    found = {name: problems_of(lambda name=name: store.load(name), store.load, tables) for name in names}
    assert len(names) == 11 and found == {name: [] for name in names}


@pytest.fixture
def store(tmp_path):
    shipped = tmp_path / "shipped"
    shipped.mkdir()
    (shipped / "hello.yaml").write_text(WAITS)
    return BehaviorStore(tmp_path / "own", shipped)


def test_what_is_saved_is_there_and_replaced_only_when_that_is_said(store):
    store.save("a", WAITS)
    assert store.names() == ["a", "hello"] and (store.text("a"), store.load("a").help) == (WAITS, "Waits.")
    with pytest.raises(BadGoal, match="there is a behavior 'a' already"):
        store.save("a", LONGER)
    assert store.text("a") == WAITS
    store.save("a", LONGER, overwrite=True)
    for change in (lambda: store.delete("hello"), lambda: store.rename("hello", "b")):
        with pytest.raises(BadGoal, match="comes with the library"):
            change()
    store.save("hello", LONGER)
    assert (store.text("hello"), store.shipped_text("hello"), store.names()) == (LONGER, WAITS, ["a", "hello"])
    store.delete("hello")
    assert store.text("hello") == WAITS
    assert store.text("a") == LONGER and [path.name for path in store.folder.iterdir()] == ["a.yaml"]


def test_names_stay_in_their_folder_and_broken_files_do_not_hide_the_others(store):
    store.save("a", WAITS)
    for ask in (store.text, store.delete, lambda n: store.save(n, WAITS), lambda n: store.rename("a", n)):
        for name in ("", "../x", "a/b", ".hidden", "a b", "-a", "a.yaml", "ä", "a" * 101, "a\n"):
            with pytest.raises(BadGoal, match="no name for a behavior"):
                ask(name)
    store.folder.joinpath("bad.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(BehaviorError, match="cannot be read"):
        store.load("bad")
    assert store.names() == ["a", "bad", "hello"]


RED = NaoLedGoal([LedFunction(function="setColor", lights=["FaceLeds"], str_param="${red}")])
ODD = NaoLedGoal([LedFunction(function="no name")])
MOVE = NaoMotionGoal(
    [MotionFunction(function="setAngles", names=["HeadYaw"], angles=[0.1]), MotionFunction(function="stopMove")]
)


def goals_in(text):
    return [each for each in walk(bind(read(text, "test"), {}, lambda name: None)) if isinstance(each, GoalNode)]


def recorded(*goals, servers=NAMES, check=lambda step: None):
    """A recording of goals: server, goal, when it was sent, how and when it ended, s."""
    recording = BehaviorRecording("x", servers)
    for number, (server, goal, sent, *_) in enumerate(goals):
        recording.sent(server, str(number), goal, sent)
    for number, (_, _, _, *end) in sorted(enumerate(goals), key=lambda each: each[1][4:]):
        if end:
            recording.ended(str(number), *end)
    return recording.timeline(check)


def test_names_change_and_users_of_a_box_are_known(store):
    store.save("a", "help: x\ndo: [{parallel: [{wait: 1}, [{behavior: hello}]]}]")
    store.save("b", "help: broken")
    assert store.users_of("hello") == ["a"]
    with pytest.raises(BadGoal, match="field new_name"):
        store.rename("a", "b")
    store.rename("a", "b", overwrite=True)
    assert store.users_of("hello") == ["b"] and store.names() == ["b", "hello"]
    for ask in (store.text, store.load, store.delete, lambda name: store.rename(name, "x")):
        with pytest.raises(NoSuchBehavior, match="did you mean 'hello'"):
            ask("helloo")


@pytest.mark.parametrize("server, goal", [("NaoLights", RED), ("NaoMotion", MOVE), ("NaoLights", ODD)])
def test_a_goal_becomes_a_behaviour_that_sends_it(server, goal):
    (node,) = goals_in(from_goal(server, goal))
    assert (node.server, node.goal) == (server, goal)
    with pytest.raises(BadGoal, match="would end itself"):
        from_goal("NaoBehavior", RED)


def test_a_recorded_goal_that_is_not_usual_was_meant():
    far = NaoMotionGoal([MotionFunction(function="moveTo", values=[30.0, 0.0, 0.0])])

    def check(step):
        bind(read(text_of("x", [step]), "test"), {}, lambda name: None, FunctionTables())

    entries, left = recorded(("NaoMotion", far, 1.0), ("NaoMotion", MOVE, 2.0), check=check)
    assert left == [] and [entry.get("unusual") for entry in entries] == [True, None]


def test_recorded_goals_come_again_at_their_times_and_are_cut_short_again():
    entries, left = recorded(("NaoMotion", MOVE, 101.5), ("NaoLights", RED, 100.25, GoalStatus.SUCCEEDED, 100.5))
    assert left == [] and [entry["at"] for entry in entries] == [0.0, 1.25]
    assert [node.goal for node in goals_in(text_of("x", [{"timeline": entries}]))] == [RED, MOVE]
    entries, _ = recorded(
        ("NaoLights", RED, 10.0, GoalStatus.PREEMPTED, 12.1),
        ("NaoLights", RED, 12.0, GoalStatus.ABORTED, 13.0),
        ("NaoMotion", MOVE, 12.0, GoalStatus.PREEMPTED, 12.5),
    )
    # The first was replaced by the second: it goes when that one comes, not when it was over.
    assert [entry.get("for") for entry in entries] == [2.0, None, 0.5]
    assert [entry.get("on_error") for entry in entries] == [None, "skip", None]
    with pytest.raises(BadGoal, match="nothing was sent"):
        recorded(("NaoLights", RED, 1.0), servers=["NaoMotion"])  # other servers do not count

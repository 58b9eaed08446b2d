"""Goals of NaoBehavior on the robot: real modules for its steps, libqi, physics, simulated time."""

from __future__ import annotations

import pytest
import rospy
import yaml
from actionlib_msgs.msg import GoalID, GoalStatus
from goal_functions import behavior as f
from plan_clients import client_of
from std_msgs.msg import Header

from nao_library_actions.msg import (
    NaoAudioOutGoal,
    NaoBehaviorGoal,
    NaoLedActionGoal,
    NaoLedActionResult,
    NaoLedGoal,
    NaoMotionGoal,
)
from nao_library_modules.audio_out.audio_out_server import NaoAudioOutput
from nao_library_modules.behaviors.server import NaoBehavior
from nao_library_modules.behaviors.server_functions import FunctionTables
from nao_library_modules.motion.motion_server import NaoMotion
from nao_library_msgs.msg import LedFunction
from nao_library_msgs.srv import ListBehaviorsRequest

TABLES = FunctionTables()
BRAIN, RED = "Device/SubDeviceList/Head/Led/Front/Right/1/Actuator/Value", "Device/SubDeviceList/Face/Led/Red/Left/0Deg"
TURN = "NaoMotion.angleInterpolation: {names: [HeadYaw], angles: [%s], times: [%s], stiffness: 1.0}"
LONG = "help: Goes on.\ndo: [{NaoLights.setIntensity: {lights: [Brain0], i_values: [0.5], time: 60}}, {wait: 1}]"
TEXTS = {
    "lights": """
help: Lights up.
tags: [light]
parameters: {light: {default: Brain0, help: which}, n: {default: 1, help: how often, min: 1, max: 3, unit: times}}
do: [{repeat: "${n}", do: [{NaoLights.setIntensity: {lights: ["${light}"], i_values: [0.25]}}]}]
""",
    "three": f"""
help: Three servers at once, then others at their times.
parameters: {{colour: {{default: green, help: of the eyes, choices: [green, red]}}}}
do:
  - parallel:
      - NaoLights.fadeRGB: {{lights: [FaceLeds], str_param: "${{colour}}", duration: 1.0}}
      - {TURN % (0.5, 1.0)}
      - [{{wait: 0.2}}, {{nao_audio_out.playSine: {{frequency: 400, volume: 0.1, duration: 0.5}}}}]
  - timeline:
      - {{NaoLights.setIntensity: {{lights: [Brain0], i_values: [0.5]}}, at: 0.5}}
      - {{{TURN % (0.2, 0.5)}, at: 0.2, label: head}}
      - {{NaoLights.off: {{lights: [Brain0]}}, at: head.end + 0.3}}
""",
    "busy": f"""
help: Keeps two servers busy.
do:
  - parallel: [{{NaoLights.fadeRGB: {{lights: [FaceLeds], str_param: red, duration: 60}}}}, {{{TURN % (1.0, 60)}}}]
  - wait: 1
""",
    "long": LONG,
}  # fmt: skip
GREEN = NaoLedGoal([LedFunction(function="setColor", lights=["FaceLeds"], str_param="green")])
BLINK = NaoLedGoal([LedFunction(function="blink")])


@pytest.fixture
def servers(robot, goals_to, lights):
    """Clients of the servers of the steps; a server is made when it is asked for."""
    kinds = {"NaoMotion": (NaoMotion, NaoMotionGoal), "nao_audio_out": (NaoAudioOutput, NaoAudioOutGoal)}
    made = {"NaoLights": client_of(lights, robot)}

    def find(name):
        if name not in made:
            made[name] = client_of(goals_to(*kinds[name]), robot)
        return made[name]

    return find


@pytest.fixture
def behaviors(goals_to, servers, tmp_path):
    goals = goals_to(NaoBehavior, NaoBehaviorGoal, behavior_dir=tmp_path, clients=servers)
    for owner in (goals.module, *goals.module.parts):
        owner.tables = TABLES  # looking them up takes a while
    for name, text in TEXTS.items():
        goals.module.store.save(name, text)
    return goals


@pytest.fixture
def to_lights(behaviors):
    """Somebody sends a goal to the lights, so many s ago; it has ended already if there is a status."""

    def send(goal, number, ago=0.0, status=None):
        id_, node = GoalID(id=str(number)), behaviors.node
        header = Header(stamp=rospy.Time.from_sec(node.clock.now() - ago))
        node.subscribers["NaoLights/goal"](NaoLedActionGoal(header=header, goal_id=id_, goal=goal))
        if status is not None:
            node.subscribers["NaoLights/result"](NaoLedActionResult(status=GoalStatus(goal_id=id_, status=status)))

    return send


def steps_of(goal):
    return {step.path: step for step in goal.result.steps}


def value(robot, key):
    return robot.ALMemory.getData(key)


def head(robot):
    return robot.ALMotion.getAngles("HeadYaw", True)[0]


def test_a_behaviour_runs_with_its_parameters_and_tells_its_steps(behaviors, robot):
    goal = behaviors.play(f("runBehavior", "lights", parameters=["n=2", "light=Brain0"]))
    assert (goal.state, goal.text, value(robot, BRAIN)) == ("succeeded", "", 0.25)
    steps = goal.result.steps
    assert [(step.path, step.what, step.state, step.behavior) for step in steps] == [
        ("1", "repeat", "ended", "lights"), ("1#1.1", "NaoLights.setIntensity", "ended", "lights"),
        ("1#2.1", "NaoLights.setIntensity", "ended", "lights"),
    ]  # fmt: skip
    assert steps[1].results[0].function == "setIntensity" and float(goal.result.memList[0]) >= steps[0].ended
    told = [(each.path, each.state) for each in goal.feedback if each.behavior]
    assert told[0] == ("1", "began") and told[-1] == ("1", "ended")
    assert {each.function for each in goal.feedback} == {"runBehavior"}


def test_several_servers_work_at_once_and_at_their_times(behaviors, robot):
    goal = behaviors.play(f("runBehavior", "three", parameters=["colour=red"]))
    steps = steps_of(goal)
    assert goal.state == "succeeded" and {step.state for step in steps.values()} == {"ended"}, goal.text
    first, second, tone = steps["1.1"], steps["1.2"], steps["1.3.2"]
    assert max(first.began, second.began, tone.began) < min(first.ended, second.ended, tone.ended), "at once"
    assert min(first.ended - first.began, second.ended - second.began) >= 0.99 and tone.began >= 0.19
    begun = steps["2"].began
    assert begun >= max(first.ended, second.ended, tone.ended)
    assert [steps[path].began - begun > due - 0.01 for path, due in (("2.1", 0.5), ("2.2", 0.2))] == [True, True]
    assert steps["2.2"].began < steps["2.1"].began and steps["2.3"].began - steps["2.2"].ended >= 0.299
    assert head(robot) == pytest.approx(0.2, abs=0.03) and value(robot, BRAIN) == 0.0
    assert value(robot, f"{RED}/Actuator/Value") == 1.0


def test_a_cancel_ends_all_servers_and_stop_tells_what_was_ended(behaviors, robot, lights):
    goal = behaviors.send(f("runBehavior", "busy"))
    robot.advance(5.0)
    assert head(robot) > 0.01
    begin = robot.now.time
    goal.cancel()
    assert goal.state == "preempted" and robot.now.time - begin < 0.5
    assert [step.state for step in goal.result.steps] == ["preempted"] * 3 + ["not run"]
    where = head(robot)
    robot.advance(1.0)
    assert head(robot) == pytest.approx(where, abs=0.01) and lights.play().state == "aborted", "it takes goals again"
    assert behaviors.succeed(f("stopBehavior")).memList == ["busy"]
    assert behaviors.succeed(f("stopBehavior")).memList == []


REFUSED = [
    ([f("runBehavior", "light")], "did you mean 'lights'"), ([f("runBehavior", "")], "no name for a behavior"),
    ([f("runBehavior", "lights", parameters=["n"])], "has no '='"),
    ([f("runBehavior", "lights", parameters=["n=4"])], "1 to 3 times"),
    ([f("runBehavior", "lights", parameters=["n=1", "n=2"])], "comes twice"),
    ([f("runBehavior", "lights", parameters=["m=1"])], "there is no parameter 'm'"),
    ([f("storeBehavior", "x")], "either a behavior, or the server"),
    ([f("storeBehavior", "x", text="help: x\ndo: [{behavior: x}]")], "x -> x"),
    ([f("storeBehavior", "lights", text=LONG)], "already"),
    ([f("storeBehavior", "../x", text=LONG)], "letters, digits"),
    ([f("storeBehavior", "x", server="NaoLight")], "did you mean 'NaoLights'"),
    ([f("renameBehavior", "lights", new_name="a/b")], "field new_name"),
    ([f("deleteBehavior", "lights"), f("runBehavior", "lights")], "function 3 (runBehavior): there is no"),
    ([f("stopRecording")], "nothing is recorded"), ([f("recordBehavior", "x"), f("recordBehavior", "y")], "goes on"),
    ([f("recordBehavior", "x", duration=-1.0)], "field duration"), ([f("recordBehavior", "lights")], "already"),
    ([f("checkBehavior")], "either a name"), ([f("describeBehavior", "nothing")], "there is no behavior"),
]  # fmt: skip


def test_what_cannot_be_done_is_refused_before_anything_happens(behaviors, robot):
    store = behaviors.module.store
    before = {name: store.text(name) for name in store.names()}
    for functions, told in REFUSED:
        assert told in behaviors.refused(f("runBehavior", "lights"), *functions), told
        assert behaviors.module.recordings.recording is None
    assert value(robot, BRAIN) == 1.0 and {name: store.text(name) for name in store.names()} == before
    assert "got no goal so far" in behaviors.refused(f("storeBehavior", "x", server="NaoLights"))


def test_a_chain_may_use_what_it_stores(behaviors):
    result = behaviors.succeed(
        f("storeBehavior", "inner", text="help: x\ndo: [{wait: 0}]"),
        f("storeBehavior", "outer", text="help: x\ndo: [{behavior: inner}]"),
        f("runBehavior", "outer"),
        f("renameBehavior", "inner", new_name="moved"),
        f("copyBehavior", "moved", new_name="again"),
        f("runBehavior", "again"),
        f("deleteBehavior", "moved"),
    )
    assert result.results[3].values == ["outer"], "it still uses the old name"
    names = set(behaviors.module.store.names())
    assert {"again", "outer"} <= names and not {"moved", "inner"} & names
    fails = "help: x\ndo:\n- {wait: 0}\n- {NaoLights.getData: {str_param: No/Such/Key}, on_error: retry 1}"
    goal = behaviors.play(f("storeBehavior", "fails", text=fails), f("runBehavior", "fails"))
    step = goal.result.steps[1]
    assert (goal.state, step.attempts, step.line) == ("aborted", 2, 4) and step.file.endswith("/fails.yaml")
    assert f"function 2 (runBehavior): {step.file}:4: step 2 (NaoLights.getData): " in goal.text


def test_a_recording_goes_on_until_it_is_stopped_and_plays_the_same_again(behaviors, to_lights, robot):
    behaviors.succeed(f("recordBehavior", "taken"))
    robot.advance(1.0)
    to_lights(GREEN, 1, 0.75, GoalStatus.SUCCEEDED)
    to_lights(GREEN, 2, 0.25, GoalStatus.ABORTED)
    to_lights(GREEN, 3, -100.0)  # by another clock: it counts as sent now
    to_lights(BLINK, 4)
    name, count, left_out = behaviors.succeed(f("stopRecording")).memList
    assert (name, count) == ("taken", "3") and "unknown function 'blink'" in left_out
    entries = yaml.safe_load(behaviors.module.store.text("taken"))["do"][0]["timeline"]
    assert [entry["at"] for entry in entries] == pytest.approx([0.0, 0.5, 0.75], abs=0.05)
    assert [entry.get("on_error") for entry in entries] == [None, "skip", None]
    to_lights(GREEN, 5)
    taken = behaviors.module.store.load("taken")
    assert len(taken.body.steps[0].steps) == 3 and taken.tags == ("recorded",)
    steps = steps_of(behaviors.play(f("runBehavior", "taken")))
    assert [steps[f"1.{i}"].began for i in (1, 2, 3)] == pytest.approx([0.0, 0.5, 0.75], abs=0.3)
    assert value(robot, f"{RED}/Actuator/Value") == 0.0


def test_a_recording_that_is_preempted_or_that_the_node_ends_keeps_what_came(behaviors, to_lights, robot):
    goal = behaviors.send(f("recordBehavior", "taken", duration=100.0))
    robot.advance(0.5)
    to_lights(GREEN, 1)
    goal.cancel()
    told = [(each.what, each.state) for each in goal.feedback if each.behavior]
    assert goal.state == "preempted"
    assert told == [("recordBehavior", "recording"), ("NaoLights.setColor", "recorded")]
    assert "setColor" in behaviors.module.store.text("taken") and behaviors.module.recordings.recording is None
    (result,) = goal.result.results
    assert list(result.values) == ["taken", "1", f"written: {behaviors.module.store.path('taken')}"]
    behaviors.succeed(f("recordBehavior", "other"))
    to_lights(GREEN, 2)
    behaviors.succeed(f("storeBehavior", "last", server="NaoLights"))
    behaviors.module.shut_down()
    assert all("setColor" in behaviors.module.store.text(name) for name in ("other", "last"))


def test_what_is_written_is_told_and_a_recording_whose_name_is_taken_meanwhile_gets_another_one(behaviors, to_lights):
    store = behaviors.module.store
    behaviors.succeed(f("recordBehavior", "taken"))
    to_lights(GREEN, 1)
    store.save("taken", LONG)
    goal = behaviors.play(f("stopRecording"))
    assert goal.text == f"written: {store.path('taken-2')}, for taken.yaml came meanwhile"
    assert list(goal.result.memList) == ["taken-2", "1"] and store.text("taken") == LONG
    for function in (
        f("storeBehavior", "kept", text=LONG),
        f("copyBehavior", "taken", new_name="kept", overwrite=True),
        f("renameBehavior", "taken", new_name="kept", overwrite=True),
    ):
        assert behaviors.play(function).text == f"written: {store.path('kept')}"


def test_behaviours_are_listed_described_and_checked(behaviors):
    shown = {info.name: info for info in behaviors.succeed(f("listBehaviors")).behaviors}
    lights = shown["lights"]
    assert (lights.help, lights.tags, lights.servers, lights.shipped) == ("Lights up.", ["light"], ["NaoLights"], False)
    n = lights.parameters[1]
    assert (n.name, n.type, n.default, n.unit) == ("n", "number", "1", "times")
    assert shown["hello"].shipped and behaviors.succeed(f("describeBehavior", "lights")).memList == [TEXTS["lights"]]
    behaviors.module.store.save("broken", "help: x\ndo: [{wat: 1}]")
    listed = lambda name: behaviors.node.services["NaoBehavior/list"](ListBehaviorsRequest(name=name)).behaviors  # noqa: E731
    problems = {info.name: info.problem for info in listed("") if not info.steps}
    assert "did you mean 'wait'" in problems["broken"] and problems["lights"] == ""
    assert list(listed("lights")[0].steps)[0] == "1 repeat 1 times"
    assert (listed("lights")[0].text, shown["lights"].text) == (TEXTS["lights"], "")
    result = behaviors.succeed(
        f("checkBehavior", "lights", parameters=["light=Brain1"]),
        f("checkBehavior", text="help: x\ndo: [{NaoLights.on: {lights: [FaceLeds], time: x}}]"),
        f("checkBehavior", "lights", parameters=["n=9"]),
    )
    assert [len(each.values) for each in result.results] == [0, 1, 1]
    step = "1#1.1 NaoLights.setIntensity: lights [Brain1], i_values [0.25]"
    lights, wrong, _ = result.behaviors
    assert (lights.problem, list(lights.steps), list(lights.unchecked)) == ("", ["1 repeat 1 times", step], [])
    assert wrong.problem and not wrong.steps

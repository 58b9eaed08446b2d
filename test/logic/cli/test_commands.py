"""What each command asks of the servers, how it ends, what it prints, and what a shell is offered."""

from __future__ import annotations

import json

import click
import pytest
import rospy
from actionlib_msgs.msg import GoalStatus

from nao_library_modules.command_line.app import COMMANDS, nao
from nao_library_modules.command_line.bash_completion import LineComplete
from nao_library_modules.command_line.chain_text import build_message, read_chain, read_value
from nao_library_modules.command_line.output import say_result
from nao_library_msgs.msg import BehaviorInfo, BehaviorParameter, LedFunction, MotionFunction
from nao_library_msgs.srv import ListBehaviorsResponse

ABORTED = GoalStatus.ABORTED


@pytest.mark.parametrize(
    "line, server, expected",
    [
        ("say hello there", "nao_audio_out", {"function": "say", "str_param": "hello there"}),
        ("say hi --animated --speed 80", "nao_audio_out", {"function": "animatedSay", "speed": 80.0}),
        ("say hi --volume 0.5 --pitch 90 --background", "nao_audio_out", {"volume": 0.5, "pitch": 90.0,
         "background": True}),
        ("leds FaceLeds green --for 2 --revert", "NaoLights", {"function": "setColor", "lights": ["FaceLeds"],
         "str_param": "green", "revert": True, "time": rospy.Duration(2)}),
        ("leds Brain0 Brain1 0.5", "NaoLights", {"function": "setIntensity", "lights": ["Brain0", "Brain1"],
         "i_values": [0.5]}),
        ("leds FaceLeds red --fade 1", "NaoLights", {"function": "fadeRGB", "duration": 1.0, "str_param": "red"}),
        ("leds FaceLeds off", "NaoLights", {"function": "off", "lights": ["FaceLeds"]}),
        ("pose Crouch --speed 0.5", "NaoMotion", {"function": "goToPosture", "str_param": "Crouch", "speed": 0.5}),
        ("rest", "NaoMotion", {"function": "rest"}),
        ("call motion setAngles names:=HeadYaw angles:=-0.1", "NaoMotion", {"names": ["HeadYaw"], "angles": [-0.1]}),
        ("run hello text=Hi n=3", "NaoBehavior", {"function": "runBehavior", "str_param": "hello",
         "parameters": ["text=Hi", "n=3"]}),
        ("record motion wave LArm --for 2", "NaoMotion", {"function": "recordMotion", "names": ["LArm"],
         "str_param": "wave", "duration": 2.0}),
        ("record sound x.wav --for 1 --channels left,right", "nao_audio_in", {"channels": ["left", "right"],
         "duration": 1.0}),
        ("record behavior new --for 1 --overwrite", "NaoBehavior", {"function": "recordBehavior", "duration": 1.0,
         "overwrite": True}),
    ],
)  # fmt: skip
def test_a_command_is_a_function_of_a_server(run, graph, sent, line, server, expected):
    graph()
    result = run(*line.split())
    assert result.exit_code == 0, result.stderr
    ((name, (message,)),) = sent.goals
    assert name == f"/{server}" and {field: getattr(message, field) for field in expected} == expected


def test_a_goal_that_fails_is_status_1_and_3_where_the_robot_is_gone(run, graph, sent):
    there = graph()
    sent.end = (ABORTED, "function 1 (setColor): no such light")
    result = run("leds", "Nose", "green")
    assert (result.exit_code, result.stderr) == (1, "Error: function 1 (setColor): no such light\n")
    document = json.loads(run("--json", "say", "hello").stdout)
    assert (document["server"], document["state"], document["text"]) == ("nao_audio_out", "aborted", sent.end[1])
    sent.end = (ABORTED, "NAOqi at 10.0.0.7:9559: not reached")
    sent.fill = lambda result: setattr(there, "connected", False)  # it goes away meanwhile
    result = run("leds", "Brain0", "green", "--json")
    assert result.exit_code == 3 and json.loads(result.stdout)["state"] == "aborted", "one document"
    del there.servers["/NaoMotion"]
    result = run("pose", "Stand")
    assert (result.exit_code, "the server NaoMotion does not run" in result.stderr) == (3, True)
    there.servers.clear()
    result = run("say", "hello")
    assert (result.exit_code, result.stderr) == (3, "Error: no robot's servers run at http://master:11311\n")


@pytest.mark.parametrize("line", ["status", "say hello", "watch a", "sim reset"])
def test_without_a_master_it_is_one_line_and_status_3(run, graph, line):
    result = run(*line.split())
    assert result.exit_code == 3 and result.stdout == ""
    (told,) = result.stderr.splitlines()
    assert "there is no ROS master at http://127.0.0.1:9" in told
    for words_ in (["--json", *line.split()], [*line.split(), "--json"]):
        result = run(*words_)
        document = json.loads(result.stdout)
        assert (result.exit_code, document["status"], result.stderr) == (3, 3, f"Error: {document['error']}\n")
    help_ = run("help", "setColor")
    assert help_.exit_code == 0 and help_.stdout.startswith("NaoLights setColor")
    assert "this is what the code says" in help_.stderr


@pytest.mark.parametrize(
    "line, complaint",
    [
        ("leds green", "lights and their look are wanted"), ("leds FaceLeds on --fade 1", "on takes no time"),
        ("call NaoLigths on", "did you mean 'NaoLights'"), ("call NaoLights on light:=a", "did you mean 'lights'"),
        ("walk far", "'far' is not a valid float"), ("run hello loud", "'loud' is no PARAMETER=VALUE"),
        ("help setColour", "did you mean 'setColor'"), ("hlep", "did you mean 'help'"),
        ("photo x.png --size 5", "'5' is no size"), ("list Nose", "there is no server 'Nose'"),
        ("say hi --timeout=0", "timeout"), ("say hi --timeout=nan", "timeout"), ("say hi --timeout=soon", "timeout"),
        ("walk far --json", "'far' is not a valid float"), ("sim * --json", "no command '*'"),
    ],
)  # fmt: skip
def test_mistakes_in_the_command_are_status_2(run, graph, sent, line, complaint):
    graph()
    result = run(*line.split(" "))
    assert result.exit_code == 2 and complaint in result.stderr and result.stdout == "" and not sent.goals


def test_servers_and_functions_are_listed_and_explained(run, graph):
    graph()
    assert "NaoLights " in run("list").stdout
    functions = run("list", "lights").stdout
    assert "setColor" in functions and "insertData" not in functions
    assert "insertData" in run("list", "lights", "--all").stdout
    assert {entry["name"] for entry in json.loads(run("list", "--json").stdout)} >= {"NaoLights", "NaoMotion"}
    text = run("help", "setintensity").stdout
    assert text.startswith("NaoLights setIntensity: Set intensities at once")
    assert "i_values (float64[]) no unit, []" in text and "allowed: each within 0..1" in text
    (described,) = json.loads(run("help", "setIntensity", "--json").stdout)
    assert described["server"] == "NaoLights" and described["arguments"][1]["minimum"] is None
    # A function of several servers is told of all of them; one that all have once.
    told = (["setParameter"], ["nao_audio_in", "setParameter"], ["getData"])
    assert [run("help", *names).stdout.count("nao call") for names in told] == [3, 1, 1]
    text = run("help", "NaoLights").stdout
    assert text.startswith("NaoLights: LED goals") and "  setColor" in text and "insertData" in text.splitlines()[-1]


def test_the_robot_is_the_only_one_or_the_one_that_is_chosen(run, graph, sent, monkeypatch):
    graph("/nao2/")
    assert run("say", "hello").exit_code == 0 and sent.goals[0][0] == "/nao2/nao_audio_out"
    fake = graph("/nao1/", "/nao2/")
    result = run("say", "hello")
    assert (result.exit_code, "choose a robot with --robot; there are nao1, nao2" in result.stderr) == (2, True)
    for line in (("--robot", "nao2", "say", "hello"), ("say", "hello", "-n", "/nao2")):
        fake.calls.clear()
        assert run(*line).exit_code == 0
        assert all(service.startswith("/nao2/") for service, _ in fake.calls)
    assert run("say", "hello", "-n", "nao3").exit_code == 3
    monkeypatch.setenv("ROS_NAMESPACE", "nao1")
    assert run("say", "hello").exit_code == 0 and sent.goals[-1][0] == "/nao1/nao_audio_out"


@pytest.fixture
def behaviors():
    tempo = BehaviorParameter(name="tempo", default="1.0", help="how fast")
    known = [
        BehaviorInfo(name="bow", help="Bows.", parameters=[tempo]),
        BehaviorInfo(name="broken", problem="no steps"),
    ]
    answer = lambda request: ListBehaviorsResponse([b for b in known if request.name in ("", b.name)])  # noqa: E731
    return {"/NaoBehavior/list": answer}


def test_behaviors_are_listed_and_checked_by_name_without_a_goal(run, graph, sent, behaviors):
    graph(services=behaviors)
    assert run("behaviors").stdout == "bow     Bows.\nbroken  no steps\n"
    assert run("behaviors", "bow").stdout == "bow: Bows.\n  tempo=1.0  how fast\n"
    assert [b["name"] for b in json.loads(run("behaviors", "--json").stdout)] == ["bow", "broken"]
    assert run("check", "bow").stdout == "bow: Bows.\n  tempo=1.0  how fast\nit can be run\n"
    broken = run("check", "broken", "--json")
    assert (broken.exit_code, json.loads(broken.stdout)["problems"]) == (1, ["no steps"])
    assert broken.stderr == "Error: broken cannot be run: no steps\n"
    for command in ("behaviors", "check"):
        mistyped = run(command, "bown")
        assert (mistyped.exit_code, mistyped.stdout, "did you mean 'bow'" in mistyped.stderr) == (1, "", True)
    assert not sent.goals


def test_a_check_with_values_or_of_a_file_tells_what_would_be_done_or_fails(run, graph, sent, tmp_path):
    graph()
    step = "1 NaoMotion.goToPosture: str_param Stand"
    info = BehaviorInfo(name="bow", help="Bows.", tags=["polite"], servers=["NaoMotion"], waits=1.5, unchecked=[step])
    info.steps = [step, "2 wait 1.5 s"]
    sent.fill = lambda result: setattr(result, "behaviors", [info])
    told = run("check", "bow", "depth=0.2").stdout
    for text in ("bow: Bows.", "polite", "NaoMotion", "1.5 s", "    2 wait 1.5 s", "only the robot knows"):
        assert text in told
    assert told.endswith("it can be run\n")
    (tmp_path / "mine.yaml").write_text("help: x\ndo: []")
    assert run("check", str(tmp_path / "mine.yaml")).stdout.startswith("mine: Bows.")
    asked = [(m.function, m.str_param, m.text, m.parameters) for _, (m,) in sent.goals]
    expected = [("checkBehavior", "bow", "", ["depth=0.2"]), ("checkBehavior", "", "help: x\ndo: []", [])]
    assert asked == expected
    info.problem = "no"
    sent.fill = lambda result: (setattr(result, "behaviors", [info]), setattr(result, "memList", ["step 1: no"]))
    result = run("check", "bow", "depth=1")
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", "Error: bow cannot be run: step 1: no\n")
    assert run("check", "bow", "depth").exit_code == 2
    assert "cannot be read" in run("check", str(tmp_path / "none.yaml")).stderr


def test_functions_have_fields_and_a_comma_or_then_between_them():
    (function,) = read_chain(["setColor", "lights:=FaceLeds,EarLeds", "str_param:=a:=b"])
    assert (function.name, function.fields) == ("setColor", {"lights": "FaceLeds,EarLeds", "str_param": "a:=b"})
    for typed in (["on", "a:=1", ",", "off"], ["on", "a:=1", "--then", "off"], ["on,", "off"]):
        assert [function.name for function in read_chain(typed)] == ["on", "off"]
    points = "trajectory:={joint_names: [HeadYaw], points: [{positions: [0.1]}]}"
    message = build_message(read_chain(["setTrajectory", "time:=1.5", points])[0], MotionFunction)
    assert message.time.to_sec() == 1.5 and message.trajectory.points[0].positions == [0.1]
    for typed, complaint in (
        (["on", ","], "function 2 has no name"),
        (["lights:=a"], "function 1 has no name"),
        (["on", "lights"], "'lights' is no field:=value"),
        (["on", "lights:=a", "lights:=b"], "lights is there twice"),
    ):
        with pytest.raises(click.UsageError, match=complaint):
            read_chain(typed)
    for field, complaint in (("light:=a", "no field 'light': did you mean 'lights'"), ("function:=on", "no field")):
        with pytest.raises(click.UsageError, match=complaint):
            build_message(read_chain(["on", field])[0], LedFunction)


@pytest.mark.parametrize(
    "kind, text, value",
    [
        ("string", "5", "5"), ("string", "a, b", "a, b"), ("string[]", "a, b", ["a", "b"]), ("string[]", "", []),
        ("string[]", "[a, 'b, c']", ["a", "b, c"]), ("float64", "-1.5e-3", -0.0015), ("int32", "-7", -7),
        ("float64[]", "0,1,.5", [0.0, 1.0, 0.5]), ("bool", "yes", True), ("bool", "False", False),
    ],
)  # fmt: skip
def test_values_are_read_by_their_type(kind, text, value):
    assert read_value(kind, text) == value


def test_values_of_another_type_are_refused():
    for kind, text, complaint in (
        ("float64", "one", "'one' is no number"),
        ("int32[]", "[.inf]", "inf is no whole number"),
        ("duration", "nan", "'nan' is no time"),
        ("bool", "perhaps", "neither true nor false"),
        ("string[]", "[a", "is no YAML"),
        ("trajectory_msgs/JointTrajectory", "{joint_name: [a]}", "joint_name"),
    ):
        with pytest.raises(ValueError, match=complaint):
            read_value(kind, text)


@pytest.mark.parametrize(
    "result, out, err",
    [
        ({"results": [{"function": "f", "values": ["1", "2"]}], "memList": ["1", "2"]}, "1\n2\n", ""),
        ({"results": [{"function": "f", "values": ["1"]}, {"function": "g", "values": ["2"]}]}, "f: 1\ng: 2\n", ""),
        ({"results": [{"function": "f", "values": [], "error": "no"}]}, "", "f: no\n"),
        ({"results": [], "name": ["HeadYaw", "Head"], "position": [0.5, 0.25]}, "HeadYaw  0.5\nHead     0.25\n", ""),
    ],
)
def test_answers_are_printed_with_what_failed(capsys, result, out, err):
    say_result(result)
    assert tuple(capsys.readouterr()) == (out, err)


@pytest.fixture
def offered(monkeypatch):
    def offered(line):
        monkeypatch.setenv("NAO_LINE", line)
        complete = LineComplete(nao, {}, "nao", "_NAO_COMPLETE")
        typed, last = complete.get_completion_args()
        return [complete.format_completion(item) for item in complete.get_completions(typed, last)]

    return offered


def test_commands_are_offered_without_a_stack_and_names_from_the_servers(offered, graph, run):
    assert offered("nao ") == list(COMMANDS) and offered("nao st") == ["status", "stop"]
    assert "--robot" in offered("nao say --")
    for line in ("nao call NaoL", "nao pose St", "nao run ", "nao get Dev", "nao help s"):
        assert offered(line) == []
    script = run("completion", "bash").stdout
    assert "_NAO_COMPLETE" in script and "COMP_LINE" in script and "nao" in run("completion", "fish").stdout
    graph()
    for line, among in (
        ("nao list Nao", "NaoLights"),
        ("nao help setC", "setColor"),
        ("nao call NaoLights setI", "setIntensity"),
        ("nao call NaoLights setIntensity l", "lights:="),
        ("nao call NaoLights on lights:=Brain0 , set", "setColor"),
        ("nao call NaoLights on lights:=Brain0 revert:=t", "true"),
        ("nao call NaoMotion getMoveConfig str_param:=D", "Default"),
        ("nao leds FaceLeds gre", "green"),
        ("nao --robot ", "/"),
    ):
        assert among in offered(line), line
    fields = offered("nao call NaoLights setIntensity lights:=Brain0 ")
    assert "lights:=" not in fields and "i_values:=" in fields

"""What each command asks of the servers, and how it ends."""

import json

import click
import pytest

from nao_library_modules.command_line.app import main
from nao_library_modules.command_line.output import say_json
from nao_library_modules.command_line.settings import NaoCommand
from nao_library_msgs.msg import BehaviorInfo, BehaviorParameter
from nao_library_msgs.srv import ListBehaviorsResponse


@pytest.mark.parametrize(
    "words, server, expected",
    [
        ("say hello there", "nao_audio_out", {"function": "say", "str_param": "hello there"}),
        ("say hi --animated --speed 80", "nao_audio_out", {"function": "animatedSay", "speed": 80.0}),
        (
            "leds FaceLeds green --for 2 --revert",
            "NaoLights",
            {"function": "setColor", "lights": ["FaceLeds"], "str_param": "green", "revert": True},
        ),
        ("leds Brain0 Brain1 0.5", "NaoLights", {"function": "setIntensity", "lights": ["Brain0", "Brain1"]}),
        ("leds FaceLeds red --fade 1", "NaoLights", {"function": "fadeRGB", "duration": 1.0}),
        ("leds FaceLeds 0 --fade 1", "NaoLights", {"function": "fade", "i_values": [0.0]}),
        ("leds FaceLeds off", "NaoLights", {"function": "off"}),
        ("pose Crouch", "NaoMotion", {"function": "goToPosture", "str_param": "Crouch"}),
        ("wake", "NaoMotion", {"function": "wakeUp"}),
        ("rest", "NaoMotion", {"function": "rest"}),
        ("call motion setAngles names:=HeadYaw angles:=-0.1", "NaoMotion", {"names": ["HeadYaw"], "angles": [-0.1]}),
        ("run hello text=Hi count=3", "NaoBehavior", {"str_param": "hello", "parameters": ["text=Hi", "count=3"]}),
        ("record motion wave LArm --for 2", "NaoMotion", {"function": "recordMotion", "names": ["LArm"]}),
        ("record sound x.wav --for 1 --channels left,right", "nao_audio_in", {"channels": ["left", "right"]}),
        ("record behavior new --for 1", "NaoBehavior", {"function": "recordBehavior", "duration": 1.0}),
    ],
)
def test_a_command_is_a_function_of_a_server(run, graph, sent, words, server, expected):
    graph()
    result = run(*words.split())
    assert result.exit_code == 0, result.stderr
    ((name, (message,)),) = sent.goals
    assert name == server
    assert {field: getattr(message, field) for field in expected} == expected


def test_times_come_from_options(run, graph, sent):
    graph()
    run("leds", "FaceLeds", "green", "--for", "2")
    assert sent.goals[0][1][0].time.to_sec() == 2.0


def test_walking_stands_up_first_and_tells_how_far_it_got(run, graph, sent, monkeypatch):
    graph()
    sent.result = {"results": [{"function": "moveTo", "values": ["0.5", "0.01", "-0.02"]}]}
    monkeypatch.setattr("nao_library_modules.command_line.doing_commands._stands", lambda settings: False)
    result = run("walk", "0.5", "0", "-0.1")
    assert [m.function for m in sent.goals[0][1]] == ["goToPosture", "moveTo"]
    assert sent.goals[0][1][1].values == [0.5, 0.0, -0.1]
    assert result.stdout == "0.500 m ahead, 0.010 m to the left, -0.020 rad to the left\n"


def test_several_functions_are_one_goal(run, graph, sent):
    graph()
    run("call", "NaoLights", "on", "lights:=Brain0", ",", "off", "lights:=Brain0", "--then", "listGroups")
    assert [message.function for message in sent.goals[0][1]] == ["on", "off", "listGroups"]


def test_a_goal_that_fails_is_status_1_and_says_why(run, graph, sent):
    graph().connected = True
    sent.end = ("aborted", "function 1 (setColor): no such light")
    result = run("leds", "Nose", "green")
    assert (result.exit_code, result.stderr) == (1, "Error: function 1 (setColor): no such light\n")


def test_a_goal_that_fails_since_the_robot_is_gone_is_status_3(run, graph, sent):
    graph()
    sent.end = ("aborted", "NAOqi at 10.0.0.7:9559: not reached")
    assert run("leds", "Brain0", "green").exit_code == 3


def test_a_server_that_does_not_run_is_status_3(run, graph, sent):
    fake = graph()
    del fake._servers["/NaoMotion"]
    result = run("pose", "Stand")
    assert (result.exit_code, "the server NaoMotion does not run" in result.stderr) == (3, True)


def test_json_is_one_document_also_of_a_goal_that_fails(run, graph, sent):
    graph().connected = True
    sent.end = ("aborted", "no")
    result = run("--json", "say", "hello")
    assert result.exit_code == 1
    assert json.loads(result.stdout) == {
        "server": "nao_audio_out",
        "state": "aborted",
        "text": "no",
        "result": {"results": []},
        "elapsed": 0.5,
    }


@pytest.mark.parametrize("words", ["--json status", "status --json", "get a --json", "sim reset --json", "stop --json"])
def test_a_command_that_fails_says_so_in_json(run, graph, words):
    result = run(*words.split())
    document = json.loads(result.stdout)
    assert (result.exit_code, document["status"]) == (3, 3)
    assert result.stderr == f"Error: {document['error']}\n"
    assert "there is no ROS master" in document["error"]


def raises(error):
    def act(*_, **__):
        raise error

    return act


@pytest.mark.parametrize("error", [KeyboardInterrupt(), click.Abort()], ids=["Ctrl-C", "abort"])
def test_ctrl_c_before_there_is_a_goal_says_so_in_json(graph, monkeypatch, capsys, error):
    monkeypatch.setattr(graph(), "services", raises(error))
    assert main(["status", "--json"]) == 130
    assert json.loads(capsys.readouterr().out) == {"error": "interrupted", "status": 130}
    assert main(["status"]) == 130
    assert capsys.readouterr().out == ""


def test_ctrl_c_adds_nothing_to_lines_that_were_said(graph, monkeypatch, capsys):
    @click.command(cls=NaoCommand)
    def watch():
        say_json({"value": 1}, compact=True)
        raise KeyboardInterrupt

    monkeypatch.setattr("nao_library_modules.command_line.memory_commands.watch_command", watch)
    assert main(["watch", "--json"]) == 130
    assert [json.loads(line) for line in capsys.readouterr().out.splitlines()] == [{"value": 1}]


def test_every_failure_says_so_in_json_but_mistakes_in_the_command(run, graph, sent, monkeypatch):
    graph()
    missing = click.ClickException("the message is not built here")
    monkeypatch.setattr("nao_library_modules.command_line.goals.message_class", raises(missing))
    assert json.loads(run("--json", "say", "hello").stdout) == {"error": missing.message, "status": 1}
    mistake = run("walk", "far", "--json")
    assert (mistake.exit_code, mistake.stdout) == (2, "")


def test_a_command_of_a_group_that_fails_says_so_in_json(run, graph):
    graph()
    document = json.loads(run("sim", "pause", "--json").stdout)
    assert document == {"error": "there is no service /nao_sim/pause: is this a simulated robot?", "status": 3}


def test_without_json_errors_are_on_standard_error_only(run, graph):
    assert run("status").stdout == ""


def test_a_document_is_not_followed_by_an_error(run, graph, sent):
    graph()
    sent.end = ("aborted", "NAOqi at 10.0.0.7:9559: not reached")
    result = run("leds", "Brain0", "green", "--json")
    assert result.exit_code == 3
    assert json.loads(result.stdout)["state"] == "aborted"


@pytest.mark.parametrize(
    "words, complaint",
    [
        ("leds green", "lights and their look are wanted"),
        ("leds FaceLeds on --fade 1", "on takes no time"),
        ("call NaoLigths on", "did you mean 'NaoLights'"),
        ("call NaoLights on light:=a", "did you mean 'lights'"),
        ("walk far", "'far' is not a valid float"),
        ("run hello loud", "'loud' is no PARAMETER=VALUE"),
        ("help setColour", "did you mean 'setColor'"),
        ("hlep", "did you mean 'help'"),
        ("say hello --timeout 0", "--timeout"),
        ("photo x.png --size 5", "'5' is no size"),
        ("list Nose", "there is no server 'Nose'"),
    ],
)
def test_mistakes_in_the_command_are_status_2(run, graph, sent, words, complaint):
    graph()
    result = run(*words.split())
    assert result.exit_code == 2
    assert complaint in result.stderr
    assert not sent.goals


@pytest.mark.parametrize(
    "words", ["status", "say hello", "stop", "get a", "watch a", "sim reset", "run x", "behaviors"]
)
def test_without_a_master_it_is_one_line_and_status_3(run, graph, words):
    result = run(*words.split())
    assert result.exit_code == 3
    (line,) = result.stderr.splitlines()
    assert "there is no ROS master at http://127.0.0.1:9" in line


def test_a_master_without_servers_is_status_3(run, monkeypatch, graph):
    fake = graph()
    fake._servers = {}
    result = run("say", "hello")
    assert (result.exit_code, result.stderr) == (3, "Error: no robot's servers run at http://master:11311\n")


# Asking


def test_servers_and_functions_are_listed(run, graph):
    graph()
    assert "NaoLights " in run("list").stdout
    functions = run("list", "lights").stdout
    assert "setColor" in functions and "insertData" not in functions
    assert "insertData" in run("list", "lights", "--all").stdout
    assert {entry["name"] for entry in json.loads(run("list", "--json").stdout)} >= {"NaoLights", "NaoMotion"}


def test_help_tells_what_a_function_takes_wherever_it_is(run, graph):
    graph()
    text = run("help", "setintensity").stdout
    assert text.startswith("NaoLights setIntensity: Set intensities at once")
    assert "i_values (float64[]) no unit, []" in text
    assert "allowed: each within 0..1" in text
    (described,) = json.loads(run("help", "setIntensity", "--json").stdout)
    assert described["server"] == "NaoLights"
    assert described["arguments"][1]["minimum"] is None


def test_help_of_a_function_of_several_servers_tells_all_but_of_one_that_all_have_once(run, graph):
    graph()
    assert run("help", "setParameter").stdout.count("nao call") == 3
    assert run("help", "nao_audio_in", "setParameter").stdout.count("nao call") == 1
    assert run("help", "getData").stdout.count("nao call") == 1


def test_help_of_a_server_lists_its_functions(run, graph):
    graph()
    text = run("help", "NaoLights").stdout
    assert text.startswith("NaoLights: LED goals") and "  setColor" in text and "insertData" in text.splitlines()[-1]


def test_without_a_stack_help_comes_from_the_code(run, graph):
    result = run("help", "setColor")
    assert result.exit_code == 0
    assert result.stdout.startswith("NaoLights setColor")
    assert "this is what the code says" in result.stderr


# Robots


def test_the_only_robot_is_found_in_its_namespace(run, graph, sent):
    graph("/nao2/")
    assert run("say", "hello").exit_code == 0


def test_among_several_robots_one_must_be_chosen(run, graph, sent):
    fake = graph("/nao1/", "/nao2/")
    result = run("say", "hello")
    assert (result.exit_code, "choose a robot with --robot; there are nao1, nao2" in result.stderr) == (2, True)
    for words in (("--robot", "nao2", "say", "hello"), ("say", "hello", "-n", "/nao2")):
        fake.calls.clear()
        assert run(*words).exit_code == 0
        assert all(service.startswith("/nao2/") for service, _ in fake.calls)
    assert run("say", "hello", "-n", "nao3").exit_code == 3


def test_the_namespace_of_the_environment_counts(run, graph, sent, monkeypatch):
    fake = graph("/nao1/", "/nao2/")
    monkeypatch.setenv("ROS_NAMESPACE", "nao1")
    assert run("say", "hello").exit_code == 0
    assert fake.calls[0][0].startswith("/nao1/")


# Behaviours


@pytest.fixture
def behaviors():
    tempo = BehaviorParameter(name="tempo", default="1.0", help="how fast", unit="", choices=[])
    known = [
        BehaviorInfo(name="bow", help="Bows.", parameters=[tempo]),
        BehaviorInfo(name="broken", problem="no steps"),
    ]
    return {
        "/NaoBehavior/list": lambda request: ListBehaviorsResponse([b for b in known if request.name in ("", b.name)])
    }


def test_behaviors_are_listed_with_help_or_what_is_wrong(run, graph, behaviors):
    graph(services=behaviors)
    assert run("behaviors").stdout == "bow     Bows.\nbroken  no steps\n"
    assert run("behaviors", "bow").stdout == "bow: Bows.\n  tempo=1.0  how fast\n"
    assert [b["name"] for b in json.loads(run("behaviors", "--json").stdout)] == ["bow", "broken"]
    mistyped = run("behaviors", "bown")
    assert (mistyped.exit_code, mistyped.stdout) == (1, "")
    assert "did you mean 'bow'" in mistyped.stderr


OUTLOOK = {
    "name": "bow", "help": "Bows.", "tags": ["polite"], "parameters": [], "servers": ["NaoMotion"], "shipped": True,
    "problem": "", "steps": ["1 NaoMotion.goToPosture: str_param Stand", "2 wait 1.5 s"], "boxes": ["nod"],
    "waits": 1.5, "unchecked": ["1 NaoMotion.goToPosture: str_param Stand"],
}  # fmt: skip


def test_a_check_tells_what_a_behavior_would_do(run, graph, sent, tmp_path):
    graph()
    sent.result = {"results": [], "memList": [], "behaviors": [dict(OUTLOOK)]}
    told = run("check", "bow", "depth=0.2").stdout
    for text in ("bow: Bows.", "polite", "NaoMotion", "nod", "1.5 s", "    2 wait 1.5 s", "only the robot knows"):
        assert text in told
    assert told.endswith("it can be run\n")
    assert json.loads(run("check", "bow", "depth=1", "--json").stdout)["problems"] == []
    file = tmp_path / "mine.yaml"
    file.write_text("help: x\ndo: []")
    assert run("check", str(file)).stdout.startswith("mine: Bows.")
    asked = [message for _, (message,) in sent.goals]
    assert [(m.function, m.str_param, m.text, m.parameters) for m in asked] == [
        ("checkBehavior", "bow", "", ["depth=0.2"]),
        ("checkBehavior", "bow", "", ["depth=1"]),
        ("checkBehavior", "", "help: x\ndo: []", []),
    ]


def test_a_check_that_finds_something_fails(run, graph, sent, tmp_path):
    graph()
    sent.result = {"results": [], "memList": ["step 1: no", "step 2: no"], "behaviors": [{**OUTLOOK, "problem": "no"}]}
    result = run("check", "bow", "depth=1")
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr == "Error: bow cannot be run: step 1: no; step 2: no\n"
    assert json.loads(run("check", "bow", "depth=1", "--json").stdout)["problems"] == ["step 1: no", "step 2: no"]
    assert run("check", "bow", "depth").exit_code == 2
    assert "cannot be read" in run("check", str(tmp_path / "none.yaml")).stderr


def test_a_check_of_a_name_alone_ends_nothing_that_runs(run, graph, sent, behaviors):
    graph(services=behaviors)
    assert run("check", "bow").stdout == "bow: Bows.\n  tempo=1.0  how fast\nit can be run\n"
    broken = run("check", "broken", "--json")
    assert (broken.exit_code, json.loads(broken.stdout)["problems"]) == (1, ["no steps"])
    assert broken.stderr == "Error: broken cannot be run: no steps\n"
    mistyped = run("check", "bown")
    assert (mistyped.exit_code, "did you mean 'bow'" in mistyped.stderr) == (1, True)
    assert not sent.goals


@pytest.mark.parametrize(
    "words", [["-"], ["*"], ["sim", "*"], ["sim", "-"], ["sim", "‮"], ["record", '"'], ["record", ""]]
)
def test_a_word_that_is_no_command_is_a_mistake_whatever_it_begins_with(run, words):
    result = run(*words, "--json")
    assert result.exit_code == 2
    assert f"there is no command {words[-1]!r}" in result.stderr
    assert result.stdout == ""


@pytest.mark.parametrize("seconds", ["nan", "0", "-1", "soon"])
def test_a_limit_that_is_no_time_is_a_mistake(run, graph, sent, seconds):
    graph()
    result = run("say", "hi", f"--timeout={seconds}")
    assert result.exit_code == 2
    assert "timeout" in result.stderr
    assert not sent.goals

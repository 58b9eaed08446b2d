"""What each command asks of the servers, how it ends, what it prints, and what a shell is offered."""

from __future__ import annotations

import itertools
import json
import math
import runpy
from types import SimpleNamespace
from xml.etree import ElementTree

import click
import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from roslaunch.substitution_args import resolve_args
from wrong_behaviors import GOOD, LINE, WRONG, wrong_text

from nao_library_modules.cli.app import COMMANDS, nao
from nao_library_modules.cli.chain_text import Angle, build_message, read_chain, read_value
from nao_library_modules.cli.commands import robot_commands, simulator_commands
from nao_library_modules.cli.completion import LineComplete
from nao_library_modules.cli.output import say_result
from nao_library_modules.cli.stack import START
from nao_library_modules.ros import master_api
from nao_library_msgs.msg import (
    BehaviorInfo,
    BehaviorParameter,
    BehaviorProblem,
    BehaviorStep,
    FunctionResult,
    GoalProblem,
    LedFunction,
    MotionFunction,
    PictureFile,
    RecordedFile,
    RecordedVideo,
)
from nao_library_msgs.srv import CheckGoalsResponse, ListBehaviorsResponse, StartFilmResponse, StopFilmResponse
from nao_sim_bridge.world.render_state import PRESETS

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


@pytest.fixture
def recorder(graph, sent, tmp_path, monkeypatch):
    """A robot whose files are in a folder of this computer: that folder. The user is in the one above."""
    folder = tmp_path / "robot"
    folder.mkdir()
    monkeypatch.chdir(tmp_path)
    graph().parameters["/nao_audio_in/robot_home"] = str(folder)
    named = SimpleNamespace(name="")

    def record(result):
        (message, *_) = sent.goals[-1][1]
        named.name = message.str_param or named.name
        path = folder / named.name
        if message.function == "record":
            result.files = [RecordedFile(path=named.name, file=str(path), duration=1.0)]
        elif message.function == "takePicture":
            path = folder / (message.str_param or "top.png")
            result.pictures = [PictureFile(path=str(path))]
        elif message.function == "deleteThread" or "startRecording" not in sent.lasting:
            result.recordings = [RecordedVideo(path=str(path), duration=1.0)]
        else:
            return
        path.write_bytes(b"new")

    sent.fill = record
    return folder


def test_files_come_to_where_the_user_is_and_replace_none_unasked(run, recorder, sent, tmp_path):
    line = ("record", "sound", "x.wav", "--for", "1", "--channels", "left,right")
    assert run(*line).stdout == f"{tmp_path}/x.wav: 1.00 s\n"
    assert sent.goals[0][1][0].channels == ["left", "right"]
    (tmp_path / "x.wav").write_bytes(b"kept")
    for command in (line, ("photo", "x.wav"), ("record", "video", "x.wav", "--for", "1"), ("sim", "picture", "x.wav")):
        refused = run(*command)
        assert (refused.exit_code, refused.stderr) == (
            1, f"Error: {tmp_path}/x.wav is there already: another name, or --overwrite\n"
        )  # fmt: skip
    for file, told in (
        ("nowhere/x.png", f"{tmp_path}/nowhere/x.png has no place: there is no folder {tmp_path}/nowhere"),
        ("nowhere/", "there is no folder nowhere/"),
    ):
        homeless = run("photo", file)
        assert (homeless.exit_code, homeless.stderr) == (1, f"Error: {told}\n")
    assert len(sent.goals) == 1 and (tmp_path / "x.wav").read_bytes() == b"kept"
    assert run(*line, "--overwrite").exit_code == 0 and (tmp_path / "x.wav").read_bytes() == b"new"
    assert list(recorder.iterdir()) == []


@pytest.mark.parametrize("more, status", [((), 0), (("--for", "5"), 130)])
def test_a_film_that_is_interrupted_is_complete_and_comes_to_where_the_user_is(
    run, graph, sent, tmp_path, monkeypatch, more, status
):
    asked, made = [], tmp_path / "made.mp4"

    def start(request):
        asked.append((request.view, request.width, request.height))
        return StartFilmResponse(success=True, path=str(made))

    def stop(_request):
        made.write_bytes(b"film")
        return StopFilmResponse(success=True, path=str(made), length=rospy.Duration(2))

    def interrupt(_seconds):
        raise KeyboardInterrupt

    graph(services={"/nao_sim/film/start": start, "/nao_sim/film/stop": stop})
    monkeypatch.setattr(simulator_commands, "start_node", lambda: None)
    monkeypatch.setattr(rospy, "sleep", interrupt)
    ended = run("sim", "film", str(tmp_path / "x.mp4"), "--view", "face", *more)
    assert (ended.exit_code, ended.stdout) == (status, f"{tmp_path}/x.mp4: 2.00 s\n"), ended.stderr
    assert asked == [("face", 480, 480)] and (tmp_path / "x.mp4").read_bytes() == b"film"


def test_a_file_that_came_meanwhile_is_not_replaced_and_one_in_a_folder_has_the_servers_name(
    run, recorder, sent, tmp_path
):
    record = sent.fill

    def another_one_first(result):
        (tmp_path / "x.png").write_bytes(b"kept")
        record(result)

    sent.fill = another_one_first
    assert run("photo", "x.png").stdout == f"{tmp_path}/x-2.png\n"
    assert ((tmp_path / "x.png").read_bytes(), (tmp_path / "x-2.png").read_bytes()) == (b"kept", b"new")
    (tmp_path / "day.d").mkdir()
    for name in ("top.png", "top-2.png"):
        assert run("photo", "day.d/").stdout == f"{tmp_path}/day.d/{name}\n"
    assert run("record", "sound", "day.d", "--for", "1").stdout.startswith(f"{tmp_path}/day.d/sound_")
    (tmp_path / "gone").mkdir()

    def no_folder_any_more(result):
        record(result)
        (tmp_path / "gone").rmdir()

    sent.fill = no_folder_any_more
    lost = run("photo", "gone/x.png")
    (left,) = recorder.iterdir()
    assert lost.exit_code == 1 and lost.stderr.endswith(f"No such file or directory; the file is {left}\n")


def test_a_sound_without_a_file_stays_where_it_is_and_a_robots_own_is_replaced_only_when_that_is_said(
    run, recorder, graph, sent
):
    (line,) = run("record", "sound", "--for", "1").stdout.splitlines()
    (left,) = recorder.iterdir()
    assert line == f"{left}: 1.00 s" and left.name.startswith("sound_")
    graph()
    sent.fill = lambda result: setattr(result, "files", [RecordedFile(path="x.wav", duration=1.0)])
    for more in ((), ("--overwrite",)):
        assert run("record", "sound", "x.wav", "--for", "1", *more).stdout == "/home/nao/x.wav, on the robot: 1.00 s\n"
        assert (sent.goals[-1][1][0].str_param, sent.goals[-1][1][0].overwrite) == ("x.wav", bool(more))


@pytest.mark.parametrize("kind, function, ended", [("sound", "record", 0), ("video", "startRecording", 1)])
@pytest.mark.parametrize(
    "interrupted, more, status, told",
    [
        (True, ("--for", "60"), 130, "Error: preempted\n"),
        (True, (), 0, ""),
        (False, ("--for", "60", "--timeout", "0.01"), 1, "Error: not done within 0.01 s: cancelled\n"),
    ],
)
def test_what_was_recorded_until_it_was_cut_short_comes_to_where_the_user_is(
    run, recorder, sent, tmp_path, kind, function, ended, interrupted, more, status, told
):
    sent.lasting, sent.interrupted = (function,), interrupted
    file = tmp_path / f"cut.{'wav' if kind == 'sound' else 'mp4'}"
    for json_, line in ((False, f"{file}: 1.00 s\n" if kind == "sound" else f"{file}\n"), (True, "")):
        result = run("record", kind, file.name, *more, *(["--json"] if json_ else []))
        assert result.exit_code == status and result.stderr.endswith(told), result.stderr
        assert file.read_bytes() == b"new" and list(recorder.iterdir()) == []
        assert result.stdout == line or f'"path": "{file}"' in json.dumps(json.loads(result.stdout))
        file.unlink()
    assert len(sent.goals) == 2 * (1 + ended), "a video goes on without its goal, and is stopped"
    sent.lasting, sent.end = (), (ABORTED, "no camera")
    sent.fill = lambda result: setattr(result, "results", [])
    assert run("record", kind, file.name, "--for", "1").stderr.endswith("Error: no camera\n")
    assert len(sent.goals) == 2 * (1 + ended) + 1, "where nothing was begun nothing is stopped"


def test_a_touch_that_lasts_longer_than_was_asked_is_reported(run, graph, monkeypatch):
    pressed, times = [], iter((10.0, 11.0))
    graph(services={"/nao_sim/press": lambda request: pressed.append(list(request.sensors))})
    monkeypatch.setattr(simulator_commands, "start_node", lambda: None)
    monkeypatch.setattr(rospy, "get_time", lambda: next(times))
    monkeypatch.setattr(rospy, "sleep", lambda _: None)
    result = run("sim", "touch", "Head/Touch/Front", "--for", "0.3")
    assert "held for 1.00 s" in result.stderr and pressed == [["Head/Touch/Front"], []]


def test_a_stop_reaches_all_who_listen_and_waits_for_no_dead_one(monkeypatch):
    """A console that hears of a stop late would go on with its trial."""
    sent, connections = [], {"/NaoLights/cancel": iter((0, 1, 1, 2)), "/NaoMotion/cancel": itertools.repeat(1)}

    class Publisher:
        def __init__(self, topic, kind, queue_size):
            self._topic = topic

        def get_num_connections(self):
            return next(connections[self._topic])

        def publish(self, message):
            sent.append((self._topic, message.id))

    monkeypatch.setattr(rospy, "Publisher", Publisher)
    monkeypatch.setattr(robot_commands, "start_node", lambda: None)
    monkeypatch.setattr(robot_commands, "GONE_AFTER", 0.1)
    monkeypatch.setattr(master_api, "node_runs", {"/NaoMotion": True, "/dead": False}.get)
    robot_commands._cancel(
        {"/NaoLights/cancel": ["/NaoLights", "/console"], "/NaoMotion/cancel": ["/NaoMotion", "/dead"]}
    )
    assert sorted(sent) == [("/NaoLights/cancel", "")] * 2 + [("/NaoMotion/cancel", "")]


def test_a_goal_that_ctrl_c_ended_is_one_document_with_its_state(run, graph, sent):
    graph()
    sent.lasting, sent.interrupted = ("rasta",), True
    result = run("call", "NaoLights", "rasta", "duration:=60", "--json")
    assert result.exit_code == 130 and json.loads(result.stdout)["state"] == "preempted"


def test_what_steps_of_a_behaviour_answered_is_printed(capsys):
    step = {"path": "5", "what": "nao_audio_in.listen", "results": [{"values": ["yes", "0.995"]}]}
    say_result({"results": [], "steps": [step, {**step, "path": "6", "results": []}]})
    assert capsys.readouterr().out == "5 nao_audio_in.listen: yes, 0.995\n"


@pytest.mark.parametrize("interrupted, more, status", [(True, (), 0), (True, ("--for", "60"), 130), (False, (), 1)])
def test_where_a_motion_is_that_was_cut_short_is_told(run, graph, sent, interrupted, more, status):
    graph()
    sent.lasting, sent.interrupted = ("recordMotion",), interrupted
    kept = FunctionResult(function="recordMotion", values=["written: /wave.yaml"])
    sent.fill = lambda result: setattr(result, "results", [kept])
    result = run("record", "motion", "wave", "--timeout", "0.01", *more)
    assert (result.exit_code, result.stdout) == (status, "written: /wave.yaml\n")


def test_a_new_study_balances_its_conditions_keeps_its_results_and_ends_without_a_master(
    run, graph, tmp_path, monkeypatch
):
    run("new", "study", "greeting", "--folder", str(tmp_path))
    study = runpy.run_path(str(tmp_path / "greeting" / "scripts" / "greeting.py"))
    assert sorted(study["balanced"](("red", "green"), 6, 1)) == ["green"] * 3 + ["red"] * 3
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    results = tmp_path / "greeting" / "results"
    assert study["place_for"]("") == results / "greeting.csv"
    (results / "greeting.csv").touch()
    assert study["place_for"]("") == results / "greeting-2.csv"
    monkeypatch.setattr("sys.argv", ["greeting.py", "--output", str(tmp_path / "trials.csv")])
    with pytest.raises(SystemExit, match="there is no ROS master"):
        study["main"]()
    (node,) = ElementTree.parse(tmp_path / "greeting" / "greeting.launch").iter("node")
    monkeypatch.setenv("PWD", "/home/me")  # nodes themselves begin in another folder
    given = {"trials": "8", "output": "", "overwrite": "false", "timeout": "", "seed": ""}
    for more, words_ in (
        ({}, ""),
        ({"output": "a.csv"}, " --output /home/me/a.csv"),
        ({"output": "/tmp/a.csv", "timeout": "5", "seed": "0"}, " --output /tmp/a.csv --timeout 5 --seed 0"),
        ({"overwrite": "true"}, " --overwrite"),
    ):
        assert resolve_args(node.get("args"), {"arg": {**given, **more}}) == "--trials 8" + words_


@pytest.mark.parametrize("name, kind", [("nao_library_msgs", "ROS package"), ("queue", "Python module")])
def test_a_new_study_takes_no_name_that_is_taken(run, tmp_path, name, kind):
    refused = run("new", "study", name, "--folder", str(tmp_path))
    assert refused.exit_code == 1 and f"there is a {kind} {name} already" in refused.stderr, refused.stderr
    assert list(tmp_path.iterdir()) == []


def test_of_the_answers_in_a_new_study_the_earliest_with_a_time_counts(run, tmp_path):
    run("new", "study", "greeting", "--folder", str(tmp_path))
    first = runpy.run_path(str(tmp_path / "greeting" / "scripts" / "greeting.py"))["first"]
    unknown, early, late = rospy.Time(), rospy.Time(4), rospy.Time(5)
    assert first([(late, "front head"), (early, "yes")]) == (early, "yes")
    assert first([(late, "front head"), (unknown, "yes")]) == (late, "front head")
    assert first([(unknown, "yes")]) == (unknown, "yes")
    assert first([]) == (unknown, "")


def test_what_a_server_remarks_is_told_also_where_nobody_asked_for_an_answer(run, graph, sent):
    graph()
    sent.end = (GoalStatus.SUCCEEDED, "no gestures")
    result = run("say", "hello", "--animated")
    assert (result.exit_code, result.stdout, "no gestures" in result.stderr) == (0, "", True)


def test_a_goal_that_fails_is_status_1_and_3_where_the_robot_is_gone(run, graph, sent):
    there = graph()
    sent.end = (ABORTED, "function 1 (setColor): no such light")
    result = run("leds", "Nose", "green")
    assert (result.exit_code, result.stderr) == (1, "Error: function 1 (setColor): no such light\n")
    sent.fill = lambda result: setattr(result, "volume", 70.0)
    assert run("say", "hello").stdout == ""
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
    assert (result.exit_code, result.stderr) == (
        3,
        f"Error: no robot's servers run at http://master:11311: start them with {START}\n",
    )


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
        ("leds Eyes 255 0 0", "a colour by its name or as '#FF8000'"), ("walk 0 0 9deeg", "rad, or degrees as 90deg"),
        ("wave", "there is no command 'wave': nao call NaoMotion playMotion str_param:=wave"), ("nod", ": nao run nod"),
        ("call motion setColor lights:=a", "NaoMotion has no function setColor; NaoLights has"),
        ("call motion say", "NaoMotion has no function say; nao_audio_out has"),
        ("record sound x.mp3", "x.mp3: the name of the file ends in .wav or .ogg"),
        ("photo x.png --size 5", "'5' is no size"), ("list Nose", "there is no server 'Nose'"),
        ("say hi --timeout=0", "timeout"), ("say hi --timeout=nan", "timeout"), ("say hi --timeout=soon", "timeout"),
        ("say hi --timeout=1e9", "1e+09 is not allowed: 0.001 to 86400 s"), ("watch a --count 1000001", "1000000"),
        ("sim touch head --for 1e9", "1e+09 is not allowed: 0 to 3600 s"), ("watch a --rate 101", "0.001 to 100 Hz"),
        ("walk nan", "nan is not allowed: -100 to 100 m"), ("leds Eyes red --for 1e9", "1e+09 is not allowed"),
        ("record sound x.wav --for nan", "0.001 to 3600 s"), ("sim push 0 1e308 0", "1e+308 is not allowed"),
        ("sim push 0 1 0 --for nan", "nan is not allowed"), ("sim advance 1e308", "0 to 86400 s"),
        ("walk far --json", "'far' is not a valid float"), ("sim * --json", "no command '*'"),
        ("call motion getAngles names=Head", "did you mean names:=Head?"),
        ("leds Eyes green --fro 2", "No such option: --fro Did you mean --for?"),
        ("walk -0.1 --tmeout 3", "Did you mean --timeout?"), ("call lights on --then off --dry-rum", "--dry-run?"),
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
    assert described["server"] == "NaoLights" and described["arguments"][0]["minimum"] is None
    # A function of several servers is told of all of them; one that all have once.
    told = (["setParameter"], ["nao_audio_in", "setParameter"], ["getData"])
    assert [run("help", *names).stdout.count("nao call") for names in told] == [3, 1, 1]
    text = run("help", "NaoLights").stdout
    assert text.startswith("NaoLights: LED goals") and "  setColor" in text and "insertData" in text.splitlines()[-1]


def test_a_server_that_died_without_a_word_is_told_of_and_missed_by_nobody_else(run, graph):
    fake = graph()
    fake.dead = {"/NaoMotion"}
    listed = run("list")
    assert listed.exit_code == 0 and "NaoLights " in listed.stdout and "NaoMotion" not in listed.stdout
    assert listed.stderr == "does not answer: NaoMotion\n"
    assert run("help", "setIntensity").stdout.startswith("NaoLights setIntensity")
    assert "NaoMotion/describe does not answer" in run("list", "motion", "-n", "/").stderr
    fake.dead = set(fake.servers)
    assert "this is what the code says" in run("list").stderr


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
    assert broken.stderr == "no steps\nError: broken cannot be run\n"
    for command in ("behaviors", "check"):
        mistyped = run(command, "bown")
        assert (mistyped.exit_code, mistyped.stdout, "did you mean 'bow'" in mistyped.stderr) == (1, "", True)
    assert not sent.goals


def test_a_check_with_values_or_of_a_file_tells_what_would_be_done_or_fails(run, graph, sent, tmp_path):
    step = "1 NaoMotion.goToPosture: str_param Stand"
    info = BehaviorInfo(name="bow", help="Bows.", tags=["polite"], servers=["NaoMotion"], waits=1.5, unchecked=[step])
    info.steps = [step, "2 wait 1.5 s"]
    fake = graph(services={"/NaoBehavior/list": lambda request: ListBehaviorsResponse([info])})
    told = run("check", "bow", "depth=0.2").stdout
    for text in ("bow: Bows.", "polite", "NaoMotion", "1.5 s", "    2 wait 1.5 s", "not known until they run"):
        assert text in told
    assert told.endswith("it can be run\n")
    mine = tmp_path / "mine.yaml"
    mine.write_text("help: x\ndo: []")
    assert run("check", str(mine)).exit_code == 0
    asked = [(r.name, r.text, r.file, r.parameters, r.validate) for _, r in fake.calls if hasattr(r, "validate")]
    assert asked == [("bow", "", "", ["depth=0.2"], True), ("", "help: x\ndo: []", str(mine), [], True)]
    info.unvalidated = ["NaoLights: there is no service /NaoLights/check"]
    assert run("check", "bow").stdout.endswith(f"    {info.unvalidated[0]}\nnothing wrong was found\n")
    info.problem, info.problems = "no", [BehaviorProblem("a.yaml", 3, "step 1", "no"), BehaviorProblem(text="none")]
    result = run("check", "bow", "depth=1")
    told = "a.yaml:3: step 1: no\nnone\nError: bow cannot be run\n"
    assert (result.exit_code, result.stdout, result.stderr) == (1, "", told)
    assert run("check", "bow", "depth").exit_code == 2
    assert "cannot be read" in run("check", str(tmp_path / "none.yaml")).stderr
    assert not sent.goals


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_file_is_refused_where_nothing_runs(run, graph, name, tmp_path):
    file = tmp_path / f"{name}.yaml"
    file.write_text(wrong_text(name))
    result = run("check", str(file))
    assert (result.exit_code, result.stdout) == (1, "")
    assert result.stderr.startswith(f"{file}:{LINE}: {WRONG[name][1]}"), result.stderr


def test_a_file_with_which_nothing_is_wrong_passes_where_nothing_runs_and_who_was_not_asked_is_told(
    run, graph, tmp_path
):
    (tmp_path / "good.yaml").write_text(GOOD)
    told = run("check", str(tmp_path / "good.yaml"), "text=Hi").stdout
    assert (
        told.count("there is no ROS master") == 1
        and "NaoTactile" in told
        and "text=Hi" in told
        and told.endswith("nothing wrong was found\n")
    )
    assert run("check", "hello").exit_code == 0 and "did you mean 'hello'" in run("check", "helo").stderr


def test_who_names_a_file_without_its_ending_is_told(run, graph, sent, behaviors, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "greetme.yaml").write_text(GOOD)
    assert "did you mean the file greetme.yaml?" in run("check", "greetme").stderr
    graph(services=behaviors)
    for command in ("run", "check"):
        assert "did you mean the file greetme.yaml?" in run(command, "greetme").stderr
    assert not sent.goals


def test_a_file_is_run_as_it_is_and_tells_its_lines(run, graph, sent, tmp_path):
    graph()
    mine = tmp_path / "mine.yaml"
    mine.write_text("help: x")
    failed = BehaviorStep(path="1", what="NaoLights.on", state="skipped", error="no", file=str(mine), line=3)
    sent.fill = lambda result: setattr(result, "steps", [failed])
    assert run("run", str(mine), "n=1").stderr.endswith(f"{mine}:3: 1 NaoLights.on skipped: no\n")
    ((_, (message,)),) = sent.goals
    assert (message.text, message.file, message.str_param, message.parameters) == ("help: x", str(mine), "", ["n=1"])


def test_a_dry_run_tells_what_is_wrong_and_sends_nothing(run, graph, sent):
    wrong = GoalProblem(goal=0, index=1, function="of", text="unknown function 'of'")
    answer = CheckGoalsResponse()
    fake = graph(services={"/NaoLights/check": lambda request: answer})
    line = ("call", "NaoLights", "on", "lights:=FaceLeds", ",", "of", "--dry-run")
    assert run(*line).stdout == "it can be done\n"
    ((_, request),) = [call for call in fake.calls if call[0] == "/NaoLights/check"]
    assert (request.type, len(request.goals)) == ("nao_library_actions/NaoLedGoal", 1)
    answer.problems = [wrong]
    result = run(*line)
    assert (result.exit_code, result.stderr) == (
        1,
        "function 2 (of): unknown function 'of'\nError: it cannot be done\n",
    )
    assert json.loads(run(*line, "--json").stdout)["problems"][0]["function"] == "of"
    answer.refused = "another type"
    assert "did not check the goal: another type" in run(*line).stderr
    assert not sent.goals


def test_functions_have_fields_and_a_comma_or_then_between_them():
    (function,) = read_chain(["setColor", "lights:=FaceLeds,EarLeds", "str_param:=a:=b"])
    assert (function.name, function.fields) == ("setColor", {"lights": "FaceLeds,EarLeds", "str_param": "a:=b"})
    for typed in (["on", "a:=1", ",", "off"], ["on", "a:=1", "--then", "off"], ["on,", "off"]):
        assert [function.name for function in read_chain(typed)] == ["on", "off"]
    points = "trajectory:={joint_names: [HeadYaw], points: [{positions: [0.1], time_from_start: 1}]}"
    message = build_message(read_chain(["setTrajectory", "time:=1.5", points])[0], MotionFunction)
    (point,) = message.trajectory.points
    assert (message.time.to_sec(), point.time_from_start.to_sec(), point.positions) == (1.5, 1.0, [0.1])
    for typed, complaint in (
        (["on", ","], "function 2 has no name"),
        (["lights:=a"], "function 1 has no name"),
        (["on", "lights"], "'lights' is no field:=value$"),
        (["on", "lights:=Eyes,", "off"], "'off' is no field:=value: a comma between functions stands by itself"),
        (["on", "lights:=a", "lights:=b"], "lights is there twice"),
    ):
        with pytest.raises(click.UsageError, match=complaint):
            read_chain(typed)
    for field, complaint in (
        ("light:=a", "no field 'light': did you mean 'lights'"),
        ("function:=on", "no field"),
        ("duration:=45deg", "duration: '45deg' is an angle, and this field is none"),
    ):
        with pytest.raises(click.UsageError, match=complaint):
            build_message(read_chain(["on", field])[0], LedFunction)


@pytest.mark.parametrize(
    "kind, text, value",
    [
        ("string", "5", "5"), ("string", "a, b", "a, b"), ("string[]", "a, b", ["a", "b"]), ("string[]", "", []),
        ("string[]", "[a, 'b, c']", ["a", "b, c"]), ("float64", "-1.5e-3", -0.0015), ("int32", "-7", -7),
        ("float64[]", "0,1,.5", [0.0, 1.0, 0.5]), ("float64[]", "180deg, 0", [math.pi, 0.0]),
        ("bool", "yes", True), ("bool", "False", False),
    ],
)  # fmt: skip
def test_values_are_read_by_their_type(kind, text, value):
    assert read_value(kind, text) == value


def test_an_angle_of_a_command_is_in_rad_or_in_degrees():
    assert [Angle().convert(text, None, None) for text in ("90deg", "-1.5")] == [math.pi / 2, -1.5]


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
        ({"touched": ["front head"], "touch_times": [1795982312.34567]}, "front head  1795982312.346\n", ""),
    ],
)
def test_answers_are_printed_with_what_failed(capsys, result, out, err):
    say_result(result)
    assert tuple(capsys.readouterr()) == (out, err)


def test_what_a_goal_says_of_its_success_is_printed_and_times_of_words_are_not(capsys):
    say_result({"results": [{"function": "listen", "values": []}], "words": []}, "nothing recognised within 5 s")
    assert capsys.readouterr().out == "nothing recognised within 5 s\n"
    say_result({"results": [], "words": ["yes"], "confidences": [0.5], "onsets": [2.0], "ends": [2.5]})
    assert capsys.readouterr().out == "yes  0.5\n"


@pytest.fixture
def offered(monkeypatch):
    def offered(line):
        monkeypatch.setenv("NAO_LINE", line)
        complete = LineComplete(nao, {}, "nao", "_NAO_COMPLETE")
        typed, last = complete.get_completion_args()
        return [complete.format_completion(item) for item in complete.get_completions(typed, last)]

    return offered


def test_commands_are_offered_without_a_stack_and_names_from_the_servers(offered, graph, run):
    assert offered("nao ") == list(COMMANDS) and offered("nao st") == ["status", "stop", "study"]
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


def test_pictures_are_offered_from_every_view_of_the_simulator():
    assert set(simulator_commands.VIEWS) == set(PRESETS)

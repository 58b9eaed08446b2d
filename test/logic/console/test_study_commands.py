"""`nao study` where no servers run: protocols are checked, tables written."""

from __future__ import annotations

import csv
import json
import threading
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from played_study import LIMIT, PlayedRobot, Trial
from scripted_disk import ScriptedDisk

from nao_library_modules.cli.app import nao
from nao_library_modules.cli.commands import study_commands
from nao_library_modules.studies import studies as module
from nao_library_modules.studies import trial_log as log_module
from nao_library_modules.studies import trial_runner as runner_module
from nao_library_modules.studies.studies import Studies
from nao_library_modules.studies.study_files import StudyFiles
from nao_library_modules.studies.trial_log import read_events


@pytest.fixture
def run():
    return lambda *words: CliRunner().invoke(nao, ["study", *map(str, words)])


@pytest.fixture
def played(tmp_path, monkeypatch):
    """A study with a trial."""
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    trial = Trial(tmp_path / "studies").begin()
    trial.play()
    return SimpleNamespace(folder=tmp_path / "studies", id=trial.runner.id)


@pytest.mark.parametrize("name", ["ten_steps", "praise_2x2"])
def test_protocols_that_come_along_fit_the_servers(run, tmp_path, name):
    told = run("check", name, "--studies", tmp_path)
    assert told.exit_code == 0, told.output


@pytest.mark.parametrize(
    "step, told",
    [
        ("call: NaoLights.setColour", "did you mean 'setColor'"),
        ("call: NaoLight.setColor", "did you mean 'NaoLights'"),
        ("run: wave", "there is no behavior 'wave'"),
        ("{run: hello, with: {txt: Hi}}", "there is no parameter 'txt'"),
        ("{run: hello, with: {colour: '{participant}'}}", "there is no parameter 'colour'"),
        ("posture: Stnd", "did you mean 'Stand'"),
        ("{call: NaoLights.setColor, with: {lights: [FaceLeds], str_param: '{n}'}}", "unknown colour 'gren'"),
        ("walk_to: [30, 0, 0]", "function 2 (moveTo): field values: 30 is unusual: usual is -10..10 m"),
        ("{call: nao_audio_out.say, with: {str_param: Hi, time: 90000}}", "0..86400 s"),
        ("{call: nao_audio_out.say, with: {str_param: Hi, time: 80000}}", "usual is 0..3600 s"),
        (
            "{call: NaoMotion.setAngles, with: {names: [HeadYaw], angles: [5.0], speed: 0.2}}",
            "HeadYaw cannot go to 5.0000 rad: -2.0857 to 2.0857 rad",
        ),
    ],
)
def test_what_the_robot_would_refuse_is_told_with_its_line(run, tmp_path, step, told):
    file = tmp_path / "mine.yaml"
    file.write_text(f"values: {{n: gren}}\nphases:\n  - steps:\n      - {step}\n")
    answer = run("check", file)
    assert answer.exit_code == 1
    assert "line 4" in answer.output
    assert told in answer.output


def test_a_step_that_says_that_its_number_is_meant_is_right(run, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text("phases:\n  - steps:\n      - {walk_to: [30, 0, 0], unusual: true}\n")
    assert run("check", file).exit_code == 0


def test_what_only_the_trial_has_is_not_looked_at(run, tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text(
        "phases:\n  - steps:\n      - {wizard: Colour, choices: [red, blue], label: colour}\n"
        "      - {run: hello, with: {text: 'Hi {participant}', color: '{colour}'}}\n"
        "      - {call: NaoLights.setColor, with: {lights: [FaceLeds], str_param: '{colour}'}}\n"
    )
    assert run("check", file).exit_code == 0


def test_a_protocol_that_there_is_not_is_told_with_those_that_are_close(run, tmp_path):
    assert "did you mean 'ten_steps'" in run("check", "ten_step", "--studies", tmp_path).output


def test_the_table_is_written_for_the_name_or_the_folder_of_a_study(run, played, tmp_path):
    for number, words in enumerate((["two_by_two", "--studies", played.folder], [played.folder / "two_by_two"])):
        file = tmp_path / f"{number}.csv"
        told = run("table", *words, "--csv", file, "--json")
        assert json.loads(told.stdout)["rows"] == len(list(csv.DictReader(file.open()))) == 4
        assert {row["participant"] for row in csv.DictReader(file.open())} == {"P01"}


def test_a_table_replaces_no_file_unless_that_is_asked_for(run, played, tmp_path):
    (tmp_path / "table.csv").write_text("mine")
    told = run("table", played.folder / "two_by_two", "--csv", tmp_path / "table.csv")
    assert (told.exit_code, (tmp_path / "table.csv").read_text()) == (1, "mine")


def test_studies_are_listed_with_their_trials(run, played):
    told = json.loads(run("list", "--studies", played.folder, "--json").stdout)
    assert told["studies"] == {"two_by_two": {"P01-1": "finished"}}
    assert {"ten_steps", "praise_2x2"} <= {*told["protocols"]}


def test_a_recording_that_there_is_not_is_refused(run):
    told = run("run", "ten_steps", "--participant", "P01", "--record", "film")
    assert told.exit_code == 2
    assert "film" in told.output


def test_a_value_that_the_protocol_does_not_have_is_refused(run):
    told = run("run", "ten_steps", "--participant", "P01", "--value", "greting=Hi")
    assert told.exit_code == 2
    assert "did you mean 'greeting'" in told.output


class FillingRobot(PlayedRobot):
    """While it says Two its disk gets full."""

    def __init__(self, disk):
        super().__init__()
        self.disk = disk

    def send(self, command, by="", stops=None):
        if command.chain[0][1]["str_param"] == "Two":
            self.disk.room = 0
        return super().send(command, by, stops)


@pytest.fixture
def on_a_full_disk(tmp_path, monkeypatch):
    """Run a trial in whose midst the disk gets full; `told(runner)` is called when the command has told of that."""
    disk = ScriptedDisk(tmp_path, monkeypatch)
    studies = Studies(StudyFiles(tmp_path))
    robot = FillingRobot(disk)
    monkeypatch.setattr(study_commands, "_studies", lambda settings, files: (studies, robot))
    for owner, name, value in (
        *((module, "settings", lambda namespace: {}), (module, "PATIENCE", 0.0)),
        *((log_module, "DELAY", 0.01), (runner_module, "LOG_PATIENCE", 0.0)),
    ):
        monkeypatch.setattr(owner, name, value)
    file = tmp_path / "three.yaml"
    file.write_text("name: three\nphases: [{steps: [{say: One}, {say: Two}, {say: Three}]}]\n")

    def run(told, *words):
        show = study_commands._show

        def shown(settings, runner, number):
            number = show(settings, runner, number)
            if disk.room == 0 and runner.state.status == "paused":
                told(runner)
            return number

        monkeypatch.setattr(study_commands, "_show", shown)
        words = ["study", "run", str(file), "--participant", "P01", "--studies", str(tmp_path), *words]
        return CliRunner().invoke(nao, words)

    return SimpleNamespace(run=run, disk=disk, folder=tmp_path / "three/P01-1")


def test_a_run_tells_that_its_log_cannot_be_written_and_again_at_its_end(on_a_full_disk):
    told = on_a_full_disk.run(lambda _: setattr(on_a_full_disk.disk, "room", None))
    assert told.exit_code == 0, told.output
    assert "No space left on device" in told.output and "events wait in memory" in told.output
    assert told.output.count("waited in memory, and were written then") == 2
    assert "trouble with the log of trial three/P01-1:" in told.output
    assert [event["n"] for event in read_events(on_a_full_disk.folder)][-1] == len(read_events(on_a_full_disk.folder))


def test_a_run_says_when_it_begins_to_wait(tmp_path, monkeypatch):
    robot, echo, lines = PlayedRobot(), study_commands.click.echo, []

    def hear(text="", **options):
        lines.append(text)
        echo(text, **options)
        if text.endswith(": waiting"):
            robot.runs[-1].end("aborted", "no participant")

    monkeypatch.setattr(study_commands, "_studies", lambda settings, files: (Studies(files), robot))
    monkeypatch.setattr(study_commands.click, "echo", hear)
    file = tmp_path / "asks.yaml"
    file.write_text("name: asks\nphases: [{steps: [{wait: touch, sensors: [head], timeout: 5}]}]\n")
    CliRunner().invoke(nao, ["study", "run", str(file), "--participant", "P01", "--studies", str(tmp_path)])
    assert "  1.1 wait for a touch: head: waiting" in lines


class FallingRobot(PlayedRobot):
    """Falls when it is to say something."""

    def send(self, command, by="", stops=None):
        self.events.add("alarm", "The robot has fallen", what="began", code="fallen")
        return super().send(command, by, stops)


def test_a_run_tells_of_an_alarm_that_begins(tmp_path, monkeypatch):
    monkeypatch.setattr(study_commands, "_studies", lambda settings, files: (Studies(files), FallingRobot()))
    monkeypatch.setattr(module, "settings", lambda namespace: {})
    file = tmp_path / "one.yaml"
    file.write_text("name: one\nphases: [{steps: [{say: One}]}]\n")
    words = ["study", "run", str(file), "--participant", "P01", "--studies", str(tmp_path)]
    assert CliRunner().invoke(nao, words).output.count("  alarm: The robot has fallen\n") == 1


def test_the_answer_for_programs_has_the_troubles(on_a_full_disk):
    told = on_a_full_disk.run(lambda _: setattr(on_a_full_disk.disk, "room", None), "--json")
    (trouble,) = json.loads(told.stdout[told.stdout.index("{") :])["troubles"]
    assert trouble.startswith("three/P01-1: the log could not be written for")


def test_a_run_whose_log_is_given_up_fails_and_tells_how_much_is_lost(on_a_full_disk):
    told = on_a_full_disk.run(lambda runner: runner.abort())
    assert told.exit_code == 1
    assert "events of trial three/P01-1 are lost" in told.output


def test_an_interrupted_run_waits_for_its_log_until_it_is_interrupted_again(on_a_full_disk, monkeypatch):
    def interrupt(runner):
        waited = runner.wait

        def wait(timeout=None):
            if runner.state.status == "paused" and timeout:
                monkeypatch.setattr(runner, "wait", waited)
                raise KeyboardInterrupt
            return waited(timeout and 0.01)

        monkeypatch.setattr(runner, "wait", wait)
        raise KeyboardInterrupt

    told = on_a_full_disk.run(interrupt)
    assert told.exit_code == 130, told.output
    assert "the trial is aborted" in told.output and "are lost" in told.output


class StoppedRobot(PlayedRobot):
    """Another program stops it while it says Two."""

    def __init__(self):
        super().__init__(plays=())

    def send(self, command, by="", stops=None):
        run = super().send(command, by, stops)
        if command.chain[0][1]["str_param"] == "Two":
            threading.Thread(target=self.stop, args=("/nao_stop",)).start()
            run.end("preempted")
        else:
            run.end()
        return run


@pytest.fixture
def stopped_run(tmp_path, monkeypatch):
    """Run a trial that another program stops; what the command has told, the robot, and the events of the trial."""
    robot = StoppedRobot()
    monkeypatch.setattr(study_commands, "_studies", lambda settings, files: (Studies(files), robot))
    for name, value in (("settings", lambda _: {}), ("ros_after", lambda seconds, callback: lambda: None)):
        monkeypatch.setattr(module, name, value)
    file = tmp_path / "three.yaml"
    file.write_text("name: three\nphases: [{steps: [{say: One}, {say: Two, on_error: skip}, {say: Three}]}]\n")

    def run():
        words = ["study", "run", str(file), "--participant", "P01", "--studies", str(tmp_path)]
        return CliRunner().invoke(nao, words), robot, read_events(tmp_path / "three/P01-1")

    return run


def test_a_stop_of_another_program_ends_a_run_that_nobody_can_be_asked_about(stopped_run):
    told, robot, events = stopped_run()
    assert (told.exit_code, "the trial was stopped" in told.output) == (1, True)
    assert [run.command.chain[0][1]["str_param"] for run in robot.runs] == ["One", "Two"]
    assert [each["by"] for each in events if each["kind"] == "stopped"] == ["/nao_stop"]
    assert events[-1]["data"]["outcome"] == "aborted"


def test_a_run_that_was_stopped_continues_where_somebody_says_so(stopped_run, monkeypatch):
    answers = iter(["c", "a"])
    monkeypatch.setattr(study_commands.click, "prompt", lambda *_, **__: next(answers))
    monkeypatch.setattr(study_commands, "_can_ask", lambda: True)
    told, robot, _ = stopped_run()
    assert [run.command.chain[0][1]["str_param"] for run in robot.runs] == ["One", "Two", "Two"]
    assert told.exit_code == 1


def test_a_choice_that_comes_when_its_step_was_stopped_is_told_and_the_trial_stays(tmp_path, monkeypatch):
    robot = PlayedRobot()
    studies = Studies(StudyFiles(tmp_path))
    asked = []

    def answer(question, **_):
        asked.append(question)
        if len(asked) == 1:
            stopping = threading.Thread(target=robot.stop, args=("/nao_stop",))
            stopping.start()
            stopping.join(LIMIT)
            runner = studies.running("/")
            while runner.state.current is not None:
                runner.wait(0.01)
            return "good"
        return "a"

    monkeypatch.setattr(study_commands, "_studies", lambda settings, files: (studies, robot))
    monkeypatch.setattr(module, "settings", lambda _: {})
    monkeypatch.setattr(study_commands, "_can_ask", lambda: True)
    monkeypatch.setattr(study_commands.click, "prompt", answer)
    file = tmp_path / "asks.yaml"
    file.write_text("name: asks\nphases: [{steps: [{wizard: Well, choices: [good]}]}]\n")
    words = ["study", "run", str(file), "--participant", "P01", "--studies", str(tmp_path)]
    told = CliRunner().invoke(nao, words)
    assert "there is no choice 'good' at this moment" in told.output
    assert asked == ["Well", "the trial was stopped. c: continue, n: next, a: abort"]

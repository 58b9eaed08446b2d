"""What a shell is offered."""

import os
import shutil
import subprocess

import pytest

from nao_library_modules.command_line.app import COMMANDS, nao
from nao_library_modules.command_line.bash_completion import LineComplete, split_line


@pytest.fixture
def offered(monkeypatch):
    def offered(line):
        monkeypatch.setenv("NAO_LINE", line)
        complete = LineComplete(nao, {}, "nao", "_NAO_COMPLETE")
        words, last = complete.get_completion_args()
        return [complete.format_completion(item) for item in complete.get_completions(words, last)]

    return offered


@pytest.mark.parametrize(
    "line, words, last",
    [
        ("nao ", ["nao"], ""),
        ("nao call", ["nao"], "call"),
        ("nao call NaoLights on lights:=Br", ["nao", "call", "NaoLights", "on"], "lights:=Br"),
        ("nao say 'good mor", ["nao", "say"], "good mor"),
        ("", [], ""),
    ],
)
def test_a_line_is_split_as_a_shell_splits_it(line, words, last):
    assert split_line(line) == (words, last)


def test_commands_are_offered_without_a_stack(offered):
    assert offered("nao ") == list(COMMANDS)
    assert offered("nao st") == ["status", "stop"]
    assert "--robot" in offered("nao say --")


@pytest.mark.parametrize(
    "line, among",
    [
        ("nao list Nao", "NaoLights"),
        ("nao help setC", "setColor"),
        ("nao call NaoLights setI", "setIntensity"),
        ("nao call NaoLights setIntensity l", "lights:="),
        ("nao call NaoLights on lights:=Brain0 , set", "setColor"),
        ("nao call NaoLights on lights:=Brain0 revert:=t", "true"),
        ("nao call NaoMotion getMoveConfig str_param:=D", "Default"),
        ("nao leds FaceLeds gre", "green"),
        ("nao --robot ", "/"),
    ],
)
def test_names_come_from_the_servers(offered, graph, line, among):
    graph()
    assert among in offered(line)


def test_fields_that_are_there_are_not_offered_again(offered, graph):
    graph()
    fields = offered("nao call NaoLights setIntensity lights:=Brain0 ")
    assert "lights:=" not in fields and "i_values:=" in fields


@pytest.mark.parametrize("line", ["nao call NaoL", "nao pose St", "nao run ", "nao get Dev", "nao help s"])
def test_without_a_stack_nothing_is_offered_and_nothing_fails(offered, graph, line):
    assert offered(line) == []


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_shells_get_their_scripts(run, shell):
    text = run("completion", shell).stdout
    assert "_NAO_COMPLETE" in text and "nao" in text


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_bash_takes_the_script_and_puts_words_behind_a_colon(run, tmp_path):
    program = tmp_path / "nao"
    program.write_text('#!/bin/sh\n[ "$_NAO_COMPLETE" = bash_complete ] && echo "got-$NAO_LINE"\n')
    program.chmod(0o755)
    script = run("completion", "bash").stdout + (
        'COMP_LINE="nao call a:=b more" COMP_POINT=13\n_nao_completion nao\nprintf "%s\\n" "${COMPREPLY[@]}"\n'
    )
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-c", script], env=environment, capture_output=True, text=True, timeout=20)
    assert (done.stdout, done.returncode) == ("got-nao call a:=b\n", 0), done.stderr

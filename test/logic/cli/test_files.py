"""`nao files` for a real robot, whose ssh and scp are programs that work on a folder of this computer."""

from __future__ import annotations

import json
import os

import pytest

from nao_library_modules.cli.commands import files_commands
from nao_library_modules.cli.commands.files_commands import FilesOverSsh
from nao_library_modules.cli.direct_robot import DirectRobot
from nao_library_modules.cli.output import CommandFailed
from nao_library_modules.cli.stack import Stack
from naoqi.errors import RobotUnreachable
from naoqi.robot_connection import Connection

LOGIN = "nao@192.0.2.7"
# What they are called with is noted, one argument a line; on the robot /home/nao is that folder.
NOTE = 'for a; do echo "$a" >> {notes}; done\n[ -n "$FAILURE" ] && {{ echo "$FAILURE" >&2; exit "$STATUS"; }}\n'
SSH = """#!/bin/bash
set -o pipefail
{note}for command; do :; done
sh -c "$(echo "$command" | sed 's#/home/nao#{home}#g')" | sed 's#{home}#/home/nao#g'
"""
SCP = """#!/bin/sh
{note}while [ "$1" != -- ]; do shift; done
exec cp "$(echo "$2" | sed 's#^nao@.*:/home/nao#{home}#')" "$(echo "$3" | sed 's#^nao@.*:/home/nao#{home}#')"
"""


class RealRobot:
    """A robot without the modules of a simulator."""

    def __init__(self, address):
        pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def has(self, module):
        return False


@pytest.fixture
def home(tmp_path, monkeypatch, graph):
    """Home of a real robot's user; the user of the command is in a folder beside it."""
    programs, folder, here = (tmp_path / name for name in ("programs", "robot", "here"))
    for each in (programs, folder, here):
        each.mkdir()
    for name, text in (("ssh", SSH), ("scp", SCP)):
        note = NOTE.format(notes=tmp_path / f"{name}.txt")
        (programs / name).write_text(text.format(note=note, home=folder))
        (programs / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}:/usr/bin:/bin")
    monkeypatch.chdir(here)
    monkeypatch.setattr(files_commands, "DirectRobot", RealRobot)
    monkeypatch.setattr(Stack, "robot_address", lambda _: ("192.0.2.7", 9559))
    graph()
    return folder


@pytest.fixture
def called(tmp_path):
    """Arguments of the last calls of a program."""
    return lambda program: (tmp_path / f"{program}.txt").read_text().splitlines()


def test_a_folder_of_a_real_robot_is_listed(run, home, called):
    (home / "recordings").mkdir()
    (home / "my song.wav").write_bytes(b"four")
    (home / "link").symlink_to("my song.wav")
    assert run("files", "list").stdout == "link         11\nmy song.wav  4\nrecordings/\n"
    assert called("ssh")[-2] == LOGIN
    told = json.loads(run("files", "list", "~/recordings/", "--json").stdout)
    assert told == {"folder": "/home/nao/recordings", "files": []}
    (home / "recordings" / os.fsdecode(b"caf\xe9.wav")).touch()
    assert run("files", "list", "recordings").stdout == "caf\\xe9.wav  0\n"
    missing = run("files", "list", "it's; touch x")
    assert missing.exit_code == 1 and "it's; touch x" in missing.stderr and not list(home.glob("x"))


def test_files_come_from_a_real_robot_and_replace_none_unasked(run, home, called, tmp_path):
    (home / "a.wav").write_bytes(b"new")
    here = tmp_path / "here"
    assert run("files", "get", "a.wav").stdout == f"{here}/a.wav\n"
    assert called("scp")[-2] == f"{LOGIN}:/home/nao/a.wav" and (here / "a.wav").read_bytes() == b"new"
    (here / "a.wav").write_bytes(b"kept")
    for remote, local in (("~/a.wav", ()), ("/home/nao/a.wav", ["a.wav"]), ("a.wav", ["."])):
        refused = run("files", "get", remote, *local)
        assert refused.exit_code == 1 and "is there already: another name, or --overwrite" in refused.stderr
    assert (here / "a.wav").read_bytes() == b"kept"
    assert json.loads(run("files", "get", "a.wav", "--overwrite", "--json").stdout) == {"path": f"{here}/a.wav"}
    assert run("files", "get", "a.wav", "b.wav").stdout == f"{here}/b.wav\n"
    assert run("files", "get", "missing.wav", "c.wav").exit_code == 1
    assert {path.name for path in here.iterdir()} == {"a.wav", "b.wav"}


def test_files_go_to_a_real_robot_and_replace_none_unasked(run, home, called, tmp_path):
    (tmp_path / "here" / "a.wav").write_bytes(b"new")
    (home / "sounds").mkdir()
    for remote, there in (
        ((), "a.wav"),
        (["sounds"], "sounds/a.wav"),
        (["~/new/b.wav"], "new/b.wav"),
        (["day/"], "day/a.wav"),
    ):
        assert run("files", "put", "a.wav", *remote).stdout == f"/home/nao/{there}\n"
        assert called("scp")[-1] == f"{LOGIN}:/home/nao/{there}" and (home / there).read_bytes() == b"new"
        (home / there).write_bytes(b"kept")
        refused = run("files", "put", "a.wav", *remote)
        assert (refused.exit_code, (home / there).read_bytes()) == (1, b"kept")
        assert refused.stderr == f"Error: /home/nao/{there} is on the robot already: another name, or --overwrite\n"
    assert run("files", "put", "a.wav", "--overwrite").exit_code == 0 and (home / "a.wav").read_bytes() == b"new"
    (home / "sounds" / "c" / "a.wav").mkdir(parents=True)
    assert "/home/nao/sounds/c/a.wav is a folder on the robot" in run("files", "put", "a.wav", "sounds/c").stderr
    assert run("files", "put", "missing.wav").exit_code == 2


def test_no_shell_sees_a_name(run, home, tmp_path):
    (tmp_path / "here" / "a b.wav").write_bytes(b"new")
    for line in (("get", "~/$(touch x)"), ("put", "a b.wav"), ("get", "a;b"), ("put", "a b.wav", "x'y"), ("get", "a*")):
        refused = run("files", *line)
        assert refused.exit_code == 1 and "is no path for scp: give one of letters, digits and" in refused.stderr
    assert not (tmp_path / "scp.txt").exists() and list(home.iterdir()) == []


def test_without_ssh_or_a_robot_that_answers_it_is_told_what_to_do(run, home, tmp_path, monkeypatch):
    monkeypatch.setenv("FAILURE", "port 22: Connection refused")
    monkeypatch.setenv("STATUS", "255")
    for line in (("list",), ("get", "a.wav")):
        silent = run("files", *line)
        assert (silent.exit_code, silent.stderr) == (
            3,
            f"Error: {LOGIN}: port 22: Connection refused\n",
        )
    monkeypatch.setenv("STATUS", "1")
    assert run("files", "list").exit_code == 1
    monkeypatch.setenv("PATH", str(tmp_path / "here"))
    for line, program in ((("list",), "ssh"), (("get", "a.wav"), "scp")):
        missing = run("files", *line)
        assert missing.exit_code == 1 and f"there is no {program} on this computer" in missing.stderr
        assert "install it (openssh-client)" in missing.stderr


def test_a_program_that_takes_too_long_is_ended(home, monkeypatch):
    monkeypatch.setenv("PATH", f"{home.parent}/slow:/usr/bin:/bin")
    (home.parent / "slow").mkdir()
    (home.parent / "slow" / "ssh").write_text("#!/bin/sh\nexec sleep 60\n")
    (home.parent / "slow" / "ssh").chmod(0o755)
    with pytest.raises(CommandFailed, match="ssh to nao@::1 has not ended within 0.1 s"):
        FilesOverSsh("::1", limit=0.1).listed("~")


def test_services_of_a_robot_whose_connection_was_just_lost_fail_with_its_reason():
    class LostConnection:
        live, module_names = None, Connection.module_names

        def unreachable(self):
            return RobotUnreachable("192.0.2.7", 9559, "the session is closed")

    robot = DirectRobot(("192.0.2.7", 9559))
    robot._connection = LostConnection()
    with pytest.raises(CommandFailed, match="the session is closed"):
        robot.services()

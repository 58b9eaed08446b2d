"""The command that starts a module's launch file."""

from __future__ import annotations

import pytest

from nao_library_modules.launcher import (
    BadLaunchPath,
    declared_arguments,
    find_launch_file,
    launch_command,
    launch_supervisor,
)
from nao_library_modules.supervisor import State

PATH = ("nao_library", "nao.launch")


@pytest.fixture
def launch_file(tmp_path):
    def write(text):
        path = tmp_path / "x.launch"
        path.write_text(text)
        return path

    return write


def test_declared_arguments_are_those_that_can_be_set(launch_file):
    path = launch_file(
        '<launch><arg name="nao_ip" default="x"/><arg name="nao_port"/><arg name="fixed" value="1"/>'
        '<include file="y"><arg name="inner" value="2"/></include></launch>'
    )
    assert declared_arguments(path) == {"nao_ip", "nao_port"}


def test_a_file_that_is_no_xml_is_refused(launch_file):
    with pytest.raises(BadLaunchPath, match="x.launch"):
        declared_arguments(launch_file("<launch>"))


@pytest.mark.parametrize(
    "declared, arguments",
    [
        (set(), []),
        ({"nao_ip"}, ["nao_ip:=10.0.0.7"]),
        ({"nao_ip", "nao_port", "gui"}, ["nao_ip:=10.0.0.7", "nao_port:=9560"]),
    ],
)
def test_the_robot_is_passed_on_to_a_file_that_asks_for_it(declared, arguments):
    command = launch_command(PATH, declared, "10.0.0.7", 9560)
    assert command == ["roslaunch", "nao_library", "nao.launch", *arguments]


def test_the_launch_file_of_this_stack_is_found_and_takes_a_robot():
    path = find_launch_file(PATH)
    assert {"nao_ip", "nao_port"} <= declared_arguments(path)


@pytest.mark.parametrize(
    "launchpath",
    [("nao_library", "nonexistent.launch"), ("nonexistent_package", "nao.launch"), ("one",), None],
)
def test_a_launch_path_that_leads_nowhere_is_refused_with_its_text(launchpath):
    with pytest.raises(BadLaunchPath, match=r"it is \(package, launchfile\)"):
        launch_supervisor(launchpath, "10.0.0.7", 9559, "/")


def test_making_a_supervisor_starts_nothing():
    assert launch_supervisor(PATH, "10.0.0.7", 9559, "/robot1/").status.state is State.STOPPED

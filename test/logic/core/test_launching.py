"""Arguments of nodes, launch files and the commands that start them."""

from __future__ import annotations

import itertools
import os
from unittest.mock import Mock

import pytest

from nao_library_modules.core.processes import (
    BadLaunchPath,
    SupervisorState,
    declared_arguments,
    find_launch_file,
    launch_arguments,
    launch_supervisor,
)
from nao_library_modules.ros import node
from nao_library_modules.ros.launch_program import _reporting, _Reports
from nao_library_modules.ros.node import launch_path, robot_address, robot_parser
from naoqi.errors import NaoError

PATH = ("nao_library", "nao.launch")


# Nodes


def test_the_address_of_the_robot_comes_from_the_command_line_then_parameters_then_the_environment(monkeypatch):
    for variable in ("NAO_IP", "NAO_PORT"):
        monkeypatch.delenv(variable, raising=False)
    parameters = {"~pip": "10.0.0.7", "~pport": 9560}
    for arguments, given, address in (
        ([], {}, ("127.0.0.1", 9559)),
        ([], parameters, ("10.0.0.7", 9560)),
        (["--pip", "nao.local", "--pport", "9561"], parameters, ("nao.local", 9561)),
    ):
        assert robot_address(robot_parser("A node.").parse_args(arguments), given.get) == address
    monkeypatch.setenv("NAO_IP", "10.0.0.8")
    monkeypatch.setenv("NAO_PORT", "9562")
    for given, address in (({}, ("10.0.0.8", 9562)), (parameters, ("10.0.0.7", 9560))):
        assert robot_address(robot_parser("A node.").parse_args([]), given.get) == address
    monkeypatch.setenv("NAO_PORT", "nine")
    with pytest.raises(NaoError, match="'nine' is no port"):
        robot_address(robot_parser("A node.").parse_args([]), {}.get)
    for port in (-1, 65536, "9559", True, 9559.0):
        with pytest.raises(NaoError, match=r"is no port: 1\.\.65535"):
            robot_address(robot_parser("A node.").parse_args([]), {"~pport": port}.get)


def test_port_0_is_that_of_the_nearest_simulator_as_soon_as_it_has_told_it(monkeypatch):
    told = {"/nao1/nao_sim/bound_port": 0}
    answers = iter([OSError, "/nao1/nao_sim/bound_port", None, "/nao1/nao_sim/bound_port"])

    def search(name):
        assert name == "nao_sim/bound_port"
        found = next(answers)
        if found is OSError:
            raise OSError("the master is away")
        return found

    def pause(_):
        told["/nao1/nao_sim/bound_port"] = 40773 if next_pause() == 3 else 0

    next_pause = itertools.count(1).__next__
    monkeypatch.setattr(node.rospy, "search_param", search)
    monkeypatch.setattr(node.rospy, "get_param", lambda name, default: told.get(name, default))
    monkeypatch.setattr(node.rospy, "is_shutdown", lambda: False)
    assert node.simulator_port(pause) == 40773
    monkeypatch.setattr(node, "simulator_port", lambda: 40774)
    options = robot_parser("A node.").parse_args(["--pport", "0"])
    assert robot_address(options, {}.get)[1] == 40774


def test_a_launch_path_is_a_text_or_a_list():
    for value, path in (("", None), ([], None), (" ".join(PATH), PATH), (["a", "b"], ("a", "b"))):
        assert launch_path(value) == path
    for value in ("one", "a b c", ["a"], ["a", 1], 7):
        with pytest.raises(NaoError, match="package launchfile"):
            launch_path(value)


# Launch files


def test_the_robot_is_passed_on_to_a_file_that_asks_for_it(tmp_path):
    path = tmp_path / "x.launch"
    path.write_text(
        '<launch><arg name="nao_ip" default="x"/><arg name="nao_port"/><arg name="fixed" value="1"/>'
        '<include file="y"><arg name="inner" value="2"/></include></launch>'
    )
    assert declared_arguments(path) == {"nao_ip", "nao_port"}
    path.write_text("<launch>")
    with pytest.raises(BadLaunchPath, match="x.launch"):
        declared_arguments(path)
    for declared, arguments in (
        (set(), []), ({"nao_ip"}, ["nao_ip:=10.0.0.7"]),
        ({"nao_ip", "nao_port", "gui"}, ["nao_ip:=10.0.0.7", "nao_port:=9560"]),
    ):  # fmt: skip
        assert launch_arguments(declared, "10.0.0.7", 9560) == arguments
    assert {"nao_ip", "nao_port"} <= declared_arguments(find_launch_file(PATH))


def test_a_launch_path_that_leads_nowhere_is_refused_and_making_a_supervisor_starts_nothing():
    for path in (("nao_library", "nonexistent.launch"), ("nonexistent_package", "nao.launch"), ("one",), None):
        with pytest.raises(BadLaunchPath, match=r"it is \(package, launchfile\)"):
            launch_supervisor(path, "10.0.0.7", 9559, "/")
    assert launch_supervisor(PATH, "10.0.0.7", 9559, "/robot1/").status.state is SupervisorState.STOPPED


@pytest.mark.parametrize("ended", [True, False])
def test_what_fails_because_the_node_is_ended_while_it_is_made_is_one_line(monkeypatch, ended):
    monkeypatch.setattr(node.rospy.core, "is_shutdown_requested", lambda: ended)
    interrupted = node.rospy.ROSInitException("init_node interrupted")
    with pytest.raises(SystemExit if ended else node.rospy.ROSInitException, match="interrupted"):
        with node.being_made("NaoLights"):
            raise interrupted


def test_nodes_are_ended_also_where_the_program_that_started_them_is_gone():
    read, write = os.pipe()
    os.close(read)
    monitor = Mock()
    end = monitor.shutdown
    try:
        _reporting(monitor, _Reports(write)).shutdown()
    finally:
        os.close(write)
    end.assert_called_once_with()

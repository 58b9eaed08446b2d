"""Arguments of nodes, launch files and the commands that start them."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
import rospy

from nao_library_modules import node
from nao_library_modules.launcher import (
    BadLaunchPath,
    declared_arguments,
    find_launch_file,
    launch_command,
    launch_supervisor,
)  # fmt: skip
from nao_library_modules.node import launch_path, robot_address, robot_parser, run_module
from nao_library_modules.supervisor import State
from naoqi.errors import NaoError

ROOT = Path(__file__).parents[3]
FILES = sorted((ROOT / "launch" / "launch").glob("*.launch"))
PATH = ("nao_library", "nao.launch")


def parsed(name):
    return ElementTree.parse(ROOT / "launch" / "launch" / name).getroot()


# Nodes


def test_the_address_of_the_robot_comes_from_the_command_line_then_from_parameters():
    parameters = {"~pip": "10.0.0.7", "~pport": 9560}
    for arguments, given, address in (
        ([], {}, ("127.0.0.1", 9559)),
        ([], parameters, ("10.0.0.7", 9560)),
        (["--pip", "nao.local", "--pport", "9561"], parameters, ("nao.local", 9561)),
    ):
        assert robot_address(robot_parser("A node.").parse_args(arguments), given.get) == address
    for port in (0, -1, 65536, "9559", True, 9559.0):
        with pytest.raises(NaoError, match=r"is no port: 1\.\.65535"):
            robot_address(robot_parser("A node.").parse_args([]), {"~pport": port}.get)


def test_a_launch_path_is_a_text_or_a_list():
    for value, path in (("", None), ([], None), (" ".join(PATH), PATH), (["a", "b"], ("a", "b"))):
        assert launch_path(value) == path
    for value in ("one", "a b c", ["a"], ["a", 1], 7):
        with pytest.raises(NaoError, match="package launchfile"):
            launch_path(value)


@pytest.mark.parametrize(
    ("parameters", "status", "options"),
    [({}, 0, {}), ({"~patience": 60}, 0, {"patience": 60.0}), ({"~patience": "long"}, 1, None)],
)
def test_a_module_gets_its_patience_only_where_it_is_set(monkeypatch, parameters, status, options):
    made = []
    for name in ("init_node", "spin", "logfatal"):
        monkeypatch.setattr(rospy, name, lambda *_: None)
    monkeypatch.setattr(rospy, "get_param", parameters.get)
    monkeypatch.setattr(rospy, "has_param", parameters.__contains__)
    monkeypatch.setattr(node, "forward_logs", lambda *_: None)

    def module(ip, port, autostart, launchpath, **more):
        made.append(more)

    assert run_module(module, "module", "A module.", ["module"]) == status
    assert made == ([] if options is None else [options])


# Launch files


def test_parts_of_the_driver_can_be_left_out_and_the_action_servers_share_few_heaps():
    assert {"nao.launch", "nao_sim.launch", "two_robots.launch"} <= {path.name for path in FILES}
    for name, included in (("nao.launch", "nao_driver.launch"), ("nao_sim.launch", "nao.launch")):
        (include,) = [each for each in parsed(name).iter("include") if each.get("file").endswith(f"/{included}")]
        passed = {each.get("name"): each.get("value") for each in include.findall("arg")}
        assert all(passed[part] == f"$(arg {part})" for part in ("cameras", "senses", "apps"))
    root = list(parsed("nao.launch"))
    (env,) = [each for each in root if each.tag == "env" and each.get("name") == "MALLOC_ARENA_MAX"]
    servers = [each for each in root if each.tag == "node"]
    assert env.get("value") == "2" and root.index(env) < root.index(servers[0])


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
        assert launch_command(PATH, declared, "10.0.0.7", 9560) == ["roslaunch", *PATH, *arguments]
    assert {"nao_ip", "nao_port"} <= declared_arguments(find_launch_file(PATH))


def test_a_launch_path_that_leads_nowhere_is_refused_and_making_a_supervisor_starts_nothing():
    for path in (("nao_library", "nonexistent.launch"), ("nonexistent_package", "nao.launch"), ("one",), None):
        with pytest.raises(BadLaunchPath, match=r"it is \(package, launchfile\)"):
            launch_supervisor(path, "10.0.0.7", 9559, "/")
    assert launch_supervisor(PATH, "10.0.0.7", 9559, "/robot1/").status.state is State.STOPPED

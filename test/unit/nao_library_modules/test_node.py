"""Arguments and parameters that all nodes have."""

from __future__ import annotations

import pytest
import rospy

from nao_library_modules import node
from nao_library_modules.node import launch_path, robot_address, robot_parser, run_module
from naoqi.errors import NaoError


def address(arguments, parameters):
    return robot_address(robot_parser("A node.").parse_args(arguments), parameters.get)


def test_the_defaults_are_this_computer():
    assert address([], {}) == ("127.0.0.1", 9559)


def test_parameters_stand_in_for_options_that_are_not_given():
    assert address([], {"~pip": "10.0.0.7", "~pport": 9560}) == ("10.0.0.7", 9560)


def test_the_command_line_wins():
    parameters = {"~pip": "10.0.0.7", "~pport": 9560}
    assert address(["--pip", "nao.local", "--pport", "9561"], parameters) == ("nao.local", 9561)


@pytest.mark.parametrize("port", [0, -1, 65536, "9559", True, 9559.0])
def test_a_port_that_is_none_is_refused(port):
    with pytest.raises(NaoError, match=r"is no port: 1\.\.65535"):
        address([], {"~pport": port})


@pytest.mark.parametrize(
    "value, path",
    [
        ("", None),
        ([], None),
        ("nao_library nao.launch", ("nao_library", "nao.launch")),
        (["a", "b"], ("a", "b")),
    ],
)
def test_a_launch_path_is_a_text_or_a_list(value, path):
    assert launch_path(value) == path


@pytest.mark.parametrize("value", ["one", "a b c", ["a"], ["a", 1], 7])
def test_other_launch_paths_are_refused(value):
    with pytest.raises(NaoError, match="package launchfile"):
        launch_path(value)


def test_help_names_options_and_parameters(capsys):
    with pytest.raises(SystemExit) as caught:
        robot_parser("Lights of a NAO.").parse_args(["--help"])
    text = capsys.readouterr().out
    assert caught.value.code == 0
    for word in ("Lights of a NAO.", "--pip", "--pport", "~pip"):
        assert word in text


@pytest.mark.parametrize(
    ("parameters", "status", "options"),
    [
        ({}, 0, {}),
        ({"~patience": 60}, 0, {"patience": 60.0}),
        ({"~patience": "long"}, 1, None),
    ],
)
def test_a_module_gets_its_patience_only_where_it_is_set(monkeypatch, parameters, status, options):
    made = []
    monkeypatch.setattr(rospy, "init_node", lambda name: None)
    monkeypatch.setattr(rospy, "spin", lambda: None)
    monkeypatch.setattr(rospy, "logfatal", lambda *_: None)
    monkeypatch.setattr(rospy, "get_param", parameters.get)
    monkeypatch.setattr(rospy, "has_param", parameters.__contains__)
    monkeypatch.setattr(node, "forward_logs", lambda *_: None)

    def module(ip, port, autostart, launchpath, **more):
        made.append(more)

    assert run_module(module, "module", "A module.", ["module"]) == status
    assert made == ([] if options is None else [options])

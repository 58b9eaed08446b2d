"""Launch files: arguments are documented, names are relative, what they start is there."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
FILES = sorted((ROOT / "launch" / "launch").glob("*.launch"))
# ROS knows one time for all robots of a master.
GLOBAL_NAMES = {"/use_sim_time"}


def test_there_are_launch_files():
    assert {"nao.launch", "nao_sim.launch", "two_robots.launch"} <= {path.name for path in FILES}


@pytest.fixture(params=FILES, ids=lambda path: path.name)
def launch(request):
    return ElementTree.parse(request.param).getroot()


def test_every_argument_has_a_default_and_says_what_it_is(launch):
    for argument in launch.findall("arg"):
        assert argument.get("default") is not None, argument.attrib
        assert argument.get("doc"), argument.attrib


def test_names_are_relative_so_that_a_namespace_holds_them(launch):
    names = [element.get("name", "") for element in launch.iter() if element.tag in ("node", "param", "remap")]
    names += [element.get(end, "") for element in launch.iter("remap") for end in ("from", "to")]
    assert {name for name in names if name.startswith("/")} <= GLOBAL_NAMES
    assert all(not element.get("ns", "").startswith("/") for element in launch.iter())


def test_every_node_has_a_program(launch):
    for node in launch.iter("node"):
        if (ROOT / node.get("pkg")).is_dir():
            assert (ROOT / node.get("pkg") / "nodes" / node.get("type")).is_file(), node.attrib

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


@pytest.mark.parametrize(("name", "included"), [("nao.launch", "nao_driver.launch"), ("nao_sim.launch", "nao.launch")])
def test_parts_of_the_driver_can_be_left_out_from_the_outside(name, included):
    root = ElementTree.parse(ROOT / "launch" / "launch" / name).getroot()
    (include,) = [each for each in root.iter("include") if each.get("file").endswith(f"/{included}")]
    passed = {each.get("name"): each.get("value") for each in include.findall("arg")}
    for part in ("cameras", "senses", "apps"):
        assert passed[part] == f"$(arg {part})"


def test_the_action_servers_share_few_heaps():
    """What comes before it in the file, as the driver, does not have it."""
    root = list(ElementTree.parse(ROOT / "launch" / "launch" / "nao.launch").getroot())
    (env,) = [each for each in root if each.tag == "env" and each.get("name") == "MALLOC_ARENA_MAX"]
    servers = [each for each in root if each.tag == "node"]
    assert env.get("value") == "2"
    assert servers and root.index(env) < root.index(servers[0])


def test_every_node_has_a_program(launch):
    for node in launch.iter("node"):
        if (ROOT / node.get("pkg")).is_dir():
            assert (ROOT / node.get("pkg") / "nodes" / node.get("type")).is_file(), node.attrib

"""Lines that start a launch file, checked without starting it: it takes long, and what runs already stands for it."""

from __future__ import annotations

import re
import shlex

import roslaunch.arg_dump
import roslaunch.config
import roslaunch.rlutil
import roslaunch.xmlloader
from rosgraph.names import load_mappings
from roslib.packages import find_node

LINE = re.compile(r"^(?:scripts/ros-env )?roslaunch (?P<arguments>\S+ \S+\.launch\b[^#\n]*)(?:#[^\n]*)?$", re.MULTILINE)


def launch_lines(commands: str) -> list[str]:
    """What follows `roslaunch` in such lines."""
    return [line["arguments"].strip() for line in LINE.finditer(commands)]


def without_launch_lines(commands: str) -> str:
    """The other lines."""
    return LINE.sub("", commands).strip()


def missing(arguments: str) -> list[str]:
    """What a launch file that is started so does not have: such an argument, a program of a node.

    Args:
        arguments: Package, file and `NAME:=VALUE`s.

    Raises:
        roslaunch.core.RLException: There is no such file, or it or one that it includes cannot be read.
    """
    words = shlex.split(arguments)
    files = roslaunch.rlutil.resolve_launch_arguments([word for word in words if ":=" not in word])
    known = roslaunch.arg_dump.get_args(files)
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(files[0], config, argv=words, verbose=False)
    programs = {(program.package, program.type) for program in [*config.nodes, *config.tests]}
    unknown = [f"{files[0]} has no argument {name!r}" for name in load_mappings(words) if name not in known]
    return unknown + [f"no program {name} in {package}" for package, name in programs if not find_node(package, name)]

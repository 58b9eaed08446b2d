"""The launch file that a module brings along, as a supervised roslaunch process."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Collection
from pathlib import Path
from typing import Tuple

from naoqi.errors import NaoError

from ..base.suggestion import did_you_mean
from .supervisor import Supervisor

LaunchPath = Tuple[str, str]


class BadLaunchPath(NaoError):
    """A launch path `(package, launchfile)` names no launch file that can be read."""

    def __init__(self, launchpath: object, problem: str) -> None:
        super().__init__(f"launchpath {launchpath!r}: {problem}: it is (package, launchfile)")
        self.launchpath = launchpath


def find_launch_file(launchpath: LaunchPath) -> Path:
    """Path of a launch file, found as roslaunch finds it. Raises BadLaunchPath if it is not there."""
    from roslaunch.core import RLException
    from roslaunch.rlutil import resolve_launch_arguments

    try:
        package, launchfile = launchpath
        return Path(resolve_launch_arguments([package, launchfile])[0])
    except (TypeError, ValueError):
        raise BadLaunchPath(launchpath, "not a pair of names") from None
    except RLException as error:
        raise BadLaunchPath(launchpath, _missing(package, launchfile) or str(error)) from error


def _missing(package: str, launchfile: str) -> str:
    """The problem with the name that is not found, with names that come close; empty if both are."""
    import roslib.packages
    import rospkg

    packages = rospkg.RosPack()
    try:
        folder = packages.get_path(package)
    except rospkg.ResourceNotFound:
        return f"there is no package {package!r}{did_you_mean(package, packages.list())}"
    if roslib.packages.find_resource(package, launchfile):
        return ""
    files = [path.name for path in Path(folder).rglob("*.launch")]
    return f"the package {package} has no {launchfile!r}{did_you_mean(launchfile, files)}"


def declared_arguments(launch_file: Path) -> set[str]:
    """Names of the arguments that a launch file takes: those it declares without a fixed value.

    Raises BadLaunchPath if the file is no XML.
    """
    try:
        root = ElementTree.parse(launch_file).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise BadLaunchPath(str(launch_file), str(error)) from error
    return {arg.get("name", "") for arg in root.findall("arg") if arg.get("value") is None}


def launched_nodes(launchpath: LaunchPath, ip: str, port: int, namespace: str) -> frozenset[str]:
    """Full names of the nodes that a launch file starts for a robot in a namespace.

    Raises BadLaunchPath if it cannot be read.
    """
    from rosgraph.names import get_ros_namespace, ns_join
    from roslaunch.config import load_config_default
    from roslaunch.core import RLException

    path = find_launch_file(launchpath)
    arguments = launch_arguments(declared_arguments(path), ip, port)
    try:
        config = load_config_default([(str(path), arguments)], None, verbose=False)
    except RLException as error:
        raise BadLaunchPath(launchpath, str(error)) from error
    ours = get_ros_namespace(argv=[])  # what the loader took relative names to be in
    names = (ns_join(node.namespace, node.name) for node in config.nodes)
    return frozenset(ns_join(namespace, name[len(ours) :]) if name.startswith(ours) else name for name in names)


def launch_arguments(declared: Collection[str], ip: str, port: int) -> list[str]:
    """Those of `nao_ip` and `nao_port` that a launch file declares, set for a robot."""
    robot = {"nao_ip": ip, "nao_port": str(port)}
    return [f"{name}:={value}" for name, value in robot.items() if name in declared]


def launch_supervisor(launchpath: LaunchPath, ip: str, port: int, namespace: str) -> Supervisor:
    """A supervisor for a launch file, not started; its nodes start in the namespace.

    Raises BadLaunchPath if there is no such file.
    """
    declared = declared_arguments(find_launch_file(launchpath))
    return Supervisor(
        ["roslaunch", *launchpath, *launch_arguments(declared, ip, port)],
        name=" ".join(("roslaunch", *launchpath)),
        environment={"ROS_NAMESPACE": namespace},
    )

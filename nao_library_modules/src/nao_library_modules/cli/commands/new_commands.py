"""`nao new`: skeletons for work of one's own."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import click

from ...base.paths import config_file
from ...base.whole_file import write_whole
from ..errors import CommandFailed
from ..settings import NaoCommand, NaoGroup

PLACEHOLDER, STEM, END = "@NAME@", "study", ".in"
"""What stands for the package's name in the templates' text, what in their names, and how these end."""
NAME = re.compile(r"[a-z][a-z0-9_]+")
PROGRAM = 0o755
ANSWERS = """\
To a simulated robot you answer from a second terminal, with a touch or, after the question, with a word:
  nao sim touch Head/Touch/Front --for 0.3
  rosservice call /nao_sim/person_says "{text: 'yes', position: {x: 1.0, z: 0.5}}\""""


@click.group(cls=NaoGroup, name="new")
def new_command() -> None:
    """Write a skeleton for something of your own."""


@new_command.command(cls=NaoCommand, name="study")
@click.argument("name")
@click.option("--folder", default=".", type=click.Path(path_type=Path), help="Where the package goes; here without.")
def study(name: str, folder: Path) -> None:
    """A ROS package NAME with a study: trials, a file for them, a launch file, and a test in the simulator."""
    if not NAME.fullmatch(name):
        raise click.UsageError(f"{name!r} is no name for a package: lower-case letters, digits and _, a letter first")
    package = folder.expanduser().absolute() / name
    if package.exists():
        raise CommandFailed(f"{package} is there already: another name, or another --folder")
    elsewhere = _place_of_package(name)
    if elsewhere:
        raise CommandFailed(f"there is a ROS package {name} already, in {elsewhere}: another name is wanted")
    if importlib.util.find_spec(name) is not None:
        raise CommandFailed(
            f"there is a Python module {name} already, which {name}.py would hide: another name is wanted"
        )
    templates = config_file("templates") / STEM
    for template in sorted(templates.rglob(f"*{END}")):
        inside = template.relative_to(templates)
        file = package / inside.parent / inside.name[: -len(END)].replace(STEM, name)
        write_whole(file, template.read_text(encoding="utf-8").replace(PLACEHOLDER, name))
        if file.suffix == ".py":
            file.chmod(PROGRAM)
    click.echo(f"{package}\n")
    click.echo(f"  export ROS_PACKAGE_PATH={package.parent}:$ROS_PACKAGE_PATH")
    click.echo(f"  roslaunch {name} {name}.launch    # the study, with a simulated robot")
    click.echo(f"  rostest {name} {name}.test        # its test\n")
    click.echo(ANSWERS)


def _place_of_package(name: str) -> str:
    """Folder of a ROS package; empty if there is none."""
    import rospkg

    try:
        return rospkg.RosPack().get_path(name)
    except rospkg.ResourceNotFound:
        return ""

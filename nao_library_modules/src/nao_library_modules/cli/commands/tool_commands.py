"""`nao new`, `bag` and `completion`: what needs no robot."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import click
from click.shell_completion import get_completion_class

from naoqi.errors import NaoError

from ...core.files import config_file, write_whole
from ...ros.type_names import OURS, THEIRS
from ..cli_settings import NaoCommand, NaoGroup, OneOf, settings_of
from ..completion import register
from ..output import CommandFailed, overwrite_option, say_json, say_lines

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


# --- nao bag ----------------------------------------------------------------------------------------------------------

SAID = {
    "renamed": "renamed",
    "refilled": "renamed, with the fields that both types have",
    "kept": "kept: named as wanted, or no type that has another name here",
    "foreign": "kept: another definition than the type of that name",
}
"""What became of messages -> how it is told."""


@click.group(cls=NaoGroup, name="bag")
def bag_command() -> None:
    """Rosbags of nao_robot's topics, with the types of this library or of the older packages."""


@bag_command.command(cls=NaoCommand, name="convert")
@click.argument("old", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.argument("new", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--to",
    "names",
    type=OneOf((OURS, THEIRS)),
    default=OURS,
    show_default=True,
    help="Names that types have in NEW: those of this library, or of naoqi_bridge_msgs and humanoid_nav_msgs.",
)
@overwrite_option
@click.pass_context
def convert(context: click.Context, old: Path, new: Path, names: str, overwrite: bool) -> None:
    """Write the bag OLD as NEW, with other names of its types; what was recorded stays as it is.

    OLD was recorded from nao_robot, also of the time of nao_msgs, or from a driver of this library. No robot is needed,
    nor the older packages.
    """
    from ...ros.bag_types import convert_bag

    try:
        done = convert_bag(old, new, names, overwrite)
    except NaoError as error:
        raise CommandFailed(str(error)) from None
    counts: dict[str, dict[str, int]] = {kind: dict(getattr(done, kind)) for kind in SAID}
    if settings_of(context).json:
        say_json({"file": str(new), "types": names, **counts})
    else:
        say_lines(_lines(counts))


def _lines(counts: Mapping[str, Mapping[str, int]]) -> Iterator[str]:
    for kind, text in SAID.items():
        for name, count in sorted(counts[kind].items()):
            yield f"{count} of {name}: {text}"
    if not counts["renamed"] and not counts["refilled"]:
        yield "nothing had to be renamed"


# --- nao completion ---------------------------------------------------------------------------------------------------

SHELLS = ("bash", "zsh", "fish")


@click.command(cls=NaoCommand, name="completion")
@click.argument("shell", type=OneOf(SHELLS))
@click.pass_context
def completion_command(context: click.Context, shell: str) -> None:
    """Print the completion for SHELL.

    bash, in ~/.bashrc: eval "$(nao completion bash)". zsh, in ~/.zshrc: eval "$(nao completion zsh)". fish, in
    ~/.config/fish/completions/nao.fish: nao completion fish | source
    """
    register()
    click.echo(get_completion_class(shell)(context.find_root().command, {}, "nao", "_NAO_COMPLETE").source())

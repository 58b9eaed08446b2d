"""`nao bag`: recordings of topics, for programs that know their types by other names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import click

from naoqi.errors import NaoError

from ...nao.type_names import OURS, THEIRS
from ..errors import CommandFailed
from ..files import overwrite_option
from ..output import say_json, say_lines
from ..settings import NaoCommand, NaoGroup, OneOf, settings_of

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

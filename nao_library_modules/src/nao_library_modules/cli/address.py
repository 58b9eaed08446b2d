"""Where the robot is, for commands that reach it past the servers: told by them, or by `--qi-url` without ROS."""

from __future__ import annotations

import re

import click

from .settings import CliSettings

URL = re.compile(r"(?:tcp://)?(?P<ip>[^:/]+)(?::(?P<port>\d+))?")
PORT = 9559

url_option = click.option(
    "--qi-url", "url", metavar="URL", help="tcp://IP:PORT of the robot, without ROS; else that of the servers."
)


def address_of(settings: CliSettings, url: str | None) -> tuple[str, int]:
    """IP and port of the robot; a UsageError when the URL is none."""
    if url is None:
        return settings.stack.robot_address()
    found = URL.fullmatch(url)
    if found is None:
        raise click.UsageError(f"--qi-url is {url!r}, allowed is tcp://IP:PORT")
    return found["ip"], int(found["port"] or PORT)

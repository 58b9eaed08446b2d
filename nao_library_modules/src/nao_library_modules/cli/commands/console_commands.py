"""`nao console`: pages in a browser."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from naoqi.errors import NaoError

from ..errors import CommandFailed
from ..settings import NaoCommand

FILE = click.Path(dir_okay=False, path_type=Path)


@click.command(cls=NaoCommand, name="console")
@click.option(
    "--port",
    type=click.IntRange(0, 65535),
    default=8080,
    show_default=True,
    help="Of the pages; 0: a free one.",
)
@click.option("--listen", default="127.0.0.1", show_default=True, metavar="ADDRESS", help="Of this computer.")
@click.option("--users", type=FILE, metavar="FILE", help="Who may log in; needed where others can reach it.")
@click.option("--add-user", metavar="NAME", help="Ask for a password, write NAME into the file of --users, and end.")
@click.option("--observer", is_flag=True, help="With --add-user: who only looks on.")
@click.option("--cert", "certificate", type=FILE, metavar="FILE", help="Certificate for https, PEM.")
@click.option("--key", type=FILE, metavar="FILE", help="Its key.")
@click.option("--console", "buttons", type=FILE, metavar="FILE", help="Buttons of the wizard's page.")
@click.option("--studies", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help="Folder of trials.")
def console_command(users: Path | None, add_user: str | None, observer: bool, **options: Any) -> None:
    """Serve the console: prints its address, ends with Ctrl-C."""
    from ...console.access.users import OBSERVER, OPERATOR
    from ...console.access.users import add_user as write_user

    try:
        if add_user is not None:
            if users is None:
                raise click.UsageError("--add-user NAME goes with --users FILE")
            password = click.prompt(f"Password of {add_user}", hide_input=True, confirmation_prompt=True)
            write_user(users, add_user, OBSERVER if observer else OPERATOR, password)
            click.echo(f"{add_user} is in {users}")
            return
        from ...console.node import serve_console

        serve_console(users=users, **{name: value for name, value in options.items() if value is not None})
    except NaoError as error:
        raise CommandFailed(str(error)) from None

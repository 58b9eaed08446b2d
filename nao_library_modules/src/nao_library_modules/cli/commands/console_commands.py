"""`nao console`: pages in a browser for the person who runs a study, and the check of commands in their files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from naoqi.errors import NaoError

from ..cli_settings import CliSettings, NaoCommand, settings_of
from ..output import CommandFailed, StackMissing, say_json

if TYPE_CHECKING:
    from ...studies.command_check import CommandCheck


def command_check(settings: CliSettings) -> CommandCheck:
    """What checks commands against the servers that run, or, where none does, against the code."""
    from nao_library_msgs.srv import ListBehaviorsRequest

    from ...studies.command_check import CommandCheck
    from ...studies.commands import NotThere

    stack = settings.stack

    def running() -> list[str]:
        try:
            return stack.servers()
        except click.ClickException:
            return []

    def ask(**fields: Any) -> Any:
        try:
            return stack.list_behaviors(ListBehaviorsRequest(**fields), patient=True)
        except StackMissing as error:
            raise NotThere(error.message) from None

    return CommandCheck(stack.describe, running, ask)


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
@click.option("--check", "checked", type=FILE, metavar="FILE", help="Check a file of the wizard's page, and end.")
@click.option("--console", "buttons", type=FILE, metavar="FILE", help="Buttons of the wizard's page.")
@click.option("--studies", type=click.Path(file_okay=False, path_type=Path), metavar="DIR", help="Folder of trials.")
@click.pass_context
def console_command(
    context: click.Context,
    users: Path | None,
    add_user: str | None,
    observer: bool,
    checked: Path | None,
    **options: Any,
) -> None:
    """Serve the console: prints its address, ends with Ctrl-C."""
    from ...console.access.sessions import OBSERVER, OPERATOR
    from ...console.access.sessions import add_user as write_user

    try:
        if checked is not None:
            _check(settings_of(context), checked)
            return
        if add_user is not None:
            if users is None:
                raise click.UsageError("--add-user NAME goes with --users FILE")
            password = click.prompt(f"Password of {add_user}", hide_input=True, confirmation_prompt=True)
            write_user(users, add_user, OBSERVER if observer else OPERATOR, password)
            click.echo(f"{add_user} is in {users}")
            return
        from ...console.app import serve_console

        serve_console(users=users, **{name: value for name, value in options.items() if value is not None})
    except NaoError as error:
        raise CommandFailed(str(error)) from None


def _check(settings: CliSettings, path: Path) -> None:
    """Tell all that is wrong with a file of the wizard's page, each mistake with its line; nothing is started.

    Raises CommandFailed if there is anything.
    """
    from ...console.wizard.layout_file import LayoutFile, layout_problems
    from ...studies.commands import ConsoleFileError

    try:
        layout = LayoutFile(path, path).layout()
        problems = layout_problems(layout, command_check(settings))
    except ConsoleFileError as error:
        problems = [*error.problems]
    if problems:
        told = [str(replace(problem, file=str(path))) for problem in problems]
        raise CommandFailed("\n".join([f"{path} cannot be used:", *told]))
    count = sum(1 for _ in layout.buttons())
    if settings.json:
        say_json({"file": str(path), "buttons": count})
        return
    click.echo(f"nothing wrong was found in {path}: {count} buttons")

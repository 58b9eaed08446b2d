"""`nao completion`: what a shell has to read to complete `nao` commands."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

from ..bash_completion import register
from ..settings import NaoCommand, OneOf

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

"""The command `nao` and the list of what it can be asked; a command is loaded when it is used."""

from __future__ import annotations

import os
import signal
from collections.abc import Sequence
from importlib import import_module
from typing import Any

import click

from .cli_settings import NaoGroup, common_options, settings_of
from .output import BEGUN, INTERRUPTED, SAID, say_json

COMMANDS = {
    "status": ("server", "Robot, battery, posture, servers, goals that run, and what is wrong."),
    "list": ("server", "The servers, or the functions of one."),
    "help": ("server", "What functions do and what they take; searches all servers."),
    "say": ("robot", "Say a text."),
    "leds": ("robot", "Set lights to a colour or an intensity."),
    "pose": ("robot", "Go to a posture: Stand, Crouch, Sit, ..."),
    "walk": ("robot", "Walk to a place: metres ahead and to the left, radians to turn."),
    "wake": ("robot", "Switch the motors on; a robot on its feet stands up."),
    "rest": ("robot", "Go to a safe posture and switch the motors off."),
    "stop": ("robot", "Cancel all goals and stop walking."),
    "photo": ("recording", "Take a picture with the robot's camera."),
    "record": ("recording", "Record a video, a sound, a motion or a behaviour."),
    "run": ("behaviors", "Run a stored behaviour."),
    "behaviors": ("behaviors", "The stored behaviours."),
    "check": ("behaviors", "Whether a behaviour can be run, and what it would do."),
    "study": ("study", "Studies with participants: run a protocol, get its table."),
    "sweep": ("behaviors", "How often a behaviour or a plan falls, over seeds, pushes and errors."),
    "call": ("server", "Call any functions of a server, as one goal."),
    "get": ("naoqi", "Values in the robot's memory."),
    "set": ("naoqi", "Write a value into the robot's memory."),
    "watch": ("naoqi", "Events and values of the robot's memory as they come."),
    "files": ("files", "Files on the robot: list them, get one, put one."),
    "bag": ("tool", "Rosbags whose types have the names of the older packages, and back."),
    "naoqi": ("naoqi", "Services of the robot: their methods, signals and properties, as qicli."),
    "console": ("console", "Pages in a browser for the person who runs a study."),
    "new": ("tool", "Write a skeleton: a package for a study of one's own."),
    "sim": ("simulator", "Touch, push and picture a simulated robot, and rule its time."),
    "completion": ("tool", "Completion for bash, zsh or fish, to be sourced."),
}
"""Command -> the module that has it, and one line of help: the list is shown without loading any."""


COMPLETE = "_NAO_COMPLETE"
"""Variable with which shells ask for completion."""


class Commands(NaoGroup):
    """Finds commands in modules, and loads those that are used."""

    def invoke(self, context: click.Context) -> Any:
        """Run a command; where JSON is wanted and it fails before it has said anything, the error is said in JSON.

        A mistake in the command is told on standard error only.
        """
        settings = settings_of(context)  # made here, so that the commands beneath share it
        try:
            return super().invoke(context)
        except click.UsageError:
            raise
        except click.ClickException as error:
            if settings.json and not context.meta.get(SAID):
                say_json({"error": error.message, "status": error.exit_code}, compact=True)
            raise
        except (click.Abort, KeyboardInterrupt):
            if settings.json and not context.meta.get(BEGUN):  # with Ctrl-C the lines of `nao watch` just end
                say_json({"error": "interrupted", "status": INTERRUPTED}, compact=True)
            raise

    def instead_of(self, word: str) -> str:
        """Behaviours and motions that come along are run by commands."""
        from ..behaviors.server import SHIPPED as BEHAVIORS
        from ..core.files import config_file
        from ..motion.motion_server import SHIPPED as MOTIONS

        for folder, line in ((BEHAVIORS, "nao run {}"), (MOTIONS, "nao call NaoMotion playMotion str_param:={}")):
            if word in {file.stem for file in config_file(folder).glob("*.yaml")}:
                return f": {line.format(word)}"
        return ""

    def list_commands(self, context: click.Context) -> list[str]:
        """Names, in the order of the table."""
        return list(COMMANDS)

    def get_command(self, context: click.Context, name: str) -> click.Command | None:
        """A command by its name; None if there is none."""
        if name not in COMMANDS:
            return None
        module = import_module(f"{__package__}.commands.{COMMANDS[name][0]}_commands")
        return getattr(module, f"{name}_command")

    def format_commands(self, context: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, text) for name, (_, text) in COMMANDS.items()])

    def shell_complete(self, context: click.Context, incomplete: str) -> list[Any]:
        """Names of commands, without loading them, and options."""
        from click.shell_completion import CompletionItem

        commands = [CompletionItem(n, help=text) for n, (_, text) in COMMANDS.items() if n.startswith(incomplete)]
        return commands if not incomplete.startswith("-") else click.Command.shell_complete(self, context, incomplete)


@click.command(
    cls=Commands,
    name="nao",
    context_settings={"help_option_names": ["-h", "--help"]},  # of all commands beneath as well
    params=common_options(),
    epilog="Exit status: 0 done, 1 failed, 2 mistake in the command, 3 nobody to ask, 130 interrupted.",
)
def nao() -> None:
    """Everything a NAO does, from a shell.

    Ctrl-C stops what runs.
    """


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program. `arguments`: those of the process by default. Returns exit status."""
    # A shell that starts it in the background may have it ignore Ctrl-C; a goal must be stoppable all the same.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if COMPLETE in os.environ:
        from .completion import register

        register()
    try:
        nao.main(args=None if arguments is None else list(arguments), prog_name="nao", standalone_mode=False)
    except click.exceptions.Exit as end:
        return end.exit_code
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    return 0

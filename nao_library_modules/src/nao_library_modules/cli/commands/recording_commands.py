"""`nao photo` and `nao record`: pictures, videos, sounds, motions, behaviours."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import click

from ...core.fields import limit
from ..chain_text import Number
from ..cli_settings import CliSettings, NaoCommand, NaoGroup, OneOf, settings_of
from ..goals import GoalEnd, GoalRun, fail, function_message, run_functions, show
from ..output import (
    NO_NAMES,
    CommandFailed,
    CommandInterrupted,
    bring,
    names_file,
    overwrite_option,
    passing_name,
    say_json,
    wanted_file,
)
from .simulator_commands import read_size

VISION, AUDIO_IN, MOTION, BEHAVIOR = "NaoVision", "nao_audio_in", "NaoMotion", "NaoBehavior"
LONGEST = limit("recording").highest
"""s of a recording that ends with Ctrl-C; servers take no longer ones."""
COMPLETION_LIMIT = 60.0
"""s of this computer that a server may take to complete the file of a recording that was cut short."""
STEPS = {"deleteThread": "the file is written"}
"""Function -> what the progress of a recording calls it."""
seconds_option = click.option(
    "--for",
    "seconds",
    type=Number("recording"),
    metavar="S",
    help="How long, in the robot's time; without: until Ctrl-C.",
)
camera_option = click.option(
    "--camera", type=OneOf(("top", "bottom")), default="top", show_default=True, help="Which one."
)


@click.command(cls=NaoCommand, name="photo")
@click.argument("file", default="", type=click.Path())
@camera_option
@click.option("--size", default="", metavar="WxH", help="In pixels; as the camera has them without.")
@overwrite_option
@click.pass_context
def photo_command(context: click.Context, file: str, camera: str, size: str, overwrite: bool) -> None:
    """Take a picture and put it into FILE, a file or a folder; without, it stays in the server's folder."""
    settings = settings_of(context)
    target = wanted_file(file, overwrite)
    named = names_file(target)
    width, height = read_size(size) if size else (0, 0)
    message = function_message(
        settings,
        VISION,
        function="takePicture",
        camera=camera,
        width=width,
        height=height,
        str_param=passing_name() if named else "",
        file_type=Path(file).suffix.lstrip(".").lower().replace("jpeg", "jpg") if named else "",
    )
    end = run_functions(settings, VISION, [message])
    _hand_over(settings, Recorded(end), "pictures", lambda taken: _brought(taken, target, overwrite), alone=True)


@click.group(cls=NaoGroup, name="record")
def record_command() -> None:
    """Record a video, a sound, a motion or a behaviour, for a time or until Ctrl-C."""


@record_command.command("video")
@click.argument("file", default="", type=click.Path())
@seconds_option
@camera_option
@click.option("--rate", type=Number("frame rate"), metavar="HZ", help="At most so many frames a second.")
@overwrite_option
@click.pass_context
def video(
    context: click.Context, file: str, seconds: float | None, camera: str, rate: float | None, overwrite: bool
) -> None:
    """Record a video into FILE (mp4, avi), or into a folder; without, it stays in the server's folder."""
    import rospy

    settings = settings_of(context)
    target = wanted_file(file, overwrite)
    named = names_file(target)
    ident = f"nao-{os.getpid()}"
    start = function_message(
        settings,
        VISION,
        function="startRecording",
        id=ident,
        camera=camera,
        rate=rate,
        str_param=passing_name() if named else "",
        file_type=Path(file).suffix.lstrip(".").lower() if named else "",
        time=rospy.Duration.from_sec(seconds or LONGEST),
    )
    stop = function_message(settings, VISION, function="deleteThread", id=ident)
    recorded = _record(settings, VISION, [start, stop], seconds, STEPS)
    end = recorded.end
    if not end.succeeded and end.result.get("results") != []:  # what was begun goes on by itself
        end = replace(end, result={**end.result, "recordings": _completed(settings, stop)})
    recorded = replace(recorded, end=end)
    _hand_over(settings, recorded, "recordings", lambda film: _brought(film, target, overwrite), alone=True)


@record_command.command("sound")
@click.argument("file", default="", type=click.Path())
@seconds_option
@click.option("--channels", default="", metavar="NAMES", help="Of left, right, front and rear, with commas between.")
@overwrite_option
@click.pass_context
def sound(context: click.Context, file: str, seconds: float | None, channels: str, overwrite: bool) -> None:
    """Record what the microphones hear into FILE (wav, ogg), or into a folder; without, it stays in the robot's folder.

    A real robot keeps it there in any case.
    """
    from ...audio_in.audio_in_fields import FILE_TYPES
    from ...core.nao_facts import full_path

    settings = settings_of(context)
    target = wanted_file(file, overwrite, FILE_TYPES)
    here = settings.stack.graph.parameter(f"{settings.stack.server(AUDIO_IN)}/robot_home")
    if not names_file(target):
        now = time.time()
        name = f"{time.strftime('sound_%Y-%m-%d_%H-%M-%S', time.localtime(now))}.{int(now * 1000) % 1000:03d}.wav"
    else:
        name = f"{passing_name()}{Path(file).suffix}" if here else Path(file).name
    message = function_message(
        settings,
        AUDIO_IN,
        function="record",
        str_param=name,
        duration=seconds or LONGEST,
        channels=[name.strip() for name in channels.split(",") if name.strip()],
        overwrite=overwrite,
    )
    recorded = _record(settings, AUDIO_IN, [message], seconds)

    def place(file: dict[str, Any]) -> str:
        written = file["file"]  # on this computer, if the server can read it
        file["path"] = bring(written, target, overwrite) if written else f"{full_path(name)}, on the robot"
        return f"{file['path']}: {file['duration']:.2f} s"

    _hand_over(settings, recorded, "files", place)


@record_command.command("motion")
@click.argument("name")
@click.argument("joints", nargs=-1)
@seconds_option
@click.option("--limp", is_flag=True, help="The joints can be moved by hand meanwhile.")
@overwrite_option
@click.pass_context
def motion(
    context: click.Context, name: str, joints: tuple[str, ...], seconds: float | None, limp: bool, overwrite: bool
) -> None:
    """Record JOINTS (all without) as the motion NAME; playMotion of NaoMotion replays it."""
    settings = settings_of(context)
    message = function_message(
        settings,
        MOTION,
        function="recordMotion",
        str_param=name,
        names=list(joints) or ["Body"],
        duration=seconds or LONGEST,
        limp=limp,
        overwrite=overwrite,
    )
    recorded = _record(settings, MOTION, [message], seconds)
    show(settings, recorded.end)
    _check(settings, recorded)


@record_command.command("behavior")
@click.argument("name")
@seconds_option
@overwrite_option
@click.pass_context
def behavior(context: click.Context, name: str, seconds: float | None, overwrite: bool) -> None:
    """Keep what is sent to the servers meanwhile as the behaviour NAME; `nao run NAME` does it again."""
    settings = settings_of(context)
    message = function_message(
        settings,
        BEHAVIOR,
        function="recordBehavior",
        str_param=name,
        duration=seconds or LONGEST,
        overwrite=overwrite,
    )
    recorded = _record(settings, BEHAVIOR, [message], seconds)
    show(settings, recorded.end)
    _check(settings, recorded)


@dataclass(frozen=True)
class Recorded:
    """How a recording ended."""

    end: GoalEnd  # of its goal
    by_hand: bool = False  # whether it went on until Ctrl-C, as it was to
    interruption: click.ClickException | None = None  # what this program ended it for, otherwise

    @property
    def as_asked(self) -> bool:
        """Whether it is what was asked for."""
        return self.interruption is None and (self.by_hand or self.end.succeeded)


def _record(
    settings: CliSettings,
    server: str,
    functions: list[Any],
    seconds: float | None,
    called: Mapping[str, str] = NO_NAMES,
) -> Recorded:
    """Run a recording, with words for functions in its progress. Without a time Ctrl-C is its end, no interruption.

    What was recorded until something went wrong is there all the same: nothing is raised that came after the begin.
    """
    # A goal that takes too long is told in JSON at once, and it is not known yet where its file comes to.
    quiet = replace(settings, json=settings.json and settings.timeout is None)
    run = GoalRun(quiet, server, called)
    try:
        return Recorded(run.run(functions))
    except (CommandInterrupted, CommandFailed) as error:
        if run.last is None:
            raise
        if isinstance(error, CommandInterrupted) and seconds is None and run.last.state in ("preempted", "succeeded"):
            return Recorded(run.last, by_hand=True)
        return Recorded(run.last, interruption=error)


def _completed(settings: CliSettings, stop: Any) -> list[dict[str, Any]]:
    """End a recording of a video that goes on without its goal; what its file holds."""
    try:
        end = GoalRun(replace(settings, timeout=COMPLETION_LIMIT, json=False), VISION, STEPS).run([stop])
        if end.succeeded:
            return end.result["recordings"]
        problem = end.text
    except click.ClickException as error:
        problem = error.message
    click.echo(f"the recording {stop.id} may go on at the server: {problem}", err=True)
    return []


def _hand_over(
    settings: CliSettings, recorded: Recorded, field: str, place: Callable[[dict[str, Any]], str], alone: bool = False
) -> None:
    """Put the file that a goal has left where it is wanted, tell of it, and then fail if the goal did.

    Args:
        settings: Of this run.
        recorded: How the goal ended.
        field: Of its result, with what the files hold.
        place: Moves the last one, and answers a line about it.
        alone: Whether JSON of a success is that of the file, not of the goal.
    """
    end = recorded.end
    files = end.result.get(field) or []
    line = ""
    try:
        if not files:
            raise CommandFailed(end.text or "there is no file")
        line = place(files[-1])
    except CommandFailed as error:
        if recorded.as_asked:
            raise
        if files:
            click.echo(error.message, err=True)
    if settings.json:
        say_json(files[-1]) if alone and recorded.as_asked else show(settings, end)
    elif line:
        click.echo(line)
    _check(settings, recorded)


def _check(settings: CliSettings, recorded: Recorded) -> None:
    """Fail as a recording did, when all of it is told."""
    if recorded.interruption is not None:
        raise recorded.interruption
    if not recorded.as_asked:
        fail(replace(settings, json=False), replace(recorded.end, result={}))


def _brought(described: dict[str, Any], target: Path | None, overwrite: bool) -> str:
    """Put a picture or video where it is wanted; where that is."""
    if described.get("error"):
        there = f"; what there is of it: {described['path']}" if described["path"] else ""
        raise CommandFailed(described["error"] + there)
    described["path"] = bring(described["path"], target, overwrite)
    return described["path"]
